// The port's own code and TinyUSB's driver on the model of the part's USB controller, against a host's
// transactions.
#include <algorithm>
#include <cerrno>
#include <limits>
#include <optional>

#include <gtest/gtest.h>
#include <gyrolog_protocol/usb_identity.h>

#include "tests/native_firmware/usb_rig.hpp"

namespace gyrolog {
namespace {

constexpr std::uint8_t gyro_and_accelerometer = glp_layout_gyro | glp_layout_accel;

// What of a stream has arrived, held against the edges of the sensor's own line.
struct StreamAccounts {
    std::uint64_t samples = 0;
    std::uint64_t next_index = 0;
    std::uint64_t jumps = 0;  // samples that an index left out
    std::uint64_t frames_missing = 0;
    std::uint64_t wrong_stamps = 0;  // frames whose ticks are those of no such edge
    std::uint32_t lost_samples = 0;  // as the board says
    bool started = false;
};

class NativeFirmware : public testing::Test {
protected:
    void TearDown() override {
        for (const std::string& one : rig_.board().processor().complaints()) { ADD_FAILURE() << one; }
    }

    // Of the frames since the last EVENT started on.
    StreamAccounts accounts(const std::vector<ArrivedFrame>& frames) {
        StreamAccounts now;
        const std::vector<std::uint64_t>& edges = rig_.board().edges_ticks();
        std::optional<std::uint32_t> sequence;
        constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();
        std::size_t first_edge = unknown;  // of index 0
        for (const ArrivedFrame& one : frames) {
            if (sequence) { now.frames_missing += one.sequence - *sequence - 1U; }
            sequence = one.sequence;
            const glp_frame frame = one.as_frame();
            glp_event event{};
            if (one.type == glp_frame_event && glp_event_read(&frame, &event) == glp_status_ok &&
                event.code == glp_event_started) {
                now = StreamAccounts{};
                now.started = true;
                first_edge = unknown;
            }
            glp_samples samples{};
            if (one.type != glp_frame_samples || glp_samples_read(&frame, &samples) != glp_status_ok) {
                continue;
            }
            if (first_edge == unknown) { first_edge = edge_at(edges, samples); }
            const std::size_t edge = first_edge + samples.first_index;
            if (edge >= edges.size() || static_cast<std::uint32_t>(edges[edge]) != samples.first_ticks) {
                ++now.wrong_stamps;
            }
            now.jumps += samples.first_index - now.next_index;
            now.next_index = samples.first_index + samples.count;
            now.samples += samples.count;
            now.lost_samples = samples.lost_samples;
        }
        return now;
    }

    void expect_every_sample(const StreamAccounts& stream, double rate_hz, double duration_s) {
        EXPECT_TRUE(stream.started);
        EXPECT_EQ(stream.jumps, 0U);
        EXPECT_EQ(stream.frames_missing, 0U);
        EXPECT_EQ(stream.wrong_stamps, 0U);
        EXPECT_EQ(stream.lost_samples, 0U);
        EXPECT_EQ(rig_.damaged_bytes(), 0U);
        // The sensor's clock is 1 % off at most; what is under way takes 0.15 s.
        EXPECT_NEAR(static_cast<double>(stream.samples), rate_hz * duration_s,
                    rate_hz * (0.01 * duration_s + 0.15));
    }

    void start_stream(std::uint32_t rate_hz) {
        ASSERT_TRUE(rig_.enumerate());
        rig_.read(true);
        rig_.configure(rate_hz, gyro_and_accelerometer);
        ASSERT_TRUE(rig_.set_dtr(true));
    }

    static bool holds(const std::vector<ArrivedFrame>& frames, std::uint8_t type) {
        return std::any_of(frames.begin(), frames.end(),
                           [type](const ArrivedFrame& one) { return one.type == type; });
    }

