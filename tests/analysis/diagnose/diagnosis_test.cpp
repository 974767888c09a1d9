#include "analysis/diagnose/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/simulate/known_motion.hpp"
#include "analysis/simulate/plain_model.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

std::set<std::string> effects_of(const Diagnosis& diagnosis) {
    std::set<std::string> effects;
    for (const Cause& cause : diagnosis.causes) { effects.insert(cause.finding.effect); }
    return effects;
}

SensorModel with_five_effects(SensorModel sensor) {
    sensor =
        with_effect(sensor, "tone", {{"amplitude_dps", 0.02}, {"f_hz", 17.3}, {"phase_rad", 1.0}}, {"x"});
    sensor = with_effect(sensor, "bias_step", {{"at_s", 131.0}, {"step_dps", 0.05}}, {"y"});
    sensor = with_effect(sensor, "heavy_tail", {{"nu", 5.0}}, {"z"});
    sensor = with_effect(sensor, "arw_scale", {{"factor", 1.2}}, {"y"});
    return with_effect(sensor, "variance_change", {{"at_s", 201.0}, {"factor", 1.5}, {"ramp_s", 0.0}}, {"x"});
}

// Each as likely right as if it were alone, and what returns without it is its own.
TEST(Diagnosis, NamesAsManyEffectsAsThereAre) {
    const SensorModel model = calibrated_sensor();
    DiagnosisOptions options;
    options.simulations = 20;
    const Diagnosis five = *diagnose(recorded(with_five_effects(model), 36000, 90), model, "model", options);
    EXPECT_EQ(effects_of(five),
              (std::set<std::string>{"arw_scale", "bias_step", "heavy_tail", "tone", "variance_change"}));
    EXPECT_EQ(five.verdict, Verdict::known);
    EXPECT_GT(five.gap_before.value, 3.0);
    EXPECT_LT(five.gap_named.value, 1.5);
    EXPECT_GT(five.shrink.lo, 0.9);
    EXPECT_LE(five.shrink.hi, 1.0);
    for (const Cause& cause : five.causes) {
        EXPECT_GT(cause.score, 0.95) << cause.finding.effect;
        EXPECT_GT(cause.share.value, 0.01) << cause.finding.effect;
        EXPECT_LT(cause.share.value, 1.0) << cause.finding.effect;
        EXPECT_LT(cause.share.lo, cause.share.value);
        EXPECT_GT(cause.share.hi, cause.share.value);
    }
    EXPECT_TRUE(std::ranges::is_sorted(five.causes, std::greater{},
                                       [](const Cause& cause) { return cause.share.value; }));
    // A line lies in few coefficients.
    EXPECT_EQ(five.not_held_out, std::vector<std::string>{"tone"});
}

// Ten repeats in ten minutes are certain, one by one, and yet no curve shows them.
TEST(Diagnosis, NamesRepeatsThatAreTooRareForTheMeasures) {
    SensorModel sensor = with_effect(calibrated_sensor(), "stale", {{"eps", 0.0002}}, {});
    sensor = with_effect(sensor, "arw_scale", {{"factor", 1.1}}, {"y"});
    DiagnosisOptions options;
    options.simulations = 20;
    const Diagnosis answer = *diagnose(recorded(sensor, 60000, 91), calibrated_sensor(), "model", options);
    EXPECT_EQ(effects_of(answer), (std::set<std::string>{"arw_scale", "stale"}));
    for (const Cause& cause : answer.causes) { EXPECT_GT(cause.score, 0.95) << cause.finding.effect; }
}

// What the catalogue lacks is left, with its place, and does not touch what is certain of the rest.
TEST(Diagnosis, IsPartOfAnAnswerWhereSomethingElseIsLeft) {
    const SensorModel model = calibrated_sensor();
    const auto stepping =
        recorded(with_effect(model, "bias_step", {{"at_s", 131.0}, {"step_dps", 0.06}}, {"y"}), 36000, 94);
    // Noise of z that comes and goes.
    Recording swelling = *stepping;
    for (Column& column : swelling.columns) {
        if (column.name != "gz") { continue; }
        std::vector<double> values = column.values();
        for (std::size_t row = 0; row < values.size(); ++row) {
            values[row] *= 1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * static_cast<double>(row) / 1700.0);
        }
        column.data = std::move(values);
        column.scale = 1.0;
        column.offset = 0.0;
    }
    DiagnosisOptions options;
    options.simulations = 20;
    const Diagnosis answer =
        *diagnose(std::make_shared<const Recording>(std::move(swelling)), model, "model", options);
    EXPECT_EQ(answer.verdict, Verdict::partly);
    EXPECT_LT(answer.shrink.value, 0.9);
    EXPECT_TRUE(std::ranges::any_of(answer.left, [](const Left& one) {
        return one.where.axes == std::vector<std::size_t>{2} && one.size > 1.0;
    }));
    const auto step = std::ranges::find(answer.causes, std::string("bias_step"),
                                        [](const Cause& cause) { return cause.finding.effect; });
    ASSERT_NE(step, answer.causes.end());
    EXPECT_GT(step->score, 0.9);
    EXPECT_GT(step->share.value, 0.1);
}

