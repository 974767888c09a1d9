#include "analysis/noise/slope_reading.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"

namespace gyrolog {
namespace {

AllanCurve exact_curve(const NoiseCoefficients& noise) {
    AllanCurve curve;
    for (int i = 0; i <= 100; ++i) {
        AllanPoint point;
        point.tau_s = 0.01 * std::pow(10.0, 0.07 * i);
        point.deviation = std::sqrt(noise.allan_variance(point.tau_s));
        point.edf = 1e6;
        curve.points.push_back(point);
    }
    return curve;
}

AllanCurve curve_of(const NoiseCoefficients& noise, std::size_t samples, std::uint64_t seed) {
    const Column column{"gx", "rad/s", test::sensor_noise(noise, samples, 10.0, seed), 1.0, 0.0, "rad_s"};
    return allan_deviation(column, {{{0, samples, 0}}}, 10.0);
}

TEST(SlopeReading, OfOnePureNoiseIsItsCoefficientAndNoOther) {
    const SlopeReading white = read_slopes(exact_curve({0.0, 0.01, 0.0, 0.0, 0.0}));
    EXPECT_NEAR(white.N->coefficient, 0.01, 1e-9);
    EXPECT_FALSE(white.B || white.K);
    const SlopeReading flicker = read_slopes(exact_curve({0.0, 0.0, 0.002, 0.0, 0.0}));
    EXPECT_NEAR(flicker.B->coefficient, 0.002, 1e-9);
    EXPECT_FALSE(flicker.N || flicker.K);
    const SlopeReading walk = read_slopes(exact_curve({0.0, 0.0, 0.0, 1e-4, 0.0}));
    EXPECT_NEAR(walk.K->coefficient, 1e-4, 1e-11);
    EXPECT_FALSE(walk.N || walk.B);
}

TEST(SlopeReading, OfASumIsTheTextbooksReading) {
    const SlopeReading reading = read_slopes(exact_curve({0.0, 0.01, 0.002, 1e-4, 0.0}));
    EXPECT_NEAR(reading.N->coefficient, 0.01, 1e-4);
    EXPECT_LT(reading.N->tau_s, 0.1);
    // The level of slope 0 holds the other noises too: never below B.
    EXPECT_GT(reading.B->coefficient, 0.002);
    EXPECT_LT(reading.B->coefficient, 0.0035);
    EXPECT_NEAR(reading.K->coefficient, 1e-4, 0.05e-4);
}

TEST(SlopeReading, IsNotMisledByTheLastNoisyTaus) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const SlopeReading reading = read_slopes(curve_of({0.0, 0.01, 0.0, 0.0, 0.0}, 20000, seed));
        ASSERT_TRUE(reading.N);
        EXPECT_NEAR(reading.N->coefficient, 0.01, 0.0005) << "seed " << seed;
        EXPECT_FALSE(reading.K) << "seed " << seed;
    }
}

TEST(SlopeReading, OfTooShortACurveIsAbsent) {
    const SlopeReading reading = read_slopes({});
    EXPECT_FALSE(reading.N || reading.B || reading.K);
    AllanCurve three = exact_curve({0.0, 0.01, 0.0, 0.0, 0.0});
    three.points.resize(3);
    EXPECT_FALSE(read_slopes(three).N);
}

}  // namespace
}  // namespace gyrolog
