#include "analysis/noise/likelihood_fit.hpp"

#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/noise/analyze.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"
#include "tests/analysis/noise/test_recording.hpp"

namespace gyrolog {
namespace {

using State = FittedCoefficient::State;

Recording recording_of(std::vector<double> samples, double rate_hz) {
    return test::recording_of({std::move(samples)}, rate_hz);
}

NoiseFit fit_of(const Recording& recording) { return analyze(recording).axes.at(0).fit; }
NoiseFit fit_of(std::vector<double> samples, double rate_hz) {
    return fit_of(recording_of(std::move(samples), rate_hz));
}

std::vector<double> gauss_markov(const GaussMarkov& noise, std::size_t samples, double rate_hz,
                                 std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double kept = std::exp(-1.0 / (noise.correlation_s * rate_hz));
    double state = noise.sigma_rad_per_s * normal(random);
    std::vector<double> x(samples);
    for (double& value : x) {
        value = state;
        state = kept * state + noise.sigma_rad_per_s * std::sqrt(1.0 - kept * kept) * normal(random);
    }
    return x;
}

bool within(const FittedCoefficient& coefficient, double truth, double sds) {
    return coefficient.state == State::identified &&
           std::abs(coefficient.value - truth) < sds * coefficient.sd;
}

TEST(LikelihoodFit, ChangesWithTheUnitAndNotWithTheBias) {
    const auto samples = test::sensor_noise({0.0, 0.01, 0.002, 1e-3, 0.0}, 30'000, 10.0, 3);
    std::vector<double> scaled;
    for (const double x : samples) { scaled.push_back(x * deg_per_rad + 700.0); }
    const NoiseFit a = fit_of(samples, 10.0);
    const NoiseFit b = fit_of(scaled, 10.0);
    for (const NoiseTerm term : {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K}) {
        ASSERT_EQ(a[term].state, b[term].state) << name_of(term);
        EXPECT_NEAR(b[term].value, a[term].value * deg_per_rad, 1e-3 * b[term].value) << name_of(term);
    }
}

TEST(LikelihoodFit, FindsAngleNoise) {
    constexpr double Q_rad = 2e-4;
    auto samples = test::sensor_noise({0.0, 0.001, 0.0, 0.0, 0.0}, 60'000, 100.0, 4);
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal(0.0, Q_rad);
    double before = normal(random);
    for (double& x : samples) {
        const double angle = normal(random);
        x += (angle - std::exchange(before, angle)) * 100.0;
    }
    const NoiseFit fit = fit_of(samples, 100.0);
    EXPECT_TRUE(within(fit[NoiseTerm::Q], Q_rad, 4.0)) << fit[NoiseTerm::Q].value;
    EXPECT_TRUE(within(fit[NoiseTerm::N], 0.001, 4.0)) << fit[NoiseTerm::N].value;
}

TEST(LikelihoodFit, FindsARampBesideARandomWalk) {
    constexpr double R_rad_per_s2 = 2e-5;
    auto samples = test::sensor_noise({0.0, 0.01, 0.0, 1e-4, 0.0}, 60'000, 10.0, 5);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] += R_rad_per_s2 * static_cast<double>(i) / 10.0;
    }
    const NoiseFit fit = fit_of(samples, 10.0);
    EXPECT_TRUE(within(fit[NoiseTerm::R], R_rad_per_s2, 4.0)) << fit[NoiseTerm::R].value;
    EXPECT_LT(fit[NoiseTerm::K].upper, 3e-4);
}

// Before the ramp is in the model, so steep a one asks for angle noise to make up for what leaks from it.
TEST(LikelihoodFit, KeepsNoAngleNoiseThatOnlyStoodInForARamp) {
    constexpr std::size_t count = 20'000;
    constexpr double R_rad_per_s2 = 5.6e-3;
    auto samples = test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, count, 10.0, 15);
    for (std::size_t i = 0; i < count; ++i) { samples[i] += R_rad_per_s2 * static_cast<double>(i) / 10.0; }
    const NoiseFit fit = fit_of(samples, 10.0);
    EXPECT_TRUE(within(fit[NoiseTerm::R], R_rad_per_s2, 4.0)) << fit[NoiseTerm::R].value;
    EXPECT_EQ(fit[NoiseTerm::Q].state, State::not_identifiable);
    EXPECT_EQ(fit.model_error, 0.0);
    // White noise alone is known to 1 / sqrt(2 n).
    EXPECT_NEAR(fit[NoiseTerm::N].sd, 0.01 / std::sqrt(2.0 * count), 0.1 * fit[NoiseTerm::N].sd);
}

TEST(LikelihoodFit, FindsGaussMarkovNoiseAndItsCorrelationTime) {
    constexpr GaussMarkov truth = {0.01, 20.0};
    auto samples = test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 100'000, 10.0, 6);
    const auto slow = gauss_markov(truth, samples.size(), 10.0, 60);
    for (std::size_t i = 0; i < samples.size(); ++i) { samples[i] += slow[i]; }
    const NoiseFit fit = fit_of(samples, 10.0);
    ASSERT_EQ(fit.gauss_markov.size(), 1U);
    const FittedGaussMarkov& found = fit.gauss_markov.front();
    EXPECT_NEAR(found.value.sigma_rad_per_s, truth.sigma_rad_per_s, 4.0 * found.sigma_sd);
    EXPECT_NEAR(found.value.correlation_s, truth.correlation_s, 4.0 * found.correlation_sd_s);
    EXPECT_LT(found.correlation_sd_s, 0.3 * truth.correlation_s);
    EXPECT_TRUE(within(fit[NoiseTerm::N], 0.01, 4.0)) << fit[NoiseTerm::N].value;
}

// Nothing in fast contrasts tells it from a random walk.
TEST(LikelihoodFit, FindsSlowGaussMarkovNoiseInSixHours) {
    constexpr GaussMarkov truth = {0.002, 100.0};
    auto samples = test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 216'000, 10.0, 16);
    const auto slow = gauss_markov(truth, samples.size(), 10.0, 61);
    for (std::size_t i = 0; i < samples.size(); ++i) { samples[i] += slow[i]; }
    const NoiseFit fit = fit_of(samples, 10.0);
    ASSERT_EQ(fit.gauss_markov.size(), 1U);
    const FittedGaussMarkov& found = fit.gauss_markov.front();
    EXPECT_NEAR(found.value.sigma_rad_per_s, truth.sigma_rad_per_s, 4.0 * found.sigma_sd);
    EXPECT_NEAR(found.value.correlation_s, truth.correlation_s, 4.0 * found.correlation_sd_s);
    EXPECT_LT(found.correlation_sd_s, 0.3 * truth.correlation_s);
    EXPECT_EQ(fit[NoiseTerm::K].state, State::not_identifiable);
}

TEST(LikelihoodFit, TakesASinusoidOutOfTheOtherTerms) {
    auto samples = test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 100'000, 100.0, 7);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] += 0.03 * std::sin(2.0 * pi * 7.31 * static_cast<double>(i) / 100.0 + 1.0);
    }
    const NoiseFit fit = fit_of(samples, 100.0);
    ASSERT_EQ(fit.sinusoids.size(), 1U);
    EXPECT_NEAR(fit.sinusoids[0].value.frequency_hz, 7.31, 1e-4);
    EXPECT_NEAR(fit.sinusoids[0].value.amplitude_rad_per_s, 0.03, 4.0 * fit.sinusoids[0].amplitude_sd);
    EXPECT_TRUE(within(fit[NoiseTerm::N], 0.01, 4.0)) << fit[NoiseTerm::N].value;
    EXPECT_EQ(fit[NoiseTerm::Q].state, State::not_identifiable);
}

TEST(LikelihoodFit, LeavesAFilteredUpperEndOut) {
    // White noise through a first-order low pass at a twentieth of the rate, and flicker behind it.
    auto samples = test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 200'000, 100.0, 8);
    double state = 0.0;
    const double kept = std::exp(-2.0 * pi * 5.0 / 100.0);
    for (double& x : samples) { x = state = kept * state + (1.0 - kept) * x; }
    const auto flicker = test::sensor_noise({0.0, 0.0, 0.003, 0.0, 0.0}, samples.size(), 100.0, 9);
    for (std::size_t i = 0; i < samples.size(); ++i) { samples[i] += flicker[i]; }
    const AnalysisReport report = analyze(recording_of(samples, 100.0));
    const NoiseFit& fit = report.axes.at(0).fit;
    EXPECT_GT(fit.upper_frequency_hz, 0.1);
    EXPECT_LT(fit.upper_frequency_hz, 13.0);
    EXPECT_NEAR(fit[NoiseTerm::N].value, 0.01, 0.001);
    EXPECT_NEAR(fit[NoiseTerm::B].value, 0.003, 0.0012);
    EXPECT_FALSE(report.warnings.empty());
}

// Through a first-order filter at a hundredth of the rate, of which nothing but the bandwidth is known.
TEST(LikelihoodFit, FindsTheWhiteNoiseBeforeAKnownFilter) {
    constexpr double rate_hz = 500.0;
    constexpr double bandwidth_hz = 5.0;
    const double kept = std::exp(-2.0 * pi * bandwidth_hz / rate_hz);
    for (const std::size_t samples : {50'000U, 500'000U}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            auto values = test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, samples, rate_hz, seed);
            double state = 0.0;
            for (double& x : values) { x = state = kept * state + (1.0 - kept) * x; }
            Recording recording = recording_of(values, rate_hz);
            recording.columns[0].bandwidth_hz = bandwidth_hz;
            const AnalysisReport report = analyze(recording);
            const NoiseFit& fit = report.axes.at(0).fit;
            EXPECT_EQ(fit.bandwidth_hz, bandwidth_hz);
            EXPECT_TRUE(within(fit[NoiseTerm::N], 0.01, 3.0)) << fit[NoiseTerm::N].value << ' ' << seed;
            EXPECT_LT(fit[NoiseTerm::N].sd, samples > 100'000U ? 0.0003 : 0.001);
            ASSERT_EQ(report.warnings.size(), 1U);
            EXPECT_NE(report.warnings[0].find("low-pass filter of 5 Hz"), std::string::npos);
        }
    }
}

TEST(LikelihoodFit, AKnownFilterAboveTheBandChangesNothing) {
    const auto samples = test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 30'000, 100.0, 3);
    Recording recording = recording_of(samples, 100.0);
    const NoiseFit without = fit_of(recording);
    recording.columns[0].bandwidth_hz = 41.0;
    const NoiseFit with = fit_of(recording);
    EXPECT_EQ(with[NoiseTerm::N].value, without[NoiseTerm::N].value);
    EXPECT_EQ(with.upper_frequency_hz, 0.0);
}

// Coloured noise that is none of the model's terms. Intervals are profiles of the likelihood, standard
// deviations its curvature: where both belong to the same departure they are alike.
TEST(LikelihoodFit, HasIntervalsAsWideAsItsStandardDeviationsWhereTheSpectrumDeparts) {
    for (const std::uint64_t seed : {1U, 2U}) {
        auto samples = test::sensor_noise({0.0, 0.01, 0.004, 1e-4, 0.0}, 20'000, 10.0, seed);
        const auto fast = gauss_markov({0.025, 0.2}, samples.size(), 10.0, seed + 100);
        for (std::size_t i = 0; i < samples.size(); ++i) { samples[i] += fast[i]; }
        const NoiseFit fit = fit_of(samples, 10.0);
        EXPECT_GT(fit.model_error, 0.02) << seed;
        for (const NoiseTerm term : {NoiseTerm::N, NoiseTerm::B}) {
            const FittedCoefficient& c = fit[term];
            ASSERT_EQ(c.state, State::identified) << name_of(term) << ' ' << seed;
            EXPECT_LT(c.lo, c.value);
            EXPECT_GT(c.hi, c.value);
            EXPECT_NEAR((c.hi - c.lo) / (2.0 * c.sd), 1.0, 0.3) << name_of(term) << ' ' << seed;
        }
    }
}

TEST(LikelihoodFit, DoesNotCountTheConvertersErrorAsNoise) {
    constexpr double step = 0.05;
    constexpr double N = 0.005;  // 0.05 a sample: as large as the step
    auto samples = test::sensor_noise({0.0, N, 0.0, 0.0, 0.0}, 400'000, 100.0, 10);
    for (double& x : samples) { x = std::round(x / step) * step; }
    const NoiseFit fit = fit_of(samples, 100.0);
    EXPECT_TRUE(within(fit[NoiseTerm::N], N, 3.0)) << fit[NoiseTerm::N].value;
    // The plain variance would give as much more:
    EXPECT_GT(std::sqrt(N * N + step * step / 12.0 / 100.0) - N, 10.0 * fit[NoiseTerm::N].sd);
    EXPECT_NEAR(fit.best.converter.step_rad_per_s, step, 1e-9);
}

// Bursts of five seconds are lost, one percent in all.
TEST(LikelihoodFit, OfARecordWithHolesIsThatOfTheWholeAndNotOfTheRestClosedUp) {
    constexpr double rate_hz = 10.0;
    constexpr double R_rad_per_s2 = 1e-3;
    constexpr NoiseCoefficients truth = {0.0, 0.01, 0.002, 1e-4, 0.0};
    auto samples = test::sensor_noise(truth, 108'000, rate_hz, 11);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double t_s = static_cast<double>(i) / rate_hz;
        samples[i] += R_rad_per_s2 * t_s + 0.02 * std::sin(2.0 * pi * 0.713 * t_s);
    }
    Recording holes = recording_of({}, rate_hz);
    holes.segments.clear();
    std::vector<double> kept;
    constexpr std::size_t period = 5'000;
    for (std::size_t begin = 0; begin < samples.size(); begin += period) {
        const std::size_t count = std::min(period - 50, samples.size() - begin);
        holes.segments.push_back({kept.size(), count, static_cast<std::int64_t>(begin)});
        kept.insert(kept.end(), samples.begin() + static_cast<std::ptrdiff_t>(begin),
                    samples.begin() + static_cast<std::ptrdiff_t>(begin + count));
    }
    holes.columns[0].data = kept;
    const NoiseFit whole = fit_of(samples, rate_hz);
    const NoiseFit with_holes = fit_of(holes);
    const NoiseFit closed_up = fit_of(kept, rate_hz);
    for (const NoiseTerm term : {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K, NoiseTerm::R}) {
        const FittedCoefficient& a = whole[term];
        const FittedCoefficient& b = with_holes[term];
        ASSERT_EQ(a.state, b.state) << name_of(term);
        if (a.state == State::identified) {
            EXPECT_GE(b.value, a.lo) << name_of(term);
            EXPECT_LE(b.value, a.hi) << name_of(term);
        }
    }
    ASSERT_EQ(with_holes.sinusoids.size(), 1U);
    EXPECT_NEAR(with_holes.sinusoids[0].value.frequency_hz, 0.713, 1e-5);
    // Closed up, time runs one percent too fast and the line's phase jumps at every hole.
    EXPECT_TRUE(within(with_holes[NoiseTerm::R], R_rad_per_s2, 3.0));
    EXPECT_FALSE(within(closed_up[NoiseTerm::R], R_rad_per_s2, 3.0));
    const bool same_line =
        closed_up.sinusoids.size() == 1 && std::abs(closed_up.sinusoids[0].value.frequency_hz - 0.713) < 1e-4;
    EXPECT_FALSE(same_line);
}

TEST(LikelihoodFit, OfARobustAnalysisIsThatOfTheRecordWithoutItsOutliers) {
    const auto clean = test::sensor_noise({0.0, 0.01, 0.002, 0.0, 0.0}, 50'000, 100.0, 12);
    auto spiked = clean;
    std::mt19937_64 random(12);
    for (int i = 0; i < 30; ++i) { spiked[random() % spiked.size()] += (i % 2 == 0 ? 5.0 : -3.0); }
    AnalysisOptions robust;
    robust.robust = true;
    const AnalysisReport report = analyze(recording_of(spiked, 100.0), robust);
    const double N = fit_of(clean, 100.0)[NoiseTerm::N].value;
    EXPECT_NEAR(report.axes[0].fit[NoiseTerm::N].value, N, 2.0 * report.axes[0].fit[NoiseTerm::N].sd);
    EXPECT_GT(fit_of(spiked, 100.0)[NoiseTerm::N].value, 1.3 * N);
    EXPECT_NEAR(static_cast<double>(report.axes[0].outliers.samples), 30.0, 1.0);
}

TEST(LikelihoodFit, OfTooFewOrUnvaryingSamplesLeavesTheCurve) {
    EXPECT_EQ(fit_of(std::vector<double>(1000, 0.25), 10.0).method, FitMethod::curve);
    EXPECT_EQ(fit_of({1.0, 2.0, 3.0, 1.0}, 10.0).method, FitMethod::curve);
    for (const std::size_t samples : {2U, 3U, 4U, 5U, 6U, 8U, 12U, 20U, 31U, 32U, 33U, 50U}) {
        const NoiseFit fit =
            fit_of(test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, samples, 10.0, samples), 10.0);
        for (const FittedCoefficient& term : fit.terms) {
            EXPECT_TRUE(std::isfinite(term.value) && std::isfinite(term.upper) && std::isfinite(term.sd));
        }
    }
}

}  // namespace
}  // namespace gyrolog
