// The whitened samples by ranges of something that every slot has, as the temperature or the rate.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace resolution {

inline constexpr std::size_t value_bins = 12;

}  // namespace resolution

using Edges = std::array<float, resolution::value_bins - 1>;  // between the bins, rising

// Ranges of equal width, and ranges that hold as many samples each.
Edges equal_ranges(const std::vector<float>& at);
Edges equal_counts(const Observation& observation, const std::vector<float>& at);

// Sums over the whitened samples of each range. `at`: the mean of what they are sorted by. A range with 30
// samples or less counts as empty.
struct ValueBins {
    std::array<double, resolution::value_bins> at{}, sum{}, squares{}, count{};
};
ValueBins by_value(const Observation& observation, std::size_t axis, const std::vector<float>& at,
                   const Edges& edges);

// The mean of each range, in standard deviations, and ln of the variance; 0 for an empty range.
GapCurve mean_curve(const Measure& measure, std::size_t axis, std::size_t other, const ValueBins& bins);
GapCurve variance_curve(const Measure& measure, std::size_t axis, const ValueBins& bins);

// What would be in proportion to `drive`: how much of it each of 16 equal parts of the record has, in
// standard deviations.
GapCurve drive_curve(const Measure& measure, const Observation& observation, std::size_t axis,
                     const std::vector<float>& drive);

// Whether there is anything to sort by.
bool varies(const std::vector<float>& values);

}  // namespace gyrolog
