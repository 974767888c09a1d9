#include <cmath>

#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/three_numbers.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view navego_facts[] = {
    "SI, as gyro_gen() wants them: not for imu_si_errors(). g_std is per sample (NaveGo, "
    "simulation/gyro_gen.m, "
    "f91a1353901b).",
    "The random walk steps by arrw dt, where a walk of density K steps by K sqrt(dt): arrw is K / sqrt(dt), "
    "and "
    "belongs to imu.freq (simulation/noise_rrw.m, 0dab41f5ee4d).",
    "The dynamic bias is off: it begins at its full size, and its steps have a factor dt too much "
    "(simulation/noise_b_dyn.m, d47eac3c6155). The static bias is drawn, not given: add it to the output.",
};

std::string navego_text(const SimulatorSource& source, std::span<const std::string> head) {
    Vector3 sd_rad_s{};
    Vector3 walk{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sd_rad_s[axis] = source.sample_sd_rad_s(axis);
        walk[axis] = source.noise[axis].K_rad_per_s_sqrt_s * std::sqrt(source.rate_hz);
    }
    return commented(head, "%") +
           fmt::format(
               "imu.freq = {:.9g};  % Hz\nimu.g_std = [{}];  % rad/s\nimu.arrw = [{}];  % rad/s^2\n"
               "imu.gb_sta = [0 0 0];  % rad/s\nimu.gb_dyn = [0 0 0];  % rad/s\n"
               "imu.gb_corr = [Inf Inf Inf];  % s\ngyro_bias = [{}];  % rad/s, for the output\n",
               source.rate_hz, three_numbers(sd_rad_s, " "), three_numbers(walk, " "),
               three_numbers(source.bias_rad_s, " "));
}

}  // namespace

constinit const SimulatorFormat navego_format = {
    .name = "navego",
    .summary = "NaveGo: the fields of an imu structure, in MATLAB",
    .abilities = {.noise = ProjectedTerms::white_walk},
    .facts = navego_facts,
    .text = navego_text,
};

}  // namespace gyrolog
