#include "analysis/diagnose/likelihood/observation.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/compare/model_draw.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

TEST(Observation, IsWhiteWhereTheModelIsRight) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(draw_within_uncertainty(model, 3), 180000, 11);
    const Observation seen(prediction_of(recording, model), recording, 1);
    for (const std::size_t axis : seen.prediction().axes()) {
        const std::vector<float>& white = seen.axis(axis).whitened;
        double square = 0.0;
        double product = 0.0;
        for (std::size_t i = 1; i < white.size(); ++i) {
            square += static_cast<double>(white[i] * white[i]);
            product += static_cast<double>(white[i] * white[i - 1]);
        }
        const auto n = static_cast<double>(white.size());
        EXPECT_NEAR(square / n, 1.0, 4.0 * std::sqrt(2.0 / n));
        EXPECT_NEAR(product / n, 0.0, 4.0 / std::sqrt(n));
        // By bin: chi-square, its mean over all bins with tolerance from their count.
        double misfit = 0.0;
        const SpectralBins& bins = seen.prediction().bins();
        for (std::size_t i = 0; i < bins.size(); ++i) {
            const double ratio = seen.axis(axis).power[i] / seen.axis(axis).density[i] - 1.0;
            misfit += 0.5 * bins[i].count() * ratio * ratio;
        }
        const auto count = static_cast<double>(bins.size());
        // A single coefficient's square has the fourth moment 60 about its mean: variance of ratio^2 / 2
        // is 14.
        EXPECT_NEAR(misfit / count, 1.0, 4.0 * std::sqrt(6.0 / count)) << axis;
    }
}

TEST(Observation, FindsTheNoiseWithinItsUncertainty) {
    const SensorModel model = calibrated_sensor();
    SensorModel louder = model;
    for (AxisModel& axis : louder.axes) { axis.noise.N_rad_per_sqrt_s *= 1.01; }
    const auto recording = recorded(louder, 180000, 12);
    const Observation seen(prediction_of(recording, model), recording, 1);
    // 180 000 samples know N to 0.17 %, the model to 0.5 %: +1 % is 2 sd, of which the prior keeps a tenth.
    for (const std::size_t axis : seen.prediction().axes()) {
        EXPECT_NEAR(seen.axis(axis).noise.z[0], 1.8, 1.2) << axis;
    }
}

TEST(Observation, FillsHolesWithoutLosingPower) {
    const SensorModel model = calibrated_sensor();
    SensorModel dropping = model;
    dropping.effects.push_back({"dropped", {}, {{"per_hour", 600.0}, {"longest", 30.0}}, ""});
    const auto recording = recorded(dropping, 180000, 13);
    const Observation seen(prediction_of(recording, model), recording, 1);
    std::size_t missing = 0;
    for (std::size_t slot = 0; slot < seen.prediction().length(); ++slot) {
        missing += !seen.present()[slot];
    }
    EXPECT_GT(missing, 1000U);
    for (const std::size_t axis : seen.prediction().axes()) {
        double square = 0.0;
        for (const float w : seen.axis(axis).whitened) { square += static_cast<double>(w * w); }
        const auto n = static_cast<double>(seen.prediction().length());
        EXPECT_NEAR(square / n, 1.0, 5.0 * std::sqrt(2.0 / n)) << axis;
    }
}

}  // namespace
}  // namespace gyrolog
