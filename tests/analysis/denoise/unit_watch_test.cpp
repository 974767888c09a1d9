#include "analysis/denoise/unit_watch.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/denoise/array_denoiser.hpp"
#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t fault_at = 2000;
constexpr std::size_t samples_in_all = 6000;

struct Watched {
    std::size_t found_at = samples_in_all;  // first sample after the fault at which the unit is not good
    std::size_t left_out = 0;               // of the faulty unit's samples since
    std::size_t false_alarms = 0;           // of the others, and of this one before
    UnitState state = UnitState::good;
    Signal rate;
};

// The last of `units` fails as `fault(sample, k)` says.
template <typename Fault>
Watched watch(std::size_t units, const Signal& rate, const Fault& fault, bool watching = true) {
    const ArrayNoise noise = equal_units(units, 0.1, 1e-6);
    ArraySamples samples = array_samples(noise, rate, 21);
    for (std::size_t k = fault_at; k < samples_in_all; ++k) {
        samples.back()[k] = fault(samples.back()[k], k);
    }
    UnitLimits limits;
    limits.white_sd = 0.1;
    limits.saturation = 50.0;
    limits.repeats_most = 8;
    DenoiseDesign design;
    design.method = DenoiseMethod::kalman;
    design.watch = watching;
    ArrayDenoiser denoiser(noise, std::vector<UnitLimits>(units, limits), design);
    Watched watched;
    for (std::size_t k = 0; k < samples_in_all; ++k) {
        watched.rate.push_back(denoiser.step(at(samples, k)));
        const auto states = denoiser.states();
        for (std::size_t i = 0; i < units; ++i) {
            if (states[i] == UnitState::good) { continue; }
            if (i + 1 < units || k < fault_at) {
                ++watched.false_alarms;
                continue;
            }
            if (watched.left_out++ == 0) {
                watched.found_at = k;
                watched.state = states[i];
            }
        }
    }
    return watched;
}

const Signal still(samples_in_all, 0.0);

TEST(UnitWatch, SeesNothingInUnitsThatWork) {
    for (const std::size_t units : {1U, 2U, 3U, 8U}) {
        const Watched watched = watch(units, still, [](double z, std::size_t) { return z; });
        EXPECT_EQ(watched.false_alarms + watched.left_out, 0U) << units;
    }
}

TEST(UnitWatch, LeavesAStuckUnitOut) {
    const Watched watched = watch(3, still, [](double, std::size_t) { return 0.05; });
    EXPECT_EQ(watched.state, UnitState::stuck);
    EXPECT_EQ(watched.found_at, fault_at + 8);
    EXPECT_EQ(watched.left_out, samples_in_all - fault_at - 8);
    EXPECT_EQ(watched.false_alarms, 0U);
}

TEST(UnitWatch, LeavesASaturatedUnitOutAtOnceAndTakesItBack) {
    const Watched watched =
        watch(3, still, [](double z, std::size_t k) { return k < fault_at + 100 ? 50.0 + std::abs(z) : z; });
    EXPECT_EQ(watched.state, UnitState::saturated);
    EXPECT_EQ(watched.found_at, fault_at);
    EXPECT_EQ(watched.left_out, 100U);
}

TEST(UnitWatch, LeavesANoisyUnitOutAndTakesItBackWhenItIsQuietAgain) {
    Signal more(samples_in_all);
    RandomStream(22, 0).normals(0, more);
    const Watched watched =
        watch(4, still, [&](double z, std::size_t k) { return k < fault_at + 1000 ? z + 0.5 * more[k] : z; });
    EXPECT_EQ(watched.state, UnitState::noisy);
    EXPECT_LT(watched.found_at, fault_at + 100);
    EXPECT_GT(watched.left_out, 900U);
    EXPECT_LT(watched.left_out, 1500U);
    EXPECT_EQ(watched.false_alarms, 0U);
}

TEST(UnitWatch, LeavesABiasThatJumpsOut) {
    const Watched watched = watch(3, still, [](double z, std::size_t) { return z + 0.6; });
    EXPECT_EQ(watched.state, UnitState::noisy);
    EXPECT_LT(watched.found_at, fault_at + 100);
    EXPECT_GT(watched.left_out, samples_in_all - fault_at - 200);
    EXPECT_EQ(watched.false_alarms, 0U);
}

TEST(UnitWatch, LeavesAWildSampleOut) {
    const Watched watched =
        watch(3, still, [](double z, std::size_t k) { return k == fault_at ? z + 3.0 : z; });
    EXPECT_EQ(watched.found_at, fault_at);
    EXPECT_EQ(watched.left_out, 1U);
    EXPECT_LT(std::abs(watched.rate[fault_at]), 0.4);
}

TEST(UnitWatch, OfTwoUnitsCannotTellWhichIsNoisy) {
    const Watched watched = watch(2, still, [](double z, std::size_t) { return 20.0 * z; });
    EXPECT_EQ(watched.left_out + watched.false_alarms, 0U);
}

TEST(UnitWatch, MotionIsNoFailureEvenWithUnequalScaleFactors) {
    Signal rate(samples_in_all);
    for (std::size_t k = 0; k < rate.size(); ++k) {
        rate[k] = 40.0 * std::sin(0.01 * static_cast<double>(k));
    }
    const Watched watched = watch(3, rate, [&](double z, std::size_t k) { return z + 0.02 * rate[k]; });
    EXPECT_EQ(watched.left_out + watched.false_alarms, 0U);
}

TEST(UnitWatch, AFailureCostsNoMoreThanTheUnit) {
    const auto stuck = [](double, std::size_t) { return 0.3; };
    const Watched with = watch(3, still, stuck);
    const Watched without = watch(3, still, stuck, false);
    // Two units left: half of 0.1^2; with the stuck one the mean is off by 0.1.
    const std::size_t late = fault_at + 100;
    const auto n = static_cast<double>(samples_in_all - late);
    EXPECT_NEAR(variance_of(with.rate, late), 0.005, 0.005 * 5.0 * std::sqrt(2.0 / n));
    EXPECT_LT(std::abs(mean_of(with.rate, late)), 0.01);
    EXPECT_GT(std::abs(mean_of(without.rate, late)), 0.05);
}

TEST(UnitWatch, CountsThatRepeatByChanceAreNotStuck) {
    EXPECT_EQ(repeats_allowed(0.0), 8U);
    EXPECT_EQ(repeats_allowed(0.5), 40U);  // 0.5^40 = 9e-13
    EXPECT_GT(repeats_allowed(0.9995), 1'000'000'000U);
}

}  // namespace
}  // namespace gyrolog
