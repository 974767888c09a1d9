#include "analysis/diagnose/estimators/quantisation_step.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/noise/noise_model.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t two_minutes = 12000;
constexpr double lsb_dps = 1.0 / 65.5;

SensorModel sensor(double step_dps) {
    SensorModel model = typical_mpu9250();
    model.lsb_rad_s = step_dps * rad_per_deg;
    return model;
}

std::optional<Finding> steps(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    return found(make_quantisation_step_estimator, "quantization", recording, model);
}

// The gyro as a text file has it: degrees per second with six decimals.
Recording printed(const Recording& counts) {
    Recording text = counts;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Column& column = text.columns[axis];
        std::vector<double> values = column.values();
        for (double& value : values) { value = std::round(value / rad_per_deg * 1e6) / 1e6; }
        column.data = std::move(values);
        column.scale = rad_per_deg;
    }
    return text;
}

TEST(QuantisationStep, OfACoarserConverterIsFoundAxisByAxis) {
    const SensorModel model = sensor(lsb_dps);
    for (const int times : {2, 3, 6, 8}) {
        const SensorModel coarse =
            with_effect(model, "quantization", {{"lsb_dps", times * lsb_dps}}, {"x", "z"});
        const auto counts = recorded(coarse, two_minutes, 4);
        for (const auto& recording : {counts, std::make_shared<const Recording>(printed(*counts))}) {
            const auto finding = steps(recording, model);
            ASSERT_TRUE(finding) << times;
            EXPECT_GT(finding->evidence_nats, 1000.0);
            ASSERT_EQ(finding->entries.size(), 1U);
            EXPECT_EQ(finding->entries.front().axes, (std::vector<std::string>{"x", "z"}));
            EXPECT_NEAR(finding->entries.front().params.at("lsb_dps"), times * lsb_dps, 1e-6);
            EXPECT_EQ(finding->where.structure, "code_grid");
            EXPECT_FALSE(steps(recording, with_cause(model, *finding)));
        }
    }
}

// Three per cent are another step: of two axes, and of a model that states one.
TEST(QuantisationStep, OfTwoAxesThatDifferByLittleIsFoundForEach) {
    const SensorModel model = sensor(lsb_dps);
    SensorModel coarse = with_effect(model, "quantization", {{"lsb_dps", 8.0 * lsb_dps}}, {"x"});
    coarse = with_effect(coarse, "quantization", {{"lsb_dps", 8.24 * lsb_dps}}, {"y"});
    coarse.lsb_rad_s = 0.0;
    const auto recording = std::make_shared<const Recording>(printed(*recorded(coarse, two_minutes, 5)));
    const auto finding = steps(recording, model);
    ASSERT_TRUE(finding);
    ASSERT_EQ(finding->entries.size(), 2U);
    EXPECT_NEAR(finding->entries[0].params.at("lsb_dps"), 8.0 * lsb_dps, 1e-6);
    EXPECT_NEAR(finding->entries[1].params.at("lsb_dps"), 8.24 * lsb_dps, 1e-6);
    const auto beside_x = steps(recording, sensor(8.0 * lsb_dps));
    ASSERT_TRUE(beside_x);
    EXPECT_EQ(beside_x->entries.front().axes, (std::vector<std::string>{"y"}));
}

// Of one axis there is nothing to choose.
TEST(QuantisationStep, PaysForTheChoiceOfAxesWhereThereIsOne) {
    const SensorModel model = sensor(lsb_dps);
    const SensorModel coarse = with_effect(model, "quantization", {{"lsb_dps", 8 * lsb_dps}}, {"x"});
    const Recording whole = *recorded(coarse, two_minutes, 4);
    for (const std::size_t axes : {1U, 2U, 3U}) {
        Recording recording = whole;
        recording.columns.erase(recording.columns.begin() + static_cast<std::ptrdiff_t>(axes),
                                recording.columns.begin() + 3);
        const auto finding = steps(std::make_shared<const Recording>(recording), model);
        ASSERT_TRUE(finding) << axes;
        const EffectParam& range = find_effect("quantization")->params.front();
        const double step_nats = parameter_cost_nats(range.plausible_to, range.plausible_from);
        const double choices = std::exp2(axes) - 1.0;
        EXPECT_NEAR(finding->evidence_nats, finding->gain_nats - step_nats - std::log(choices), 1e-9) << axes;
    }
}

TEST(QuantisationStep, OfAConverterThatTheModelLacksIsFound) {
    const auto recording =
        std::make_shared<const Recording>(printed(*recorded(sensor(lsb_dps), two_minutes, 4)));
    const auto finding = steps(recording, sensor(0.0));
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->entries.front().axes.size(), 3U);
    EXPECT_NEAR(finding->entries.front().params.at("lsb_dps"), lsb_dps, 1e-6);
    EXPECT_GT(finding->evidence_nats, 1000.0);
}

TEST(QuantisationStep, ThatTheModelHasIsNoGap) {
    const auto counts = recorded(sensor(lsb_dps), two_minutes, 4);
    EXPECT_FALSE(steps(counts, sensor(lsb_dps)));
    EXPECT_FALSE(steps(std::make_shared<const Recording>(printed(*counts)), sensor(lsb_dps)));
    // Real numbers, printed: six decimals are no converter.
    const auto smooth = recorded(sensor(0.0), two_minutes, 4);
    EXPECT_FALSE(steps(smooth, sensor(0.0)));
    EXPECT_FALSE(steps(std::make_shared<const Recording>(printed(*smooth)), sensor(0.0)));
    // Finer than the model's: nothing that is added makes it so.
    EXPECT_FALSE(steps(smooth, sensor(lsb_dps)));
    EXPECT_FALSE(steps(counts, sensor(4.0 * lsb_dps)));
}

TEST(QuantisationStep, OfADeadAxisIsNone) {
    Recording recording = *recorded(sensor(lsb_dps), two_minutes, 4);
    std::ranges::fill(std::get<std::vector<std::int16_t>>(recording.columns[1].data), std::int16_t{-3});
    EXPECT_FALSE(steps(std::make_shared<const Recording>(recording), sensor(lsb_dps)));
}

}  // namespace
}  // namespace gyrolog
