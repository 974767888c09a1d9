#include "analysis/diagnose/likelihood/hole_filling.hpp"

#include <array>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "analysis/diagnose/likelihood/effect_response.hpp"
#include "analysis/diagnose/likelihood/mean_regression.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr double true_gain = 0.005;
constexpr double plateau_s = 8.0;
constexpr double between_s = 3.0;

// From plateau to plateau along a straight line.
double plateau_rate_rad_s(double t_s) {
    constexpr std::array plateaus_dps = {30.0, -30.0, 0.0, 30.0, 0.0, -30.0, 15.0, 15.0};
    const double place = t_s / (plateau_s + between_s);
    const auto plateau = static_cast<std::size_t>(std::max(0.0, place)) % plateaus_dps.size();
    const double beyond_s = (place - std::floor(place)) * (plateau_s + between_s) - plateau_s;
    const double share = std::max(0.0, beyond_s / between_s);
    const double next_dps = plateaus_dps.at((plateau + 1) % plateaus_dps.size());
    return (plateaus_dps.at(plateau) + share * (next_dps - plateaus_dps.at(plateau))) * rad_per_deg;
}

// Of the rows on plateaus, a quarter second from their ends.
bool is_on_plateau(std::size_t row) {
    const double within_s = std::fmod(static_cast<double>(row) / 100.0, plateau_s + between_s);
    return within_s > 0.25 && within_s < plateau_s - 0.25;
}

struct Gain {
    double value;
    double sd;
};

// The scale factor's error as it is read off one recording.
Gain gain_with_holes(std::uint64_t seed) {
    SensorModel model = calibrated_sensor();
    model.sd_abs.erase("M");  // or the model itself would give way to the gain
    SensorModel sensor = model;
    sensor.M[0][0] += true_gain;
    const auto world = world_turning([](double t_s) { return Vector3{plateau_rate_rad_s(t_s), 0.0, 0.0}; });
    const std::shared_ptr<const Recording> whole = recorded(sensor, 17'600, seed, world);
    const auto recording =
        std::make_shared<const Recording>(rows_of(*whole, segments_where(whole->segments, is_on_plateau)));
    const auto prediction = prediction_of(recording, model);
    const Observation observation(prediction, recording, 1);
    const EffectModel unit{"scale_factor", {}, {{"eps", 1.0}}, {}};
    const MeanResponses responses(*prediction, 0, {effect_response(*prediction, unit, false)[0]});
    const NormalEquations equations =
        MeanRegression(observation, 0, responses).equations(observation.axis(0).density);
    return {equations.solution().front(), equations.sd().front()};
}

// A third of the time is missing, in holes across which the rate changes. With a response that ends at each
// hole a tenth of the gain is lost, which is seven standard deviations.
TEST(ResponseWithHoles, IsReadOffTheSamplesAlone) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Gain gain = gain_with_holes(seed);
        EXPECT_NEAR(gain.value, true_gain, 4.0 * gain.sd) << "seed " << seed;
        EXPECT_LT(gain.sd, 0.02 * true_gain);
    }
}

}  // namespace
}  // namespace gyrolog
