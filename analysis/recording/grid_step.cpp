#include "analysis/recording/grid_step.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace gyrolog {
namespace {

// A converter's steps are looked for among so many different values at most.
constexpr std::size_t most_steps = 1U << 16U;
// Of a step: how far printed decimals may put a value from its place on the grid.
constexpr double grid_tolerance = 0.05;

}  // namespace

double grid_step(std::span<const double> values) {
    constexpr std::size_t least_values = 4;
    std::set<double> different;
    for (const double value : values) {
        if (std::isnan(value)) { continue; }
        different.insert(value);
        // Values on a grid repeat: this many samples without are enough to know.
        if (different.size() > most_steps ||
            (different.size() > 1000 && different.size() * 2 > values.size())) {
            return 0.0;
        }
    }
    if (different.size() < least_values) { return 0.0; }
    double step = *different.rbegin() - *different.begin();
    for (auto low = different.begin(), high = std::next(low); high != different.end(); ++low, ++high) {
        step = std::min(step, *high - *low);
    }
    // The smallest distance carries the decimals' rounding; the whole range divides it out.
    const double range = *different.rbegin() - *different.begin();
    double refined = step;
    for (auto high = std::next(different.begin()); high != different.end(); ++high) {
        const double distance = *high - *different.begin();
        const double steps = std::round(distance / refined);
        if (std::abs(distance - steps * refined) > grid_tolerance * refined) { return 0.0; }
        refined = distance / steps;
    }
    return range / std::round(range / refined);
}

double grid_step(const Column& column) {
    const auto* reals = std::get_if<std::vector<double>>(&column.data);
    return std::abs(column.scale) * (reals != nullptr ? grid_step(*reals) : 1.0);
}

}  // namespace gyrolog
