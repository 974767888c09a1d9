// From a stream to columns, segments and times.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/host/decode/made_stream.hpp"

namespace gyrolog {
namespace {

const std::vector<std::int16_t>& counts(const Recording& recording, std::string_view name) {
    const Column* column = recording.find(name);
    EXPECT_NE(column, nullptr) << name;
    return std::get<std::vector<std::int16_t>>(column->data);
}

TEST(DecodedRecording, HoldsEveryCountInItsColumn) {
    Listening link;
    link.begin();
    link.hear_samples(99);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->name, "bench");
    EXPECT_EQ(recording->rows(), 1600U);
    const char* names[] = {"gx", "gy", "gz", "ax", "ay", "az"};
    for (std::size_t field = 0; field < 6; ++field) {
        const auto& column = counts(*recording, names[field]);
        for (std::size_t i = 0; i < column.size(); ++i) { ASSERT_EQ(column[i], made_value(i, field)); }
    }
    EXPECT_EQ(counts(*recording, "temp"), std::vector<std::int16_t>(1600, 100));
    ASSERT_EQ(recording->segments.size(), 1U);
    EXPECT_EQ(recording->segments[0].count, 1600U);
    EXPECT_TRUE(recording->dropouts.empty());
    EXPECT_TRUE(recording->warnings.empty());
}

TEST(DecodedRecording, GivesValuesInTheirUnits) {
    Listening link;
    link.begin();
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    // One count at 500 deg/s full scale is 1/65.5 deg/s; at 8 g it is 1/4096 g (MPU-9250 product
    // specification, tables 1 and 2). The temperature is counts/333.87 + 21 degC (register map, 4.23).
    EXPECT_NEAR(recording->find("gy")->value(3), made_value(3, 1) / 65.5 * std::numbers::pi / 180.0, 1e-6);
    EXPECT_NEAR(recording->find("az")->value(3), made_value(3, 5) / 4096.0 * 9.80665, 1e-9);
    EXPECT_NEAR(recording->find("temp")->value(0), 100 / 333.87 + 21.0, 1e-6);
}

TEST(DecodedRecording, KnowsTheSensorsFilters) {
    Listening link;
    link.board.config.dlpf_hz = 20;
    link.board.config.registers[4] = 5;  // ACCEL_CONFIG2
    link.begin();
    link.hear_samples(9);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_EQ(recording->find("gx")->bandwidth_hz, 20.0);
    EXPECT_EQ(recording->find("az")->bandwidth_hz, 10.0);
    EXPECT_EQ(recording->find("temp")->bandwidth_hz, 0.0);
}

TEST(DecodedRecording, LeavesAHoleOfTheTrueLengthForADropout) {
    Listening link;
    link.begin();
    link.hear_samples(9);
    link.board.lose_samples(12);
    link.hear(link.board.samples_frame(glp_flag_sensor_fifo_overflow));
    link.hear_samples(200);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    ASSERT_EQ(recording->segments.size(), 2U);
    EXPECT_EQ(recording->segments[1].first, 160U);
    EXPECT_EQ(recording->segments[1].first_index, 172);
    EXPECT_EQ(recording->missing_samples(), 12);
    ASSERT_EQ(recording->dropouts.size(), 1U);
    EXPECT_EQ(recording->dropouts[0].samples, 12);
    EXPECT_EQ(recording->dropouts[0].cause, "sensor_fifo_overflow");
    EXPECT_NEAR(recording->dropouts[0].at_s, 160 / 1003.0, 1e-5);
    EXPECT_EQ(counts(*recording, "gx")[160], made_value(172, 0));
}

TEST(DecodedRecording, EstimatesTheSensorsRateWithinItsUncertainty) {
    Listening link;
    link.begin();
    link.hear_samples(1000);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    ASSERT_TRUE(recording->rate_sd_hz);
    EXPECT_EQ(recording->nominal_rate_hz, 1000.0);
    EXPECT_EQ(recording->stamps, StampKind::sampling);
    EXPECT_LT(std::abs(recording->rate_hz - 1003.0), 5.0 * *recording->rate_sd_hz);
    // 1001 stamps of 1 us over 16 s: sd of the slope is (1 us / sqrt(12)) / (16 s / sqrt(12) * sqrt(1001)) =
    // 2e-9.
    EXPECT_NEAR(*recording->rate_sd_hz / 1003.0, 2e-9, 1e-9);
}

// 1600 samples; as many more begin at this instant of the same grid.
constexpr double restarted_at = 1600 + 7.25 * 1003.0;

void hear_a_restart(Listening& link) {
    link.begin();
    link.hear_samples(99);
    link.hear(link.board.event_frame(glp_event_stopped));
    link.board.restart(restarted_at / 1003.0);
    link.hear(link.board.samples_frame(glp_flag_first_after_start));
    link.hear_samples(99);
}

TEST(DecodedRecording, SetsARestartApartByTheBoardsTicks) {
    Listening link;
    hear_a_restart(link);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    ASSERT_EQ(recording->segments.size(), 2U);
    EXPECT_EQ(recording->segments[1].first_index, std::llround(restarted_at));
    ASSERT_EQ(recording->dropouts.size(), 1U);
    EXPECT_EQ(recording->dropouts[0].cause, stopped_cause);
    EXPECT_EQ(recording->dropouts[0].samples, recording->missing_samples());
    EXPECT_EQ(recording->stops().events, 1U);
    EXPECT_NEAR(recording->stops().s, 7.25, 1e-3);
}

// Rows of means are on one grid, too: the later run's begin at the nearest of its places.
TEST(DecodedRecording, SetsARestartApartInMeans) {
    constexpr std::size_t samples = 12;
    Listening link(samples);
    hear_a_restart(link);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_NEAR(recording->rate_hz * samples, 1003.0, 1e-3);
    ASSERT_EQ(recording->segments.size(), 2U);
    EXPECT_EQ(recording->segments[0].count, 1600U / samples) << "the last four are no row";
    EXPECT_EQ(recording->segments[1].first_index, std::llround(restarted_at / samples));
    EXPECT_EQ(recording->rows(), 2U * (1600U / samples));
    const auto& means = std::get<std::vector<double>>(recording->find("gx")->data);
    double sum = 0.0;
    for (std::size_t i = 0; i < samples; ++i) { sum += made_value(samples + i, 0); }
    EXPECT_NEAR(means[1], sum / samples, 1e-9);
}

TEST(DecodedRecording, SetsAResetApartByTheHostsClock) {
    Listening link;
    link.begin();
    link.hear_samples(99);
    link.board.hello.boot_id = 2;
    link.board.sequence = 0;
    link.board.restart(30.0);
    link.board.ticks_offset = static_cast<std::uint64_t>(-29'000'000LL);
    link.begin();
    link.hear_samples(99);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    ASSERT_EQ(recording->segments.size(), 2U);
    EXPECT_NEAR(static_cast<double>(recording->segments[1].first_index), 30.0 * 1003.0, 2.0);
    ASSERT_EQ(recording->warnings.size(), 1U);
}

// A board that has kept its memory: its ticks say to the sample how long it was away.
TEST(DecodedRecording, JoinsConnectionsByTheBoardsTicks) {
    Listening link;
    link.begin();
    link.hear_samples(99);
    link.decoder.begin_connection();
    link.board.sequence += 2;  // a partial frame and its EVENT, which nobody took
    link.board.restart(1600 / 1003.0 + 7200.25);
    link.board.delay_s = 0.4;  // the host's clock would be off by as much
    link.begin();
    link.hear_samples(99);
    const LinkReport report = link.decoder.report();
    EXPECT_FALSE(report.complete());
    ASSERT_EQ(report.dropouts.size(), 1U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::unplugged);
    EXPECT_EQ(report.dropouts[0].samples, std::llround(7200.25 * 1003.0));
    EXPECT_EQ(report.samples.missing, report.dropouts[0].samples);
    EXPECT_EQ(report.samples_in_joins, report.dropouts[0].samples);
    EXPECT_EQ(report.boots, 1U);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    ASSERT_EQ(recording->segments.size(), 2U);
    EXPECT_EQ(recording->segments[1].first_index, 1600 + std::llround(7200.25 * 1003.0));
    ASSERT_EQ(recording->dropouts.size(), 1U);
    EXPECT_EQ(recording->dropouts[0].cause, "unplugged");
    EXPECT_EQ(recording->dropouts[0].samples, recording->missing_samples());
    EXPECT_NEAR(recording->dropouts[0].at_s, 1600 / 1003.0, 1e-5);
}

// A board that has booted: only the pause is measured by the host's clock, and not the hours before it, in
// which the board's clock has parted from the host's.
TEST(DecodedRecording, JoinsBootsByTheHostsClockOfTheTimeAboutThePause) {
    Listening link;
    link.board.host_ratio = 1.0 + 100e-6;
    link.begin();
    const std::size_t frames = 3600 * 1003 / 16;
    link.hear_samples(frames);
    const double end_s = link.board.time_s();
    const double end_host_s = static_cast<double>(link.board.now().monotonic_ns) * 1e-9;
    link.decoder.begin_connection();
    link.board.hello.boot_id = 2;
    link.board.sequence = 0;
    link.board.restart(0.0);
    link.board.ticks_offset = 77;
    // The host's clock goes on by the pause of 30 s.
    const double pause_s = 30.0;
    const double shift_s = end_host_s + pause_s - static_cast<double>(link.board.now().monotonic_ns) * 1e-9;
    link.board.delay_s += shift_s;
    link.begin();
    link.hear_samples(99);
    const LinkReport report = link.decoder.report();
    ASSERT_EQ(report.dropouts.size(), 1U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::reset);
    EXPECT_EQ(report.frames.missing, 0U);
    EXPECT_EQ(report.boots, 2U);
    EXPECT_GT(end_s, 3599.0);
    EXPECT_NEAR(static_cast<double>(report.dropouts[0].samples), pause_s * 1003.0, 1.0)
        << "100 ppm of an hour would be 361 samples";
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_NEAR(static_cast<double>(recording->missing_samples()), pause_s * 1003.0, 1.0);
}

TEST(DecodedRecording, HalfAFrameOfAnEndedConnectionIsSkipped) {
    Listening link;
    link.begin();
    const Bytes torn = link.board.samples_frame();
    link.decoder.feed(ByteView(torn).first(torn.size() / 2), link.board.now());
    EXPECT_GT(link.decoder.report().bytes.buffered, 0U);
    link.decoder.begin_connection();
    EXPECT_EQ(link.decoder.report().bytes.buffered, 0U);
    link.board.restart(60.0);
    link.begin();
    link.hear_samples(3);
    const LinkReport report = link.decoder.report();
    EXPECT_TRUE(report.bytes.balanced());
    EXPECT_EQ(report.bytes.skipped, torn.size() / 2);
    EXPECT_EQ(report.frames.good, 9U);
    EXPECT_EQ(report.frames.corrupted, 0U);
}

// What a booted board answers before its HELLO has small numbers, and is no duplicate.
TEST(DecodedRecording, AnswerOfABootedBoardBeforeItsHelloIsTaken) {
    Listening link;
    link.begin();
    link.hear_samples(99);
    link.decoder.begin_connection();
    link.board.sequence = 0;
    link.board.hello.boot_id = 2;
    link.board.restart(0.0);
    link.hear(link.board.config_frame());
    link.begin();
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.duplicated, 0U);
    EXPECT_EQ(report.boots, 2U);
}

