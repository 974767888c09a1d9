#include "analysis/diagnose/estimators/outliers.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/tails.hpp"
#include "analysis/diagnose/estimators/variance_change_point.hpp"
#include "tests/analysis/diagnose/estimators/white_noise_case.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t half_hour = 180'000;  // samples

EffectModel spikes(double per_hour, double smallest_dps, double largest_dps, std::vector<std::string> axes) {
    return effect_entry(
        "spikes", {{"per_hour", per_hour}, {"smallest_dps", smallest_dps}, {"largest_dps", largest_dps}},
        std::move(axes));
}

TEST(OutlierEvidence, CountsTheSpikes) {
    const auto seen = seen_effects(known_sensor(), {spikes(80.0, 1.0, 3.0, {"y"})}, half_hour, 21);
    const auto found = seen.find("spikes", make_outlier_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, std::vector<std::size_t>{1});
    EXPECT_EQ(found->where.structure, "isolated_samples");
    ASSERT_EQ(found->entries.size(), 1U);
    EXPECT_FALSE(effect_refusal(found->entries[0]));
    const auto& params = found->entries[0].params;
    const auto& sd = found->sd[0];
    EXPECT_NEAR(params.at("per_hour"), 80.0, 3.5 * sd.at("per_hour"));
    // Forty sizes leave about a fortieth of the range at either end; the noise smears it by 0.07.
    EXPECT_NEAR(params.at("smallest_dps"), 1.0, 0.25);
    EXPECT_NEAR(params.at("largest_dps"), 3.0, 0.25);
    // Each of some forty is worth about half its square in standard deviations of the noise.
    EXPECT_GT(found->gain_nats, 40.0 * 0.5 * std::pow(1.0 / 0.08, 2.0));
}

// Spikes that double the power of the noise pass for more of it where the model leaves that open: their
// sizes are what they are.
TEST(OutlierEvidence, KeepsTheSizesWhereTheNoiseGivesWay) {
    SensorModel model = known_sensor();
    for (AxisModel& axis : model.axes) { axis.sd_rel["N"] = 0.5; }
    const auto seen = seen_effects(model, {spikes(360.0, 3.0, 5.0, {"y"})}, half_hour, 26);
    const auto found = seen.find("spikes", make_outlier_estimator);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->entries.at(0).params.at("smallest_dps"), 3.0, 0.2);
    EXPECT_NEAR(found->entries.at(0).params.at("largest_dps"), 5.0, 0.2);
}

TEST(OutlierEvidence, SharesWhatAxesHaveInCommon) {
    const auto seen = seen_effects(known_sensor(), {spikes(40.0, 1.0, 3.0, {})}, half_hour, 24);
    const auto found = seen.find("spikes", make_outlier_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(found->entries.size(), 1U);
}

TEST(OutlierEvidence, OfOneSpikeIsEnough) {
    const auto clean = seen_effects(known_sensor(), {}, 20'000, 23);
    Recording recording = *clean.recording;
    for (Column& column : recording.columns) {
        if (column.name != "gz") { continue; }
        auto& counts = std::get<std::vector<std::int16_t>>(column.data);
        counts[12'345] =
            static_cast<std::int16_t>(counts[12'345] + std::lround(1.0 * rad_per_deg / column.scale));
    }
    const auto seen = seen_with(known_sensor(), std::make_shared<const Recording>(std::move(recording)));
    const auto found = seen.find("spikes", make_outlier_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, std::vector<std::size_t>{2});
    EXPECT_GT(found->evidence_nats, 20.0);
}

TEST(OutlierEvidence, IsMoreThanThatOfTailsOrAChangingLevel) {
    const auto seen = seen_effects(known_sensor(), {spikes(100.0, 0.6, 2.0, {"x", "y"})}, half_hour, 24);
    const auto outliers = seen.find("spikes", make_outlier_estimator);
    ASSERT_TRUE(outliers);
    const auto tails = seen.find("heavy_tail", make_tail_estimator);
    ASSERT_TRUE(tails);
    EXPECT_LT(tails->evidence_nats, outliers->evidence_nats - 100.0);
    EXPECT_LT(seen.evidence_nats("variance_change", make_variance_change_point_estimator), 3.0);
    const EffectModel change =
        effect_entry("variance_change", {{"factor", 1.3}, {"at_s", 700.0}, {"ramp_s", 0.0}});
    const auto both =
        seen_effects(known_sensor(), {spikes(100.0, 0.6, 2.0, {"x", "y"}), change}, half_hour, 24);
    EXPECT_GT(both.evidence_nats("variance_change", make_variance_change_point_estimator), 20.0);
}

TEST(OutlierEvidence, IsGoneOnceTheModelHasThem) {
    SensorModel model = known_sensor();
    model.effects.push_back(spikes(100.0, 0.8, 2.0, {}));
    const auto seen = seen_effects(model, {}, half_hour, 25);
    EXPECT_LT(seen.evidence_nats("spikes", make_outlier_estimator), 3.0);
    EXPECT_LT(seen.evidence_nats("heavy_tail", make_tail_estimator), 3.0);
    const auto without = seen_with(known_sensor(), seen.recording);
    EXPECT_GT(without.evidence_nats("spikes", make_outlier_estimator), 100.0);
    EXPECT_GT(without.evidence_nats("heavy_tail", make_tail_estimator), 20.0);
}

}  // namespace
}  // namespace gyrolog
