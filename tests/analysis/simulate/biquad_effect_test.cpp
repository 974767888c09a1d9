// A digital filter's section in a simulated sensor.
#include <cmath>
#include <complex>
#include <map>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "analysis/simulate/chain.hpp"
#include "tests/analysis/simulate/periodogram.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;

bool is_refused(std::map<std::string, double> params) {
    return effect_refusal(effect_entry("biquad", std::move(params))).has_value();
}

TEST(Biquad, RefusesWhatIsNotStable) {
    EXPECT_FALSE(is_refused({{"b0", 1.0}, {"a1", -1.8}, {"a2", 0.9}}));
    EXPECT_TRUE(is_refused({{"b0", 1.0}, {"a2", 1.0}}));
    EXPECT_TRUE(is_refused({{"b0", 1.0}, {"a1", 1.0}}));
    EXPECT_TRUE(is_refused({{"b1", 1.0}}));  // without b0
}

// A resonance: poles at 0.95 of the unit circle.
SensorModel resonant(double N_rad_per_sqrt_s) {
    return with_effect(white_model(N_rad_per_sqrt_s), "biquad", {{"b0", 0.1}, {"a1", -1.2}, {"a2", 0.9025}});
}

double resonance(double turns) {
    const auto back = std::polar(1.0, -2.0 * pi * turns);
    return 0.01 / std::norm(1.0 + back * (-1.2 + back * 0.9025));
}

TEST(Biquad, FiltersTheNoise) {
    const Simulated out = simulate(resonant(0.02), rate_hz, 3, 400);
    SpectrumAverage spectrum(4096);
    for (std::size_t from = 0; from + 4096 <= out.size(); from += 4096) {
        spectrum.add(std::span(out.rate_rad_s[0]).subspan(from, 4096));
    }
    const double white = 0.02 * 0.02 * rate_hz;
    for (const OctaveRatio& octave :
         octave_ratios(spectrum, [&](double turns) { return white * resonance(turns); })) {
        EXPECT_NEAR(octave.ratio, 1.0, 4.0 * octave.sd);
    }
}

// The first samples of many streams scatter as later ones do.
TEST(Biquad, StartsWithNoiseThatHasSettled) {
    double settled = 0.0;
    constexpr int steps = 20'000;
    for (int i = 0; i < steps; ++i) { settled += resonance((i + 0.5) / steps) / steps; }
    double first = 0.0;
    constexpr int streams = 400;
    for (std::uint64_t seed = 1; seed <= streams; ++seed) {
        const Simulated out = simulate(resonant(0.02), rate_hz, seed, 1);
        for (const auto& axis : out.rate_rad_s) { first += axis[0] * axis[0]; }
    }
    const double variance = 0.02 * 0.02 * rate_hz * settled;
    EXPECT_NEAR(first / (3 * streams) / variance, 1.0, 4.0 * std::sqrt(2.0 / (3 * streams)));
}

TEST(Biquad, KeepsABiasByItsGainAtZero) {
    SensorModel model = with_effect(ideal_model(), "biquad", {{"b0", 0.5}, {"b1", 0.3}, {"a1", -0.6}});
    for (AxisModel& axis : model.axes) { axis.bias_rad_s = 0.02; }
    const Simulated out = simulate(model, rate_hz, 1, 1);
    for (const double rate : out.rate_rad_s[1]) { EXPECT_NEAR(rate, 0.04, 1e-12); }
}

}  // namespace
}  // namespace gyrolog