TEST(DecodedRecording, KeepsTheLongestConfigurationAndNamesTheRest) {
    Listening link;
    link.begin();
    link.hear_samples(9);
    link.board.config.generation = 2;
    link.board.config.gyro_ndps_per_lsb = 60'975'610;
    link.hear(link.board.config_frame());
    link.hear_samples(50);
    link.board.config.generation = 3;
    link.board.layout = link.board.config.layout = glp_layout_gyro;
    link.hear(link.board.config_frame());
    link.hear_samples(20);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_EQ(recording->rows(), 800U);
    EXPECT_EQ(recording->segments[0].first_index, 0);
    EXPECT_NEAR(recording->columns[0].scale, 60'975'610e-9 * std::numbers::pi / 180.0, 1e-15);
    ASSERT_EQ(recording->warnings.size(), 1U);
    EXPECT_NE(recording->warnings[0].find("480 samples"), std::string::npos);
    EXPECT_EQ(counts(*recording, "gx")[0], made_value(160, 0));
}

TEST(DecodedRecording, LearnsTheScaleOfEarlierSamplesWhenItJoinsAStream) {
    Listening link;
    link.hear_samples(10);
    link.hear(link.board.hello_frame());
    link.hear(link.board.config_frame());
    link.hear_samples(10);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_EQ(recording->rows(), 320U);
}

