#include "analysis/diagnose/measures/motion_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gyrolog {

namespace {

constexpr std::size_t value_bins = 12;
constexpr double samples_of_bin_least = 30.0;
// Quantiles are those of as many samples as this, spread over all.
constexpr std::size_t samples_for_quantiles = 20'000;
constexpr std::size_t course_blocks = 16;

double square(double value) { return value * value; }

using Edges = std::array<float, value_bins - 1>;  // between the bins, rising

Edges equal_ranges(const std::vector<float>& at) {
    const auto [least, most] = std::ranges::minmax(at);
    Edges edges{};
    for (std::size_t i = 0; i < edges.size(); ++i) {
        edges[i] = least + (most - least) * static_cast<float>(i + 1) / static_cast<float>(value_bins);
    }
    return edges;
}

Edges equal_counts(const Observation& observation, const std::vector<float>& at) {
    const std::size_t stride = std::max<std::size_t>(1, at.size() / samples_for_quantiles);
    std::vector<float> some;
    for (std::size_t slot = 0; slot < at.size(); slot += stride) {
        if (observation.present()[slot]) { some.push_back(at[slot]); }
    }
    if (some.empty()) { some.push_back(0.0F); }
    std::ranges::sort(some);
    Edges edges{};
    for (std::size_t i = 0; i < edges.size(); ++i) { edges[i] = some[(i + 1) * some.size() / value_bins]; }
    return edges;
}

// Sums of the whitened samples by ranges of what `at` has by slot.
struct ValueBins {
    std::array<double, value_bins> at{}, sum{}, squares{}, count{};
};

ValueBins by_value(const Observation& observation, std::size_t axis, const std::vector<float>& at,
                   const Edges& edges) {
    ValueBins bins;
    const std::vector<float>& white = observation.axis(axis).whitened;
    for (std::size_t slot = 0; slot < white.size(); ++slot) {
        if (!observation.present()[slot]) { continue; }
        std::size_t bin = 0;
        for (const float edge : edges) { bin += std::size_t{at[slot] >= edge}; }
        const auto value = static_cast<double>(white[slot]);
        bins.at[bin] += static_cast<double>(at[slot]);
        bins.sum[bin] += value;
        bins.squares[bin] += square(value);
        bins.count[bin] += 1.0;
    }
    for (std::size_t bin = 0; bin < value_bins; ++bin) {
        const double nearest = static_cast<double>(edges[std::min(bin, edges.size() - 1)]);
        bins.at[bin] = bins.count[bin] > 0.0 ? bins.at[bin] / bins.count[bin] : nearest;
        if (bins.count[bin] <= samples_of_bin_least) { bins.count[bin] = 0.0; }
    }
    return bins;
}

// In standard deviations.
GapCurve mean_curve(GapDomainKind kind, std::size_t axis, std::size_t other, const ValueBins& bins) {
    GapCurve curve{kind, axis, other, {bins.at.begin(), bins.at.end()}, {}};
    for (std::size_t bin = 0; bin < value_bins; ++bin) {
        const double count = bins.count[bin];
        curve.value.push_back(count > 0.0 ? bins.sum[bin] / std::sqrt(count) : 0.0);
    }
    return curve;
}

GapCurve variance_curve(GapDomainKind kind, std::size_t axis, const ValueBins& bins) {
    GapCurve curve{kind, axis, axis, {bins.at.begin(), bins.at.end()}, {}};
    for (std::size_t bin = 0; bin < value_bins; ++bin) {
        const double count = bins.count[bin];
        curve.value.push_back(count > 0.0 ? std::log(std::max(bins.squares[bin] / count, 1e-12)) : 0.0);
    }
    return curve;
}

// Of what would be in proportion to `drive`, how much is in each part of the record.
GapCurve course_curve(GapDomainKind kind, const Observation& observation, std::size_t axis,
                      const std::vector<float>& drive) {
    GapCurve curve{kind, axis, axis, {}, {}};
    const std::vector<float>& white = observation.axis(axis).whitened;
    for (std::size_t block = 0; block < course_blocks; ++block) {
        const std::size_t first = block * white.size() / course_blocks;
        const std::size_t end = (block + 1) * white.size() / course_blocks;
        double product = 0.0;
        double squares = 0.0;
        for (std::size_t slot = first; slot < end; ++slot) {
            if (!observation.present()[slot]) { continue; }
            product += static_cast<double>(white[slot]) * static_cast<double>(drive[slot]);
            squares += square(static_cast<double>(drive[slot]));
        }
        curve.x.push_back(0.5 * static_cast<double>(first + end) / observation.prediction().rate_hz());
        curve.value.push_back(squares > 0.0 ? product / std::sqrt(squares) : 0.0);
    }
    return curve;
}

}  // namespace

bool varies(const std::vector<float>& values) {
    if (values.empty()) { return false; }
    const auto [least, most] = std::ranges::minmax(values);
    return most > least;
}

GapCurve temperature_curve(const Observation& observation, std::size_t axis) {
    const std::vector<float>& temperature_C = observation.prediction().temperature_C();
    return mean_curve(GapDomainKind::temperature, axis, axis,
                      by_value(observation, axis, temperature_C, equal_ranges(temperature_C)));
}

std::vector<GapCurve> motion_curves(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    std::vector<GapCurve> curves;
    for (const std::size_t other : prediction.axes()) {
        const std::vector<float>& rate = prediction.true_rate_rad_s(other);
        if (!varies(rate)) { continue; }
        const ValueBins bins = by_value(observation, axis, rate, equal_ranges(rate));
        curves.push_back(mean_curve(GapDomainKind::rate, axis, other, bins));
        if (other != axis) { continue; }
        curves.push_back(variance_curve(GapDomainKind::rate_noise, axis, bins));
        curves.push_back(course_curve(GapDomainKind::gain_course, observation, axis, rate));
    }
    const std::vector<float>& change = prediction.response_change_rad_s2(axis);
    if (!varies(change)) { return curves; }
    curves.push_back(mean_curve(GapDomainKind::acceleration, axis, axis,
                                by_value(observation, axis, change, equal_counts(observation, change))));
    curves.push_back(course_curve(GapDomainKind::delay_course, observation, axis, change));
    return curves;
}

}  // namespace gyrolog
