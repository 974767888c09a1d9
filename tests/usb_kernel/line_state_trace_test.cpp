#include "tools/vhci_board/line_state_trace.hpp"

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// As a 6.1 kernel wrote them while a terminal was opened and closed.
constexpr std::string_view opened_and_closed =
    "          <idle>-0       [001] dNs2.     2.939961: line_state: (acm_setup+0x0/0x1aa [usb_f_acm]) "
    "request=34 value=3\n"
    "          <idle>-0       [001] d.s2.     2.944460: line_state: (acm_setup+0x0/0x1aa [usb_f_acm]) "
    "request=34 value=0\n";

TEST(LineStateTrace, TellsTheValueOfEachRequest) {
    LineStateTrace trace;
    EXPECT_EQ(trace.append(opened_and_closed), (std::vector<unsigned>{3, 0}));
}

TEST(LineStateTrace, DoesNotDependOnHowTheTextIsCut) {
    for (std::size_t cut = 0; cut <= opened_and_closed.size(); ++cut) {
        LineStateTrace trace;
        std::vector<unsigned> values = trace.append(opened_and_closed.substr(0, cut));
        for (const unsigned value : trace.append(opened_and_closed.substr(cut))) { values.push_back(value); }
        EXPECT_EQ(values, (std::vector<unsigned>{3, 0})) << "cut at " << cut;
    }
}

TEST(LineStateTrace, IgnoresLinesThatAreNotTheProbes) {
    LineStateTrace trace;
    EXPECT_TRUE(trace.append("CPU:1 [LOST 12 EVENTS]\n value=\n value=0x3\n").empty());
}

}  // namespace
}  // namespace gyrolog
