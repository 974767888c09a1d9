// An accelerometer's scale, misalignment and bias from rests, in which the specific force has the size of
// gravity and any direction: no face has to be level.
//
// y = M a + b, a the specific force in orthogonal axes. M is lower triangular: a's x axis is the sensor's x
// axis, and a's y axis lies in the plane of the sensor's x and y. A rotation of all three is not to be told
// from |a| alone (I. Frosio, F. Pedersini, N. A. Borghese, IEEE Trans. Instrum. Meas. 58 (2009) 2034-2041;
// triangular as in D. Tedaldi, A. Pretto, E. Menegatti, ICRA 2014, eqs. 1-5, whose correction is our M^-1).
//
// Least squares of (|M^-1 (y - b)| - g) / sigma, sigma that of the rest's mean along the force. Rests say of
// six parameters (scale and bias) with as few as six faces, of nine with nine poses; where they leave more
// than half of what a data sheet leaves open (knowledge.hpp), a parameter is not determined. Then M has no
// misalignment, or there is no answer.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/calibrate/knowledge.hpp"
#include "analysis/calibrate/pose_advice.hpp"
#include "analysis/calibrate/rests.hpp"
#include "analysis/numerics/matrix.hpp"
#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct AccelerometerFitOptions {
    double gravity_m_s2 = standard_gravity_m_s2;
    SensorTolerance tolerance;
    // Residuals whose chi-squared is less likely than this are larger than the means' scatter: the covariance
    // is then that of the residuals (Birge's ratio; R. T. Birge, Phys. Rev. 40 (1932) 207).
    double chance_least = 0.01;
    std::size_t poses_advised = 3;
    std::size_t poses_most = 12;  // nine parameters ask for nine poses; more is no advice
};

struct AccelerometerCalibration {
    Matrix3 M = identity_matrix;
    Matrix3 M_sd{};  // 0 where it is no parameter
    Vector3 bias_m_s2{};
    Vector3 bias_sd_m_s2{};
    bool has_misalignment = false;

    // Of the parameters in the order of `names`.
    std::vector<std::string> names;  // "M_xx", "M_yx", ..., "bias_x"
    Matrix covariance;

    std::vector<double> residual_m_s2;  // of each rest: the size that comes out less gravity's
    double rms_m_s2 = 0.0;
    double chi_squared = 0.0;
    double degrees = 0.0;    // rests less parameters
    double sd_factor = 1.0;  // by which the means' scatter was too small; in the covariance
};

struct AccelerometerResult {
    std::optional<AccelerometerCalibration> calibration;
    std::vector<std::string> undetermined;  // "scale x", "misalignment of y from x", "bias z"
    std::vector<PoseAdvice> advice;         // the poses to record next, the best one first
};

AccelerometerResult fit_accelerometer(std::span<const Rest> rests, const MeanScatter& scatter,
                                      const AccelerometerFitOptions& options = {});

}  // namespace gyrolog
