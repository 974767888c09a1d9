// Effects of the mean response and of the spectrum: as much evidence as there is, the right parameters,
// little for rivals and by chance.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "analysis/simulate/chain.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

Hypotheses examined(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    return examine(prediction_of(recording, model), recording, 1, 1);
}

const Finding& of(const Hypotheses& hypotheses, const std::string& effect) {
    for (const std::optional<Finding>& finding : hypotheses.findings) {
        if (finding && finding->effect == effect) { return *finding; }
    }
    static const Finding none{};
    ADD_FAILURE() << "no finding of " << effect;
    return none;
}

TEST(EffectEvidence, OfARampIsItsEnergyOverTheNoise) {
    const SensorModel model = calibrated_sensor();
    SensorModel drifting = model;
    const double ramp_dps_per_s = 2e-5;
    drifting.effects.push_back({"rate_ramp", {}, {{"ramp_dps_per_s", ramp_dps_per_s}}, ""});
    const auto recording = recorded(drifting, 180000, 21);
    const Hypotheses seen = examined(recording, model);

    // With N, B and K as they are: 1/2 sum of G^2 over the expected density. The cosine transform of a ramp:
    // odd coefficients of -2 slope sqrt(2 / n) / (2 sin(pi k / 2 n))^2 / rate.
    double energy_nats = 0.0;
    const Prediction& prediction = *seen.prediction;
    const auto n = static_cast<double>(prediction.length());
    for (const SpectralBin& bin : prediction.bins()) {
        for (std::size_t k = bin.first; k < bin.end; k += 1) {
            if (k % 2 == 0 || k > 8191) { continue; }
            const double sine = std::sin(pi * static_cast<double>(k) / (2.0 * n));
            const double step_rad_s = ramp_dps_per_s * rad_per_deg / prediction.rate_hz();
            const double coefficient = std::sqrt(2.0 / n) * step_rad_s / (2.0 * sine * sine);
            const std::size_t i = static_cast<std::size_t>(&bin - prediction.bins().data());
            energy_nats +=
                0.5 * coefficient * coefficient / (prediction.parts(0)[i].sum() * prediction.rate_hz());
        }
    }
    const Finding& found = of(seen, "rate_ramp");
    EXPECT_EQ(found.where.axes, (std::vector<std::size_t>{0, 1, 2}));
    // A refitted K takes a part of it; chance is sqrt(2 x energy) either way.
    const double all_axes_nats = 3.0 * energy_nats;
    EXPECT_LT(found.gain_nats, all_axes_nats + 3.0 * std::sqrt(2.0 * all_axes_nats));
    EXPECT_GT(found.gain_nats, 0.5 * all_axes_nats - 3.0 * std::sqrt(2.0 * all_axes_nats));
    for (std::size_t i = 0; i < found.entries.size(); ++i) {
        EXPECT_NEAR(found.entries[i].params.at("ramp_dps_per_s"), ramp_dps_per_s,
                    4.0 * found.sd[i].at("ramp_dps_per_s"));
    }
    // A temperature that happens to drift tells nearly the same.
    EXPECT_LT(seen.best()->evidence_nats, found.evidence_nats + 4.0);
}

TEST(EffectEvidence, OfALouderAxisIsThatAxisAlone) {
    const SensorModel model = calibrated_sensor();
    SensorModel louder = model;
    louder.effects.push_back({"arw_scale", {"y"}, {{"factor", 1.06}}, ""});
    const Hypotheses seen = examined(recorded(louder, 180000, 22), model);
    const Finding& found = of(seen, "arw_scale");
    EXPECT_EQ(found.where.axes, std::vector<std::size_t>{1});
    EXPECT_NEAR(found.entries.front().params.at("factor"), 1.06, 4.0 * found.sd.front().at("factor"));
    EXPECT_LT(found.sd.front().at("factor"), 0.01);
    EXPECT_EQ(seen.best()->effect, "arw_scale");
}

