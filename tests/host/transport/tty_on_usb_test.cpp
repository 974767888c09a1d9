// A serial port with a USB device behind it: the kernel's files tell who that is.
#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "host/transport/tty_source.hpp"
#include "tests/support/collecting_sink.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/umockdev_board.hpp"

namespace gyrolog {
namespace {

using test::CollectingSink;
using test::MockUsbIdentity;

// A pseudo-terminal carries the bytes.
class TtyOnUsb : public testing::Test {
protected:
    void SetUp() override {
        if (!bus_.in_force()) { GTEST_SKIP() << needs_umockdev_wrapper; }
        board_ = posix_openpt(O_RDWR | O_NOCTTY);
        ASSERT_GE(board_, 0);
        ASSERT_EQ(grantpt(board_), 0);
        ASSERT_EQ(unlockpt(board_), 0);
        path_ = ptsname(board_);
    }
    void TearDown() override {
        if (board_ >= 0) { close(board_); }
    }

    // The endpoints by which data and commands are told of.
    void expect_told_by(std::uint8_t in, std::uint8_t out) {
        auto source = TtySource::open(path_);
        ASSERT_TRUE(source.ok()) << source.error().message;
        identity_ = (*source)->identity();
        CollectingSink sink;
        ASSERT_TRUE((*source)->start(sink).ok());
        ASSERT_EQ(write(board_, "data", 4), 4);
        EXPECT_TRUE(sink.wait_for_bytes(4));
        EXPECT_TRUE((*source)->write(as_bytes("command")).ok());
        (*source)->stop();
        std::size_t told_in = 0;
        std::size_t told_out = 0;
        for (const CollectingSink::Told& one : sink.told()) {
            if (one.transfer.kind != TransferKind::bulk) { continue; }
            told_in += one.transfer.endpoint == in ? 1U : 0U;
            told_out += one.transfer.endpoint == out ? 1U : 0U;
            EXPECT_TRUE(one.transfer.endpoint == in || one.transfer.endpoint == out);
        }
        EXPECT_GT(told_in, 0U);
        EXPECT_EQ(told_out, 2U);
    }

    test::UmockdevBus bus_;
    int board_ = -1;
    std::string path_;
    SourceIdentity identity_;
};

TEST_F(TtyOnUsb, TransfersAreToldByTheDescriptorsEndpoints) {
    MockUsbIdentity identity;
    identity.configuration_descriptor = test::cdc_acm_configuration(0x82, 0x02, 0x81);
    bus_.add_serial_port(identity, path_.substr(path_.rfind('/') + 1));
    expect_told_by(0x82, 0x02);
    EXPECT_EQ(identity_.vendor_id, 0x1209);
    EXPECT_EQ(identity_.product_id, 0x6779);
    EXPECT_EQ(identity_.serial, "S1");
    EXPECT_EQ(identity_.configuration_descriptor, identity.configuration_descriptor);
    EXPECT_EQ(identity_.device_descriptor.size(), 18U);
}

TEST_F(TtyOnUsb, ABridgesEndpointsAreNotTheBoards) {
    MockUsbIdentity bridge;
    bridge.vendor_id = 0x0403;
    bridge.product_id = 0x6001;
    bridge.configuration_descriptor = {9, 2, 32, 0, 1,    1, 0,  0x80, 50, 9, 4, 0,    0, 2,  0xFF, 0xFF,
                                       0, 0, 7,  5, 0x81, 2, 64, 0,    0,  7, 5, 0x02, 2, 64, 0,    0};
    bus_.add_serial_port(bridge, path_.substr(path_.rfind('/') + 1));
    expect_told_by(line_endpoint_in, line_endpoint_out);
    EXPECT_EQ(identity_.vendor_id, 0x0403);
    EXPECT_TRUE(identity_.configuration_descriptor.empty());
}

}  // namespace
}  // namespace gyrolog
