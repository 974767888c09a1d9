// A gyro's scale, misalignment, bias and g-sensitivity from rests, turns and moves.
//
// y = M w + b + K f. The mean over a time whose rate is known is one equation an axis, linear in all
// parameters: a rest (w = 0), a turn by a known angle about an upright axis (w = angle / time along gravity;
// F. Ferraris, U. Grimaldi, M. Parvis, Sensors and Materials 7 (1995) 311-330), a block of a reference's
// rate. A move between two rests takes gravity's direction along: u' = -w x u with w = M^-1 (y - b - K f),
// row by row by the rotation of the mean of two rates, must end where the accelerometer sees it (Tedaldi,
// Pretto, Menegatti, ICRA 2014, eq. 12); that tells of turns by hand about any axis that is not upright, and
// needs no angle. All in one least squares, each equation over its sigma.
//
// What is of one kind is weighted together: where a kind's chi-squared is less likely than `chance_least`,
// its sigmas are raised until it is as large as its redundancy (W. Foerstner, Z. Vermessungswesen 104 (1979)
// 446-453, the variance component of a group), one kind at a time, so that a hand's turns do not spoil the
// rests.
//
// What of M the motion does not determine (knowledge.hpp) stays as in the identity, and K stays 0
// if the rests' poses do not determine all of it. The Earth's rate, up to 0.0042 deg/s, is not modelled: in
// turns of poses it acts as noise of b and K.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/calibrate/gyro_observations.hpp"
#include "analysis/calibrate/knowledge.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/numerics/matrix.hpp"
#include "analysis/recording/standard_gravity.hpp"

namespace gyrolog {

// A g-sensitivity in s/m times this is in deg/s per g.
inline constexpr double dps_per_g_in_s_per_m = deg_per_rad * standard_gravity_m_s2;

struct GyroFitOptions {
    SensorTolerance tolerance;
    double chance_least = 0.01;
    // Of a parameter's prior deviation, the step of derivatives by differences: far above rounding, and far
    // below what bends.
    double step_of_prior = 1e-3;
    // Of the logarithm of a factor of sigmas: less is no reason to weight again.
    double factor_settled = 0.02;
    int weightings_most = 40;  // each makes the sigmas of one kind right to first order
};

struct ObservationFit {
    ObservationKind kind = ObservationKind::rest;
    std::size_t count = 0;
    double rms = 0.0;         // of residuals: rad/s of means, rad of gravity's direction
    double sd_factor = 1.0;   // by which their sigmas were raised
    double redundancy = 0.0;  // equations less their share of the parameters
};

struct GyroCalibration {
    Vector3 bias_rad_s{};
    Vector3 bias_sd_rad_s{};
    std::array<bool, 3> has_scale{};  // M_ii is determined
    Matrix3 M = identity_matrix;
    Matrix3 M_sd{};  // 0: not determined, the identity's
    bool has_g_sensitivity = false;
    Matrix3 K_s_per_m{};  // rad/s per m/s^2: row of the gyro's axis, column of the force's
    Matrix3 K_sd_s_per_m{};

    std::vector<std::string> names;  // of the parameters: "bias_x", "K_xy", "M_xy"
    Matrix covariance;
    std::vector<ObservationFit> fits;
};

struct GyroResult {
    std::optional<GyroCalibration> calibration;  // none without a rest or a reference
    std::vector<std::string> undetermined;       // "scale and misalignment of turns about x", "g-sensitivity"
};

GyroResult fit_gyro(const GyroObservations& observations, const GyroFitOptions& options = {});

}  // namespace gyrolog
