#include "analysis/noise/static_bias.hpp"

#include <cmath>

#include "analysis/allan/prefix_sum.hpp"

namespace gyrolog {

StaticBias static_bias(const Column& column, double rate_hz, const NoiseModel& noise) {
    StaticBias bias;
    const auto samples = static_cast<double>(column.size());
    if (column.size() < 2) { return bias; }
    bias.value = raw_mean(column) * column.scale + column.offset;
    double squares = 0.0;
    for (std::size_t i = 0; i < column.size(); ++i) { squares += std::pow(column.value(i) - bias.value, 2); }
    const double variance = noise.allan_variance(samples / rate_hz);
    bias.expanded_uncertainty = bias.coverage_factor * std::sqrt(variance);
    if (variance > 0.0) { bias.effective_samples = squares / (samples - 1.0) / variance; }
    return bias;
}

}  // namespace gyrolog
