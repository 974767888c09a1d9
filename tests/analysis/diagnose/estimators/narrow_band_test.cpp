// Noise about a frequency is found with its middle, width and height, is no steady line, nor is one it.
#include "analysis/diagnose/estimators/narrow_band.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/line.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t ten_minutes = 60'000;
using Names = std::vector<std::string>;

SensorModel with_band(const SensorModel& model, double f_hz, double width_hz, double sigma_dps,
                      std::vector<std::string> axes = {"x"}) {
    return with_effect(model, "narrowband",
                       {{"f_hz", f_hz}, {"width_hz", width_hz}, {"sigma_dps", sigma_dps}}, std::move(axes));
}

Names causes_of(const SensorModel& sensor, std::uint64_t seed, std::uint64_t samples = ten_minutes) {
    const auto recording = recorded(sensor, samples, seed);
    const Hypotheses first = examine(prediction_of(recording, calibrated_sensor()), recording, 1, 1);
    const auto selection = select_causes(first, recording, {});
    Names names;
    for (const FoundCause& cause : selection->causes) { names.push_back(cause.finding.effect); }
    std::ranges::sort(names);
    return names;
}

std::optional<Finding> band_in(const SensorModel& sensor, std::uint64_t seed) {
    return found(make_narrow_band_estimator, "narrowband", recorded(sensor, ten_minutes, seed),
                 calibrated_sensor());
}

// A resonance has a Lorentzian's skirts, a line that wanders has none.
TEST(NarrowBandShape, IsToldByItsSkirts) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        for (const double wander_s : {0.0, 2.0}) {
            SensorModel sensor = with_band(calibrated_sensor(), 34.0, 2.0, 0.01);
            sensor.effects.back().params["wander_s"] = wander_s;
            const auto finding = band_in(sensor, 90 + seed);
            ASSERT_TRUE(finding);
            const auto& params = finding->entries.front().params;
            EXPECT_EQ(params.count("wander_s"), wander_s > 0.0 ? 1 : 0) << "seed " << seed;
            // Four standard deviations: 150 independent frequencies in ten minutes, 0.85 Hz apart.
            EXPECT_NEAR(params.at("f_hz"), 34.0, 0.28);
            EXPECT_NEAR(params.at("width_hz"), 2.0, 0.4);
            EXPECT_NEAR(params.at("sigma_dps"), 0.01, 0.001);
        }
    }
}

// Behind the filter the skirts of a Lorentzian would be a hundred times the noise: other causes would be
// found that make up for them.
TEST(NarrowBands, AreTheOnlyCauseBesideAFilterThatLeavesLittle) {
    SensorModel sensor = with_band(calibrated_sensor(), 34.0, 2.0, 0.006);
    sensor.effects.back().params["wander_s"] = 2.0;
    sensor = with_effect(sensor, "lowpass", {{"fc_hz", 7.3}, {"order", 2.0}}, {"x"});
    for (std::uint64_t seed = 1; seed <= seeds_asked(2); ++seed) {
        EXPECT_EQ(causes_of(sensor, 200 + seed), (Names{"lowpass", "narrowband"})) << "seed " << seed;
    }
}

struct BandCase {
    double f_hz;
    double width_hz;
    double sigma_dps;
    double seen_hz;

    friend void PrintTo(const BandCase& band, std::ostream* out) {
        *out << band.width_hz << " Hz wide at " << band.f_hz << " Hz";
    }
};

class NarrowBand : public testing::TestWithParam<BandCase> {};
// From far narrower than a spectral bin to far wider; the last but one folds.
INSTANTIATE_TEST_SUITE_P(Bands, NarrowBand,
                         testing::Values(BandCase{38.0, 0.05, 0.01, 38.0}, BandCase{38.0, 0.5, 0.01, 38.0},
                                         BandCase{31.0, 4.0, 0.015, 31.0}, BandCase{83.0, 1.0, 0.01, 17.0},
                                         BandCase{2.0, 0.3, 0.004, 2.0}));