// A rate table in steps about each axis in turn; its encoder is read while the rate is steady.
constexpr double turntable_eps = 0.012;
constexpr double turntable_from_x = 0.006;

SensorModel turntable_model() {
    SensorModel model = calibrated_sensor();
    model.ref_noise_rad_s = 0.02 * rad_per_deg;
    model.sd_abs = {{"M", 2e-4}, {"latency_s", 1e-4}, {"rate_rel", 5e-5}};
    return model;
}

// Steps about one axis after the other; while they change the reference is not known.
std::shared_ptr<const Recording> on_a_turntable() {
    constexpr double step_s = 10.0;
    constexpr double ramp_s = 2.0;
    const auto turntable = world_turning([&](double t_s) {
        constexpr std::array<double, 8> rates_dps = {0.0, 50.0, -50.0, 100.0, -100.0, 200.0, -200.0, 0.0};
        const auto axis_rate = [&](double step) {
            Vector3 rate{};
            const auto number = static_cast<std::size_t>(std::max(0.0, step));
            rate.at(number / rates_dps.size() % 3) = rates_dps.at(number % rates_dps.size()) * rad_per_deg;
            return rate;
        };
        const double step = std::floor(t_s / step_s);
        const double turned = std::min(1.0, (t_s - step * step_s) / ramp_s);
        Vector3 rate = axis_rate(step - 1.0);
        const Vector3 next = axis_rate(step);
        for (std::size_t axis = 0; axis < 3; ++axis) { rate[axis] += turned * (next[axis] - rate[axis]); }
        return rate;
    });
    SensorModel sensor = with_effect(turntable_model(), "scale_factor", {{"eps", turntable_eps}}, {"x"});
    sensor = with_effect(sensor, "misalignment", {{"from_x", turntable_from_x}}, {"y"});
    Recording recording = *recorded(sensor, 48'000, 95, turntable);
    for (Column& column : recording.columns) {
        if (!column.name.starts_with("ref_")) { continue; }
        std::vector<double> values = column.values();
        for (std::size_t row = 0; row < values.size(); ++row) {
            if (std::fmod(static_cast<double>(row) / 100.0, step_s) < ramp_s) { values[row] = std::nan(""); }
        }
        column.data = std::move(values);
        column.scale = 1.0;
    }
    return std::make_shared<const Recording>(with_known_motion(recording));
}

// The two gains, alone or among other causes.
void expect_turntable_gains(const Diagnosis& answer) {
    EXPECT_EQ(answer.verdict, Verdict::known);
    EXPECT_GT(answer.shrink.value, 0.95);
    int gains = 0;
    for (const Cause& cause : answer.causes) {
        const bool is_scale = cause.finding.effect == "scale_factor";
        if (!is_scale && cause.finding.effect != "misalignment") { continue; }
        const char* name = is_scale ? "eps" : "from_x";
        EXPECT_EQ(cause.finding.where.axes, std::vector<std::size_t>{is_scale ? 0U : 1U});
        EXPECT_NEAR(cause.finding.entries.front().params.at(name),
                    is_scale ? turntable_eps : turntable_from_x, 4.0 * cause.finding.sd.front().at(name));
        EXPECT_GT(cause.score, 0.99) << cause.finding.effect;
        ++gains;
    }
    EXPECT_EQ(gains, 2);
}

TEST(Diagnosis, NamesTheGainsOfATurntableWhoseRampsAreNotKnown) {
    DiagnosisOptions options;
    options.simulations = 20;
    const Diagnosis answer = *diagnose(on_a_turntable(), turntable_model(), "model", options);
    expect_turntable_gains(answer);
    EXPECT_EQ(effects_of(answer), (std::set<std::string>{"misalignment", "scale_factor"}));
}

// Each gain was found while the other one was missing, and noise about all axes had more evidence then.
TEST(Diagnosis, HoldsGainsAgainstRivalsBesideEachOther) {
    const auto recording = on_a_turntable();
    DiagnosisOptions options;
    options.simulations = 20;
    expect_turntable_gains(*diagnose(recording, plain_model(*recording)->model, "plain", options));
}

// Hollows in the density: no effect of the catalogue takes noise away there. The model with the form is that
// of another recording, too.
TEST(Diagnosis, ModelsWithoutANameWhatNoEffectIs) {
    const SensorModel model = calibrated_sensor();
    SensorModel sensor = model;
    sensor.effects.push_back({"density_table",
                              {"x", "y"},
                              {},
                              "",
                              {{"f_hz", {6.0, 11.0, 13.0, 18.0, 26.0, 30.0, 32.0, 36.0, 42.0, 44.0}},
                               {"factor", {1.0, 0.25, 0.25, 1.0, 1.0, 0.3, 0.3, 1.0, 1.0, 0.4}}}});
    DiagnosisOptions options;
    options.simulations = 24;
    const Diagnosis answer = *diagnose(recorded(sensor, 24'000, 98), model, "model", options);
    ASSERT_FALSE(answer.unnamed.empty());
    EXPECT_EQ(answer.unnamed.front().form, "density");
    EXPECT_LT(answer.gap_after.value, answer.gap_named.value);
    EXPECT_LT(answer.gap_after.value, 1.5);
    EXPECT_GT(answer.gap_before.value, 3.0);
    EXPECT_GT(answer.shrink_modelled, 0.95);
    EXPECT_GT(answer.unnamed.front().share, 0.1);
    const auto again = recorded(sensor, 24'000, 99);
    const Diagnosis with_form = *diagnose(again, with_unnamed(answer.corrected, answer), "form", options);
    EXPECT_LT(with_form.gap_before.value, 1.5);
    const Diagnosis without_form = *diagnose(again, answer.corrected, "named", options);
    EXPECT_GT(without_form.gap_before.value, 2.0);
}

// A jump of the first recording is none of the second, in which a correction by it would be a gap.
TEST(Diagnosis, JudgesASecondRecordingWithoutTheEventsOfTheFirst) {
    const SensorModel model = calibrated_sensor();
    const SensorModel jumping = with_effect(model, "bias_step", {{"at_s", 60.0}, {"step_dps", 0.05}}, {"y"});
    DiagnosisOptions options;
    options.simulations = 20;
    Recording second = *recorded(model, 12000, 92);
    second.name = "second.csv";
    options.holdout = std::make_shared<const Recording>(std::move(second));
    const Diagnosis diagnosis = *diagnose(recorded(jumping, 12000, 91), model, "model", options);
    ASSERT_EQ(effects_of(diagnosis), std::set<std::string>{"bias_step"});
    ASSERT_EQ(diagnosis.held_out, "second.csv");
    EXPECT_DOUBLE_EQ(diagnosis.gap_named.value, diagnosis.gap_before.value);
    EXPECT_EQ(diagnosis.causes.front().share.value, 0.0);
    EXPECT_EQ(
        std::ranges::count(diagnosis.warnings,
                           "bias_step happened in the first recording: the second is judged without it"),
        1);
}

// A second recording is asked also where the first calls for no cause.
TEST(Diagnosis, MeasuresAModelWithoutCausesOnASecondRecording) {
    const SensorModel model = calibrated_sensor();
    DiagnosisOptions options;
    options.simulations = 20;
    Recording second = *recorded(with_effect(model, "arw_scale", {{"factor", 1.5}}, {}), 8000, 96);
    second.name = "second.csv";
    options.holdout = std::make_shared<const Recording>(std::move(second));
    const Diagnosis diagnosis = *diagnose(recorded(model, 8000, 95), model, "model", options);
    ASSERT_EQ(diagnosis.verdict, Verdict::none);
    EXPECT_EQ(diagnosis.held_out, "second.csv");
    EXPECT_GT(diagnosis.gap_before.value, 5.0);
    EXPECT_EQ(diagnosis.gap_named.value, diagnosis.gap_before.value);
}

TEST(Diagnosis, SaysOfALineThatOnlyTheModelHasThatTheModelHasIt) {
    const SensorModel sensor = calibrated_sensor();
    const std::map<std::string, double> line = {{"amplitude_dps", 0.02}, {"f_hz", 17.3}, {"phase_rad", 1.0}};
    DiagnosisOptions options;
    options.simulations = 20;
    const auto sense = [&](const SensorModel& has, const SensorModel& model) {
        const Diagnosis diagnosis = *diagnose(recorded(has, 24000, 97), model, "model", options);
        EXPECT_EQ(effects_of(diagnosis), std::set<std::string>{"tone"});
        return diagnosis.causes.empty() ? std::nullopt : std::optional(diagnosis.causes.front().sense);
    };
    const SensorModel with_line = with_effect(sensor, "tone", line, {"x"});
    EXPECT_EQ(sense(sensor, with_line), Sense::model_has);
    EXPECT_EQ(sense(with_line, sensor), Sense::recording_has);
}

// What a diagnosis does not look for may be in a model.
TEST(Diagnosis, IsGivenOfAModelWithEffectsThatNothingLooksFor) {
    SensorModel model = calibrated_sensor();
    std::set<std::string> listed;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature != nullptr) { continue; }
        std::map<std::string, double> params;
        for (const EffectParam& param : link.effect->params) {
            params[std::string(param.name)] = param.otherwise.value_or(
                param.plausible_from + 0.1 * (param.plausible_to - param.plausible_from));
        }
        listed.insert(std::string(link.effect->name));
        model = with_effect(model, std::string(link.effect->name), params);
    }
    EXPECT_EQ(listed, (std::set<std::string>{"angle_noise", "self_heating", "temp_scale",
                                             "vibration_rectification"}));
    DiagnosisOptions options;
    options.simulations = 12;
    const Diagnosis diagnosis = *diagnose(recorded(model, 4096, 93), model, "model", options);
    EXPECT_EQ(diagnosis.verdict, Verdict::none);
    EXPECT_EQ(diagnosis.corrected.effects.size(), listed.size());
}

}  // namespace
}  // namespace gyrolog
