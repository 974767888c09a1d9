#include <cmath>

#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/three_numbers.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view genesis_facts[] = {
    "Noise and walk are per step of the scene, so that the rate above belongs to them; the walk begins at "
    "zero "
    "(Genesis, genesis/engine/sensors/base_sensor.py, _add_noise_drift_bias; imu.py at f8c684abf052).",
    "gyro_axes_skew is the matrix from true to measured rate; delay is in s (imu.py, _update_shared_cache).",
};

std::string genesis_text(const SimulatorSource& source, std::span<const std::string> head) {
    Vector3 sd_rad_s{};
    Vector3 walk_rad_s{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sd_rad_s[axis] = source.sample_sd_rad_s(axis);
        walk_rad_s[axis] = source.noise[axis].K_rad_per_s_sqrt_s / std::sqrt(source.rate_hz);
    }
    return commented_for_python(head) +
           fmt::format(
               "import genesis as gs\n\n\ndef imu_options(entity_idx, link_idx_local=0):\n"
               "    return gs.sensors.IMU(\n        entity_idx=entity_idx,\n"
               "        link_idx_local=link_idx_local,\n"
               "        gyro_noise=({}),  # rad/s a step\n        gyro_random_walk=({}),  # rad/s a step\n"
               "        gyro_bias=({}),  # rad/s\n        gyro_resolution={:.9g},  # rad/s\n"
               "        gyro_axes_skew=(({}), ({}), ({})),\n        delay={:.9g},  # s\n    )\n",
               three_numbers(sd_rad_s), three_numbers(walk_rad_s), three_numbers(source.bias_rad_s),
               source.lsb_rad_s, three_numbers(source.M[0]), three_numbers(source.M[1]),
               three_numbers(source.M[2]), source.latency_s);
}

}  // namespace

constinit const SimulatorFormat genesis_format = {
    .name = "genesis",
    .summary = "Genesis: the options of an IMU, in Python",
    .abilities = {.noise = ProjectedTerms::white_walk, .rounds = true, .cross_axis = true, .delays = true},
    .facts = genesis_facts,
    .text = genesis_text,
};

}  // namespace gyrolog
