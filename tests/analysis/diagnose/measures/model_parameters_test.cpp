#include "analysis/diagnose/measures/model_parameters.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

std::vector<GapCurve> curves_of_sensor(const SensorModel& sensor, const SensorModel& model,
                                       const std::shared_ptr<const World>& world = nullptr) {
    const auto recording = recorded(sensor, 30'000, 5, world);
    return gap_curves(Observation(prediction_of(recording, model), recording, 1));
}

// A noise fit takes up what no spectrum shows any more.
TEST(ModelParameters, ShowNoiseThatIsNotAsStated) {
    SensorModel model = calibrated_sensor();
    model.sd_rel = {{"N", 0.02}, {"B", 0.02}, {"K", 0.02}};
    const std::vector<GapCurve> curves =
        curves_of_sensor(with_effect(model, "arw_scale", {{"factor", 1.2}}, {"x"}), model);
    EXPECT_GT(curve_of(curves, measures::noise_coefficients, 0).value[0], 5.0);
    EXPECT_LT(std::fabs(curve_of(curves, measures::noise_coefficients, 1).value[0]), 4.0);
}

// The latency of a motion likewise, where the model leaves it open.
TEST(ModelParameters, ShowALatencyThatIsNotAsStated) {
    SensorModel model = calibrated_sensor();
    model.sd_abs = {{"latency_s", 1e-4}};
    const auto world = tumbling_world(1.5);
    const auto farthest = [&](const SensorModel& sensor) {
        double most = 0.0;
        const std::vector<GapCurve> curves = curves_of_sensor(sensor, model, world);
        for (const double value : curve_of(curves, measures::motion_parameters, 0).value) {
            most = std::max(most, std::fabs(value));
        }
        return most;
    };
    EXPECT_LT(farthest(model), 4.0);
    EXPECT_GT(farthest(with_effect(model, "latency", {{"delay_s", 2e-3}}, {})), 8.0);
}

}  // namespace
}  // namespace gyrolog
