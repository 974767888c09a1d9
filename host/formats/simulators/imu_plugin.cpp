#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view px4_facts[] = {
    "Densities, two-sided, of a sample each simulation step; the bias is a Gauss-Markov process that begins "
    "at "
    "zero and is driven by gyroscopeRandomWalk (PX4-SITL_gazebo-classic, src/gazebo_imu_plugin.cpp, "
    "addNoise, "
    "03fa8f2970dd).",
    "The turn-on bias is drawn, not given, so that the model's bias is not in here (the same file, Load).",
};
constexpr std::string_view rotors_facts[] = {
    "Densities, two-sided, of a sample each simulation step; the bias is a Gauss-Markov process that begins "
    "at "
    "zero and is driven by gyroscopeRandomWalk (rotors_simulator, "
    "rotors_gazebo_plugins/src/gazebo_imu_plugin.cpp, 748268f9a11f).",
    "The turn-on bias is drawn, not given, so that the model's bias is not in here (the same file). The "
    "macros "
    "of rotors_description call the same values gyroscope_noise_density, gyroscope_random_walk, "
    "gyroscope_bias_correlation_time and gyroscope_turn_on_bias_sigma.",
};

// The plugins assert that the correlation time is above zero.
double correlation_s(const NoiseProjection& noise) {
    return noise.gauss_markov.sigma_rad_per_s > 0.0 ? noise.gauss_markov.correlation_s : 1000.0;
}

std::string plugin_text(const SimulatorSource& source, std::span<const std::string> head, const char* name,
                        const char* library) {
    const NoiseProjection& noise = source.noise[0];
    return "<?xml version=\"1.0\"?>\n" + xml_commented(head) +
           fmt::format(
               "<plugin name=\"{}\" filename=\"{}\">\n"
               "  <robotNamespace></robotNamespace>\n  <linkName>imu_link</linkName>\n"
               "  <imuTopic>/imu</imuTopic>\n"
               "  <gyroscopeNoiseDensity>{:.9g}</gyroscopeNoiseDensity>\n"
               "  <gyroscopeRandomWalk>{:.9g}</gyroscopeRandomWalk>\n"
               "  <gyroscopeBiasCorrelationTime>{:.9g}</gyroscopeBiasCorrelationTime>\n"
               "  <gyroscopeTurnOnBiasSigma>0</gyroscopeTurnOnBiasSigma>\n</plugin>\n",
               name, library, noise.N_rad_per_sqrt_s, noise.drive_rad_per_s_sqrt_s(), correlation_s(noise));
}

std::string px4_text(const SimulatorSource& source, std::span<const std::string> head) {
    return plugin_text(source, head, "imu_plugin", "libgazebo_imu_plugin.so");
}
std::string rotors_text(const SimulatorSource& source, std::span<const std::string> head) {
    return plugin_text(source, head, "rotors_gazebo_imu_plugin", "librotors_gazebo_imu_plugin.so");
}

constexpr SimulatorAbilities plugin_abilities = {
    .noise = ProjectedTerms::white_gauss_markov, .per_axis = false, .bias = false};

}  // namespace

constinit const SimulatorFormat px4_classic_format = {
    .name = "px4-classic",
    .summary = "Gazebo classic with PX4: the imu plugin's element",
    .abilities = plugin_abilities,
    .facts = px4_facts,
    .text = px4_text,
};

constinit const SimulatorFormat rotors_format = {
    .name = "rotors",
    .summary = "RotorS: the imu plugin's element",
    .abilities = plugin_abilities,
    .facts = rotors_facts,
    .text = rotors_text,
};

}  // namespace gyrolog
