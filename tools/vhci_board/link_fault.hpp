// Faults of the wire between board and host, as a host controller reports them.
#pragma once

#include <string>
#include <string_view>

#include "host/base/result.hpp"

namespace gyrolog {

enum class LinkFaultKind {
    stall,   // the endpoint halts: -EPIPE until the host clears it
    babble,  // a packet longer than there is room for: -EOVERFLOW
    crc,     // no intact packet in three tries: -EPROTO
};

// One bulk IN transfer fails, the first that waits `at_s` seconds after the host first raised DTR.
struct LinkFault {
    LinkFaultKind kind = LinkFaultKind::stall;
    double at_s = 0.0;
};

// The status with which the transfer completes.
int link_fault_status(LinkFaultKind kind);

// "stall@2.5"
Result<LinkFault> parse_link_fault(std::string_view text);

}  // namespace gyrolog
