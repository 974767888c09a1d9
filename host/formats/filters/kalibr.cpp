#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view kalibr_facts[] = {
    "Kalibr makes a sample's deviation of a density itself, density * sqrt(update_rate); of a "
    "random walk it takes the density (Kalibr, kalibr_common/ConfigReader.py, getGyroStatistics and "
    "getAccelerometerStatistics, 0b8b9e8ea4c2).",
    "All six keys are needed there, the four numbers above zero; one that is missing ends it with an error. "
    "Each has a "
    "point: PyYAML takes 3e-06 for a text.",
};

constexpr FilterNumber kalibr_numbers[] = {
    {"gyroscope_noise_density", SensorKind::gyro, NoiseTerm::N, "rad/s/sqrt(Hz)", continuous},
    {"gyroscope_random_walk", SensorKind::gyro, NoiseTerm::K, "rad/s^2/sqrt(Hz)", continuous},
    {"accelerometer_noise_density", SensorKind::accelerometer, NoiseTerm::N, "m/s^2/sqrt(Hz)", continuous},
    {"accelerometer_random_walk", SensorKind::accelerometer, NoiseTerm::K, "m/s^3/sqrt(Hz)", continuous},
};

}  // namespace

constinit const FilterFormat kalibr_format = {
    .name = "kalibr",
    .summary = "Kalibr's imu.yaml",
    .kind = "Continuous-time densities.",
    .facts = kalibr_facts,
    .numbers = kalibr_numbers,
    .line = "{key}: {value}",
    .before = "rostopic: /imu0\nupdate_rate: {rate}  # Hz\n",
    .after = "",
};

}  // namespace gyrolog
