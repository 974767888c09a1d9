#include <cmath>

#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view vins_fusion_facts[] = {
    "VINS-Fusion and VINS-Mono: the covariance of a step is V noise V', with dt itself in V: numbers are "
    "deviations of a sample, not densities (vins_estimator/src/factor/integration_base.h, "
    "midPointIntegration, VINS-Fusion 939f01282fa4).",
    "A fault there: the mean of two neighbouring samples is taken for one of independent errors (noise has "
    "ACC_N and GYR_N twice, V halves of dt), although each sample is in two steps. Half of the variance is "
    "lost; acc_n and gyr_n are larger by sqrt(2) here, which gives back density^2 * t.",
    "acc_w and gyr_w are multiplied by dt: they are K * sqrt(rate). They hold at this rate of the IMU only; "
    "steps that an image cuts in two count for less.",
    "Part of a configuration: keep topics, cameras and g_norm of your own file.",
};

double half_lost(double density, double rate_hz) { return density * std::sqrt(2.0 * rate_hz); }

constexpr FilterNumber vins_fusion_numbers[] = {
    {"acc_n", SensorKind::accelerometer, NoiseTerm::N, "m/s^2", half_lost},
    {"gyr_n", SensorKind::gyro, NoiseTerm::N, "rad/s", half_lost},
    {"acc_w", SensorKind::accelerometer, NoiseTerm::K, "m/s^3", once_a_sample},
    {"gyr_w", SensorKind::gyro, NoiseTerm::K, "rad/s^2", once_a_sample},
};

}  // namespace

constinit const FilterFormat vins_fusion_format = {
    .name = "vins-fusion",
    .summary = "VINS-Fusion, VINS-Mono: the IMU's four numbers",
    .kind = "Discrete at {rate} Hz.",
    .facts = vins_fusion_facts,
    .numbers = vins_fusion_numbers,
    .line = "{key}: {value}",
    .before = "",
    .after = "",
    .first = "%YAML:1.0\n",
};

}  // namespace gyrolog