TEST_P(NarrowBand, IsFoundWithItsMiddleWidthAndHeight) {
    const BandCase band = GetParam();
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto finding =
            band_in(with_band(calibrated_sensor(), band.f_hz, band.width_hz, band.sigma_dps), 80 + seed);
        ASSERT_TRUE(finding);
        EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{0});
        const auto& params = finding->entries.front().params;
        const auto& sd = finding->sd.front();
        EXPECT_NEAR(params.at("f_hz"), band.seen_hz, 4.0 * sd.at("f_hz"));
        EXPECT_NEAR(std::log(params.at("width_hz") / band.width_hz), 0.0,
                    4.0 * sd.at("width_hz") / params.at("width_hz"));
        EXPECT_NEAR(params.at("sigma_dps"), band.sigma_dps, 4.0 * sd.at("sigma_dps"));
        EXPECT_LT(sd.at("f_hz"), 0.3 * band.width_hz);
        EXPECT_LT(sd.at("width_hz"), 0.4 * band.width_hz);
        EXPECT_LT(sd.at("sigma_dps"), 0.2 * band.sigma_dps);
        EXPECT_LT(finding->where.freq_hz->from, band.seen_hz);
        EXPECT_GT(finding->where.freq_hz->to, band.seen_hz);
    }
}

TEST_P(NarrowBand, IsTheOnlyCauseWhereItIsOne) {
    const BandCase band = GetParam();
    EXPECT_EQ(causes_of(with_band(calibrated_sensor(), band.f_hz, band.width_hz, band.sigma_dps), 84),
              Names{"narrowband"});
}

TEST(NarrowBands, HaveAHeightOfTheirOwnOnEachAxis) {
    SensorModel sensor = with_band(calibrated_sensor(), 38.0, 0.6, 0.012, {"x"});
    sensor = with_band(sensor, 38.0, 0.6, 0.006, {"z"});
    const auto finding = band_in(sensor, 85);
    ASSERT_TRUE(finding);
    ASSERT_EQ(finding->where.axes, (std::vector<std::size_t>{0, 2}));
    EXPECT_NEAR(finding->entries[0].params.at("sigma_dps"), 0.012, 4.0 * finding->sd[0].at("sigma_dps"));
    EXPECT_NEAR(finding->entries[1].params.at("sigma_dps"), 0.006, 4.0 * finding->sd[1].at("sigma_dps"));
    EXPECT_EQ(finding->entries[0].params.at("f_hz"), finding->entries[1].params.at("f_hz"));
}

TEST(NarrowBands, AreSeveral) {
    const SensorModel sensor =
        with_band(with_band(calibrated_sensor(), 38.0, 0.5, 0.01), 31.0, 0.4, 0.008, {"x"});
    EXPECT_EQ(causes_of(sensor, 86), (Names{"narrowband", "narrowband"}));
}

// Beside each other both are told; a line is one whatever its height.
TEST(NarrowBands, AreNoSteadyLinesNorTheyBands) {
    const SensorModel model = calibrated_sensor();
    for (std::uint64_t seed = 1; seed <= seeds_asked(1); ++seed) {
        for (const double amplitude_dps : {0.002, 0.005, 0.05}) {
            const SensorModel line = with_effect(
                model, "tone", {{"f_hz", 31.37}, {"amplitude_dps", amplitude_dps}, {"phase_rad", 1.0}});
            EXPECT_EQ(causes_of(line, 90 + seed), Names{"tone"}) << amplitude_dps << " " << seed;
        }
        const SensorModel both = with_effect(with_band(model, 38.0, 0.5, 0.01), "tone",
                                             {{"f_hz", 20.0}, {"amplitude_dps", 0.005}}, {"x"});
        EXPECT_EQ(causes_of(both, 95 + seed), (Names{"narrowband", "tone"})) << seed;
    }
}

TEST(NarrowBands, AreNotTakenForOtherNoise) {
    const SensorModel model = calibrated_sensor();
    const std::vector<EffectModel> neighbours = {
        effect_entry("arw_scale", {{"factor", 1.2}}),
        effect_entry("lowpass", {{"fc_hz", 20.0}, {"order", 2.0}}),
        effect_entry("gauss_markov", {{"sigma_dps", 0.01}, {"tau_s", 1.0}}),
        effect_entry("noise_colour", {{"gain", 2.0}, {"middle_of_rate", 0.2}}),
        effect_entry("flicker_missing", {{"B_dps", 0.004}}),
    };
    for (const EffectModel& neighbour : neighbours) {
        for (std::uint64_t seed = 1; seed <= seeds_asked(1); ++seed) {
            SensorModel sensor = model;
            sensor.effects = {neighbour};
            EXPECT_EQ(causes_of(sensor, 100 + seed), Names{neighbour.effect}) << seed;
        }
    }
}

TEST(NarrowBands, AreNoneInNoiseOfTheModel) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        EXPECT_LT(evidence(found(make_narrow_band_estimator, "narrowband",
                                 recorded(calibrated_sensor(), 20'000, 120 + seed), calibrated_sensor())),
                  3.0)
            << seed;
    }
}

}  // namespace
}  // namespace gyrolog
