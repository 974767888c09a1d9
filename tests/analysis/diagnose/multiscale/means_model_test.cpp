#include "analysis/diagnose/multiscale/means_model.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "analysis/diagnose/selection/forward_selection.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t samples = 10;

SensorModel fast_sensor() {
    SensorModel model = calibrated_sensor();
    model.rate_hz = 1000.0;
    // A quarter of the noise is the converter's.
    model.lsb_rad_s = 0.3 * rad_per_deg;
    return model;
}

std::shared_ptr<const Recording> means(const SensorModel& sensor, std::uint64_t seed) {
    return std::make_shared<const Recording>(means_of(*recorded(sensor, 600000, seed), samples));
}

TEST(ModelOfMeans, IsThatOfTheMeansOfItsSamples) {
    const SensorModel model = fast_sensor();
    for (std::uint64_t seed = 80; seed < 84; ++seed) {
        const auto recording = means(model, seed);
        EXPECT_NEAR(recording->rate_hz, 100.0, 1e-6);
        const Hypotheses seen =
            examine(prediction_of(recording, model_of_means(model, samples, 1000.0)), recording, 1, 1);
        for (const std::size_t axis : {0U, 1U, 2U}) {
            double square = 0.0;
            const std::vector<float>& white = seen.observation->axis(axis).whitened;
            for (const float w : white) { square += static_cast<double>(w) * static_cast<double>(w); }
            const auto n = static_cast<double>(white.size());
            EXPECT_NEAR(square / n, 1.0, 4.0 * std::sqrt(2.0 / n)) << seed << ' ' << axis;
        }
        ASSERT_NE(seen.best(), nullptr) << seed;
        EXPECT_LT(seen.best()->evidence_nats, 5.0) << seen.best()->effect;
    }
}

TEST(ModelOfMeans, HasTheSlowEffects) {
    const SensorModel model = fast_sensor();
    const auto recording =
        means(with_effect(model, "gauss_markov", {{"sigma_dps", 0.02}, {"tau_s", 5.0}}, {"y"}), 85);
    const Hypotheses seen =
        examine(prediction_of(recording, model_of_means(model, samples, 1000.0)), recording, 1, 1);
    ASSERT_NE(seen.best(), nullptr);
    EXPECT_EQ(seen.best()->effect, "gauss_markov");
    for (const char* single : {"lowpass", "quantization", "stale", "heavy_tail"}) {
        const auto entry = std::ranges::find_if(
            seen.catalogue, [&](const CatalogueEntry& one) { return one.effect->name == single; });
        ASSERT_NE(entry, seen.catalogue.end()) << single;
        EXPECT_EQ(entry->untestable, "means of several samples do not show it") << single;
    }
}

TEST(ModelOfMeans, LeavesOutWhatOnlySamplesShow) {
    SensorModel model = with_effect(fast_sensor(), "heavy_tail", {{"nu", 4.0}}, {});
    model = with_effect(model, "rate_ramp", {{"ramp_dps_per_s", 1e-5}}, {});
    const SensorModel of_means = model_of_means(model, samples, 1000.0);
    ASSERT_EQ(of_means.effects.size(), 1U);
    EXPECT_EQ(of_means.effects.front().effect, "rate_ramp");
    EXPECT_EQ(model_of_means(model, 1, 1000.0).effects.size(), 2U);
}

TEST(ModelOfMeans, HasSingleSamplesThatAreOffByLess) {
    const SensorModel model =
        with_effect(fast_sensor(), "spikes",
                    {{"per_hour", 1000.0}, {"smallest_dps", 10.0}, {"largest_dps", 20.0}}, {"x"});
    const EffectModel in_means = model_of_means(model, samples, 1000.0).effects.at(0);
    EXPECT_EQ(in_means.params.at("per_hour"), 1000.0);
    EXPECT_NEAR(in_means.params.at("smallest_dps"), 1.0, 1e-12);
    EXPECT_NEAR(in_means.params.at("largest_dps"), 2.0, 1e-12);

    const auto recording = means(model, 86);  // some 170 of them
    const Hypotheses seen =
        examine(prediction_of(recording, model_of_means(fast_sensor(), samples, 1000.0)), recording, 1, 1);
    ASSERT_NE(seen.best(), nullptr);
    EXPECT_EQ(seen.best()->effect, "spikes");
    const Finding found = finding_of_samples(*seen.best(), samples, 1000.0);
    for (const auto& [name, value] : model.effects.front().params) {
        EXPECT_NEAR(found.entries.at(0).params.at(name), value, 4.0 * found.sd.at(0).at(name)) << name;
    }
}

TEST(ModelOfMeans, HasLinesAsMeansHaveThem) {
    constexpr double rate_hz = 1000.0;
    constexpr double phase_rad = 0.7;
    for (const double f_hz : {0.2, 7.0, 49.0, 137.3, 430.0}) {
        const double turn_rad = 2.0 * pi * f_hz / rate_hz;
        SensorModel model = fast_sensor();
        model.effects = {
            {"tone", {}, {{"f_hz", f_hz}, {"amplitude_dps", 0.1}, {"phase_rad", phase_rad}}, ""}};
        const EffectModel in_means = model_of_means(model, samples, rate_hz).effects.at(0);
        for (std::size_t row = 0; row < 5; ++row) {
            double mean = 0.0;
            for (std::size_t i = row * samples; i < (row + 1) * samples; ++i) {
                mean += 0.1 * std::sin(turn_rad * static_cast<double>(i) + phase_rad) / samples;
            }
            const double at = turn_rad * static_cast<double>(row * samples) + in_means.params.at("phase_rad");
            EXPECT_NEAR(in_means.params.at("amplitude_dps") * std::sin(at), mean, 1e-12) << f_hz;
        }
        Finding finding;
        finding.entries = {in_means};
        finding.sd = {{{"amplitude_dps", 0.1 * in_means.params.at("amplitude_dps")}}};
        finding = finding_of_samples(finding, samples, rate_hz);
        EXPECT_NEAR(finding.entries[0].params.at("amplitude_dps"), 0.1, 1e-12);
        EXPECT_NEAR(finding.entries[0].params.at("phase_rad"), phase_rad, 1e-9);
        EXPECT_NEAR(finding.sd[0].at("amplitude_dps"), 0.01, 1e-12);
    }
    EXPECT_EQ(std::abs(line_in_means(1000.0, rate_hz, samples)), 1.0);
}

}  // namespace
}  // namespace gyrolog
