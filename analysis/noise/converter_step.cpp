#include "analysis/noise/converter_step.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gyrolog {
namespace {

constexpr std::size_t enough_samples = 20000;
constexpr double least_sd_in_steps = 0.4;

// The smallest difference of neighbouring values, if all values are whole multiples of it apart.
double grid_step(const std::vector<double>& data) {
    std::vector<double> values(
        data.begin(), data.begin() + static_cast<std::ptrdiff_t>(std::min(data.size(), enough_samples)));
    std::ranges::sort(values);
    const double range = values.back() - values.front();
    // Numbers printed to six digits or so repeat a value with so much error.
    const double same = std::max(1e-6 * range, 1e-12 * std::abs(values.back()));
    double step = range;
    std::size_t distinct = 1;
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double difference = values[i] - values[i - 1];
        if (difference <= same) { continue; }
        step = std::min(step, difference);
        ++distinct;
    }
    // Values that hardly repeat lie on no grid but that of their printing.
    if (!(step > 0.0) || 4 * distinct > values.size()) { return 0.0; }
    const double steps = range / step;
    if (steps > 1e5) { return 0.0; }
    step = range / std::round(steps);
    constexpr double tolerance = 0.05;
    const bool on_grid = std::ranges::all_of(values, [&](double value) {
        const double place = (value - values.front()) / step;
        return std::abs(place - std::round(place)) < tolerance;
    });
    return on_grid ? step : 0.0;
}

double first_difference_sd(const Column& column) {
    double sum = 0.0;
    const std::size_t count = std::min(column.size(), enough_samples);
    for (std::size_t i = 1; i < count; ++i) { sum += std::pow(column.value(i) - column.value(i - 1), 2); }
    return std::sqrt(sum / (2.0 * static_cast<double>(count - 1)));
}

}  // namespace

double converter_step(const Column& column) {
    if (column.size() < 2) { return 0.0; }
    const auto* reals = std::get_if<std::vector<double>>(&column.data);
    const double step =
        reals != nullptr ? grid_step(*reals) * std::abs(column.scale) : std::abs(column.scale);
    return first_difference_sd(column) > least_sd_in_steps * step ? step : 0.0;
}

}  // namespace gyrolog