TEST(EffectEvidence, OfGaussMarkovNoiseKnowsItsTime) {
    const SensorModel model = calibrated_sensor();
    SensorModel wandering = model;
    wandering.effects.push_back({"gauss_markov", {}, {{"sigma_dps", 0.01}, {"tau_s", 5.0}}, ""});
    const Hypotheses seen = examined(recorded(wandering, 180000, 23), model);
    const Finding& found = of(seen, "gauss_markov");
    ASSERT_EQ(found.entries.size(), 1U) << "the axes share both";
    EXPECT_NEAR(found.entries.front().params.at("tau_s"), 5.0, 4.0 * found.sd.front().at("tau_s"));
    EXPECT_NEAR(found.entries.front().params.at("sigma_dps"), 0.01, 4.0 * found.sd.front().at("sigma_dps"));
    EXPECT_GT(found.evidence_nats, of(seen, "flicker_missing").evidence_nats + 50.0);
}

TEST(EffectEvidence, IsRarelyThereByChance) {
    const SensorModel model = calibrated_sensor();
    constexpr int records = 30;
    int above_3 = 0;
    int above_6 = 0;
    for (int i = 0; i < records; ++i) {
        const Hypotheses seen = examined(recorded(model, 8192, 100 + static_cast<std::uint64_t>(i)), model);
        const Finding* best = seen.best();
        above_3 += best != nullptr && best->evidence_nats > 3.0;
        above_6 += best != nullptr && best->evidence_nats > 6.0;
    }
    // Some thirty scans, each above e nats with a probability of exp(-e) at most, most far less.
    EXPECT_LE(above_3, 10);
    EXPECT_LE(above_6, 3);
}

TEST(ForwardSelection, TakesTwoCausesApart) {
    const SensorModel model = calibrated_sensor();
    SensorModel two = model;
    two.effects.push_back({"gauss_markov", {"x"}, {{"sigma_dps", 0.01}, {"tau_s", 5.0}}, ""});
    two.effects.push_back({"tone", {}, {{"f_hz", 31.0}, {"amplitude_dps", 0.004}}, ""});
    const auto recording = recorded(two, 180000, 24);
    const Hypotheses first = examined(recording, model);
    const std::optional<CauseSelection> found = select_causes(first, recording, {});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->causes.size(), 2U);
    std::vector<std::string> names = {found->causes[0].finding.effect, found->causes[1].finding.effect};
    std::ranges::sort(names);
    EXPECT_EQ(names, (std::vector<std::string>{"gauss_markov", "tone"}));
    const Finding* left = found->last.best();
    ASSERT_NE(left, nullptr);
    EXPECT_LT(left->evidence_nats, 6.0);
}

// Beyond half of the rate a first-order filter folds to more white noise, within a tenth.
TEST(EffectEvidence, OfMoreWhiteNoiseIsNoLowPassBeyondHalfTheRate) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(with_effect(model, "arw_scale", {{"factor", 1.45}}), 30000, 33);
    const Hypotheses first = examined(recording, model);
    const Finding lowpass = of(first, "lowpass");
    ASSERT_FALSE(lowpass.entries.empty());
    for (const EffectModel& entry : lowpass.entries) {
        EXPECT_LE(entry.params.at("fc_hz"), 0.5 * recording->rate_hz);
    }
    EXPECT_GT(of(first, "arw_scale").evidence_nats, lowpass.evidence_nats + 100.0);
}

// A low-pass that was fitted beside more white noise is another one without it.
TEST(ForwardSelection, FitsACauseAgainWhereAnotherIsLeftOut) {
    const SensorModel model = calibrated_sensor();
    SensorModel filtered = model;
    filtered.effects.push_back({"lowpass", {"x"}, {{"fc_hz", 28.0}, {"order", 1.0}}, ""});
    const auto recording = recorded(filtered, 30000, 31);
    const Hypotheses first = examined(recording, model);
    const Finding alone = of(first, "lowpass");
    Finding beside_noise = alone;
    beside_noise.entries.at(0).params["fc_hz"] = 12.0;
    Finding more_noise = alone;
    more_noise.effect = "arw_scale";
    more_noise.entries = {{"arw_scale", {"x"}, {{"factor", 2.0}}, ""}};
    CauseSelection both;
    both.causes = {{beside_noise, {}}, {more_noise, {}}};
    both.without_causes = model;
    const std::optional<CauseSelection> without = without_cause(std::move(both), 1, first, recording, {});
    ASSERT_TRUE(without);
    ASSERT_EQ(without->causes.size(), 1U);
    const double fc_hz = without->causes[0].finding.entries.at(0).params.at("fc_hz");
    EXPECT_NEAR(fc_hz, alone.entries.at(0).params.at("fc_hz"), 0.01);
    EXPECT_NEAR(fc_hz, 28.0, 2.0);
    ASSERT_EQ(without->corrected.effects.size(), 1U);
    EXPECT_EQ(without->corrected.effects[0].params.at("fc_hz"), fc_hz);
}

