#include <cmath>

#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/three_numbers.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view gnss_ins_sim_facts[] = {
    "deg/h and deg/sqrt(h); gyro_b_stability is the standard deviation of a Gauss-Markov process, which "
    "begins "
    "at zero (gnss-ins-sim, gnss_ins_sim/sim/imu_model.py at dc4da27e97fb; pathgen/pathgen.py, bias_drift).",
    "A correlation time that is left out or infinite makes white noise of it, no random walk (the same).",
    "The accelerometer's three numbers are needed there; the model has none, and they are zero.",
};

std::string gnss_ins_sim_text(const SimulatorSource& source, std::span<const std::string> head) {
    Vector3 bias_deg_h{};
    Vector3 arw_deg_sqrt_h{};
    Vector3 sd_deg_h{};
    Vector3 correlation_s{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const NoiseProjection& noise = source.noise[axis];
        bias_deg_h[axis] = source.bias_rad_s[axis] * deg_per_rad * s_per_h;
        arw_deg_sqrt_h[axis] = noise.N_rad_per_sqrt_s * deg_per_rad * std::sqrt(s_per_h);
        sd_deg_h[axis] = noise.gauss_markov.sigma_rad_per_s * deg_per_rad * s_per_h;
        correlation_s[axis] =
            noise.gauss_markov.sigma_rad_per_s > 0.0 ? noise.gauss_markov.correlation_s : 100.0;
    }
    return commented_for_python(head) +
           fmt::format(
               "import numpy as np\nfrom gnss_ins_sim.sim import imu_model\n\n"
               "fs = {:.9g}  # Hz\nimu_err = {{\n    'gyro_b': np.array([{}]),  # deg/h\n"
               "    'gyro_arw': np.array([{}]),  # deg/sqrt(h)\n"
               "    'gyro_b_stability': np.array([{}]),  # deg/h\n"
               "    'gyro_b_corr': np.array([{}]),  # s\n    'accel_b': np.zeros(3),\n"
               "    'accel_vrw': np.zeros(3),\n    'accel_b_stability': np.zeros(3),\n"
               "    'accel_b_corr': np.full(3, 100.0),\n}}\n"
               "imu = imu_model.IMU(accuracy=imu_err, axis=6, gps=False)\n",
               source.rate_hz, three_numbers(bias_deg_h), three_numbers(arw_deg_sqrt_h),
               three_numbers(sd_deg_h), three_numbers(correlation_s));
}

}  // namespace

constinit const SimulatorFormat gnss_ins_sim_format = {
    .name = "gnss-ins-sim",
    .summary = "gnss-ins-sim: the IMU's error model, in Python",
    .abilities = {.noise = ProjectedTerms::white_gauss_markov},
    .facts = gnss_ins_sim_facts,
    .text = gnss_ins_sim_text,
};

}  // namespace gyrolog
