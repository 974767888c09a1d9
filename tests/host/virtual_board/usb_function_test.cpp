#include "host/virtual_board/usb_function.hpp"

#include <gtest/gtest.h>

#include "host/virtual_board/usb_descriptors.hpp"
#include "tests/host/virtual_board/board_stream.hpp"

namespace gyrolog {
namespace {

using SetupPacket = std::array<std::uint8_t, 8>;

class UsbBoard : public testing::Test {
protected:
    std::unique_ptr<VirtualBoard> board = VirtualBoard::create({}).value();
    UsbFunction usb{*board};

    Bytes get(const SetupPacket& setup) {
        const auto response = usb.control(setup, {});
        EXPECT_FALSE(response.stall);
        return response.data;
    }
    void raise_dtr() { EXPECT_FALSE(usb.control({0x21, 0x22, 3, 0, 0, 0, 0, 0}, {}).stall); }
};

TEST_F(UsbBoard, EnumeratesAsACdcAcmDevice) {
    const Bytes device = get({0x80, 6, 0, 1, 0, 0, 64, 0});
    ASSERT_EQ(device.size(), 18U);
    EXPECT_EQ(device[0], 18);
    EXPECT_EQ(device[4], 0x02);  // communications
    EXPECT_EQ(device[8] + 256 * device[9], 0x1209);
    EXPECT_EQ(device[10] + 256 * device[11], 0x6779);

    const Bytes configuration = get({0x80, 6, 0, 2, 0, 0, 255, 0});
    EXPECT_EQ(configuration[2] + 256U * configuration[3], configuration.size());
    EXPECT_EQ(configuration[4], 2);  // interfaces
    // Descriptors follow each other to the end without a hole, and the three endpoints are among them.
    Bytes endpoints;
    std::size_t at = 0;
    while (at < configuration.size()) {
        ASSERT_GT(configuration[at], 1);
        if (configuration[at + 1] == 5) { endpoints.push_back(configuration[at + 2]); }
        at += configuration[at];
    }
    EXPECT_EQ(at, configuration.size());
    EXPECT_EQ(endpoints, (Bytes{0x82, 0x81, 0x01}));
}

TEST_F(UsbBoard, GivesNoMoreThanAskedForAndItsStrings) {
    EXPECT_EQ(get({0x80, 6, 0, 1, 0, 0, 8, 0}).size(), 8U);
    const Bytes serial = get({0x80, 6, 3, 3, 9, 4, 255, 0});
    EXPECT_EQ(serial, (Bytes{16, 3, 'S', 0, 'I', 0, 'M', 0, '0', 0, '0', 0, '0', 0, '1', 0}));
    EXPECT_EQ(get({0x80, 6, 0, 3, 0, 0, 255, 0}), (Bytes{4, 3, 0x09, 0x04}));
    EXPECT_TRUE(usb.control({0x80, 6, 9, 3, 9, 4, 255, 0}, {}).stall);
    EXPECT_TRUE(usb.control({0x80, 6, 0, 6, 0, 0, 10, 0}, {}).stall);  // no device qualifier: full speed only
}

TEST_F(UsbBoard, KeepsTheLineCodingAndTheConfiguration) {
    const Bytes coding = {0x80, 0x25, 0, 0, 0, 0, 8};
    EXPECT_FALSE(usb.control({0x21, 0x20, 0, 0, 0, 0, 7, 0}, coding).stall);
    EXPECT_EQ(get({0xA1, 0x21, 0, 0, 0, 0, 7, 0}), coding);
    EXPECT_TRUE(usb.control({0x21, 0x20, 0, 0, 0, 0, 3, 0}, ByteView(coding).first(3)).stall);
    EXPECT_FALSE(usb.control({0x00, 9, 1, 0, 0, 0, 0, 0}, {}).stall);
    EXPECT_EQ(get({0x80, 8, 0, 0, 0, 0, 1, 0}), Bytes{1});
    EXPECT_TRUE(usb.control({0x00, 9, 2, 0, 0, 0, 0, 0}, {}).stall);
    EXPECT_EQ(get({0x80, 0, 0, 0, 0, 0, 2, 0}), (Bytes{0, 0}));
}

TEST_F(UsbBoard, StreamsInRealTimeOnceDtrIsUp) {
    std::int64_t now_ns = 5'000'000'000;
    BoardStream stream;
    Bytes buffer(512);
    usb.advance_to(now_ns);
    EXPECT_EQ(usb.bulk_in(buffer), std::nullopt);
    raise_dtr();
    std::size_t short_transfers = 0;
    for (int i = 0; i < 2000; ++i) {
        now_ns += 1'000'000;
        usb.advance_to(now_ns);
        while (const auto size = usb.bulk_in(buffer)) {
            short_transfers += *size % 64 != 0;
            stream.feed(ByteView(buffer).first(*size));
        }
    }
    EXPECT_NEAR(static_cast<double>(stream.indices.size()), 200.0, 5.0);
    EXPECT_TRUE(stream.indices_consecutive());
    EXPECT_EQ(stream.missing_sequences(), 0U);
    EXPECT_GT(short_transfers, 40U);
}

TEST_F(UsbBoard, AHostThatDoesNotReadLosesWholeFramesAndIsTold) {
    std::int64_t now_ns = 0;
    usb.advance_to(now_ns);
    raise_dtr();
    now_ns += 10'000'000'000;  // 20 kB, of which the ring holds 4
    usb.advance_to(now_ns);
    BoardStream stream;
    Bytes buffer(512);
    for (int i = 0; i < 100; ++i) {
        now_ns += 10'000'000;
        usb.advance_to(now_ns);
        while (const auto size = usb.bulk_in(buffer)) { stream.feed(ByteView(buffer).first(*size)); }
    }
    EXPECT_GT(stream.missing_sequences(), 0U);
    EXPECT_GT(stream.lost_samples, 0U);
    EXPECT_EQ(stream.frames_refused(), 0U);
}

TEST_F(UsbBoard, AnswersCommandsAndFallsQuietOnABusReset) {
    usb.advance_to(0);
    usb.bulk_out(command_bytes(glp_frame_get_hello));
    BoardStream stream;
    Bytes buffer(512);
    while (const auto size = usb.bulk_in(buffer)) { stream.feed(ByteView(buffer).first(*size)); }
    EXPECT_EQ(stream.replies.size(), 1U);
    EXPECT_EQ(stream.hellos.size(), 1U);
    raise_dtr();
    EXPECT_TRUE(board->streaming());
    usb.bus_reset();
    EXPECT_FALSE(board->streaming());
    EXPECT_EQ(get({0x80, 8, 0, 0, 0, 0, 1, 0}), Bytes{0});
}

}  // namespace
}  // namespace gyrolog
