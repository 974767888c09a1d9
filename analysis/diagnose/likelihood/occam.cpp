#include "analysis/diagnose/likelihood/occam.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog {

double parameter_cost_nats(double range, double sd) {
    if (!(sd > 0.0) || !(range > 0.0)) { return 0.5; }
    return std::max(0.5, std::log(range / (sd * std::sqrt(2.0 * std::numbers::pi))));
}

double joint_parameter_cost_nats(const Matrix& information, std::span<const double> ranges) {
    Matrix scaled(ranges.size(), ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        for (std::size_t j = 0; j < ranges.size(); ++j) {
            scaled(i, j) = ranges[i] * information(i, j) * ranges[j] / (2.0 * std::numbers::pi);
        }
    }
    double cost_nats = 0.0;
    for (const double value : symmetric_eigenvalues(scaled)) {
        cost_nats += value > 0.0 ? std::max(0.5, 0.5 * std::log(value)) : 0.5;
    }
    return cost_nats;
}

}  // namespace gyrolog