// SPEC.md, 9.5.
TEST(DecodedRecording, SamplesWhoseConfigurationNeverCameAreLeftOutAndCounted) {
    Listening link;
    link.hear_samples(3);
    ++link.board.config.generation;
    link.hear(link.board.hello_frame());
    link.hear(link.board.config_frame());
    link.hear_samples(10);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_EQ(recording->rows(), 160U);
    ASSERT_EQ(recording->warnings.size(), 1U);
    EXPECT_EQ(recording->warnings[0], "48 samples whose configuration was never told are left out");
}

TEST(DecodedRecording, WithoutAHelloTheRateIsTheNominalOne) {
    Listening link;
    link.hear(link.board.config_frame());
    link.hear_samples(20);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_EQ(recording->rows(), 320U);
    EXPECT_EQ(recording->rate_hz, 1000.0);
    ASSERT_EQ(recording->warnings.size(), 1U);
    EXPECT_NE(recording->warnings[0].find("no HELLO"), std::string::npos) << recording->warnings[0];
}

TEST(DecodedRecording, RefusesToGuessAScale) {
    Listening link;
    link.hear_samples(10);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_FALSE(recording.ok());
    EXPECT_EQ(recording.error().code, ErrorCode::malformed);
}

TEST(SampleTimeline, FollowsTicksThatGoRound) {
    Listening link;
    link.board.hello.tick_bits = 32;
    link.board.ticks_offset = 0xFFFF'FFFFU - 3'000'000U;
    link.begin();
    link.hear_samples(1000);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    EXPECT_NEAR(recording->rate_hz, 1003.0, 1e-4);
    EXPECT_LT(*recording->stamp_jitter_s, 1e-6);
}

