#include "analysis/diagnose/likelihood/observed_line.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

EffectModel line_on(const char* axis, double amplitude_dps, double phase_rad) {
    EffectModel line;
    line.effect = "tone";
    line.axes = {axis};
    line.params = {{"amplitude_dps", amplitude_dps}, {"f_hz", 31.3}, {"phase_rad", phase_rad}};
    return line;
}

TEST(ObservedLine, IsTheRecordingsToItsCramerRaoBound) {
    constexpr std::uint64_t samples = 60'000;
    constexpr double amplitude_dps = 0.02;
    constexpr double noise_dps = 0.005 * 10.0;  // N times the root of the rate
    const double sd_rad = noise_dps / amplitude_dps * std::sqrt(2.0 / static_cast<double>(samples));
    for (const double phase_rad : {-2.5, 0.3, 1.9}) {
        SensorModel truth = calibrated_sensor();
        truth.effects = {line_on("y", amplitude_dps, phase_rad)};
        const auto recording = recorded(truth, samples, 5);
        SensorModel model = calibrated_sensor();
        // A line on another axis that is not in the recording changes nothing.
        model.effects = {line_on("y", amplitude_dps, 0.0), line_on("x", amplitude_dps, 1.0)};
        const auto prediction = prediction_of(recording, model);
        const ObservedLine seen = observe_line(*prediction, recording, model.effects[0], 1);
        EXPECT_NEAR(std::remainder(seen.phase_rad - phase_rad, 2.0 * pi), 0.0, 4.0 * sd_rad) << phase_rad;
        EXPECT_NEAR(seen.share, 1.0, 4.0 * sd_rad) << phase_rad;
        EXPECT_NEAR(observe_line(*prediction, recording, model.effects[1], 1).share, 0.0, 4.0 * sd_rad)
            << phase_rad;
    }
}

}  // namespace
}  // namespace gyrolog