// One that the recording does not call for by itself goes, too.
TEST(ForwardSelection, DropsACauseWithoutEvidenceWhereAnotherIsLeftOut) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(model, 30000, 32);
    const Hypotheses first = examined(recording, model);
    Finding nothing;
    nothing.effect = "lowpass";
    nothing.entries = {{"lowpass", {"x"}, {{"fc_hz", 28.0}, {"order", 1.0}}, ""}};
    CauseSelection both;
    both.causes = {{nothing, {}}, {nothing, {}}};
    both.without_causes = model;
    const std::optional<CauseSelection> without = without_cause(std::move(both), 1, first, recording, {});
    ASSERT_TRUE(without);
    EXPECT_TRUE(without->causes.empty());
    EXPECT_TRUE(without->corrected.effects.empty());
}

// A random walk takes up both; only together they are worth more.
TEST(ForwardSelection, TakesTelegraphNoiseOnARampForNoRandomWalk) {
    const SensorModel model = calibrated_sensor();
    SensorModel two = model;
    two.effects.push_back(
        {"rtn", {"y"}, {{"amplitude_dps", 0.012}, {"dwell_high_s", 21.0}, {"dwell_low_s", 15.0}}, ""});
    two.effects.push_back({"rate_ramp", {"y"}, {{"ramp_dps_per_s", 1.5e-4}}, ""});
    const auto recording = recorded(two, 180000, 25);
    const Hypotheses first = examined(recording, model);
    EXPECT_EQ(find_effect(first.best()->effect)->signature->method, EvidenceMethod::spectrum)
        << "the trap is not set";
    const std::optional<CauseSelection> found = select_causes(first, recording, {});
    ASSERT_TRUE(found);
    std::vector<std::string> names;
    for (const FoundCause& cause : found->causes) { names.push_back(cause.finding.effect); }
    std::ranges::sort(names);
    EXPECT_EQ(names, (std::vector<std::string>{"rate_ramp", "rtn"}));
}

// What a steady line leaves of one that swells is no further line at the same place.
TEST(ForwardSelection, TakesALineThatSwellsOnce) {
    const SensorModel model = calibrated_sensor();
    Recording swelling = *recorded(model, 120000, 26);
    Column& column = swelling.columns.front();
    ASSERT_EQ(column.name, "gx");
    std::vector<double> rates;
    for (std::size_t row = 0; row < column.size(); ++row) {
        const double at_s = static_cast<double>(row) / swelling.rate_hz;
        const double part = static_cast<double>(row) / static_cast<double>(column.size());
        const double amplitude_rad_s = 3.5e-4 * (0.7 + 0.3 * part);
        rates.push_back(column.value(row) + amplitude_rad_s * std::sin(2.0 * std::numbers::pi * 31.0 * at_s));
    }
    column.data = std::move(rates);
    column.scale = 1.0;
    column.offset = 0.0;
    const Hypotheses first = examined(std::make_shared<const Recording>(swelling), model);
    const std::optional<CauseSelection> found =
        select_causes(first, std::make_shared<const Recording>(swelling), {});
    ASSERT_TRUE(found);
    std::vector<std::string> names;
    for (const FoundCause& cause : found->causes) { names.push_back(cause.finding.effect); }
    EXPECT_EQ(std::ranges::count(names, "tone"), 1) << testing::PrintToString(names);
    for (const FoundCause& cause : found->causes) {
        for (const Finding& rival : cause.rivals) {
            const bool is_other_cause = std::ranges::any_of(found->causes, [&](const FoundCause& other) {
                return &other != &cause && other.finding.effect == rival.effect;
            });
            EXPECT_FALSE(is_other_cause) << rival.effect;
        }
    }
}

