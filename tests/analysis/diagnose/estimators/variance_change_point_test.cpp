#include "analysis/diagnose/estimators/variance_change_point.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/tails.hpp"
#include "analysis/diagnose/estimators/variance_with_temperature.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "tests/analysis/diagnose/estimators/white_noise_case.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t half_hour = 180'000;  // samples

EffectModel change(double factor, double at_s, double ramp_s, std::vector<std::string> axes = {}) {
    return effect_entry("variance_change", {{"factor", factor}, {"at_s", at_s}, {"ramp_s", ramp_s}},
                        std::move(axes));
}

TEST(VarianceChangePoint, OfAStepIsTheLikelihoodRatio) {
    for (const double factor : {1.04, 1.5}) {
        const auto seen =
            seen_effects(known_sensor(), {change(factor, 700.0, 0.0, {"x", "z"})}, half_hour, 31);
        const auto found = seen.find("variance_change", make_variance_change_point_estimator);
        ASSERT_TRUE(found);
        const auto n = static_cast<double>(seen.prediction->length());
        const double after = 1.0 - 700.0 / seen.prediction->duration_s();
        const double square = factor * factor;
        const double ideal = 2.0 * 0.5 * n *
                             (std::log(1.0 - after + after * square) - after * std::log(square)) *
                             white_share(*seen.prediction, 0).variance;
        EXPECT_NEAR(found->gain_nats, ideal, 5.0 * std::sqrt(2.0 * ideal)) << factor;
        EXPECT_EQ(found->where.axes, (std::vector<std::size_t>{0, 2}));
        ASSERT_EQ(found->entries.size(), 1U);
        EXPECT_FALSE(effect_refusal(found->entries[0]));
        EXPECT_NEAR(found->entries[0].params.at("factor"), factor, 4.0 * found->sd[0].at("factor"));
        EXPECT_EQ(found->entries[0].params.at("ramp_s"), 0.0);
        EXPECT_NEAR(found->entries[0].params.at("at_s"), 700.0, 5.0 * found->sd[0].at("at_s")) << factor;
        EXPECT_LT(found->sd[0].at("at_s"), factor > 1.2 ? 1.0 : 100.0);
        ASSERT_TRUE(found->where.time_s);
        EXPECT_EQ(found->where.time_s->from, found->where.time_s->to);
    }
}

// That the level before the change is the model's, the spectra's likelihood has as well: for less white noise
// than the model's, they would mend each other without end.
TEST(VarianceChangePoint, TellsWhatOfItsGainTheSpectraHave) {
    const double factor = 1.5;
    SensorModel model = known_sensor();
    model.sd_rel["N"] = 0.005;
    const auto seen = seen_effects(model, {change(factor, 700.0, 0.0, {"x"})}, half_hour, 33);
    const auto found = seen.find("variance_change", make_variance_change_point_estimator);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->where.axes, std::vector<std::size_t>{0});
    const auto n = static_cast<double>(seen.prediction->length());
    const double after = 1.0 - 700.0 / seen.prediction->duration_s();
    const double square = factor * factor;
    const double share = white_share(*seen.prediction, 0).variance;
    const double of_course =
        0.5 * n * (std::log(1.0 - after + after * square) - after * std::log(square)) * share;
    EXPECT_NEAR(found->beside_nats(), of_course, 5.0 * std::sqrt(2.0 * of_course));
    EXPECT_GT(found->spectral_nats(), 500.0);
}

TEST(VarianceChangePoint, TellsARampFromAStep) {
    const auto seen = seen_effects(known_sensor(), {change(1.6, 400.0, 800.0)}, half_hour, 32);
    const auto found = seen.find("variance_change", make_variance_change_point_estimator);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->entries.size(), 1U);
    const auto& params = found->entries[0].params;
    const auto& sd = found->sd[0];
    EXPECT_NEAR(params.at("factor"), 1.6, 4.0 * sd.at("factor"));
    EXPECT_NEAR(params.at("at_s"), 400.0, 4.0 * sd.at("at_s"));
    EXPECT_NEAR(params.at("ramp_s"), 800.0, 4.0 * sd.at("ramp_s"));
    EXPECT_LT(sd.at("ramp_s"), 100.0);
}

TEST(VarianceChangePoint, IsNoneForALevelThatIsHigherThroughout) {
    const EffectModel louder = effect_entry("arw_scale", {{"factor", 1.4}});
    const auto seen = seen_effects(known_sensor(), {louder}, half_hour, 33);
    EXPECT_LT(seen.evidence_nats("variance_change", make_variance_change_point_estimator), 2.0);
    const auto both = seen_effects(known_sensor(), {louder, change(1.2, 700.0, 0.0)}, half_hour, 33);
    EXPECT_GT(both.evidence_nats("variance_change", make_variance_change_point_estimator), 100.0);
}

TEST(VarianceChangePoint, IsMoreThanThatOfTailsAndFollowsTheTemperatureLess) {
    const auto seen =
        seen_effects(known_sensor(), {change(1.5, 700.0, 0.0)}, half_hour, 34, swept_temperature());
    const auto found = seen.find("variance_change", make_variance_change_point_estimator);
    ASSERT_TRUE(found);
    const auto tails = seen.find("heavy_tail", make_tail_estimator);
    ASSERT_TRUE(tails);
    EXPECT_LT(tails->evidence_nats, 0.5 * found->evidence_nats);
    const auto warmth = seen.find("temp_noise", make_variance_with_temperature_estimator);
    ASSERT_TRUE(warmth);
    EXPECT_LT(warmth->evidence_nats, found->evidence_nats - 100.0);
}

TEST(VarianceChangePoint, IsSeenBesideTailsThatTheModelHas) {
    SensorModel model = known_sensor();
    model.effects.push_back(effect_entry("heavy_tail", {{"nu", 5.0}}));
    const auto seen = seen_effects(model, {change(1.2, 700.0, 0.0)}, half_hour, 35);
    const auto found = seen.find("variance_change", make_variance_change_point_estimator);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->entries[0].params.at("factor"), 1.2, 4.0 * found->sd[0].at("factor"));
    EXPECT_GT(found->evidence_nats, 100.0);
}

TEST(VarianceChangePoint, IsGoneOnceTheModelHasIt) {
    SensorModel model = known_sensor();
    model.effects.push_back(change(2.0, 500.0, 300.0));
    const auto seen = seen_effects(model, {}, half_hour, 36);
    for (const std::size_t axis : seen.prediction->axes()) {
        double squares = 0.0;
        for (const float w : seen.seen->axis(axis).whitened) { squares += static_cast<double>(w * w); }
        const auto n = static_cast<double>(seen.prediction->length());
        EXPECT_NEAR(squares / n, 1.0, 5.0 * std::sqrt(2.0 / n));
    }
    EXPECT_LT(seen.evidence_nats("variance_change", make_variance_change_point_estimator), 3.0);
    EXPECT_LT(seen.evidence_nats("heavy_tail", make_tail_estimator), 3.0);
    const auto without = seen_with(known_sensor(), seen.recording);
    EXPECT_GT(without.evidence_nats("variance_change", make_variance_change_point_estimator), 100.0);
    EXPECT_GT(without.evidence_nats("heavy_tail", make_tail_estimator), 20.0);
}

}  // namespace
}  // namespace gyrolog
