#include "analysis/denoise/motion_error.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 200.0;

Signal motion(std::size_t rows, double lag_samples = 0.0) {
    Signal x(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        const double t_s = (static_cast<double>(i) - lag_samples) / rate_hz;
        x[i] =
            10.0 * std::sin(6.283185307179586 * 0.5 * t_s) + 3.0 * std::sin(6.283185307179586 * 0.13 * t_s);
    }
    return x;
}

TEST(MotionError, FindsLagGainAndNoiseApart) {
    constexpr std::size_t rows = 20'000;
    for (const double lag : {0.0, 0.4, 3.0, 7.3, -2.6}) {
        Signal noise(rows);
        RandomStream(51, 0).normals(0, noise);
        Signal y = motion(rows, lag);
        for (std::size_t i = 0; i < rows; ++i) { y[i] = 0.7 + 0.95 * y[i] + 0.1 * noise[i]; }
        const Signal reference = motion(rows);
        const auto error = motion_error(y, reference, std::vector<Segment>{{0, rows, 0}}, rate_hz, 0.1);
        ASSERT_TRUE(error);
        // The lag is known to noise / (rms of the motion's rate of change) / sqrt(rows).
        const double sd_s = 0.1 / (0.95 * 22.0) / std::sqrt(static_cast<double>(rows));
        EXPECT_NEAR(error->lag_s, lag / rate_hz, 5.0 * sd_s + 2e-6);
        EXPECT_NEAR(error->gain, 0.95, 1e-3);
        EXPECT_NEAR(error->offset, 0.7, 5e-3);
        EXPECT_NEAR(error->noise_variance, 0.01, 0.01 * 5.0 * std::sqrt(2.0 / rows));
        EXPECT_NEAR(error->motion_variance + error->noise_variance, error->error_variance,
                    0.03 * error->error_variance);
    }
}

TEST(MotionError, OfASwingIsNeitherAPeriodNorHalfAPeriodLate) {
    constexpr std::size_t rows = 6000;
    for (const double frequency_hz : {2.0, 5.0, 20.0}) {
        Signal reference(rows);
        Signal y(rows);
        RandomStream(52, 0).normals(0, y);
        for (std::size_t i = 0; i < rows; ++i) {
            reference[i] = std::sin(6.283185307179586 * frequency_hz * static_cast<double>(i) / rate_hz);
            y[i] = reference[i] + 0.3 * y[i];
        }
        const auto error = motion_error(y, reference, std::vector<Segment>{{0, rows, 0}}, rate_hz, 0.5);
        ASSERT_TRUE(error);
        EXPECT_NEAR(error->lag_s, 0.0, 2e-3) << frequency_hz;
        EXPECT_NEAR(error->gain, 1.0, 0.05) << frequency_hz;
    }
}

TEST(MotionError, IsNoneWithoutMotion) {
    const Signal rest(1000, 0.0);
    EXPECT_FALSE(motion_error(rest, rest, std::vector<Segment>{{0, 1000, 0}}, rate_hz, 0.1));
    EXPECT_FALSE(
        motion_error(rest, Signal(1000, std::nan("")), std::vector<Segment>{{0, 1000, 0}}, rate_hz, 0.1));
}

TEST(MotionError, LeavesUnknownReferenceAndHolesOut) {
    constexpr std::size_t rows = 4000;
    Signal y = motion(rows, 2.0);
    Signal reference = motion(rows);
    for (std::size_t i = 500; i < 600; ++i) { reference[i] = std::nan(""); }
    for (std::size_t i = 2000; i < rows; ++i) { y[i] = 1e6; }
    const std::vector<Segment> parts{{0, 1000, 0}, {1000, 1000, 9000}};
    const auto error = motion_error(y, reference, parts, rate_hz, 0.05);
    ASSERT_TRUE(error);
    EXPECT_NEAR(error->lag_s, 0.01, 1e-5);
    EXPECT_LT(error->noise_variance, 1e-6);
}

}  // namespace
}  // namespace gyrolog
