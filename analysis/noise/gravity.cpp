#include "analysis/noise/gravity.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/noise/noise_model.hpp"
#include "analysis/numerics/square.hpp"

namespace gyrolog {
namespace {

// Of sum_i weight_i f_i.
ExpandedNumber with_uncertainty_of(double value, const std::array<AxisMean, 3>& axes,
                                   const std::array<double, 3>& weights) {
    double variance = 0.0;
    double variance_of_variance = 0.0;  // over 2
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const StaticBias& mean = axes[i].mean;
        const double share = square(weights[i] * mean.expanded_uncertainty / mean.coverage_factor);
        variance += share;
        if (axes[i].dof > 0.0) { variance_of_variance += square(share) / axes[i].dof; }
    }
    const double dof = variance_of_variance > 0.0 ? square(variance) / variance_of_variance : 0.0;
    const double factor = coverage_factor(dof);
    return {value, factor * std::sqrt(variance), factor};
}

double standard_uncertainty(const AxisMean& axis) {
    return axis.mean.expanded_uncertainty / axis.mean.coverage_factor;
}

// The unit vector across `direction` along which the tilt from axis `up` grows.
std::array<double, 3> across(const std::array<double, 3>& direction, std::size_t up,
                             const std::array<AxisMean, 3>& axes) {
    std::array<double, 3> level{};
    const std::size_t a = (up + 1) % 3;
    const std::size_t b = (up + 2) % 3;
    const double sine = std::hypot(direction[a], direction[b]);
    if (sine == 0.0) {
        level[standard_uncertainty(axes[a]) > standard_uncertainty(axes[b]) ? a : b] = 1.0;
        return level;
    }
    const double cosine = std::abs(direction[up]);
    level[a] = cosine * direction[a] / sine;
    level[b] = cosine * direction[b] / sine;
    level[up] = direction[up] > 0.0 ? -sine : sine;
    return level;
}

}  // namespace

const char* Gravity::up_name() const {
    constexpr std::array names = {"+x", "-x", "+y", "-y", "+z", "-z"};
    return names[2 * up_axis + (up_is_negative ? 1 : 0)];
}

Gravity gravity_of(const std::array<AxisMean, 3>& axes) {
    Gravity gravity;
    const double size = std::hypot(axes[0].mean.value, axes[1].mean.value, axes[2].mean.value);
    if (!(size > 0.0)) { return gravity; }
    for (std::size_t i = 0; i < 3; ++i) {
        gravity.direction[i] = axes[i].mean.value / size;
        if (std::abs(gravity.direction[i]) > std::abs(gravity.direction[gravity.up_axis])) {
            gravity.up_axis = i;
        }
    }
    gravity.up_is_negative = gravity.direction[gravity.up_axis] < 0.0;
    gravity.size = with_uncertainty_of(size, axes, gravity.direction);

    const double sine = std::hypot(gravity.direction[(gravity.up_axis + 1) % 3],
                                   gravity.direction[(gravity.up_axis + 2) % 3]);
    const double tilt_rad = std::atan2(sine, std::abs(gravity.direction[gravity.up_axis]));
    std::array<double, 3> weights = across(gravity.direction, gravity.up_axis, axes);
    for (double& weight : weights) { weight /= size; }
    gravity.tilt_rad = with_uncertainty_of(tilt_rad, axes, weights);
    gravity.tilt_rad.expanded_uncertainty = std::min(gravity.tilt_rad.expanded_uncertainty, pi);
    return gravity;
}

}  // namespace gyrolog
