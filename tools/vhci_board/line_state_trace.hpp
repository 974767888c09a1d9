// DTR as a kernel probe tells it. The ACM function of the gadget stack keeps the host's
// SET_CONTROL_LINE_STATE to itself (its handler acm_setup only stores the value), so a tracing probe on that
// handler has to.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gyrolog {

// Takes the text of trace_pipe, however it is cut, and gives the values of the requests in it: each line of
// the probe ends in " value=N", with N as in the request (bit 0 is DTR).
class LineStateTrace {
public:
    std::vector<unsigned> append(std::string_view text);

private:
    std::string line_;
};

}  // namespace gyrolog
