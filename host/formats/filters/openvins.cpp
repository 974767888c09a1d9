#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view openvins_facts[] = {
    "OpenVINS divides a density's square by the step before it multiplies by the step's square, so that its "
    "variance grows by density^2 * dt (ov_msckf/src/state/Propagator.cpp, predict_and_compute, "
    "03b3442451ec).",
    "T_i_b, the intrinsic matrices and time_offset are those of an ideal IMU at the body: put in what a "
    "calibration gives. The keys are those of config/euroc_mav/kalibr_imu_chain.yaml, 1d10d1257d7c.",
};

constexpr FilterNumber openvins_numbers[] = {
    {"accelerometer_noise_density", SensorKind::accelerometer, NoiseTerm::N, "m/s^2/sqrt(Hz)", continuous},
    {"accelerometer_random_walk", SensorKind::accelerometer, NoiseTerm::K, "m/s^3/sqrt(Hz)", continuous},
    {"gyroscope_noise_density", SensorKind::gyro, NoiseTerm::N, "rad/s/sqrt(Hz)", continuous},
    {"gyroscope_random_walk", SensorKind::gyro, NoiseTerm::K, "rad/s^2/sqrt(Hz)", continuous},
};

}  // namespace

constinit const FilterFormat openvins_format = {
    .name = "openvins",
    .summary = "OpenVINS: kalibr_imu_chain.yaml",
    .kind = "Continuous-time densities.",
    .facts = openvins_facts,
    .numbers = openvins_numbers,
    .line = "  {key}: {value}",
    .before =
        "imu0:\n"
        "  T_i_b:\n"
        "    - [1.0, 0.0, 0.0, 0.0]\n"
        "    - [0.0, 1.0, 0.0, 0.0]\n"
        "    - [0.0, 0.0, 1.0, 0.0]\n"
        "    - [0.0, 0.0, 0.0, 1.0]\n",
    .after =
        "  rostopic: /imu0\n"
        "  time_offset: 0.0\n"
        "  update_rate: {rate}\n"
        "  model: \"kalibr\"\n"
        "  Tw:\n    - [1.0, 0.0, 0.0]\n    - [0.0, 1.0, 0.0]\n    - [0.0, 0.0, 1.0]\n"
        "  R_IMUtoGYRO:\n    - [1.0, 0.0, 0.0]\n    - [0.0, 1.0, 0.0]\n    - [0.0, 0.0, 1.0]\n"
        "  Ta:\n    - [1.0, 0.0, 0.0]\n    - [0.0, 1.0, 0.0]\n    - [0.0, 0.0, 1.0]\n"
        "  R_IMUtoACC:\n    - [1.0, 0.0, 0.0]\n    - [0.0, 1.0, 0.0]\n    - [0.0, 0.0, 1.0]\n"
        "  Tg:\n    - [0.0, 0.0, 0.0]\n    - [0.0, 0.0, 0.0]\n    - [0.0, 0.0, 0.0]\n",
    .first = "%YAML:1.0\n",
};

}  // namespace gyrolog
