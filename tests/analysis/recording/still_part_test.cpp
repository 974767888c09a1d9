#include "analysis/recording/still_part.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

Recording recording_of(std::size_t rows) {
    Recording recording;
    recording.rate_hz = 100.0;
    recording.columns = {{"gx", "rad/s", Signal(rows, 0.0)}};
    recording.segments = {{0, rows, 0}};
    return recording;
}

Signal noise(std::size_t rows) {
    Signal x(rows);
    RandomStream(41, 0).normals(0, x);
    return x;
}

TEST(StillPart, IsAllOfARecordingAtRest) {
    const std::vector<Signal> signals{noise(10'000)};
    const TimeSpan span = still_part(recording_of(10'000), signals);
    EXPECT_EQ(span.from_s, 0.0);
    EXPECT_EQ(span.to_s, 100.0);
}

TEST(StillPart, IsTheLongestStretchWithoutMotion) {
    Signal x = noise(20'000);
    for (std::size_t i = 3000; i < 5000; ++i) { x[i] += 20.0 * std::sin(0.05 * static_cast<double>(i)); }
    for (std::size_t i = 16'000; i < 20'000; ++i) { x[i] += 20.0 * std::sin(0.05 * static_cast<double>(i)); }
    const TimeSpan span = still_part(recording_of(20'000), std::vector<Signal>{x});
    EXPECT_NEAR(span.from_s, 50.0, 1.01);
    EXPECT_NEAR(span.to_s, 160.0, 1.01);
}

TEST(StillPart, ATurnAtConstantRateIsNotPartOfTheRestBeforeIt) {
    Signal x = noise(10'000);
    for (std::size_t i = 7000; i < 10'000; ++i) { x[i] += 50.0; }
    const TimeSpan span = still_part(recording_of(10'000), std::vector<Signal>{x});
    EXPECT_EQ(span.from_s, 0.0);
    EXPECT_NEAR(span.to_s, 70.0, 1.01);
}

TEST(StillPart, IsNoneOfAFewSamples) {
    const TimeSpan span = still_part(recording_of(40), std::vector<Signal>{noise(40)});
    EXPECT_EQ(span.from_s, span.to_s);
}

}  // namespace
}  // namespace gyrolog
