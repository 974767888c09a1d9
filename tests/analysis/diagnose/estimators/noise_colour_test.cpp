// White noise behind one zero and one pole is found as that, and is not taken for its neighbours, nor they
// for it.
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t ten_minutes = 60'000;

std::vector<std::string> causes_of(const SensorModel& sensor, std::uint64_t seed,
                                   const SensorModel& model = calibrated_sensor()) {
    const auto recording = recorded(sensor, ten_minutes, seed);
    const Hypotheses first = examine(prediction_of(recording, model), recording, 1, 1);
    const auto selection = select_causes(first, recording, {});
    std::vector<std::string> names;
    for (const FoundCause& cause : selection->causes) { names.push_back(cause.finding.effect); }
    return names;
}

using Names = std::vector<std::string>;

TEST(NoiseColour, IsFoundWithItsGainAndItsMiddle) {
    for (const auto& [gain, middle] : {std::pair(0.5, 0.2), std::pair(0.2, 0.3), std::pair(2.0, 0.1)}) {
        const SensorModel sensor = with_effect(calibrated_sensor(), "noise_colour",
                                               {{"gain", gain}, {"middle_of_rate", middle}}, {"y"});
        const auto finding = found(make_noise_spectrum_estimator, "noise_colour",
                                   recorded(sensor, ten_minutes, 71), calibrated_sensor());
        ASSERT_TRUE(finding);
        EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{1});
        const auto& params = finding->entries.front().params;
        const auto& sd = finding->sd.front();
        EXPECT_NEAR(params.at("gain"), gain, 4.0 * sd.at("gain"));
        EXPECT_NEAR(params.at("middle_of_rate"), middle, 4.0 * sd.at("middle_of_rate"));
        EXPECT_LT(sd.at("gain"), 0.1 * gain);
        EXPECT_LT(sd.at("middle_of_rate"), 0.2 * middle);
    }
}

TEST(NoiseColour, IsTheOnlyCauseWhereItIsOne) {
    for (std::uint64_t seed = 1; seed <= seeds_asked(1); ++seed) {
        for (const auto& [gain, middle] : {std::pair(0.4, 0.25), std::pair(2.0, 0.15)}) {
            const SensorModel sensor = with_effect(calibrated_sensor(), "noise_colour",
                                                   {{"gain", gain}, {"middle_of_rate", middle}});
            EXPECT_EQ(causes_of(sensor, seed), Names{"noise_colour"}) << seed << " " << gain;
        }
    }
}

TEST(NoiseColour, IsNotTakenForItsNeighbours) {
    const SensorModel model = calibrated_sensor();
    const std::vector<EffectModel> neighbours = {
        effect_entry("arw_scale", {{"factor", 0.8}}),
        effect_entry("arw_scale", {{"factor", 1.2}}),
        effect_entry("lowpass", {{"fc_hz", 20.0}, {"order", 1.0}}),
        effect_entry("lowpass", {{"fc_hz", 25.0}, {"order", 2.0}}),
        effect_entry("gauss_markov", {{"sigma_dps", 0.02}, {"tau_s", 0.3}}),
        effect_entry("gauss_markov", {{"sigma_dps", 0.01}, {"tau_s", 5.0}}),
    };
    for (const EffectModel& neighbour : neighbours) {
        for (std::uint64_t seed = 1; seed <= seeds_asked(1); ++seed) {
            SensorModel sensor = model;
            sensor.effects = {neighbour};
            EXPECT_EQ(causes_of(sensor, 10 + seed), Names{neighbour.effect}) << seed;
        }
    }
}

// Of which a model says little, the slow noise may be as it likes, and the white.
TEST(NoiseColour, IsNotTakenForSlowNoiseWhereTheWhiteIsNotKnown) {
    SensorModel model = calibrated_sensor();
    model.sd_rel["N"] = 0.5;
    const SensorModel sensor =
        with_effect(model, "gauss_markov", {{"sigma_dps", 0.02}, {"tau_s", 0.5}}, {"x"});
    for (std::uint64_t seed = 1; seed <= seeds_asked(1); ++seed) {
        EXPECT_EQ(causes_of(sensor, 20 + seed, model), Names{"gauss_markov"}) << seed;
    }
}

TEST(NoiseColour, IsNoneInWhiteNoise) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto finding = found(make_noise_spectrum_estimator, "noise_colour",
                                   recorded(calibrated_sensor(), 20'000, 30 + seed), calibrated_sensor());
        EXPECT_LT(evidence(finding), 4.0) << seed;
    }
}

}  // namespace
}  // namespace gyrolog
