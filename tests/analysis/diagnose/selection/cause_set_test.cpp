#include "analysis/diagnose/selection/cause_set.hpp"

#include <array>
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

}  // namespace
}  // namespace gyrolog
