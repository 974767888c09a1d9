// Which poses to record next.
//
// Of the six faces, twelve edges and eight corners of a box, the one that makes the determinant of the
// parameters' covariance smallest (D-optimality): the one whose measurement the fit foresees worst, since the
// determinant falls by 1 + j' C j / sigma^2, j the derivatives (V. V. Fedorov, Theory of Optimal Experiments,
// 1972, ch. 2; Kiefer and Wolfowitz, Canad. J. Math. 12 (1960) 363-366). What a data sheet says of the
// sensor is in C, so that there is an answer with too few poses, too.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/numerics/matrix.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct PoseAdvice {
    Vector3 up{};       // the direction that points upward, in the sensor's axes, of length one
    std::string words;  // "x up", "the edge between x and -z up", "the corner of x, y and -z up"
    // Of the parameter that is known worst against what a data sheet says, before the poses and with this one
    // and those before it.
    std::size_t parameter = 0;
    std::string symbol{};  // of that parameter, by whoever has the parameters
    double sd_before = 0.0;
    double sd_after = 0.0;
};

// The derivatives of a pose's residual over its sigma by the parameters.
using PoseDerivatives = std::function<std::vector<double>(const Vector3& up)>;

// `information`: of the rests that there are, at least one parameter. As many poses as `poses`, or more until
// no parameter is undetermined (knowledge.hpp), `poses_most` at most.
std::vector<PoseAdvice> advise_poses(const Matrix& information, std::span<const double> prior_sd,
                                     double share_most, const PoseDerivatives& derivatives, std::size_t poses,
                                     std::size_t poses_most);

}  // namespace gyrolog
