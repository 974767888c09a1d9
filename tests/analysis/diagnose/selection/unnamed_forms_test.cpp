#include "analysis/diagnose/selection/unnamed_forms.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

using ::testing::ElementsAre;

using Table = std::map<std::string, std::vector<double>>;

SensorModel with_table(SensorModel model, const char* effect, Table table, std::vector<std::string> axes) {
    model.effects.push_back({effect, std::move(axes), {}, "", std::move(table)});
    return model;
}

std::vector<Finding> forms_of(const SensorModel& sensor, const SensorModel& model, std::uint64_t seed,
                              const std::shared_ptr<const World>& world = nullptr) {
    const auto recording = recorded(sensor, 60'000, seed, world);
    return unnamed_forms(prediction_of(recording, model), recording, 1);
}

Course course_of(const Finding& finding, std::size_t entry, const char* at, const char* value) {
    const Table& table = finding.entries[entry].table;
    return {table.at(at), table.at(value)};
}

// Known white noise alone, so that what is found can be told in its standard deviations.
SensorModel white_sensor() {
    SensorModel model = calibrated_sensor();
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = axis.noise.K_rad_per_s_sqrt_s = 0.0; }
    model.sd_rel = {};
    return model;
}

// A bin of 500 coefficients is known to 6 %, and the form, which smooths over several, rounds corners (seed
// 61).
TEST(UnnamedForms, HaveTheDensityThatNoFormulaHas) {
    const SensorModel model = white_sensor();
    const Table shape = {{"f_hz", {0.0, 12.0, 20.0, 28.0, 50.0}}, {"factor", {1.0, 1.0, 3.0, 1.0, 0.4}}};
    const std::vector<Finding> forms = forms_of(with_table(model, "density_table", shape, {"y"}), model, 61);
    ASSERT_EQ(forms.size(), 1U);
    EXPECT_EQ(forms[0].effect, "density_table");
    EXPECT_THAT(forms[0].where.axes, ElementsAre(1U));
    EXPECT_GT(forms[0].evidence_nats, 1000.0);
    ASSERT_TRUE(forms[0].where.freq_hz);
    EXPECT_GT(forms[0].where.freq_hz->from, 10.0);
    const Course factor = course_of(forms[0], 0, "f_hz", "factor");
    const Course truth(shape.at("f_hz"), shape.at("factor"));
    for (const double f_hz : {5.0, 9.0, 16.0, 20.0, 24.0, 35.0, 45.0}) {
        EXPECT_NEAR(factor(f_hz) / truth(f_hz), 1.0, 0.15) << f_hz;
    }
}

TEST(UnnamedForms, HaveTheMeanOverTheTemperature) {
    const SensorModel model = white_sensor();
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double t_s) { return 30.0 + 5.0 * triangle(t_s / 200.0); };
    // Level, steep and level again; the corners are where knots are, too.
    const Table course = {{"temp_C", {27.5, 32.5}}, {"bias_dps", {0.0, 0.01}}};
    const std::vector<Finding> forms =
        forms_of(with_table(model, "temperature_table", course, {"x"}), model, 62, world);
    ASSERT_EQ(forms.size(), 1U);
    EXPECT_EQ(forms[0].effect, "temperature_table");
    EXPECT_THAT(forms[0].where.axes, ElementsAre(0U));
    EXPECT_TRUE(forms[0].where.temperature);
    // Four standard deviations of the difference of two knots with 15 000 samples each.
    const Course found = course_of(forms[0], 0, "temp_C", "bias_dps");
    EXPECT_NEAR(found(34.0) - found(26.0), 0.01, 0.003);
    EXPECT_NEAR(found(30.0) - found(27.5), 0.005, 0.003);
}

TEST(UnnamedForms, HaveTheMeanOverTheRate) {
    SensorModel model = white_sensor();
    const Table course = {{"rate_dps", {-30.0, -15.0, 15.0, 30.0}}, {"added_dps", {0.1, 0.0, 0.0, 0.1}}};
    const std::vector<Finding> forms = forms_of(with_table(model, "rate_table", course, {"z"}), model, 63,
                                                tumbling_world(30.0 * rad_per_deg));
    ASSERT_EQ(forms.size(), 1U);
    EXPECT_EQ(forms[0].effect, "rate_table");
    EXPECT_THAT(forms[0].where.axes, ElementsAre(2U));
    ASSERT_TRUE(forms[0].where.rate_rad_s);
    const Course found = course_of(forms[0], 0, "rate_dps", "added_dps");
    EXPECT_NEAR(found(25.0) - found(0.0), 0.0667, 0.01);
    EXPECT_NEAR(found(-25.0) - found(25.0), 0.0, 0.01);
}

// Schwarz's price is two standard deviations and more of what chance gains by a coefficient: of 12 recordings
// with three axes and ten orders each, few have a form, and none one of much evidence.
TEST(UnnamedForms, AreRareWhereTheModelIsRight) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        for (const Finding& form : forms_of(calibrated_sensor(), calibrated_sensor(), seed)) {
            EXPECT_LT(form.evidence_nats, 5.0) << form.effect << ", seed " << seed;
            ++found;
        }
    }
    EXPECT_LE(found, 1);
}

}  // namespace
}  // namespace gyrolog
