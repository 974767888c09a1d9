#include "analysis/diagnose/estimators/random_telegraph.hpp"

#include <Eigen/Dense>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/diagnose/estimators/telegraph_filter.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

std::vector<double> normals(std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) { values[i] = RandomStream(5, 6).normal(i); }
    return values;
}

TEST(TelegraphFilter, SumsOverAllPathsWhereNothingDrifts) {
    constexpr std::size_t count = 10;
    const std::vector<double> values = normals(count);
    const Telegraph telegraph{1.3, 4.0, 2.5};
    constexpr double step_s = 0.5;
    DriftStates noise;
    noise.white_variance = 0.6;
    const double forgotten = 1.0 - std::exp(-step_s * (1.0 / 4.0 + 1.0 / 2.5));
    const double share = 4.0 / 6.5;
    double sum = 0.0;
    for (unsigned path = 0; path < 1U << count; ++path) {
        double probability = 1.0;
        const unsigned flips = path ^ (path << 1U);
        for (std::size_t i = 0; i < count; ++i) {
            const bool high = (path >> i & 1U) != 0;
            const bool changed = i > 0 && (flips >> i & 1U) != 0;
            const double stationary = high ? share : 1.0 - share;
            if (i == 0) {
                probability *= stationary;
            } else {
                probability *= forgotten * stationary + (changed ? 0.0 : 1.0 - forgotten);
            }
            const double level = changed ? 1.3 * (0.5 - share) : high ? 1.3 * (1.0 - share) : -1.3 * share;
            const double variance = changed ? 0.6 + 1.3 * 1.3 / 12.0 : 0.6;
            const double left = values[i] - level;
            probability *= std::exp(-0.5 * left * left / variance) / std::sqrt(2.0 * pi * variance);
        }
        sum += probability;
    }
    EXPECT_NEAR(telegraph_log_likelihood(values, step_s, noise, telegraph), std::log(sum), 1e-9);
}

TEST(TelegraphFilter, OfGaussMarkovNoiseIsTheNormalDensity) {
    constexpr std::size_t count = 30;
    const std::vector<double> values = normals(count);
    const Telegraph telegraph{1.3, 4.0, 2.5};
    constexpr double step_s = 0.5;
    DriftStates noise;
    noise.white_variance = 0.6;
    noise.kept = {0.9, 0.0, 0.0, 1.0};
    noise.innovation = {0.5 * (1.0 - 0.81), 0.0, 0.0, 0.02};
    noise.start = {0.5, 0.0, 0.0, 3.0};
    // Of means of exp(-|t| / T) over steps of u T: 2 (u - 1 + exp(-u)) / u^2 within one, and between two
    // (2 sinh(u / 2) / u)^2 exp(-|i - j| u).
    const double u = step_s / telegraph.correlation_s();
    const double within = 2.0 * (u - 1.0 + std::exp(-u)) / (u * u);
    const double between = 2.0 * std::sinh(0.5 * u) / u;
    Eigen::MatrixXd covariance(count, count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
            const double apart = std::fabs(static_cast<double>(i) - static_cast<double>(j));
            covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                (i == j ? 0.6 : 0.0) + 0.5 * std::pow(0.9, apart) + 3.0 +
                0.02 * static_cast<double>(std::min(i, j)) +
                telegraph.variance() * (i == j ? within : between * between * std::exp(-apart * u));
        }
    }
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    const Eigen::VectorXd white =
        root.matrixL().solve(Eigen::Map<const Eigen::VectorXd>(values.data(), count));
    const double log_root = root.matrixLLT().diagonal().array().log().sum();
    const double density = -0.5 * white.squaredNorm() - log_root - 0.5 * count * std::log(2.0 * pi);
    EXPECT_NEAR(gauss_markov_log_likelihood(values, step_s, noise, telegraph), density, 1e-9);
}

TEST(DriftStates, FollowFlickerAndRandomWalk) {
    constexpr double step_s = 0.5;
    constexpr double duration_s = 7200.0;
    std::vector<double> f_hz;
    std::vector<double> density;
    const NoiseCoefficients sensor{.N_rad_per_sqrt_s = 5e-3, .B_rad_per_s = 2e-3, .K_rad_per_s_sqrt_s = 1e-4};
    for (double f = 0.5 / duration_s; f < 50.0; f *= 1.03) {
        f_hz.push_back(f);
        density.push_back(sensor.psd(f));
    }
    const DriftStates states = drift_states(f_hz, density, step_s, duration_s);
    for (double f = 2.0 / duration_s; f < 0.1 / step_s; f *= 1.5) {
        double sum = states.white_variance * step_s;
        for (std::size_t part = 0; part < resolution::drift_parts; ++part) {
            const double kept = states.kept[part];
            const double sine = std::sin(pi * f * step_s);
            sum +=
                step_s * states.innovation[part] / ((1.0 - kept) * (1.0 - kept) + 4.0 * kept * sine * sine);
        }
        EXPECT_NEAR(sum / sensor.psd(f), 1.0, 0.15) << f;
    }
}

