#include "analysis/diagnose/selection/cause_set.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/effect_axes.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

using Axes = std::vector<std::size_t>;

// With an entry for each axis.
Finding finding(const char* effect, const std::array<double, 3>& axis_gain_nats) {
    Finding made;
    made.effect = effect;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis_gain_nats[axis] == 0.0) { continue; }
        EffectModel entry;
        entry.effect = effect;
        entry.axes = {std::string(axis_names.at(axis))};
        made.entries.push_back(entry);
        made.where.axes.push_back(axis);
        made.gain_nats += axis_gain_nats[axis];
    }
    made.axis_gain_nats = axis_gain_nats;
    made.evidence_nats = made.gain_nats - 3.0;
    made.parameters = 1;
    return made;
}

class CauseSetTest : public testing::Test {
protected:
    const SensorModel model = calibrated_sensor();
    const std::shared_ptr<const Recording> recording = recorded(model, 2000, 1);
    const std::shared_ptr<const Prediction> prediction = prediction_of(recording, model);
    const Hypotheses first = {
        prediction, std::make_shared<const Observation>(prediction, recording, 1), {}, {}};
    CauseSet set{first, recording, {}};
};

// A cause may stand for two: neither of them explains all that it does.
TEST_F(CauseSetTest, GivesAxesToARivalThatExplainsAPart) {
    const Finding rival = finding("rrw_missing", {40.0, 0.5, 30.0});
    set.causes = {{finding("temp_cubic", {0.0, 150.0, 120.0}), {rival}}};
    const std::vector<Finding> rivals = set.rivals_to_try(set.causes.front());
    ASSERT_EQ(rivals.size(), 1U);
    EXPECT_EQ(rivals.front().effect, "rrw_missing");
    ASSERT_TRUE(set.give_to_rival(0, rival));
    ASSERT_EQ(set.causes.size(), 2U);
    EXPECT_EQ(set.causes[0].finding.where.axes, Axes{1});  // nothing of the rival is seen there
    EXPECT_EQ(set.causes[1].finding.where.axes, Axes{2});
}

TEST_F(CauseSetTest, GivesTheAxesThatACauseOfOthersHasNot) {
    const Finding rival = finding("rrw_missing", {40.0, 50.0, 0.0});
    const FoundCause cubic = {finding("temp_cubic", {100.0, 150.0, 0.0}), {rival}};
    set.causes = {{finding("rrw_missing", {300.0, 0.0, 300.0}), {}}, cubic};
    ASSERT_EQ(set.rivals_to_try(cubic).size(), 1U);
    ASSERT_TRUE(set.give_to_rival(1, rival));
    ASSERT_EQ(set.causes.size(), 2U);
    EXPECT_EQ(set.causes[0].finding.where.axes, (Axes{0, 1, 2}));
    EXPECT_DOUBLE_EQ(set.causes[0].finding.axis_gain_nats[0], 300.0);
    EXPECT_DOUBLE_EQ(set.causes[0].finding.axis_gain_nats[1], 50.0);
    EXPECT_EQ(set.causes[1].finding.where.axes, Axes{0});
}

TEST_F(CauseSetTest, GivesNothingWhereNothingIsSeen) {
    set.causes = {{finding("temp_cubic", {0.0, 150.0, 120.0}), {finding("rrw_missing", {40.0, 1.0, 2.0})}}};
    EXPECT_TRUE(set.rivals_to_try(set.causes.front()).empty());
}

// What a rival has beside all causes speaks for a further cause, and not for it in the place of this one.
TEST_F(CauseSetTest, GivesWayToWhatARivalTakesOverOnly) {
    set.causes = {{finding("gauss_markov", {60.0, 0.0, 0.0}), {}}, {finding("tone", {0.0, 90.0, 0.0}), {}}};
    const Finding again = finding("gauss_markov", {58.0, 0.0, 0.0});
    const std::vector<Finding> found = {finding("heavy_tail", {200.0, 0.0, 0.0}),
                                        finding("rrw_missing", {70.0, 0.0, 0.0}), again};
    Hypotheses beside_all{
        first.prediction, first.observation, {}, {finding("heavy_tail", {199.0, 0.0, 0.0})}};
    const Finding* rival = set.gives_way_to(0, &again, found, beside_all);
    ASSERT_NE(rival, nullptr);
    EXPECT_EQ(rival->effect, "rrw_missing");
    beside_all.findings.emplace_back(finding("rrw_missing", {30.0, 0.0, 0.0}));
    EXPECT_EQ(set.gives_way_to(0, &again, found, beside_all), nullptr);
    beside_all.findings = {};
    rival = set.gives_way_to(0, &again, found, beside_all);
    ASSERT_NE(rival, nullptr);
    EXPECT_EQ(rival->effect, "heavy_tail");
}

// A tie is no reason to change, and what is a cause already takes no other's place.
TEST_F(CauseSetTest, StaysBesideATieAndBesideOtherCauses) {
    set.causes = {{finding("gauss_markov", {60.0, 0.0, 0.0}), {}},
                  {finding("temp_cubic", {0.0, 90.0, 0.0}), {}}};
    const Finding again = finding("gauss_markov", {58.0, 0.0, 0.0});
    const std::vector<Finding> found = {finding("temp_cubic", {90.0, 0.0, 0.0}),
                                        finding("rrw_missing", {60.0, 0.0, 0.0}), again};
    EXPECT_EQ(set.gives_way_to(0, &again, found, first), nullptr);
    const Finding* rival = set.gives_way_to(0, nullptr, found, first);
    ASSERT_NE(rival, nullptr);
    EXPECT_EQ(rival->effect, "rrw_missing");
}

