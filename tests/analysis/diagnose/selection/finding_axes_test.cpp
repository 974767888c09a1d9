#include "analysis/diagnose/selection/finding_axes.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using Axes = std::vector<std::size_t>;

// On x by itself, on y and z with the same parameters.
Finding finding() {
    Finding finding;
    finding.effect = "rtn";
    for (const std::vector<std::string>& axes : {std::vector<std::string>{"x"}, {"y", "z"}}) {
        EffectModel entry;
        entry.effect = "rtn";
        entry.axes = axes;
        finding.entries.push_back(entry);
        finding.sd.push_back({{"amplitude_dps", static_cast<double>(axes.size())}});
    }
    finding.where.axes = {0, 1, 2};
    finding.axis_gain_nats = {50.0, 20.0, 10.0};
    finding.gain_nats = 80.0;
    finding.evidence_nats = 70.0;
    return finding;
}

TEST(FindingAxes, KeepWhatTheyHave) {
    const auto rest = on_axes(finding(), {0, 2});
    ASSERT_TRUE(rest);
    EXPECT_EQ(rest->where.axes, (Axes{0, 2}));
    ASSERT_EQ(rest->entries.size(), 2U);
    EXPECT_EQ(rest->entries[1].axes, std::vector<std::string>{"z"});
    EXPECT_DOUBLE_EQ(rest->gain_nats, 60.0);
    EXPECT_DOUBLE_EQ(rest->evidence_nats, 50.0);
    const auto one = on_axes(finding(), {2});
    ASSERT_TRUE(one);
    ASSERT_EQ(one->entries.size(), 1U);
    EXPECT_EQ(one->sd.size(), 1U);
    EXPECT_DOUBLE_EQ(one->sd.front().at("amplitude_dps"), 2.0);
}

TEST(FindingAxes, AreNotTakenFromWhatTheSensorHasAsAWhole) {
    Finding whole = finding();
    for (EffectModel& entry : whole.entries) { entry.axes.clear(); }
    EXPECT_FALSE(on_axes(whole, {0}));
    EXPECT_FALSE(on_axes(finding(), {}));
}

TEST(FindingAxes, AreJoinedWhereTheyAreOthers) {
    const auto all = on_more_axes(*on_axes(finding(), {0}), *on_axes(finding(), {1, 2}));
    ASSERT_TRUE(all);
    EXPECT_EQ(all->where.axes, (Axes{0, 1, 2}));
    ASSERT_EQ(all->entries.size(), 2U);
    ASSERT_EQ(all->sd.size(), 2U);
    EXPECT_EQ(all->entries[1].axes, (std::vector<std::string>{"y", "z"}));
    EXPECT_DOUBLE_EQ(all->gain_nats, 80.0);
    EXPECT_DOUBLE_EQ(all->axis_gain_nats[2], 10.0);
    EXPECT_FALSE(on_more_axes(finding(), *on_axes(finding(), {1})));
    Finding whole = *on_axes(finding(), {1, 2});
    for (EffectModel& entry : whole.entries) { entry.axes.clear(); }
    EXPECT_FALSE(on_more_axes(*on_axes(finding(), {0}), whole));
}

}  // namespace
}  // namespace gyrolog
