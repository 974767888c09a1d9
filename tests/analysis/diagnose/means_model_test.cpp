#include "analysis/diagnose/means_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/effect_search.hpp"
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
            examine(baseline_of(recording, model_of_means(model, samples)), recording, 1, 1);
        for (const std::size_t axis : {0U, 1U, 2U}) {
            double square = 0.0;
            const std::vector<float>& white = seen.observation->axis(axis).whitened;
            for (const float w : white) { square += static_cast<double>(w) * static_cast<double>(w); }
            const auto n = static_cast<double>(white.size());
            EXPECT_NEAR(square / n, 1.0, 4.0 * std::sqrt(2.0 / n)) << seed << ' ' << axis;
        }
        if (seen.best() != nullptr) { EXPECT_LT(seen.best()->evidence_nats, 5.0) << seen.best()->effect; }
    }
}

TEST(ModelOfMeans, HasTheSlowEffects) {
    const SensorModel model = fast_sensor();
    const auto recording =
        means(with_effect(model, "gauss_markov", {{"sigma_dps", 0.02}, {"tau_s", 5.0}}, {"y"}), 85);
    const Hypotheses seen = examine(baseline_of(recording, model_of_means(model, samples)), recording, 1, 1);
    ASSERT_NE(seen.best(), nullptr);
    EXPECT_EQ(seen.best()->effect, "gauss_markov");
    for (const CatalogueEntry& entry : seen.catalogue) {
        const bool single = entry.effect->name == "lowpass" || entry.effect->name == "spikes" ||
                            entry.effect->name == "quantization" || entry.effect->name == "stale" ||
                            entry.effect->name == "heavy_tail";
        if (single) { EXPECT_EQ(entry.untestable, "means of several samples do not show it"); }
    }
}

TEST(ModelOfMeans, LeavesOutWhatSingleSamplesShow) {
    SensorModel model = with_effect(fast_sensor(), "spikes",
                                    {{"per_hour", 10.0}, {"smallest_dps", 1.0}, {"largest_dps", 2.0}}, {});
    model = with_effect(model, "rate_ramp", {{"ramp_dps_per_s", 1e-5}}, {});
    const SensorModel of_means = model_of_means(model, samples);
    ASSERT_EQ(of_means.effects.size(), 1U);
    EXPECT_EQ(of_means.effects.front().effect, "rate_ramp");
    EXPECT_EQ(model_of_means(model, 1).effects.size(), 2U);
}

}  // namespace
}  // namespace gyrolog
