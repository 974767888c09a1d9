#include <cmath>
#include <complex>
#include <ostream>

#include <gtest/gtest.h>

#include "tests/analysis/simulate/periodogram.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

struct Filter {
    int order;
    double fc_per_rate;

    friend std::ostream& operator<<(std::ostream& out, const Filter& filter) {
        return out << "order " << filter.order << ", cut-off at " << filter.fc_per_rate << " of the rate";
    }

    // |H|^2 at a frequency in cycles per sample.
    double power(double nu) const { return 1.0 / (1.0 + std::pow(nu / fc_per_rate, 2.0 * order)); }
    // The covariance of the filtered noise in units of N^2 / T, from the filter's residues.
    double covariance(double lag) const {
        const double w = 2.0 * pi * fc_per_rate;
        if (order == 1) { return 0.5 * w * std::exp(-w * lag); }
        const double a = w / std::sqrt(2.0);
        return 0.5 * a * std::exp(-a * lag) * (std::cos(a * lag) + std::sin(a * lag));
    }
    // Of the sampled noise, in units of N^2: the sum over all that folds here, its tail as an integral.
    double folded_power(double nu) const {
        constexpr int images = 100;
        double sum = power(nu);
        for (int k = 1; k <= images; ++k) { sum += power(nu + k) + power(nu - k); }
        const double reach = images + 0.5;
        return sum + 2.0 * std::pow(fc_per_rate, 2.0 * order) /
                         ((2.0 * order - 1.0) * std::pow(reach, 2.0 * order - 1.0));
    }
};

SensorModel filtered(const SensorModel& model, const Filter& filter, double rate_hz) {
    return with_effect(
        model, "lowpass",
        {{"fc_hz", filter.fc_per_rate * rate_hz}, {"order", static_cast<double>(filter.order)}});
}

class Lowpass : public testing::TestWithParam<Filter> {};
INSTANTIATE_TEST_SUITE_P(Filters, Lowpass,
                         testing::Values(Filter{1, 0.05}, Filter{1, 0.3}, Filter{1, 2.0}, Filter{2, 0.05},
                                         Filter{2, 0.1}, Filter{2, 0.3}, Filter{2, 0.7}, Filter{2, 2.0}));

constexpr double N = 0.02;
constexpr double rate_hz = 200.0;

TEST_P(Lowpass, WhiteNoiseHasTheFiltersSpectrumWithItsFoldedPartInEveryOctave) {
    const Filter filter = GetParam();
    SpectrumAverage spectrum(block_samples);
    const Simulated run = simulate(filtered(white_model(N), filter, rate_hz), rate_hz, 1, 120);
    for (const auto& axis : run.rate_rad_s) {
        for (std::size_t at = 0; at < run.size(); at += block_samples) {
            spectrum.add(std::span(axis).subspan(at, block_samples));
        }
    }
    for (const OctaveRatio& octave :
         octave_ratios(spectrum, [&](double nu) { return N * N * rate_hz * filter.folded_power(nu); })) {
        EXPECT_NEAR(octave.ratio, 1.0, 4.0 * octave.sd) << "from " << octave.from_nu << " of the rate";
    }
}

TEST_P(Lowpass, WhiteNoiseIsStationaryFromTheFirstSample) {
    const Filter filter = GetParam();
    const SensorModel model = filtered(white_model(N), filter, rate_hz);
    constexpr int seeds = 2500;  // enough to see a state before the first sample that is 10 % off
    constexpr double draws = 3.0 * seeds;
    constexpr std::array<std::size_t, 2> places = {0, 500};
    std::array<std::array<double, 3>, 2> products{};  // of a sample and the next two
    for (int seed = 1; seed <= seeds; ++seed) {
        SensorSimulator simulator(model, rate_hz, static_cast<std::uint64_t>(seed));
        for (const BlockValues& y : simulator.next_block().rate_rad_s) {
            for (std::size_t place = 0; place < places.size(); ++place) {
                const std::size_t at = places[place];
                for (std::size_t lag = 0; lag < 3; ++lag) {
                    products[place][lag] += y[at] * y[at + lag] / draws;
                }
            }
        }
    }
    const double unit = N * N * rate_hz;
    const double variance = unit * filter.covariance(0.0);
    for (std::size_t lag = 0; lag < 3; ++lag) {
        const double expected = unit * filter.covariance(static_cast<double>(lag));
        const double sd = std::sqrt((variance * variance + expected * expected) / draws);
        EXPECT_NEAR(products[0][lag], expected, 4.0 * sd) << "lag " << lag << " at the first sample";
        EXPECT_NEAR(products[1][lag], expected, 4.0 * sd) << "lag " << lag << " in mid-block";
    }
}

