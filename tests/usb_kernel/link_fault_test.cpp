#include "tools/vhci_board/link_fault.hpp"

#include <cerrno>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

TEST(LinkFault, IsAKindAndATime) {
    const auto fault = parse_link_fault("babble@2.5");
    ASSERT_TRUE(fault.ok());
    EXPECT_EQ(fault->kind, LinkFaultKind::babble);
    EXPECT_EQ(fault->at_s, 2.5);
}

TEST(LinkFault, OfAnotherFormIsRefused) {
    for (const char* text : {"", "stall", "stall@", "@1", "smoke@1", "crc@1s", "crc@-1", "crc@nan"}) {
        EXPECT_FALSE(parse_link_fault(text).ok()) << text;
    }
}

// Linux kernel documentation, "USB Error codes", for transfers that complete.
TEST(LinkFault, ReportsTheStatusThatTheKernelDocuments) {
    EXPECT_EQ(link_fault_status(LinkFaultKind::stall), -EPIPE);
    EXPECT_EQ(link_fault_status(LinkFaultKind::babble), -EOVERFLOW);
    EXPECT_EQ(link_fault_status(LinkFaultKind::crc), -EPROTO);
}

}  // namespace
}  // namespace gyrolog
