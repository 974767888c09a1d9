#include "host/formats/stamp_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace gyrolog {
namespace {

// 0: no step rises. Stamps of arrival repeat within a burst.
double median_step(std::span<const double> stamps) {
    constexpr std::size_t looked_at = 1001;
    std::vector<double> steps;
    for (std::size_t i = 1; i < std::min(stamps.size(), looked_at); ++i) {
        const double step = stamps[i] - stamps[i - 1];
        if (step > 0.0 && std::isfinite(step)) { steps.push_back(step); }
    }
    if (steps.empty()) { return 0.0; }
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

}  // namespace

StampUnits plausible_stamp_units(std::span<const double> stamps, double samples_per_row,
                                 const StampUnitOptions& options) {
    const double step = median_step(stamps) / samples_per_row;
    if (!(step > 0.0)) { return {{stamp_units.front()}, 0.0}; }
    std::vector<StampUnit> fitting;
    for (const StampUnit& unit : stamp_units) {
        const double rate_hz = unit.per_s / step;
        if (rate_hz >= options.rate_least_hz && rate_hz <= options.rate_most_hz) { fitting.push_back(unit); }
    }
    if (fitting.size() < 2) { return {std::move(fitting), step}; }
    for (const StampUnit& unit : fitting) {
        const double first_s = stamps.front() / unit.per_s;
        if (first_s >= options.epoch_least_s && first_s <= options.epoch_most_s) { return {{unit}, step}; }
    }
    if (step < 1.0 && fitting.front().per_s == 1.0) { return {{stamp_units.front()}, step}; }
    return {std::move(fitting), step};
}

}  // namespace gyrolog