TEST(RandomTelegraph, IsWorthMoreThanGaussMarkovNoiseWhereTheLevelsAreTwo) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth = with_effect(
        model, "rtn", {{"amplitude_dps", 0.02}, {"dwell_high_s", 12.0}, {"dwell_low_s", 5.0}}, {"y"});
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const auto recording = recorded(truth, 120000, seed);
        const auto finding = found(make_random_telegraph_estimator, "rtn", recording, model);
        ASSERT_TRUE(finding);
        EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{1});
        EXPECT_GT(finding->evidence_nats,
                  evidence(found(make_noise_spectrum_estimator, "gauss_markov", recording, model)) + 50.0);
        EXPECT_GT(finding->beside_nats(), 50.0);
        EXPECT_LT(finding->beside_nats(), finding->gain_nats);
        const auto& params = finding->entries.front().params;
        const auto& sd = finding->sd.front();
        EXPECT_NEAR(params.at("amplitude_dps"), 0.02, 5.0 * sd.at("amplitude_dps"));
        // So few dwell times differ from their mean by themselves.
        EXPECT_NEAR(params.at("dwell_high_s"), 12.0, 4.0 * sd.at("dwell_high_s"));
        EXPECT_NEAR(params.at("dwell_low_s"), 5.0, 4.0 * sd.at("dwell_low_s"));
        EXPECT_LT(sd.at("dwell_high_s"), 4.0);
        EXPECT_LT(
            evidence(found(make_random_telegraph_estimator, "rtn", recording, with_cause(model, *finding))),
            3.0);
    }
}

TEST(RandomTelegraph, IsWorthLessWhereTheNoiseIsGaussMarkov) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth =
        with_effect(model, "gauss_markov", {{"sigma_dps", 0.01}, {"tau_s", 4.0}}, {"x"});
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const auto recording = recorded(truth, 120000, seed);
        const auto wandering = found(make_noise_spectrum_estimator, "gauss_markov", recording, model);
        ASSERT_TRUE(wandering);
        const auto levels = found(make_random_telegraph_estimator, "rtn", recording, model);
        ASSERT_TRUE(levels);
        EXPECT_GT(wandering->evidence_nats, levels->evidence_nats + 30.0);
        EXPECT_LT(levels->beside_nats(), -30.0);
    }
}

// Short of the levels to be seen, nothing but the spectrum speaks, and that alike.
TEST(RandomTelegraph, IsWorthAsMuchWhereTheLevelsDrownInNoise) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth = with_effect(
        model, "rtn", {{"amplitude_dps", 0.008}, {"dwell_high_s", 1.0}, {"dwell_low_s", 1.0}}, {"x"});
    const auto recording = recorded(truth, 360000, 3);
    const auto levels = found(make_random_telegraph_estimator, "rtn", recording, model);
    const auto spectrum = found(make_noise_spectrum_estimator, "gauss_markov", recording, model);
    ASSERT_TRUE(levels && spectrum);
    EXPECT_GT(spectrum->gain_nats, 10.0);
    EXPECT_NEAR(levels->gain_nats, spectrum->gain_nats, 5.0);
    EXPECT_NEAR(levels->beside_nats(), 0.0, 5.0);
}

TEST(RandomTelegraph, AnswersForOneDeadAxisAndFewSamples) {
    const SensorModel model = calibrated_sensor();
    EXPECT_LT(evidence(found(make_random_telegraph_estimator, "rtn", few_samples_with_a_dead_axis(model, 10),
                             model)),
              3.0);
    const SensorModel sensor = with_effect(
        model, "rtn", {{"amplitude_dps", 0.2}, {"dwell_high_s", 2.0}, {"dwell_low_s", 2.0}}, {"z"});
    const auto finding =
        found(make_random_telegraph_estimator, "rtn", few_samples_with_a_dead_axis(sensor, 10), model);
    ASSERT_TRUE(finding);
    EXPECT_TRUE(std::isfinite(finding->evidence_nats));
    EXPECT_GT(finding->evidence_nats, 20.0);
    EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{2});
}

}  // namespace
}  // namespace gyrolog
