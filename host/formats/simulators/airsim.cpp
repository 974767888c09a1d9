#include <cmath>

#include <nlohmann/json.hpp>

#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr double s_per_h = 3600.0;
// The walk is GyroBiasStability / sqrt(tau), and nothing else is made of tau.
constexpr double tau_s = 100.0;

constexpr std::string_view facts[] = {
    "deg/sqrt(h) and deg/h; the bias is a random walk of density GyroBiasStability / "
    "sqrt(GyroBiasStabilityTau), "
    "no Gauss-Markov process (AirSim, AirLib/include/sensors/imu/ImuSimple.hpp, 04c4bf969f6b, and "
    "ImuSimpleParams.hpp, 006d4e2ac54f).",
    "Read more often than 1000 times a second, white noise is too small and the walk too large: no step "
    "counts "
    "as shorter than 1 ms (the same, min_sample_time). The constant bias cannot be set there.",
};

std::string airsim_text(const SimulatorSource& source, std::span<const std::string> head) {
    const NoiseProjection& noise = source.noise[0];
    nlohmann::ordered_json settings;
    settings["_gyrolog"] = std::vector<std::string>(head.begin(), head.end());
    settings["SettingsVersion"] = 1.2;
    nlohmann::ordered_json& imu = settings["DefaultSensors"]["Imu"];
    imu["SensorType"] = 2;
    imu["Enabled"] = true;
    imu["GenerateNoise"] = true;
    imu["AngularRandomWalk"] = noise.N_rad_per_sqrt_s * deg_per_rad * std::sqrt(s_per_h);
    imu["GyroBiasStabilityTau"] = tau_s;
    imu["GyroBiasStability"] = noise.K_rad_per_s_sqrt_s * std::sqrt(tau_s) * deg_per_rad * s_per_h;
    return settings.dump(2) + '\n';
}

}  // namespace

constinit const SimulatorFormat airsim_format = {
    .name = "airsim",
    .summary = "AirSim and Colosseum: settings.json",
    .abilities = {.noise = ProjectedTerms::white_walk, .per_axis = false, .bias = false},
    .facts = facts,
    .text = airsim_text,
};

}  // namespace gyrolog
