#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;
constexpr double decay_s = 0.2;
constexpr double f_hz = 8.0;

EffectModel bumps(double per_hour, double simulated = 1.0) {
    return effect_entry("disturbance", {{"per_hour", per_hour},
                                        {"size_dps", 2.0},
                                        {"decay_s", decay_s},
                                        {"f_hz", f_hz},
                                        {"simulated", simulated}});
}

Simulated bumped(const EffectModel& entry, std::size_t blocks, std::uint64_t seed = 3) {
    SensorModel model = ideal_model();
    model.effects = {entry};
    return simulate(model, rate_hz, seed, blocks);
}

double size_dps(const Simulated& out, std::size_t i) {
    double square = 0.0;
    for (const auto& axis : out.rate_rad_s) { square += axis[i] * axis[i]; }
    return std::sqrt(square) / rad_per_deg;
}

// The sample after which each bump's first is the quiet before it.
std::vector<std::size_t> onsets(const Simulated& out) {
    std::vector<std::size_t> found;
    const auto quiet = static_cast<std::size_t>(2.5 * rate_hz);
    std::size_t silent = quiet;
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (size_dps(out, i) > 1e-3) {
            if (silent >= quiet) { found.push_back(i - 1); }
            silent = 0;
        } else {
            ++silent;
        }
    }
    return found;
}

TEST(DisturbanceEffect, RingsOutOnAllAxesAtOnce) {
    const Simulated out = bumped(bumps(120.0), 60);
    const std::vector<std::size_t> found = onsets(out);
    ASSERT_GT(found.size(), 5U);
    const std::size_t at = found[2];
    const auto course = [](double since_s) {
        return std::exp(-since_s / decay_s) * std::sin(2.0 * pi * f_hz * since_s);
    };
    for (const auto& axis : out.rate_rad_s) {
        const double size_rad_s = axis[at + 1] / course(1.0 / rate_hz);
        EXPECT_NE(size_rad_s, 0.0);
        for (std::size_t i = 1; i < 100; ++i) {
            EXPECT_NEAR(axis[at + i], size_rad_s * course(static_cast<double>(i) / rate_hz),
                        1e-9 * std::fabs(size_rad_s));
        }
    }
}

TEST(DisturbanceEffect, HasSizesFromHalfToOneAndAHalf) {
    const Simulated out = bumped(bumps(120.0), 600);
    const double first = std::exp(-1.0 / rate_hz / decay_s) * std::sin(2.0 * pi * f_hz / rate_hz);
    double sum_dps = 0.0;
    const std::vector<std::size_t> found = onsets(out);
    for (const std::size_t at : found) {
        const double dps = size_dps(out, at + 1) / first;
        EXPECT_GE(dps, 1.0 - 1e-3);
        EXPECT_LE(dps, 3.0 + 0.1);
        sum_dps += dps;
    }
    // A uniform variable's mean, within four standard errors.
    const auto n = static_cast<double>(found.size());
    EXPECT_NEAR(sum_dps / n, 2.0, 4.0 * 2.0 / std::sqrt(12.0 * n));
    // Poisson, less those that another one hides for about three seconds.
    const double hours = static_cast<double>(out.size()) / rate_hz / 3600.0;
    const double expected = 120.0 * hours * std::exp(-120.0 * 3.5 / 3600.0);
    EXPECT_NEAR(n, expected, 5.0 * std::sqrt(expected) + 0.06 * expected);
}

TEST(DisturbanceEffect, IsOnlyLeftOutWhereItIsNotSimulated) {
    const Simulated out = bumped(bumps(3600.0, 0.0), 20);
    for (std::size_t i = 0; i < out.size(); ++i) { ASSERT_EQ(size_dps(out, i), 0.0); }
}

TEST(DisturbanceEffect, ActsOnItsAxes) {
    EffectModel entry = bumps(3600.0);
    entry.axes = {"y"};
    const Simulated out = bumped(entry, 20);
    double most = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        ASSERT_EQ(out.rate_rad_s[0][i], 0.0);
        most = std::max(most, std::fabs(out.rate_rad_s[1][i]));
    }
    EXPECT_GT(most, 0.1 * rad_per_deg);
}

}  // namespace
}  // namespace gyrolog
