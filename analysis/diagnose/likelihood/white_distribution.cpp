#include "analysis/diagnose/likelihood/white_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

namespace {

double log_likelihood(const WhitenedHistogram& histogram, const LogDensityTable& log_density,
                      double log_scale) {
    const double per_scale = std::exp(-log_scale);
    double sum = -histogram.samples * log_scale;
    for (std::size_t i = 0; i < histogram.at.size(); ++i) {
        if (histogram.count[i] > 0.0) {
            sum += histogram.count[i] * log_density(histogram.at[i] * per_scale);
        }
    }
    return sum;
}

}  // namespace

double white_degrees_of_freedom(const Prediction& prediction, std::size_t axis) {
    double nu = std::numeric_limits<double>::infinity();
    for (const EffectModel& entry : prediction.model().effects) {
        const EffectSignature* signature = find_effect(entry.effect)->signature;
        if (signature == nullptr || signature->degrees_of_freedom == nullptr) { continue; }
        if (acts_on(entry, axis)) { nu = signature->degrees_of_freedom(EffectValues(entry)); }
    }
    return nu;
}

NormalMixture whitened_mixture(const Prediction& prediction, std::size_t axis, double nu) {
    const WhiteShare share = white_share(prediction, axis);
    return {nu, share.own_variance, share.lattice};
}

ScaledFit fit_scale(const WhitenedHistogram& histogram, const LogDensityTable& log_density, double start) {
    double middle = std::log(start);
    double at_middle = log_likelihood(histogram, log_density, middle);
    double step = 0.02;
    for (int iteration = 0; iteration < 40; ++iteration) {
        const double below = log_likelihood(histogram, log_density, middle - step);
        const double above = log_likelihood(histogram, log_density, middle + step);
        const double curvature = 2.0 * at_middle - below - above;
        const double slope = above - below;
        double move = slope > 0.0 ? step : -step;
        if (curvature > 0.0) { move = std::clamp(0.5 * step * slope / curvature, -0.4, 0.4); }
        const double there = log_likelihood(histogram, log_density, middle + move);
        if (!(there > at_middle)) {
            if (step < 1e-3) { break; }
            step *= 0.25;
            continue;
        }
        const double gained = there - at_middle;
        middle += move;
        at_middle = there;
        if (gained < 1e-3) { break; }
        step = std::clamp(std::fabs(move), 1e-3, 0.05);
    }
    return {at_middle, std::exp(middle)};
}

}  // namespace gyrolog
