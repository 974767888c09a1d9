#include "analysis/noise/static_bias.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/allan/prefix_sum.hpp"
#include "analysis/numerics/distributions.hpp"

namespace gyrolog {
namespace {

constexpr double least_dof = 1.0;

}  // namespace

double coverage_factor(double dof) {
    constexpr double upper_tail = 0.02275;  // beyond 2 of a normal distribution
    if (!(dof > 0.0)) { return 2.0; }
    return students_t_upper_quantile(std::clamp(dof, least_dof, 1e9), upper_tail);
}

StaticBias static_bias(const Column& column, double rate_hz, const NoiseFit& fit) {
    StaticBias bias;
    const auto samples = static_cast<double>(column.size());
    if (column.size() < 2) { return bias; }
    const double mean = raw_mean(column);
    bias.value = mean * column.scale + column.offset;
    double fourth = 0.0;
    const double squares = std::visit(
        [&](const auto& data) {
            double sum = 0.0;
            for (const auto x : data) {
                const double square = (static_cast<double>(x) - mean) * (static_cast<double>(x) - mean);
                sum += square;
                fourth += square * square;
            }
            return sum;
        },
        column.data);
    bias.sample_sd = std::abs(column.scale) * std::sqrt(squares / (samples - 1.0));
    if (squares > 0.0) { bias.excess_kurtosis = fourth * samples / (squares * squares) - 3.0; }
    const double variance = fit.sparse.allan_variance(samples / rate_hz);
    bias.coverage_factor = coverage_factor(fit.mean_dof);
    bias.expanded_uncertainty = bias.coverage_factor * std::sqrt(variance);
    if (variance > 0.0) { bias.effective_samples = bias.sample_sd * bias.sample_sd / variance; }
    return bias;
}

}  // namespace gyrolog
