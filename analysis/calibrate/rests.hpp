// The rests of a recording, and what happens between them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/calibrate/inertial_signals.hpp"
#include "analysis/noise/converter_step.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

struct RestOptions {
    double block_s = 0.25;         // a hand sets a sensor down within it
    std::size_t blocks_least = 4;  // a rest of a second, of which the edges are left out (still_runs.hpp)
    // A constant rate has no scatter either. A rest's mean rate is within this of the slowest one's: the
    // zero-rate output's tolerance of an MPU-9250 (PS-MPU-9250A-01 rev. 1.1, table 1).
    double rate_most_rad_s = 5.0 * rad_per_deg;
    // Nor is the reference's, where there is one: a tenth of that, many times the noise of its mean.
    double reference_most_rad_s = 0.5 * rad_per_deg;
    // A slow tilt is no rest: between the first and the last quarter of a rest the force turns by less, in
    // proportion where they are farther apart than that. What the temperature does to the bias is slower.
    double tilt_most_rad = 0.5 * rad_per_deg;
    double tilt_s = 10.0;
    // Parts of a rest, whose means tell how well its mean is known: noise as slow as an eighth of a rest, and
    // seven degrees of freedom of each.
    std::size_t parts = 8;
    // Of the converter's step: noise of less leaves an error of rounding that no averaging takes off
    // (converter_step.hpp).
    double sd_in_steps_least = least_sd_in_steps;
    // No mean is known better: the resolution of the best part of that class, 1 ug and 0.2 deg/h.
    double force_sd_least_m_s2 = 1e-5;
    double rate_sd_least_rad_s = 1e-6;
};

struct Rest {
    std::size_t recording = 0;  // of those that were given
    std::size_t first = 0;      // row
    std::size_t rows = 0;
    double from_s = 0.0;  // from the recording's first sampling instant
    double duration_s = 0.0;
    Vector3 force_m_s2{};  // means; 0 without the sensor
    Vector3 rate_rad_s{};
    std::optional<double> temperature_C;
};

// Between two rests of one recording that follow each other. All rows of it are there.
struct Move {
    std::size_t before = 0;  // rests
    std::size_t after = 0;
};

// How well a mean over T seconds is known: density / sqrt(T), by axis. From the means of a rest's eight
// parts, whose variance is that of noise as slow as an eighth of a rest; pooled over all rests.
struct MeanScatter {
    Vector3 force_m_s2_sqrt_s{};
    Vector3 rate_rad_s_sqrt_s{};
    // What no averaging takes off: where the noise hardly moves the numbers over the converter's steps, a
    // mean is off by as much as one sample is, step / sqrt(12) (Widrow and Kollar, Quantization Noise, 2008).
    Vector3 force_floor_m_s2{};
    Vector3 rate_floor_rad_s{};
    double force_degrees = 0.0;  // of freedom, an axis
    double rate_degrees = 0.0;

    // Of a mean, one sigma.
    Vector3 force_sd_m_s2(double duration_s) const;
    Vector3 rate_sd_rad_s(double duration_s) const;
};

struct Phases {
    std::vector<Rest> rests;
    std::vector<Move> moves;
    MeanScatter scatter;
};

Phases find_phases(std::span<const InertialSignals> recordings, const RestOptions& options = {});

}  // namespace gyrolog
