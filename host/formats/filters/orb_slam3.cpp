#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view orb_slam3_facts[] = {
    "ORB-SLAM3 multiplies noises by sqrt(IMU.Frequency) and divides walks by it (version 1.0, "
    "src/Tracking.cc, where mpImuCalib is made), then adds (noise * dt)^2 and walk^2 for each sample "
    "(src/ImuTypes.cc, IntegrateNewMeasurement, c85e0eada71f): densities. With another IMU.Frequency than "
    "the "
    "IMU's both are wrong.",
    "The walk of the bias is in the bias' covariance, not in the rotation's: that grows by N^2 t without K^2 "
    "t^3 / 3 (the same), too little where key frames are more than sqrt(3) N / K apart.",
    "Each number has to have a point there, IMU.Frequency as well (src/Settings.cc, readParameter<float>).",
    "Part of a settings file: keep the camera's and IMU.T_b_c1 of your own.",
};

constexpr FilterNumber orb_slam3_numbers[] = {
    {"IMU.NoiseGyro", SensorKind::gyro, NoiseTerm::N, "rad/s/sqrt(Hz)", continuous},
    {"IMU.NoiseAcc", SensorKind::accelerometer, NoiseTerm::N, "m/s^2/sqrt(Hz)", continuous},
    {"IMU.GyroWalk", SensorKind::gyro, NoiseTerm::K, "rad/s^2/sqrt(Hz)", continuous},
    {"IMU.AccWalk", SensorKind::accelerometer, NoiseTerm::K, "m/s^3/sqrt(Hz)", continuous},
};

}  // namespace

constinit const FilterFormat orb_slam3_format = {
    .name = "orb-slam3",
    .summary = "ORB-SLAM3: the IMU's settings",
    .kind = "Continuous-time densities.",
    .facts = orb_slam3_facts,
    .numbers = orb_slam3_numbers,
    .line = "{key}: {value}",
    .before = "IMU.Frequency: {rate}  # Hz\n",
    .after = "",
    .first = "%YAML:1.0\n",
};

}  // namespace gyrolog
