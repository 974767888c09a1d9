#include "analysis/diagnose/selection/forward_selection.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t half_hour = 180'000;  // samples

CauseSelection searched(const SensorModel& sensor, const SensorModel& model, std::uint64_t seed) {
    const auto recording = recorded(sensor, half_hour, seed);
    SelectionOptions options;
    options.threads = 2;
    return *select_causes(examine(prediction_of(recording, model), recording, 1, 2), recording, options);
}

std::set<std::string> effects_of(const CauseSelection& result) {
    std::set<std::string> effects;
    for (const FoundCause& cause : result.causes) { effects.insert(cause.finding.effect); }
    return effects;
}

const EffectModel* entry_of(const CauseSelection& result, const char* effect) {
    for (const FoundCause& cause : result.causes) {
        if (cause.finding.effect == effect) { return &cause.finding.entries.front(); }
    }
    return nullptr;
}

// Each of some forty jumps is a step that noise of that spectrum does not have.
TEST(ForwardSelection, OfClearTelegraphNoiseFindsNoStepsBeside) {
    const SensorModel model = calibrated_sensor();
    const CauseSelection result =
        searched(with_effect(model, "rtn",
                             {{"amplitude_dps", 0.08}, {"dwell_high_s", 51.0}, {"dwell_low_s", 26.0}}, {"x"}),
                 model, 11);
    EXPECT_EQ(effects_of(result), (std::set<std::string>{"rtn"}));
    EXPECT_EQ(result.causes.size(), 1U);
}

// Their power varies by more than normal noise's does, and a few lie farther out than the rest.
TEST(ForwardSelection, OfHeavyTailsFindsNothingBeside) {
    const SensorModel model = calibrated_sensor();
    for (const double nu : {3.5, 4.0, 5.0, 6.0}) {
        const CauseSelection result = searched(with_effect(model, "heavy_tail", {{"nu", nu}}, {}), model, 13);
        EXPECT_EQ(effects_of(result), (std::set<std::string>{"heavy_tail"})) << nu;
    }
}

// On the axis of the line both share a band; neither is found well before the other is.
TEST(ForwardSelection, OfALineBeyondALowPassFindsBoth) {
    const SensorModel model = calibrated_sensor();
    SensorModel sensor = with_effect(model, "lowpass", {{"fc_hz", 28.5}, {"order", 2.0}}, {});
    sensor =
        with_effect(sensor, "tone", {{"amplitude_dps", 0.0143}, {"f_hz", 60.0}, {"phase_rad", 1.0}}, {"x"});
    const CauseSelection result = searched(sensor, model, 12);
    ASSERT_EQ(effects_of(result), (std::set<std::string>{"lowpass", "tone"}));
    EXPECT_NEAR(entry_of(result, "lowpass")->params.at("fc_hz"), 28.5, 0.3);
    EXPECT_NEAR(entry_of(result, "tone")->params.at("amplitude_dps"), 0.0143, 5e-4);
}

// Telegraph noise on two axes comes first and takes up what flicker noise is on the third, with dwell times
// that none of its own has there; flicker noise then has nothing left to explain.
TEST(ForwardSelection, GivesAnAxisToTheRivalThatIsThere) {
    SensorModel model = calibrated_sensor();
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = axis.noise.K_rad_per_s_sqrt_s = 0.0; }
    SensorModel sensor = with_effect(
        model, "rtn", {{"amplitude_dps", 0.022}, {"dwell_high_s", 1.8}, {"dwell_low_s", 1.7}}, {"x", "y"});
    sensor = with_effect(sensor, "flicker_missing", {{"B_dps", 0.0038}}, {"y", "z"});
    const CauseSelection result = searched(sensor, model, 14);
    EXPECT_EQ(effects_of(result), (std::set<std::string>{"rtn", "flicker_missing"}));
    for (const FoundCause& cause : result.causes) {
        const bool is_rtn = cause.finding.effect == "rtn";
        EXPECT_EQ(cause.finding.where.axes,
                  is_rtn ? (std::vector<std::size_t>{0, 1}) : (std::vector<std::size_t>{1, 2}));
    }
}

}  // namespace
}  // namespace gyrolog
