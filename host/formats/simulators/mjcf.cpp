#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/three_numbers.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view facts[] = {
    "MuJoCo from 3.1.4 on adds no noise: noise is a note there. The lines in Python below add it, and the "
    "bias, to "
    "what the sensor reads; the error above is theirs (MuJoCo, changelog of 3.1.4, item 1; XML reference, "
    "sensor).",
    "Before 3.1.4 it adds noise where <flag sensornoise=\"enable\"/> stands in the option element, of one "
    "size for all axes: here that of the noisiest (MuJoCo, src/engine/engine_sensor.c, add_noise, "
    "01a932e052f5).",
    "From 3.5 on a body may have shorter steps than the sensor: take the gyro in the comment below, which is "
    "read every interval and shown with delay. nsample belongs to both: without it interval is not heeded, "
    "and with fewer the delay is shorter (seen in 3.14.0).",
    "cutoff is the range. Or put libgyrolog-sensor into the loop, which has the whole model.",
};

double noisiest_rad_s(const SimulatorSource& source) {
    double sd_rad_s = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sd_rad_s = std::max(sd_rad_s, source.sample_sd_rad_s(axis));
    }
    return sd_rad_s;
}

std::string range_text(const SimulatorSource& source) {
    return source.full_scale_rad_s > 0.0 ? fmt::format(" cutoff=\"{:.9g}\"", source.full_scale_rad_s) : "";
}

// For versions that have delay and interval. What is kept reaches back to the reading that is shown.
std::string late_gyro_text(const SimulatorSource& source) {
    const double periods = std::ceil(source.latency_s * source.rate_hz);
    return fmt::format(
        "    <gyro name=\"gyro\" site=\"imu\" noise=\"{:.9g}\"{} interval=\"{:.9g}\" delay=\"{:.9g}\" "
        "nsample=\"{:.0f}\"/>\n",
        noisiest_rad_s(source), range_text(source), 1.0 / source.rate_hz, source.latency_s, periods + 1.0);
}

std::string python_text(const SimulatorSource& source) {
    Vector3 sd_rad_s{};
    Vector3 keep{};
    Vector3 drive_rad_s{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const GaussMarkov& slow = source.noise[axis].gauss_markov;
        sd_rad_s[axis] = source.sample_sd_rad_s(axis);
        if (slow.sigma_rad_per_s == 0.0) { continue; }
        const double steps = 1.0 / (slow.correlation_s * source.rate_hz);
        keep[axis] = std::exp(-steps);
        drive_rad_s[axis] = slow.sigma_rad_per_s * std::sqrt(-std::expm1(-2.0 * steps));
    }
    return fmt::format(
        "  import numpy as np\n  random = np.random.default_rng(1)\n  drift = np.zeros(3)\n"
        "  def gyro(data):  # once a sample, {:.9g} times a second\n      global drift\n"
        "      drift = np.array([{}]) * drift + np.array([{}]) * random.standard_normal(3)\n"
        "      return (data.sensor('gyro').data + np.array([{}]) + drift\n"
        "              + np.array([{}]) * random.standard_normal(3))\n",
        source.rate_hz, three_numbers(keep), three_numbers(drive_rad_s), three_numbers(source.bias_rad_s),
        three_numbers(sd_rad_s));
}

std::string mjcf_text(const SimulatorSource& source, std::span<const std::string> head) {
    return "<?xml version=\"1.0\"?>\n" + xml_commented(head) + "<!--\n" + late_gyro_text(source) +
           python_text(source) + "-->\n" +
           fmt::format(
               "<mujoco model=\"imu\">\n  <option timestep=\"{:.9g}\"/>\n  <worldbody>\n    <body "
               "name=\"imu\">\n"
               "      <freejoint/>\n      <geom type=\"box\" size=\".01 .01 .01\" mass=\".01\"/>\n"
               "      <site name=\"imu\"/>\n    </body>\n  </worldbody>\n  <sensor>\n"
               "    <gyro name=\"gyro\" site=\"imu\" noise=\"{:.9g}\"{}/>\n  </sensor>\n</mujoco>\n",
               1.0 / source.rate_hz, noisiest_rad_s(source), range_text(source));
}

}  // namespace

constinit const SimulatorFormat mjcf_format = {
    .name = "mjcf",
    .summary = "MuJoCo: a gyro in MJCF, with its noise in Python",
    .abilities = {.noise = ProjectedTerms::white_gauss_markov, .clips = true},
    .facts = facts,
    .text = mjcf_text,
};

}  // namespace gyrolog
