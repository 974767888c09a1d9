#include "analysis/diagnose/selection/forward_selection.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t half_hour = 180'000;  // samples

CauseSelection searched(const SensorModel& sensor, const SensorModel& model, std::uint64_t seed,
                        std::uint64_t samples = half_hour) {
    const auto recording = recorded(sensor, samples, seed);
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
    for (const double nu : {3.5, 6.0}) {
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

// A bin of the spectrum's likelihood is forty times as wide as the band.
TEST(ForwardSelection, KeepsABandThatIsFarNarrowerThanItsNeighboursBins) {
    const SensorModel model = calibrated_sensor();
    SensorModel sensor =
        with_effect(model, "narrowband", {{"sigma_dps", 0.005}, {"f_hz", 38.0}, {"width_hz", 0.03}}, {"x"});
    for (AxisModel& axis : sensor.axes) { axis.noise.N_rad_per_sqrt_s *= 1.05; }
    for (const std::uint64_t seed : {17U, 18U, 19U}) {
        const CauseSelection result = searched(sensor, model, seed, 22'000);
        ASSERT_EQ(effects_of(result), (std::set<std::string>{"arw_scale", "narrowband"})) << seed;
        EXPECT_NEAR(entry_of(result, "narrowband")->params.at("f_hz"), 38.0, 0.05) << seed;
    }
}

// One by one the filter is found with too low a corner and order, the band too narrow; three further causes
// made up for it.
TEST(ForwardSelection, OfWideNoiseOnAFiltersSkirtFindsBothAndNothingBeside) {
    const SensorModel model = calibrated_sensor();
    SensorModel sensor =
        with_effect(model, "narrowband", {{"sigma_dps", 0.013}, {"f_hz", 33.0}, {"width_hz", 8.0}}, {});
    sensor = with_effect(sensor, "lowpass", {{"fc_hz", 8.2}, {"order", 2.0}}, {});
    const CauseSelection result = searched(sensor, model, 16);
    ASSERT_EQ(effects_of(result), (std::set<std::string>{"lowpass", "narrowband"}));
    EXPECT_EQ(result.causes.size(), 2U);
    EXPECT_NEAR(entry_of(result, "lowpass")->params.at("fc_hz"), 8.2, 0.2);
    EXPECT_EQ(entry_of(result, "lowpass")->params.at("order"), 2.0);
    EXPECT_NEAR(entry_of(result, "narrowband")->params.at("width_hz"), 8.0, 0.5);
}

// Gauss-Markov noise with sizes and times of its own on each axis comes first and takes up the flicker noise,
// which has nothing left to explain beside it. A walk and Gauss-Markov noise are not told apart in half an
// hour.
TEST(ForwardSelection, GivesThePlaceOfWhatCameFirstToRivalsThatAreThere) {
    SensorModel model = calibrated_sensor(0.003);
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = axis.noise.K_rad_per_s_sqrt_s = 0.0; }
    SensorModel sensor = with_effect(
        model, "rtn", {{"amplitude_dps", 0.0126}, {"dwell_high_s", 4.65}, {"dwell_low_s", 9.16}}, {});
    sensor = with_effect(sensor, "flicker_missing", {{"B_dps", 0.0045}}, {"y"});
    sensor = with_effect(sensor, "rrw_missing", {{"K_dps_sqrt_hz", 9e-5}}, {});
    const std::set<std::string> effects = effects_of(searched(sensor, model, 14));
    EXPECT_TRUE(effects.contains("rtn"));
    EXPECT_TRUE(effects.contains("flicker_missing"));
}

// Beside Gauss-Markov noise the rest has the spectrum of telegraph noise as well; it does not jump.
TEST(ForwardSelection, TakesASecondGaussMarkovNoiseForNoTelegraph) {
    const SensorModel model = calibrated_sensor(0.003);
    SensorModel sensor = with_effect(model, "gauss_markov", {{"sigma_dps", 0.03}, {"tau_s", 0.3}}, {});
    sensor = with_effect(sensor, "gauss_markov", {{"sigma_dps", 0.006}, {"tau_s", 6.0}}, {});
    const std::set<std::string> effects = effects_of(searched(sensor, model, 15));
    EXPECT_TRUE(effects.contains("gauss_markov"));
    EXPECT_FALSE(effects.contains("rtn"));
}

// Coloured noise with a shape of its own on each axis is as good as a filter on one and louder noise on
// another.
TEST(ForwardSelection, GivesEachAxisOfACauseToTheSimplerRivalThatIsThere) {
    const SensorModel model = calibrated_sensor(0.003);
    SensorModel sensor = with_effect(model, "narrowband",
                                     {{"sigma_dps", 0.039}, {"f_hz", 20.7}, {"width_hz", 2.9}}, {"x", "z"});
    sensor = with_effect(sensor, "arw_scale", {{"factor", 1.47}}, {"y"});
    sensor = with_effect(sensor, "lowpass", {{"fc_hz", 5.9}, {"order", 1.0}}, {"x"});
    const CauseSelection result = searched(sensor, model, 18);
    ASSERT_EQ(effects_of(result), (std::set<std::string>{"arw_scale", "lowpass", "narrowband"}));
    const std::map<std::string, std::vector<std::size_t>> axes = {
        {"lowpass", {0}}, {"arw_scale", {1}}, {"narrowband", {0, 2}}};
    for (const FoundCause& cause : result.causes) {
        EXPECT_EQ(cause.finding.where.axes, axes.at(cause.finding.effect)) << cause.finding.effect;
    }
}

}  // namespace
}  // namespace gyrolog
