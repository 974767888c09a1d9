#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view facts[] = {
    "stddev is per sample, so that update_rate belongs to it. dynamic_bias_stddev is no standard deviation "
    "but "
    "the density that drives the bias, rad/s*sqrt(Hz); the bias begins at rest "
    "(gz-sensors, src/GaussianNoiseModel.cc, ApplyImpl).",
    "The bias is in mean: bias_mean changes its sign in half of all runs, and decays with the correlation "
    "time "
    "(the same file, Load and ApplyImpl; the sign also at b394cc612d26).",
    "precision below 1e-6 rad/s is taken for none (the same file, Load).",
    "Put the sensor element into a link of a model.",
};

std::string axis_text(const SimulatorSource& source, std::size_t axis) {
    const NoiseProjection& noise = source.noise[axis];
    const char* const name = axis_names[axis];
    const bool rounds = source.lsb_rad_s > 0.0;
    std::string text = fmt::format(
        "        <{}>\n          <noise type=\"{}\">\n            <mean>{:.9g}</mean>\n"
        "            <stddev>{:.9g}</stddev>\n",
        name, rounds ? "gaussian_quantized" : "gaussian", source.bias_rad_s[axis],
        source.sample_sd_rad_s(axis));
    if (noise.gauss_markov.sigma_rad_per_s > 0.0) {
        text += fmt::format(
            "            <dynamic_bias_stddev>{:.9g}</dynamic_bias_stddev>\n"
            "            <dynamic_bias_correlation_time>{:.9g}</dynamic_bias_correlation_time>\n",
            noise.drive_rad_per_s_sqrt_s(), noise.gauss_markov.correlation_s);
    }
    if (rounds) { text += fmt::format("            <precision>{:.9g}</precision>\n", source.lsb_rad_s); }
    return text + fmt::format("          </noise>\n        </{}>\n", name);
}

std::string sdf_text(const SimulatorSource& source, std::span<const std::string> head) {
    std::string text = "<?xml version=\"1.0\"?>\n" + xml_commented(head) +
                       fmt::format(
                           "<sdf version=\"1.7\">\n  <model name=\"imu\">\n    <link name=\"imu_link\">\n"
                           "    <sensor name=\"imu\" type=\"imu\">\n"
                           "      <always_on>1</always_on>\n      <update_rate>{:.9g}</update_rate>\n"
                           "      <imu>\n      <angular_velocity>\n",
                           source.rate_hz);
    for (std::size_t axis = 0; axis < 3; ++axis) { text += axis_text(source, axis); }
    return text + "      </angular_velocity>\n      </imu>\n    </sensor>\n    </link>\n  </model>\n</sdf>\n";
}

}  // namespace

constinit const SimulatorFormat sdf_format = {
    .name = "sdf",
    .summary = "gz-sensors and Gazebo classic: an imu sensor in SDF",
    .abilities = {.noise = ProjectedTerms::white_gauss_markov, .rounds = true},
    .facts = facts,
    .text = sdf_text,
};

}  // namespace gyrolog
