#include "analysis/denoise/adaptive_rate.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/denoise/array_denoiser.hpp"
#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 200.0;
constexpr double sd = 0.3;

Signal noise(std::size_t samples, std::uint64_t seed) {
    Signal x(samples);
    RandomStream(seed, 0).normals(0, x);
    for (double& value : x) { value *= sd; }
    return x;
}

Signal run(AdaptiveRate& filter, const Signal& z) {
    Signal y;
    y.reserve(z.size());
    for (const double sample : z) { y.push_back(filter.step(sample, sd * sd)); }
    return y;
}

TEST(AdaptiveRate, IsNarrowAtRestAndWideInMotion) {
    AdaptiveRate filter(50.0, rate_hz, sd * sd);
    const Signal at_rest = run(filter, noise(20'000, 81));
    // The narrowest band leaves 1/62 of the noise, the next 1/16.
    EXPECT_LT(variance_of(at_rest, 1000), sd * sd / 16.0);
    EXPECT_GT(variance_of(at_rest, 1000), sd * sd / 62.0);
    EXPECT_LT(filter.probabilities()[2] + filter.probabilities()[3], 0.2);
    Signal fast = noise(2000, 82);
    for (std::size_t k = 0; k < fast.size(); ++k) {
        fast[k] += 30.0 * std::sin(6.283185307179586 * 4.0 * static_cast<double>(k) / rate_hz);
    }
    run(filter, fast);
    EXPECT_GT(filter.probabilities()[2] + filter.probabilities()[3], 0.9);
}

TEST(AdaptiveRate, FollowsAStepWithinAFewSamples) {
    AdaptiveRate filter(50.0, rate_hz, sd * sd);
    Signal z = noise(4000, 83);
    for (std::size_t k = 3000; k < z.size(); ++k) { z[k] += 20.0; }
    const Signal y = run(filter, z);
    EXPECT_LT(std::abs(y[2999]), 0.3);
    for (std::size_t k = 3010; k < 4000; ++k) { ASSERT_NEAR(y[k], 20.0, 1.5) << k; }
    EXPECT_NEAR(mean_of(Signal(y.begin() + 3200, y.end())), 20.0, 0.05);
}

TEST(AdaptiveRate, ConstantRateAndConstantAccelerationPassUnbiased) {
    double offset = 0.0;
    double lag = 0.0;
    constexpr int seeds = 30;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        AdaptiveRate filter(50.0, rate_hz, sd * sd);
        Signal z = noise(4000, 90 + seed);
        for (std::size_t k = 0; k < z.size(); ++k) {
            z[k] += k < 2000 ? 7.0 : 7.0 + 0.05 * static_cast<double>(k - 2000);
        }
        const Signal y = run(filter, z);
        offset += mean_of(Signal(y.begin() + 200, y.begin() + 2000)) - 7.0;
        for (std::size_t k = 3000; k < 4000; ++k) {
            lag += (7.0 + 0.05 * static_cast<double>(k - 2000) - y[k]) / 1000.0;
        }
    }
    // Means of 1800 and of 1000 samples' noise, to five of their standard deviations.
    EXPECT_NEAR(offset / seeds, 0.0, 5.0 * sd / std::sqrt(1800.0 * seeds));
    EXPECT_NEAR(lag / seeds, 0.0, 5.0 * sd / std::sqrt(1000.0 * seeds));
}

TEST(AdaptiveRate, ProbabilitiesAreProbabilitiesWhateverTheSample) {
    AdaptiveRate filter(50.0, rate_hz, sd * sd);
    for (const double sample : {0.0, 1e-9, 1e6, -1e6, 1e12, 0.0}) {
        ASSERT_TRUE(std::isfinite(filter.step(sample, sd * sd))) << sample;
        double sum = 0.0;
        for (const double p : filter.probabilities()) {
            ASSERT_GE(p, 0.0);
            sum += p;
        }
        ASSERT_NEAR(sum, 1.0, 1e-12);
    }
}

}  // namespace
}  // namespace gyrolog
