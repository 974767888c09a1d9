// Which parameters of a fit the data tell, and which only a data sheet does.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

// What one knows of a sensor before it is measured, one sigma: the tolerances of an MPU-9250
// (PS-MPU-9250A-01 rev. 1.1, tables 1 and 2: sensitivity +-3 %, cross-axis +-2 %, zero-rate output +-5 deg/s,
// zero-g output +-60 mg). The rate that follows the specific force is not in it; 0.1 deg/s/g is a usual one.
struct SensorTolerance {
    double scale = 0.03;
    double cross_axis = 0.02;
    double bias_rad_s = 0.0872664625997;       // 5 deg/s
    double bias_m_s2 = 0.588399;               // 60 mg
    double g_sensitivity_s_per_m = 1.7797e-4;  // 0.1 deg/s/g
    // A parameter is determined where the data leave less than this share of its tolerance.
    double share_most = 0.5;  // of a standard deviation: three quarters of the variance come from the data
};

// What is left of the prior deviations after the data: (S I S + 1)^-1, I the data's Fisher information and S
// the prior deviations. The identity: the data say nothing.
Matrix covariance_left(const Matrix& information, std::span<const double> prior_sd);

// The parameters of which the data leave more than `share_most` of the prior deviation: by themselves, or, if
// only a combination of them is open (an eigenvalue of the covariance), the one that has most part in it.
// None: all are determined.
std::vector<std::size_t> undetermined(const Matrix& information, std::span<const double> prior_sd,
                                      double share_most);

// J'J.
Matrix information_of(const Matrix& derivatives);

}  // namespace gyrolog