    UsbRig rig_;

private:
    // Where index 0 stands among the edges: by the ticks of the first frame.
    static std::size_t edge_at(const std::vector<std::uint64_t>& edges, const glp_samples& samples) {
        const auto found = std::find_if(edges.rbegin(), edges.rend(), [&](std::uint64_t ticks) {
            return static_cast<std::uint32_t>(ticks) == samples.first_ticks;
        });
        if (found == edges.rend()) { return edges.size(); }
        return static_cast<std::size_t>(edges.rend() - found) - 1 - samples.first_index;
    }
};

TEST_F(NativeFirmware, EnumeratesAsTheSpecificationSays) {
    ASSERT_TRUE(rig_.enumerate());
    EXPECT_EQ(rig_.host().address(), 5U);
    const Bytes device = rig_.descriptor(1);
    ASSERT_EQ(device.size(), 18U);
    EXPECT_EQ(device[8] | device[9] << 8, GLP_USB_VENDOR_ID);
    EXPECT_EQ(device[10] | device[11] << 8, GLP_USB_PRODUCT_ID);
    const Bytes configuration = rig_.descriptor(2);
    ASSERT_GT(configuration.size(), 64U);  // more than one packet
    EXPECT_EQ(configuration.size(), configuration[2] | static_cast<std::size_t>(configuration[3]) << 8U);
    EXPECT_EQ(rig_.text(device[15]).rfind(GLP_USB_PRODUCT_PREFIX, 0), 0U);
    EXPECT_EQ(rig_.text(device[16]), "A1B2C3D40102030405060708090A0B0C");
    EXPECT_TRUE(rig_.board().lit(Led::green));
    EXPECT_EQ(rig_.host().accounts().repeated, 0U);
}

TEST_F(NativeFirmware, StallsWhatItDoesNotKnowAndGoesOn) {
    ASSERT_TRUE(rig_.enumerate());
    EXPECT_EQ(rig_.control({0x80, 6, 9, 3, 0x09, 0x04, 0xFF, 0}).status, -EPIPE);  // string 9
    EXPECT_EQ(rig_.control({0xC0, 1, 0, 0, 0, 0, 8, 0}).status, -EPIPE);           // a vendor's request
    EXPECT_EQ(rig_.descriptor(1).size(), 18U);
}

TEST_F(NativeFirmware, KeepsTheLineCodingThatItIsTold) {
    ASSERT_TRUE(rig_.enumerate());
    const Bytes coding = {0x00, 0x10, 0x0E, 0x00, 0, 0, 8};
    EXPECT_EQ(rig_.control({0x21, GLP_CDC_SET_LINE_CODING, 0, 0, 0, 0, 7, 0}, coding).status, 0);
    EXPECT_EQ(rig_.control({0xA1, GLP_CDC_GET_LINE_CODING, 0, 0, 0, 0, 7, 0}).in_data, coding);
}

TEST_F(NativeFirmware, EverySampleArrivesAt1kHz) {
    start_stream(1000);
    rig_.run_s(30.0);
    expect_every_sample(accounts(rig_.take_frames()), 1000, 30.0);
    EXPECT_EQ(rig_.host().accounts().repeated, 0U);
}

TEST_F(NativeFirmware, EverySampleArrivesAt8kHz) {
    start_stream(8000);
    rig_.run_s(30.0);
    expect_every_sample(accounts(rig_.take_frames()), 8000, 30.0);
    EXPECT_EQ(rig_.host().accounts().repeated, 0U);
}

TEST_F(NativeFirmware, SendsNothingBeforeTheHostOpensThePort) {
    ASSERT_TRUE(rig_.enumerate());
    rig_.read(true);
    rig_.run_s(0.5);
    EXPECT_TRUE(rig_.take_frames().empty());
    EXPECT_FALSE(rig_.board().lit(Led::blue));
}

TEST_F(NativeFirmware, AnswersACommandWithoutAnOpenPort) {
    ASSERT_TRUE(rig_.enumerate());
    rig_.read(true);
    rig_.command(glp_frame_get_hello, {});
    rig_.run_s(0.1);
    const std::vector<ArrivedFrame> frames = rig_.take_frames();
    EXPECT_TRUE(holds(frames, glp_frame_reply));
    EXPECT_TRUE(holds(frames, glp_frame_hello));
    EXPECT_FALSE(holds(frames, glp_frame_samples));
}

TEST_F(NativeFirmware, RepeatsAPacketWhoseHandshakeWasLostAndTheHostTakesItOnce) {
    start_stream(8000);
    for (int i = 0; i < 20; ++i) {
        rig_.run_s(0.1);
        rig_.host().lose_handshakes(2);
    }
    rig_.run_s(0.1);
    EXPECT_EQ(rig_.host().accounts().repeated, 40U);
    expect_every_sample(accounts(rig_.take_frames()), 8000, 2.1);
}

TEST_F(NativeFirmware, CountsWhatAHostThatDoesNotReadLoses) {
    start_stream(8000);
    rig_.run_s(0.5);
    rig_.read(false);
    rig_.run_s(2.0);
    rig_.read(true);
    rig_.run_s(1.0);
    const StreamAccounts stream = accounts(rig_.take_frames());
    EXPECT_GT(stream.frames_missing, 0U);
    EXPECT_GT(stream.jumps, 8000U);
    EXPECT_EQ(stream.wrong_stamps, 0U);
    EXPECT_EQ(stream.lost_samples, stream.jumps);
    EXPECT_NEAR(static_cast<double>(stream.samples + stream.jumps), 8000 * 3.5, 8000 * 0.2);
}

TEST_F(NativeFirmware, NothingIsLostWhereTheHostGivesATransferUp) {
    start_stream(8000);
    for (int i = 0; i < 40; ++i) {
        rig_.run_s(0.0501 + 0.0003 * i);  // wherever in a frame that is
        rig_.read(false);
        rig_.read(true);
    }
    expect_every_sample(accounts(rig_.take_frames()), 8000, 40 * 0.0501 + 0.0003 * 780);
}

// The sensor samples on while its FIFO is read for the last time.
TEST_F(NativeFirmware, StoppingLosesNoSample) {
    start_stream(8000);
    for (int i = 0; i < 20; ++i) {
        rig_.run_s(0.0501 + 0.0003 * i);
        ASSERT_TRUE(rig_.set_dtr(false));
        rig_.run_s(0.1);
        const std::vector<ArrivedFrame> frames = rig_.take_frames();
        ASSERT_FALSE(frames.empty());
        const glp_frame last = frames.back().as_frame();
        glp_event stopped{};
        ASSERT_EQ(glp_event_read(&last, &stopped), glp_status_ok) << "stop " << i;
        EXPECT_EQ(stopped.code, glp_event_stopped);
        EXPECT_EQ(stopped.value, 0) << "samples lost at stop " << i;
        const StreamAccounts stream = accounts(frames);
        EXPECT_EQ(stream.next_index, stopped.index) << "stop " << i;
        EXPECT_EQ(stream.wrong_stamps, 0U) << "stop " << i;
        ASSERT_TRUE(rig_.set_dtr(true));
    }
}

// DTR has not fallen for the host, so that a resumed bus begins a stream of its own accord.
TEST_F(NativeFirmware, SuspendEndsTheStreamAndResumeBeginsAnother) {
    start_stream(1000);
    rig_.run_s(0.5);
    rig_.host().suspend(true);
    rig_.run_s(0.5);
    EXPECT_FALSE(rig_.board().lit(Led::blue));
    EXPECT_TRUE(accounts(rig_.take_frames()).started);
    rig_.host().suspend(false);
    rig_.run_s(1.0);
    EXPECT_TRUE(rig_.board().lit(Led::blue));
    expect_every_sample(accounts(rig_.take_frames()), 1000, 1.0);
}

TEST_F(NativeFirmware, ReplugBeginsAnew) {
    start_stream(1000);
    rig_.run_s(0.5);
    rig_.host().plug(false);
    rig_.run_s(0.5);
    EXPECT_FALSE(rig_.board().lit(Led::blue));
    EXPECT_EQ(rig_.board().lit(Led::green), !part_sees_cable);
    static_cast<void>(rig_.take_frames());
    ASSERT_TRUE(rig_.enumerate());
    EXPECT_TRUE(rig_.board().lit(Led::green));
    ASSERT_TRUE(rig_.set_dtr(true));
    rig_.run_s(1.0);
    const StreamAccounts stream = accounts(rig_.take_frames());
    EXPECT_EQ(stream.jumps, 0U);
    EXPECT_EQ(stream.wrong_stamps, 0U);
    EXPECT_GT(stream.samples, 800U);
}

TEST_F(NativeFirmware, ResetInMidFrameBeginsAnew) {
    start_stream(8000);
    for (int i = 0; i < 20; ++i) {
        rig_.run_s(0.0501 + 0.0003 * i);  // wherever in a frame that is
        ASSERT_TRUE(rig_.enumerate_again()) << "reset " << i;
        EXPECT_FALSE(rig_.board().lit(Led::blue)) << "reset " << i;
        static_cast<void>(rig_.take_frames());
        ASSERT_TRUE(rig_.set_dtr(true));
        rig_.run_s(0.3);
        const StreamAccounts stream = accounts(rig_.take_frames());
        EXPECT_TRUE(stream.started) << "reset " << i;
        EXPECT_EQ(stream.jumps, 0U) << "reset " << i;
        EXPECT_EQ(stream.frames_missing, 0U) << "reset " << i;
        EXPECT_EQ(stream.wrong_stamps, 0U) << "reset " << i;
        EXPECT_GT(stream.samples, 1000U) << "reset " << i;
    }
    EXPECT_EQ(rig_.host().accounts().repeated, 0U);  // no packet came before the toggles began anew
}

TEST_F(NativeFirmware, TakesASetupInPlaceOfTheLastRequestsRest) {
    ASSERT_TRUE(rig_.enumerate());
    for (std::uint32_t id = 1000; id < 1040; ++id) {
        UsbTransfer configuration;
        configuration.id = id;
        configuration.setup = {0x80, 6, 0, 2, 0, 0, 0xFF, 0};
        configuration.in_bytes = 0xFF;
        rig_.host().submit(configuration);
        rig_.board().processor().run_until(rig_.board().processor().now_ticks() +
                                           (id - 1000) * 5 * part_ticks_per_us);
        rig_.host().give_up(id);
        EXPECT_EQ(rig_.descriptor(1).size(), 18U) << id;
    }
}

}  // namespace
}  // namespace gyrolog
