#include "analysis/diagnose/estimators/tails.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/outliers.hpp"
#include "analysis/diagnose/estimators/variance_change_point.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/numerics/normal_mixture.hpp"
#include "tests/analysis/diagnose/estimators/white_noise_case.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t half_hour = 180'000;  // samples

// Mean log-likelihood ratio of one sample of Student's t against the normal distribution.
double nats_per_sample(double nu, double share) {
    const NormalMixture tails(nu, share, 0.0);
    const NormalMixture normal(std::numeric_limits<double>::infinity(), share, 0.0);
    double sum = 0.0;
    constexpr double step = 0.01;
    for (double x = -80.0; x < 80.0; x += step) {
        const double log_density = tails.log_density(x);
        sum += std::exp(log_density) * (log_density - normal.log_density(x)) * step;
    }
    return sum;
}

TEST(TailEvidence, IsTheLikelihoodRatioOfTheDistributions) {
    for (const double nu : {6.0, 12.0, 30.0}) {
        const auto seen = seen_effects(known_sensor(), {effect_entry("heavy_tail", {{"nu", nu}}, {"x", "y"})},
                                       half_hour, 5);
        const auto found = seen.find("heavy_tail", make_tail_estimator);
        ASSERT_TRUE(found);
        const double share = white_share(*seen.prediction, 0).own_variance;
        const double ideal =
            2.0 * static_cast<double>(seen.prediction->length()) * nats_per_sample(nu, share);
        // The sum of a log-likelihood ratio scatters by about the root of twice its mean, and more with
        // tails.
        EXPECT_NEAR(found->gain_nats, ideal, 6.0 * std::sqrt(2.0 * ideal)) << nu;
        EXPECT_EQ(found->where.axes, (std::vector<std::size_t>{0, 1}));
        ASSERT_EQ(found->entries.size(), 1U);
        const double sd = found->sd[0].at("nu");
        EXPECT_NEAR(found->entries[0].params.at("nu"), nu, 3.5 * sd) << nu;
        EXPECT_LT(sd, 0.3 * nu);
        EXPECT_FALSE(effect_refusal(found->entries[0]));
    }
}

TEST(TailEvidence, TellsAxesWithTailsOfTheirOwn) {
    const auto seen = seen_effects(
        known_sensor(),
        {effect_entry("heavy_tail", {{"nu", 4.0}}, {"x"}), effect_entry("heavy_tail", {{"nu", 12.0}}, {"z"})},
        half_hour, 6);
    const auto found = seen.find("heavy_tail", make_tail_estimator);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->entries.size(), 2U);
    EXPECT_NEAR(found->entries[0].params.at("nu"), 4.0, 4.0 * found->sd[0].at("nu"));
    EXPECT_NEAR(found->entries[1].params.at("nu"), 12.0, 4.0 * found->sd[1].at("nu"));
}

TEST(TailEvidence, IsMoreThanThatOfOutliersOrAChangingLevel) {
    const auto seen = seen_effects(known_sensor(), {effect_entry("heavy_tail", {{"nu", 5.0}})}, half_hour, 7);
    const auto tails = seen.find("heavy_tail", make_tail_estimator);
    const auto outliers = seen.find("spikes", make_outlier_estimator);
    const auto change = seen.find("variance_change", make_variance_change_point_estimator);
    ASSERT_TRUE(tails);
    ASSERT_TRUE(outliers);
    EXPECT_LT(outliers->evidence_nats, tails->evidence_nats - 100.0);
    // The blocks' variances scatter four times as much as those of normal samples.
    ASSERT_TRUE(change);
    EXPECT_LT(change->evidence_nats, 3.0);
}

TEST(TailEvidence, IsGoneOnceTheModelHasThem) {
    SensorModel model = known_sensor();
    model.effects.push_back(effect_entry("heavy_tail", {{"nu", 5.0}}));
    const auto seen = seen_effects(model, {}, half_hour, 8);
    EXPECT_LT(seen.evidence_nats("heavy_tail", make_tail_estimator), 2.0);
    EXPECT_LT(seen.evidence_nats("spikes", make_outlier_estimator), 2.0);
    const auto without = seen_with(known_sensor(), seen.recording);
    EXPECT_GT(without.evidence_nats("heavy_tail", make_tail_estimator), 100.0);
    EXPECT_GT(without.evidence_nats("spikes", make_outlier_estimator), 20.0);
}

TEST(TailEvidence, IsNotMadeByACoarseConverter) {
    SensorModel model = known_sensor();
    // One standard deviation of the white noise.
    model.lsb_rad_s = model.axes[0].noise.N_rad_per_sqrt_s * std::sqrt(model.rate_hz);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const auto seen = seen_effects(model, {}, half_hour, seed);
        EXPECT_LT(seen.evidence_nats("heavy_tail", make_tail_estimator), 1.0) << seed;
    }
    const auto with_tails = seen_effects(model, {effect_entry("heavy_tail", {{"nu", 5.0}})}, half_hour, 1);
    EXPECT_GT(with_tails.evidence_nats("heavy_tail", make_tail_estimator), 100.0);
}

TEST(TailEvidence, IsNoneOfADeadAxis) {
    SensorModel model = known_sensor();
    const auto alive = seen_effects(model, {effect_entry("heavy_tail", {{"nu", 3.0}})}, 4096, 9);
    Recording recording = *alive.recording;
    for (Column& column : recording.columns) {
        if (column.name == "gx") { std::get<std::vector<std::int16_t>>(column.data).assign(4096, 7); }
    }
    const auto seen = seen_with(model, std::make_shared<const Recording>(std::move(recording)));
    const auto found = seen.find("heavy_tail", make_tail_estimator);
    ASSERT_TRUE(found);
    EXPECT_TRUE(std::isfinite(found->gain_nats));
    EXPECT_EQ(found->where.axes, (std::vector<std::size_t>{1, 2}));
}

}  // namespace
}  // namespace gyrolog