// An exchange may remove a cause and move others; of causes that recur the line tells which one it is.
TEST_F(CauseSetTest, FindsTheCauseThatAFindingWas) {
    const auto tone_at = [](double f_hz) {
        Finding tone = finding("tone", {20.0, 0.0, 0.0});
        tone.where.freq_hz = Span{f_hz, f_hz};
        return tone;
    };
    set.causes = {{finding("temp_cubic", {10.0, 0.0, 0.0}), {}}, {tone_at(12.0), {}}, {tone_at(31.0), {}}};
    EXPECT_EQ(set.place_of(tone_at(31.0)), 2U);
    EXPECT_EQ(set.place_of(finding("temp_cubic", {30.0, 0.0, 0.0})), 0U);
    EXPECT_EQ(set.place_of(tone_at(20.0)), std::nullopt);
    EXPECT_EQ(set.place_of(finding("lowpass", {30.0, 0.0, 0.0})), std::nullopt);
}

TEST_F(CauseSetTest, TellsStepsByTheirInstants) {
    const auto step_at = [](double t_s) {
        Finding step = finding("bias_step", {20.0, 0.0, 0.0});
        step.where.time_s = Span{t_s, t_s};
        return step;
    };
    set.causes = {{step_at(7.0), {}}, {step_at(11.0), {}}};
    EXPECT_EQ(set.place_of(step_at(11.0)), 1U);
    EXPECT_FALSE(set.is_new(step_at(7.0)));
    EXPECT_TRUE(set.is_new(step_at(9.0)));
    EXPECT_TRUE(set.is_of_another(step_at(11.0), 0));
    EXPECT_FALSE(set.is_of_another(step_at(9.0), 0));
}

// A walk of one size for all axes, which differ: with its size unknown on each axis any size would do.
TEST(CauseSetOfSpectra, FitsThemAsTheModelSaysThem) {
    const SensorModel model = calibrated_sensor();
    SensorModel sensor = with_effect(model, "rrw_missing", {{"K_dps_sqrt_hz", 3e-4}}, {"x", "z"});
    sensor = with_effect(sensor, "rrw_missing", {{"K_dps_sqrt_hz", 1.2e-3}}, {"y"});
    sensor = with_effect(sensor, "arw_scale", {{"factor", 1.2}}, {"x"});
    const auto recording = recorded(sensor, 60'000, 6);
    const Hypotheses first = examine(prediction_of(recording, model), recording, 1, 1);
    CauseSet set(first, recording, {});
    Finding walk = finding("rrw_missing", {100.0, 100.0, 100.0});
    walk.entries = {{"rrw_missing", {"x", "y", "z"}, {{"K_dps_sqrt_hz", 6e-4}}, ""}};
    walk.sd = {{{"K_dps_sqrt_hz", 1e-4}}};
    Finding louder = finding("arw_scale", {100.0, 0.0, 0.0});
    louder.entries.front().params = {{"factor", 1.1}};
    louder.sd = {{{"factor", 0.01}}};
    set.causes = {{walk, {}}, {louder, {}}};
    set.settle_spectra();
    const auto log_likelihood = [&](double of_walk) {
        std::vector<EffectModel> effects = set.causes[0].finding.entries;
        effects.front().params.at("K_dps_sqrt_hz") *= of_walk;
        effects.push_back(set.causes[1].finding.entries.front());
        SensorModel there = model;
        there.effects = std::move(effects);
        return log_likelihood_nats({prediction_of(recording, there), recording, 1});
    };
    EXPECT_GT(log_likelihood(1.0), log_likelihood(1.1));
    EXPECT_GT(log_likelihood(1.0), log_likelihood(0.9));
}

// A filter with a wrong corner, and a level of the white noise that makes up for it: needed as long as the
// corner stays.
TEST(CauseSetOfSpectra, LeavesOutWhatTheOthersExplainFittedAgain) {
    const SensorModel model = calibrated_sensor();
    const SensorModel sensor = with_effect(with_effect(model, "lowpass", {{"fc_hz", 8.0}, {"order", 1.0}}),
                                           "gauss_markov", {{"sigma_dps", 0.01}, {"tau_s", 1.0}});
    const auto recording = recorded(sensor, 30'000, 5);
    const Hypotheses first = examine(prediction_of(recording, model), recording, 1, 1);
    CauseSet set(first, recording, {});
    const auto take = [&](const char* effect) {
        const auto found = examine_for(
            effect, first.prediction->with(set.model_with_all_but(set.causes.size())), set.observed());
        ASSERT_TRUE(found) << effect;
        set.causes.push_back({*found, {}});
    };
    take("lowpass");
    take("gauss_markov");
    for (EffectModel& entry : set.causes.front().finding.entries) { entry.params.at("fc_hz") *= 1.1; }
    take("arw_scale");
    const std::vector<FoundCause> before = set.causes;
    const double before_nats = set.worth_nats(set.observed());

    set.causes = {before[0], before[1]};
    EXPECT_LT(set.worth_nats(set.observed()), before_nats - 100.0);  // needed beside the others as they are
    set.causes = before;
    ASSERT_TRUE(set.leave_out_if_needless(2, before_nats));
    EXPECT_GT(set.worth_nats(set.observed()), before_nats - decisions.strong_nats);
    ASSERT_EQ(set.causes.size(), 2U);
    EXPECT_NEAR(set.causes.front().finding.entries.front().params.at("fc_hz"), 8.0, 0.15);

    set.causes = before;
    EXPECT_FALSE(set.leave_out_if_needless(1, before_nats));  // nothing else is a second slow
    EXPECT_EQ(set.causes.size(), 3U);
}

}  // namespace
}  // namespace gyrolog
