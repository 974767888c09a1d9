// A board whose frames are all in order, and that does not sample.
#include "host/decode/sample_liveness.hpp"

#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/host/decode/made_stream.hpp"

namespace gyrolog {
namespace {

// At 100 Hz, ten samples of one axis triple a frame.
class Readings {
public:
    Readings() {
        glp_hello hello{};
        hello.tick_hz = 1'000'000;
        hello.tick_bits = 32;
        liveness.take_hello(hello);
    }
    // The counts of gyro x, y and z are `reading`.
    void take(std::uint8_t reading, int frames) {
        const std::vector<std::uint8_t> values(std::size_t{10} * 6, reading);
        for (int i = 0; i < frames; ++i) {
            const glp_samples samples{ticks, 0, 1, 100, 0, 10, glp_layout_gyro, values.data()};
            ticks = (ticks + 100'000) & 0xFFFF'FFFFU;
            liveness.take_samples(samples, 100.0);
        }
    }

    SampleLiveness liveness;
    std::uint64_t ticks = 0;
};

TEST(SampleLiveness, OneReadingForMoreThanTwoSecondsIsAFrozenSensor) {
    Readings readings;
    for (std::uint8_t i = 0; i < 50; ++i) { readings.take(i, 1); }
    readings.take(100, 20);
    EXPECT_EQ(readings.liveness.frozen_samples(), 0U) << "2.0 s are within the limit";
    readings.take(100, 10);
    EXPECT_EQ(readings.liveness.frozen_samples(), 299U) << "each repeat of the first";
    EXPECT_NEAR(readings.liveness.frozen_now_s(), 3.0, 0.02);
    readings.take(101, 1);
    EXPECT_EQ(readings.liveness.frozen_samples(), 299U);
    EXPECT_EQ(readings.liveness.frozen_now_s(), 0.0);
    readings.take(102, 30);
    EXPECT_EQ(readings.liveness.frozen_samples(), 598U);
}

// Counted one sample after the other, by the definition.
struct RepeatCount {
    void take(std::uint8_t reading) {
        if (last == reading) {
            ++repeats;
        } else {
            frozen_before += counted();
            repeats = 0;
        }
        last = reading;
    }
    std::uint64_t counted() const { return repeats >= least ? repeats : 0; }

    std::uint64_t least;
    int last = -1;  // none yet
    std::uint64_t repeats = 0;
    std::uint64_t frozen_before = 0;
};

TEST(SampleLiveness, CountsEveryLongStretchWhereverTheFramesEnd) {
    std::mt19937 random(7);
    std::uint64_t frozen = 0;
    for (std::uint64_t least = 1; least <= 9; ++least) {
        SampleLiveness liveness({.frozen_s = 0.0, .frozen_samples = least});
        RepeatCount expected{least};
        for (int frame = 0; frame < 2000; ++frame) {
            std::uint8_t reading = 0;
            std::vector<std::uint8_t> values;
            const std::size_t count = 1 + random() % 20;
            for (std::size_t i = 0; i < count; ++i) {
                if (random() % 5 == 0) { reading = static_cast<std::uint8_t>(random() % 3); }
                values.insert(values.end(), 6, reading);
                expected.take(reading);
            }
            liveness.take_samples(
                {0, 0, 1, 100, 0, static_cast<std::uint8_t>(count), glp_layout_gyro, values.data()}, 100.0);
            ASSERT_EQ(liveness.frozen_samples(), expected.frozen_before + expected.counted())
                << "frame " << frame << ", least " << least;
        }
        frozen += expected.frozen_before;
    }
    EXPECT_GT(frozen, 10'000U);
}

TEST(SampleLiveness, BoardsClockRunsOnOverItsOwnWrap) {
    Readings readings;
    readings.ticks = 0xFFFF'0000U;
    readings.take(1, 1);
    const std::uint64_t last = 0xFFFF'0000U;
    glp_device_status status{};
    status.streaming = 1;
    for (std::uint64_t second = 1; second <= 5000; ++second) {  // more than one round of 4295 s
        status.ticks = (last + second * 1'000'000) & 0xFFFF'FFFFU;
        readings.liveness.take_status(status);
    }
    EXPECT_DOUBLE_EQ(readings.liveness.silent_s(), 5000.0);
    EXPECT_EQ(readings.liveness.silent_instants(100.0), 500'000U - 10U);
    status.streaming = 0;
    readings.liveness.take_status(status);
    readings.take(2, 1);
    EXPECT_EQ(readings.liveness.silent_s(), 0.0);
}

TEST(SampleLiveness, SamplesThatStopAreMissingByTheBoardsClock) {
    Listening link;
    link.begin();
    link.hear_samples(200);
    const std::uint64_t good = link.decoder.report().samples.good;
    for (int second = 0; second < 2; ++second) {
        link.hear(link.board.status_frame());
        link.board.start_s += 0.99;
    }
    EXPECT_TRUE(link.decoder.report().complete()) << "less than two seconds are no proof";
    for (int second = 0; second < 8; ++second) {
        link.board.start_s += 1.0;
        link.hear(link.board.status_frame());
    }
    const LinkReport report = link.decoder.report();
    EXPECT_FALSE(report.complete());
    EXPECT_EQ(report.samples.good, good);
    // 9.98 s at 1003 Hz, known to a frame of 16.
    EXPECT_NEAR(static_cast<double>(report.samples.missing), 9.98 * 1003.0, 17.0);
    ASSERT_EQ(report.dropouts.size(), 1U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::silent);
    EXPECT_EQ(report.dropouts[0].first_index, good);
}

TEST(SampleLiveness, BoardThatNeverSamplesIsSilentFromItsStart) {
    Listening link;
    link.hear(link.board.hello_frame());
    link.hear(link.board.config_frame());
    link.hear(link.board.event_frame(glp_event_started));
    for (int second = 0; second < 5; ++second) {
        link.board.start_s += 1.0;
        link.hear(link.board.status_frame());
    }
    EXPECT_NEAR(link.decoder.liveness().silent_s(), 5.0, 1e-6);
    const LinkReport report = link.decoder.report();
    EXPECT_FALSE(report.complete());
    EXPECT_NEAR(static_cast<double>(report.samples.missing), 5000.0, 1.0);
}

TEST(SampleLiveness, StoppedBoardIsNotSilent) {
    Listening link;
    link.begin();
    link.hear_samples(10);
    link.hear(link.board.event_frame(glp_event_stopped));
    link.board.start_s += 100.0;
    link.hear(link.board.event_frame(glp_event_text));
    EXPECT_LT(link.decoder.liveness().silent_s(), 0.1) << "the frame before the stop";
    EXPECT_TRUE(link.decoder.report().complete());
}

}  // namespace
}  // namespace gyrolog
