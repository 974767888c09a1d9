#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view pegasus_facts[] = {
    "For IMU(config=imu_config). Densities, two-sided; the bias is a Gauss-Markov process that begins at "
    "zero "
    "(PegasusSimulator, extensions/pegasus.simulator/pegasus/simulator/logic/sensors/imu.py, update, "
    "df4a932a39be).",
    "The simulator takes the accelerometer's correlation time for the gyro's, too: it is set in both places. "
    "The turn-on bias is never added (the same file).",
};

std::string pegasus_text(const SimulatorSource& source, std::span<const std::string> head) {
    const NoiseProjection& noise = source.noise[0];
    const double correlation_s =
        noise.gauss_markov.sigma_rad_per_s > 0.0 ? noise.gauss_markov.correlation_s : 1000.0;
    return commented_for_python(head) +
           fmt::format(
               "imu_config = {{\n    \"update_rate\": {0:.9g},  # Hz\n    \"gyroscope\": {{\n"
               "        \"noise_density\": {1:.9g},  # rad/s/sqrt(Hz)\n"
               "        \"random_walk\": {2:.9g},  # rad/s*sqrt(Hz)\n"
               "        \"bias_correlation_time\": {3:.9g},  # s\n"
               "        \"turn_on_bias_sigma\": 0.0,\n    }},\n"
               "    \"accelerometer\": {{\"bias_correlation_time\": {3:.9g}}},  # s: acts on the gyro\n}}\n",
               source.rate_hz, noise.N_rad_per_sqrt_s, noise.drive_rad_per_s_sqrt_s(), correlation_s);
}

}  // namespace

constinit const SimulatorFormat pegasus_format = {
    .name = "pegasus",
    .summary = "Pegasus Simulator: the IMU's configuration in Python",
    .abilities = {.noise = ProjectedTerms::white_gauss_markov, .per_axis = false, .bias = false},
    .facts = pegasus_facts,
    .text = pegasus_text,
};

}  // namespace gyrolog
