#include "analysis/noise/converter_step.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/recording/grid_step.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t enough_samples = 20000;

double first_difference_sd(const Column& column) {
    double sum = 0.0;
    const std::size_t count = std::min(column.size(), enough_samples);
    for (std::size_t i = 1; i < count; ++i) { sum += std::pow(column.value(i) - column.value(i - 1), 2); }
    return std::sqrt(sum / (2.0 * static_cast<double>(count - 1)));
}

}  // namespace

double converter_step(const Column& column) {
    if (column.size() < 2) { return 0.0; }
    const double step = grid_step(column);
    return first_difference_sd(column) > least_sd_in_steps * step ? step : 0.0;
}

}  // namespace gyrolog