// Numbers on a coarse grid look heavy-tailed to a likelihood that knows no grid, more than they look coarse.
TEST(ForwardSelection, TakesACoarseStepForNothingElse) {
    SensorModel model = calibrated_sensor(0.0033);
    // The next code is rarely reached.
    model.axes[0].bias_rad_s = 1.2 * model.lsb_rad_s;
    SensorModel coarse = model;
    coarse.effects.push_back({"quantization", {"x"}, {{"lsb_dps", 8.0 * model.lsb_rad_s * deg_per_rad}}, ""});
    const auto recording = recorded(coarse, 60'000, 27);
    const Hypotheses first = examined(recording, model);
    EXPECT_GT(of(first, "heavy_tail").evidence_nats, of(first, "quantization").evidence_nats)
        << "the trap is not set";
    const std::optional<CauseSelection> found = select_causes(first, recording, {});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->causes.size(), 1U);
    EXPECT_EQ(found->causes.front().finding.effect, "quantization");
    EXPECT_EQ(found->causes.front().rivals.size(), 1U) << "itself";
    EXPECT_TRUE(found->noise_refits.empty());
}

// Size and correlation time of slow Gauss-Markov noise give way to each other: with the other one held, each
// would seem to be known better than estimates scatter.
TEST(EffectEvidence, OfParametersThatGiveWayToEachOtherStatesTheirScatter) {
    SensorModel model = calibrated_sensor();
    for (AxisModel& axis : model.axes) { axis.noise = {.N_rad_per_sqrt_s = axis.noise.N_rad_per_sqrt_s}; }
    model.sd_rel = {{"N", 0.005}};
    const std::map<std::string, double> put_in = {{"sigma_dps", 0.004}, {"tau_s", 60.0}};
    const SensorModel sensor = with_effect(model, "gauss_markov", put_in, {"x"});
    constexpr int seeds = 60;
    std::map<std::string, double> chi2;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const auto recording = recorded(sensor, 180'000, 500 + seed);
        const auto finding = found(make_noise_spectrum_estimator, "gauss_markov", recording, model);
        ASSERT_TRUE(finding) << seed;
        const std::map<std::string, double>& params = finding->entries.front().params;
        for (const auto& [name, value] : put_in) {
            const double log_sd = finding->sd.front().at(name) / params.at(name);
            const double z = std::log(params.at(name) / value) / log_sd;
            chi2[name] += z * z / seeds;
        }
    }
    // Of 60 squares the mean has a standard deviation of 0.18.
    for (const auto& [name, mean] : chi2) {
        EXPECT_LT(mean, 1.0 + 4.0 * 0.18) << name;
        EXPECT_GT(mean, 1.0 - 4.0 * 0.18) << name;
    }
}

TEST(OccamCost, RisesSmoothlyBeyondWhatIsPlausible) {
    const EffectParam size{.name = "a", .meaning = "", .plausible_from = -3.0, .plausible_to = 3.0};
    const double sd = 0.01;
    EXPECT_DOUBLE_EQ(occam_cost_nats(size, 0.5, sd), occam_cost_nats(size, -2.9, sd));
    const double inside = occam_cost_nats(size, 0.0, sd);
    EXPECT_NEAR(occam_cost_nats(size, 6.0, sd) - inside, 0.5, 1e-9) << "half the range beyond: one sigma";
    EXPECT_NEAR(occam_cost_nats(size, -9.0, sd) - inside, 2.0, 1e-9);
    const EffectParam time{.name = "tau_s", .meaning = "", .plausible_from = 60.0, .plausible_to = 960.0};
    const double relative = 0.1;
    const double usual = occam_cost_nats(time, 100.0, relative * 100.0);
    EXPECT_NEAR(occam_cost_nats(time, 960.0 * 4.0, relative * 960.0 * 4.0) - usual, 0.5, 1e-9);
    EXPECT_NEAR(occam_cost_nats(time, 60.0 / 16.0, relative * 60.0 / 16.0) - usual, 2.0, 1e-9);
}

}  // namespace
}  // namespace gyrolog