// Its amplitude is what the samples show, whatever the filter left of it at its true frequency.
TEST_P(Lowpass, LineIsAsHighAsWithout) {
    const SensorModel line = with_effect(
        ideal_model(), "tone", {{"f_hz", 0.7 * rate_hz}, {"amplitude_dps", 1.0}, {"phase_rad", 0.4}});
    EXPECT_EQ(simulate(filtered(line, GetParam(), rate_hz), rate_hz, 1, 2).rate_rad_s,
              simulate(line, rate_hz, 1, 2).rate_rad_s);
}

// Lagrange's cubic through four samples a unit apart, at `s` from the third.
double cubic_at(const std::array<double, 4>& samples, double s) {
    return -samples[0] * (s + 1.0) * s * (s - 1.0) / 6.0 + samples[1] * (s + 2.0) * s * (s - 1.0) / 2.0 -
           samples[2] * (s + 2.0) * (s + 1.0) * (s - 1.0) / 2.0 +
           samples[3] * (s + 2.0) * (s + 1.0) * s / 6.0;
}

// The filter as a differential equation with such cubics for input, by Runge and Kutta's classical method.
std::vector<double> filter_numerically(const Filter& filter, const std::vector<double>& input) {
    constexpr int steps = 400;
    const double w = 2.0 * pi * filter.fc_per_rate;
    using State = std::array<double, 2>;
    const auto slope = [&](const State& y, double u) -> State {
        if (filter.order == 1) { return {w * (u - y[0]), 0.0}; }
        return {y[1], w * w * (u - y[0]) - std::sqrt(2.0) * w * y[1]};
    };
    const auto moved = [](const State& y, const State& by, double h) -> State {
        return {y[0] + h * by[0], y[1] + h * by[1]};
    };
    State y = {input.front(), 0.0};
    std::vector<double> output = {input.front()};
    for (std::size_t k = 1; k < input.size(); ++k) {
        const double h = 1.0 / steps;
        std::array<double, 4> around{};
        for (std::size_t i = 0; i < 4; ++i) { around[i] = input[k + i < 3 ? 0 : k + i - 3]; }
        for (int step = 0; step < steps; ++step) {
            const double begin = step * h;
            const State k1 = slope(y, cubic_at(around, begin));
            const State k2 = slope(moved(y, k1, h / 2.0), cubic_at(around, begin + h / 2.0));
            const State k3 = slope(moved(y, k2, h / 2.0), cubic_at(around, begin + h / 2.0));
            const State k4 = slope(moved(y, k3, h), cubic_at(around, begin + h));
            for (std::size_t i = 0; i < 2; ++i) {
                y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        output.push_back(y[0]);
    }
    return output;
}

TEST_P(Lowpass, MotionPassesItAsCubicsThroughTheSamples) {
    const Filter filter = GetParam();
    const Simulated run =
        simulate(filtered(ideal_model(), filter, rate_hz), rate_hz, 1, 1, tumbling_world(5.0));
    const std::vector<double> expected = filter_numerically(filter, run.true_rate_rad_s[2]);
    for (std::size_t i = 0; i < run.size(); ++i) {
        ASSERT_NEAR(run.rate_rad_s[2][i], expected[i], 1e-8) << i;
    }
}

TEST_P(Lowpass, AStepRisesToItsFullHeightAndStaysThere) {
    const Filter filter = GetParam();
    const auto world = world_turning([](double t_s) { return Vector3{t_s < 0.5 ? 1.0 : 3.0, 0.0, 0.0}; });
    const Simulated run = simulate(filtered(ideal_model(), filter, rate_hz), rate_hz, 1, 1, world);
    EXPECT_EQ(run.rate_rad_s[0][0], 1.0);
    EXPECT_NEAR(run.rate_rad_s[0][99], 1.0, 1e-12);
    EXPECT_LT(run.rate_rad_s[0][100], 3.0);
    const double overshoot = *std::max_element(run.rate_rad_s[0].begin(), run.rate_rad_s[0].end()) - 3.0;
    // Butterworth's second order overshoots by exp(-pi) of a step; the cubic beside it by a quarter.
    EXPECT_LT(overshoot, 2.0 * (0.25 + (filter.order == 1 ? 0.0 : std::exp(-pi))));
    EXPECT_NEAR(run.rate_rad_s[0].back(), 3.0, 1e-12);
}

TEST_P(Lowpass, AnEvenTurnUpComesLateByItsGroupDelay) {
    const Filter filter = GetParam();
    const auto world = world_turning([](double t_s) { return Vector3{t_s, 0.0, 0.0}; });
    const Simulated run = simulate(filtered(ideal_model(), filter, rate_hz), rate_hz, 1, 1, world);
    const double w = 2.0 * pi * filter.fc_per_rate * rate_hz;
    const double delay_s = filter.order == 1 ? 1.0 / w : std::sqrt(2.0) / w;
    EXPECT_NEAR(run.true_rate_rad_s[0].back() - run.rate_rad_s[0].back(), delay_s, 1e-12);
}

TEST_P(Lowpass, ASlowSwingHasTheFiltersGainAndPhase) {
    const Filter filter = GetParam();
    constexpr double nu = 16.0 / block_samples;
    const auto world = world_turning([](double t_s) {
        return Vector3{std::sin(2.0 * pi * nu * rate_hz * t_s), 0.0, 0.0};
    });
    const Simulated run = simulate(filtered(ideal_model(), filter, rate_hz), rate_hz, 1, 2, world);
    std::complex<double> line = 0.0;
    for (std::size_t i = block_samples; i < run.size(); ++i) {
        line +=
            run.rate_rad_s[0][i] * std::polar(2.0 / block_samples, -2.0 * pi * nu * static_cast<double>(i));
    }
    const std::complex<double> s(0.0, nu / filter.fc_per_rate);
    const auto response = filter.order == 1 ? 1.0 / (1.0 + s) : 1.0 / (1.0 + std::sqrt(2.0) * s + s * s);
    // The cubics miss at most (2 pi nu)^4 / 24 of a sine.
    EXPECT_LT(std::abs(line - response * std::complex<double>(0.0, -1.0)), std::pow(2.0 * pi * nu, 4) / 24.0);
}

TEST(LowpassLevel, FollowsWhatOtherEffectsMadeOfTheWhiteNoise) {
    const Filter filter{2, 0.02};
    SensorModel model = filtered(white_model(N), filter, rate_hz);
    model.effects.push_back(effect_entry("arw_scale", {{"factor", 3.0}}));
    constexpr int seeds = 500;
    double first = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
        SensorSimulator simulator(model, rate_hz, static_cast<std::uint64_t>(seed));
        for (const BlockValues& y : simulator.next_block().rate_rad_s) {
            first += y[0] * y[0] / (3.0 * seeds);
        }
    }
    EXPECT_NEAR(first / (9.0 * N * N * rate_hz * filter.covariance(0.0)), 1.0,
                4.0 * std::sqrt(2.0 / (3.0 * seeds)));
}

TEST(LowpassOrder, IsOneOrTwo) {
    SensorModel model = with_effect(ideal_model(), "lowpass", {{"fc_hz", 41.0}, {"order", 3.0}});
    EXPECT_EQ(simulation_refusal(model), "effect 'lowpass': order is not a whole number from 1 to 2");
    model.effects[0].params["order"] = 1.5;
    EXPECT_EQ(simulation_refusal(model), "effect 'lowpass': order is not a whole number from 1 to 2");
}

}  // namespace
}  // namespace gyrolog
