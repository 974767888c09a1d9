// What a simulator's file is written from: a sensor model, its noise put into the terms that the simulator
// has. SI units.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/noise_projection.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// What a simulator's sensor has. What it lacks is told in the head of its file.
struct SimulatorAbilities {
    std::optional<ProjectedTerms> noise;  // none: no noise at all
    bool projects = true;                 // what it lacks into what it has; otherwise N and K as they are
    bool per_axis = true;                 // its own numbers for each axis
    bool bias = true;                     // a constant one that is given, not drawn
    bool rounds = false;                  // to the converter's step
    bool clips = false;                   // at full scale
    bool cross_axis = false;              // the matrix from true to measured rate
    bool delays = false;
};

struct SimulatorSource {
    std::string name;  // of the model
    double rate_hz = 0.0;
    double horizon_s = 0.0;
    std::array<NoiseProjection, 3> noise;  // the same for all axes where the simulator has one number
    Vector3 bias_rad_s{};
    double lsb_rad_s = 0.0;
    double full_scale_rad_s = 0.0;  // 0: none
    Matrix3 M = identity_matrix;
    double latency_s = 0.0;
    std::vector<std::string> left_out;  // of the model, each a noun

    double sample_sd_rad_s(std::size_t axis) const;  // of the white noise, per sample
};

// Noise of one axis, with the effects that are noise: what Allan variances can be stated of. Lines are none.
NoiseModel still_noise(const SensorModel& model, std::size_t axis);

SimulatorSource simulator_source(const SensorModel& model, const std::string& name,
                                 const SimulatorAbilities& abilities, double horizon_s);

// The lines that a file begins with, without comment signs: where it is from, the largest error, what is left
// out.
std::vector<std::string> head_lines(const SimulatorSource& source, const SimulatorAbilities& abilities);

}  // namespace gyrolog