// A board keeps its oldest frames while nobody takes them: they come late, together with the next ones.
TEST(SampleTimeline, FramesThatWaitedOnTheBoardAreNoTurnsOfTheTicks) {
    for (const double stall_s : {2500.0, 9000.0}) {
        Listening link;
        link.begin();
        link.hear_samples(99);
        link.board.delay_s = stall_s;
        link.hear_samples(20);
        link.board.lose_samples(static_cast<std::uint32_t>(stall_s * 1003.0));
        link.board.delay_s = 0.001;
        link.hear_samples(100);
        const auto recording = link.decoder.take_recording("bench");
        ASSERT_TRUE(recording.ok());
        EXPECT_NEAR(recording->rate_hz, 1003.0, 1e-4) << stall_s;
        ASSERT_EQ(recording->dropouts.size(), 1U);
        EXPECT_NEAR(recording->dropouts[0].at_s, 120 * 16 / 1003.0, 1e-3) << stall_s;
    }
}

TEST(SampleTimeline, AsksTheHostHowOftenTicksWentRoundInAPause) {
    Listening link;
    link.begin();
    link.hear_samples(99);
    const double pause_s = 3.0 * 4294.967296 + 100.0;
    link.board.restart(1600 / 1003.0 + pause_s);
    link.hear(link.board.samples_frame(glp_flag_first_after_start));
    link.hear_samples(99);
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok());
    ASSERT_EQ(recording->segments.size(), 2U);
    EXPECT_EQ(recording->segments[1].first_index, std::llround(1600 + pause_s * recording->rate_hz));
}

TEST(SampleTimeline, FindsTheBoardsClockUnderLateArrivals) {
    Listening link;
    link.board.host_ratio = 1.0 + 40e-6;
    std::mt19937 random(3);
    std::exponential_distribution<double> late(1.0 / 0.004);
    link.begin();
    for (int i = 0; i < 20000; ++i) {
        link.board.delay_s = 0.001 + late(random);
        link.hear(link.board.samples_frame());
    }
    const auto fit = link.decoder.timeline().host_clock();
    ASSERT_TRUE(fit);
    EXPECT_LT(fit->ratio_sd, 1e-6);
    EXPECT_LT(std::abs(fit->ratio - link.board.host_ratio), 5.0 * fit->ratio_sd);
    // Device time 0 is host time 100 s; the smallest delay adds to it. The frame is stamped by hear() a
    // period after its last sample.
    EXPECT_NEAR(fit->offset_s, 100.0 + 0.001 + 1.0 / 1003.0, 5.0 * fit->offset_sd_s + 1e-4);
}

TEST(SampleTimeline, ItsMemoryDoesNotGrowWithTheStream) {
    Listening link;
    link.begin();
    link.hear_samples(30'000);
    const auto rate = link.decoder.timeline().rate(0, 0);
    ASSERT_TRUE(rate);
    EXPECT_LE(rate->stamps, 1024U);
    EXPECT_GE(rate->stamps, 512U);
    EXPECT_NEAR(rate->rate_hz, 1003.0, 5.0 * rate->sd_hz);
}

// Numbers that a board may send after a reset; UndefinedBehaviorSanitizer looks on.
TEST(DecodedRecording, ANumberNearTheEndOfItsTypeIsNoPause) {
    for (const std::uint64_t first : {(std::uint64_t{1} << 63U) + 1, std::uint64_t{1} << 63U,
                                      (std::uint64_t{1} << 63U) - 8, ~std::uint64_t{0} - 100}) {
        Listening link;
        link.begin();
        link.hear_samples(20);
        ++link.board.hello.boot_id;
        link.hear(link.board.hello_frame());
        link.hear(link.board.config_frame());
        link.board.index = first;
        link.board.start_s = -static_cast<double>(first) / link.board.rate_hz;
        link.hear_samples(3);
        const auto recording = link.decoder.take_recording("bench");
        ASSERT_TRUE(recording.ok()) << first;
        EXPECT_EQ(recording->rows(), 24U * 16U) << first;
        std::int64_t missing = 0;
        for (const Dropout& dropout : recording->dropouts) {
            EXPECT_GE(dropout.samples, 0) << first;
            missing += dropout.samples;
        }
        EXPECT_EQ(missing, recording->missing_samples()) << first;
        EXPECT_LT(missing, 1'000'000'000'000) << first;
    }
}

}  // namespace
}  // namespace gyrolog
