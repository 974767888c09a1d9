#include "analysis/noise/temperature_drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "analysis/numerics/distributions.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"
#include "tests/analysis/noise/temperature_courses.hpp"

namespace gyrolog {
namespace {

using test::Course;

constexpr double rate_hz = 10.0;
constexpr std::size_t samples = 12'800;
constexpr NoiseCoefficients noise = {0.0, 0.01, 0.002, 1e-4, 0.0};
constexpr double slope = 0.02;

std::vector<double> with_drift(std::vector<double> values, const std::vector<double>& temperature_C,
                               double slope_per_C) {
    for (std::size_t i = 0; i < values.size(); ++i) { values[i] += slope_per_C * temperature_C[i]; }
    return values;
}

// Of one axis with this drift in that noise.
Recording drifting(double slope_per_C, Course course, std::uint64_t seed = 1) {
    const std::vector<double> temperature_C = test::temperature_course(course, samples, 100 + seed);
    return test::with_temperature(
        {with_drift(test::sensor_noise(noise, samples, rate_hz, seed), temperature_C, slope_per_C)}, rate_hz,
        temperature_C);
}

std::optional<TemperatureDrift> drift_of(const Recording& recording,
                                         const TemperatureDriftOptions& options = {}) {
    const Column* const columns[] = {&recording.columns.front()};
    return temperature_drifts(recording, columns, options).at(0);
}

TEST(TemperatureDrift, IsFoundWithinItsUncertainty) {
    for (const Course course : {Course::ramp, Course::warm_up, Course::walk}) {
        const auto drift = drift_of(drifting(slope, course));
        ASSERT_TRUE(drift);
        EXPECT_TRUE(drift->is_there);
        EXPECT_LT(drift->chance, 1e-4);
        EXPECT_NEAR(drift->slope_per_C, slope, 4.0 * drift->sd_per_C);
        EXPECT_GT(drift->sd_per_C, slope / 1000.0);
        // What the drift would pass for: far more than the noise has.
        EXPECT_GT(drift->walk_left_in, 3.0 * drift->walk_without);
        EXPECT_FALSE(drift->is_taken_off);
    }
}

TEST(TemperatureDrift, IsMovedByWhatIsAddedAndNothingElseIs) {
    for (const Course course : {Course::ramp, Course::walk}) {
        const auto none = drift_of(drifting(0.0, course));
        const auto more = drift_of(drifting(slope, course));
        ASSERT_TRUE(none && more);
        EXPECT_FALSE(none->is_there);
        EXPECT_GT(none->chance, 0.001);
        EXPECT_NEAR(more->slope_per_C - none->slope_per_C, slope, 1e-6 * slope);
        EXPECT_NEAR(more->sd_per_C, none->sd_per_C, 1e-6 * none->sd_per_C);
        EXPECT_NEAR(more->walk_without, none->walk_without, 1e-6 * none->walk_without);
    }
}

TEST(TemperatureDrift, FollowsTheUnits) {
    Recording recording = drifting(slope, Course::warm_up);
    const auto once = drift_of(recording);
    recording.columns[0].scale = -1000.0;
    recording.columns[1].scale = 2.0;
    const auto scaled = drift_of(recording);
    ASSERT_TRUE(once && scaled);
    EXPECT_NEAR(scaled->slope_per_C, -500.0 * once->slope_per_C, 1e-6);
    EXPECT_NEAR(scaled->sd_per_C, 500.0 * once->sd_per_C, 1e-6);
    EXPECT_NEAR(scaled->walk_left_in, 1000.0 * once->walk_left_in, 1e-6);
    EXPECT_EQ(scaled->is_there, once->is_there);
}

// Where the noise is known to be white it is the line through the means by least squares, with Student's t
// (N. R. Draper, H. Smith, Applied Regression Analysis, 3rd ed. 1998, sec. 1.4).
TEST(TemperatureDrift, OfWhiteNoiseAloneIsTheLineByLeastSquares) {
    const Recording recording = drifting(slope, Course::walk);
    TemperatureDriftOptions white;
    white.chance_without_flicker = white.chance_without_walk = 1.0;
    const auto drift = drift_of(recording, white);
    ASSERT_TRUE(drift);
    constexpr std::size_t blocks = 128;
    std::vector<double> t(blocks, 0.0);
    std::vector<double> y(blocks, 0.0);
    for (std::size_t i = 0; i < samples; ++i) {
        t[i / 100] += recording.columns[1].value(i) / 100.0;
        y[i / 100] += recording.columns[0].value(i) / 100.0;
    }
    double t_mean = 0.0;
    double y_mean = 0.0;
    for (std::size_t i = 0; i < blocks; ++i) { t_mean += t[i] / blocks, y_mean += y[i] / blocks; }
    double tt = 0.0;
    double ty = 0.0;
    double yy = 0.0;
    for (std::size_t i = 0; i < blocks; ++i) {
        tt += (t[i] - t_mean) * (t[i] - t_mean);
        ty += (t[i] - t_mean) * (y[i] - y_mean);
        yy += (y[i] - y_mean) * (y[i] - y_mean);
    }
    const double sd = std::sqrt((yy - ty * ty / tt) / (blocks - 2.0) / tt);
    EXPECT_NEAR(drift->slope_per_C, ty / tt, 1e-9 * slope);
    EXPECT_NEAR(drift->sd_per_C, sd * students_t_upper_quantile(blocks - 2.0, 0.15865525393145707),
                1e-9 * slope);
}

TEST(TemperatureDrift, IsToldAcrossHolesAndUnknownTemperatures) {
    const Recording whole = drifting(slope, Course::ramp);
    const auto before = drift_of(whole);
    // Every seventh reading is known; a hole of a tenth of the record, and shorter ones.
    Recording holed = rows_of(whole, segments_where(whole.segments, [](std::size_t row) {
                                  return !(row > 4000 && row < 5300) && row % 500 > 20;
                              }));
    auto& readings = std::get<std::vector<double>>(holed.columns[1].data);
    for (std::size_t i = 0; i < readings.size(); ++i) {
        if (i % 7 != 0) { readings[i] = std::numeric_limits<double>::quiet_NaN(); }
    }
    const auto after = drift_of(holed);
    ASSERT_TRUE(before && after);
    EXPECT_TRUE(after->is_there);
    EXPECT_NEAR(after->slope_per_C, slope, 4.0 * after->sd_per_C);
    EXPECT_NEAR(after->sd_per_C, before->sd_per_C, 0.5 * before->sd_per_C);
}

TEST(TemperatureDrift, NeedsATemperatureThatVariesBeyondItsNoise) {
    const std::vector<double> values = test::sensor_noise(noise, samples, rate_hz, 1);
    const auto drift_with = [&](const std::vector<double>& temperature_C) {
        return drift_of(test::with_temperature({values}, rate_hz, temperature_C));
    };
    ASSERT_TRUE(drift_with(test::temperature_course(Course::ramp, samples, 1)));
    EXPECT_FALSE(drift_with(std::vector<double>(samples, 25.0)));
    EXPECT_FALSE(drift_with(std::vector<double>(samples, std::numeric_limits<double>::quiet_NaN())));
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(25.0, 0.2);
    std::vector<double> noisy(samples);
    for (double& reading_C : noisy) { reading_C = normal(random); }
    EXPECT_FALSE(drift_with(noisy));
    // Whole degrees.
    std::vector<double> coarse = test::temperature_course(Course::ramp, samples, 1);
    for (double& reading_C : coarse) { reading_C = std::floor(reading_C / 2.0) * 2.0; }
    EXPECT_FALSE(drift_with(coarse));

    Recording recording = drifting(slope, Course::ramp);
    recording.columns[1].unit = "lsb";
    EXPECT_FALSE(drift_of(recording));
    recording.columns.pop_back();
    EXPECT_FALSE(drift_of(recording));
    EXPECT_FALSE(drift_of(first_rows(drifting(slope, Course::ramp), 31)));
    EXPECT_TRUE(drift_of(first_rows(drifting(slope, Course::ramp), 32)));
    Recording stuck = drifting(slope, Course::ramp);
    stuck.columns[0].data = std::vector<double>(samples, 1.0);
    EXPECT_FALSE(drift_of(stuck));
}

TEST(TemperatureDrift, TakenOffLeavesTheNoiseAndTheMean) {
    const std::vector<double> temperature_C = test::temperature_course(Course::warm_up, samples, 1);
    const std::vector<double> quiet = test::sensor_noise(noise, samples, rate_hz, 1);
    const Recording recording =
        test::with_temperature({with_drift(quiet, temperature_C, slope)}, rate_hz, temperature_C);
    auto drift = drift_of(recording);
    ASSERT_TRUE(drift);
    drift->slope_per_C = slope;
    const Column rest = without_drift(recording, recording.columns[0], *drift);
    double mean_C = 0.0;
    for (const double reading_C : temperature_C) { mean_C += reading_C / static_cast<double>(samples); }
    EXPECT_NEAR(drift->mean_C, mean_C, 1e-3);
    double sum = 0.0;
    for (std::size_t i = 0; i < samples; ++i) {
        // Half of the 16 samples over which it is smooth, at both ends, are all that it does not follow: at
        // its steepest it goes 0.0044 degC a sample.
        EXPECT_NEAR(rest.value(i), quiet[i] + slope * drift->mean_C, slope * 8.0 * 0.0044) << i;
        sum += rest.value(i) - recording.columns[0].value(i);
    }
    EXPECT_NEAR(sum / static_cast<double>(samples), 0.0, 1e-12);
}

TEST(TemperatureDrift, TakenOffCountsIsInTheirScale) {
    constexpr double step = 1e-3;
    Recording recording = drifting(slope, Course::ramp);
    std::vector<std::int16_t> counts;
    for (const double value : recording.columns[0].values()) {
        counts.push_back(static_cast<std::int16_t>(std::lround(value / step)));
    }
    recording.columns[0].data = counts;
    recording.columns[0].scale = step;
    const auto drift = drift_of(recording);
    ASSERT_TRUE(drift);
    const Column rest = without_drift(recording, recording.columns[0], *drift);
    EXPECT_EQ(rest.scale, step);
    const double first_C = recording.columns[1].value(0);
    const double last_C = recording.columns[1].value(samples - 1);
    EXPECT_NEAR(rest.value(0) - recording.columns[0].value(0),
                -drift->slope_per_C * (first_C - drift->mean_C), slope * 0.01);
    EXPECT_NEAR(rest.value(samples - 1) - recording.columns[0].value(samples - 1),
                -drift->slope_per_C * (last_C - drift->mean_C), slope * 0.01);
}

}  // namespace
}  // namespace gyrolog
