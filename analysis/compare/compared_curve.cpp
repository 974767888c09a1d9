#include "analysis/compare/compared_curve.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/compare/axis_curves.hpp"
#include "analysis/compare/compared_number.hpp"
#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

namespace {

constexpr double tail_probability = 0.025;

// Squares of the amplitudes are about chi-square, whose cube root is nearly normal from two degrees of
// freedom on (Wilson and Hilferty 1931): distances mean the same at every point.
double evenly_scattered(double amplitude) { return std::cbrt(amplitude * amplitude); }

double in_dB(double ratio) { return 20.0 * std::log10(ratio); }

// -1 below, 1 above, 0 within.
int side_of(double value, double lo, double hi) {
    if (value < lo) { return -1; }
    return value > hi ? 1 : 0;
}

void collect_ranges(ComparedCurve& curve, std::span<const int> sides) {
    int before = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] != 0) {
            if (sides[i] != before) { curve.outside.push_back({curve.at[i], 0.0, 0.0, 0.0, 0}); }
            OutsideRange& range = curve.outside.back();
            const double gap_dB = curve.ratio_dB(i);
            if (range.points == 0 || std::fabs(gap_dB) > std::fabs(range.worst_dB)) {
                range.worst_at = curve.at[i];
                range.worst_dB = gap_dB;
            }
            range.to = curve.at[i];
            ++range.points;
        }
        before = sides[i];
    }
}

bool all_positive(std::span<const double> values) {
    return std::ranges::all_of(values, [](double value) { return value > 0.0 && std::isfinite(value); });
}

}  // namespace

std::size_t ComparedCurve::points_outside() const {
    std::size_t sum = 0;
    for (const OutsideRange& range : outside) { sum += range.points; }
    return sum;
}

double ComparedCurve::ratio_dB(std::size_t point) const { return in_dB(recording[point] / other[point]); }

std::size_t band_rank(std::size_t simulations) {
    // The small addition keeps a product that is whole from being rounded below it.
    const double rank = std::floor(tail_probability * static_cast<double>(simulations + 1) + 1e-9);
    return std::max<std::size_t>(1, static_cast<std::size_t>(rank));
}

double band_probability(std::size_t simulations) {
    return 1.0 - 2.0 * static_cast<double>(band_rank(simulations)) / static_cast<double>(simulations + 1);
}

ComparedCurve compare_with_simulations(std::span<const double> at, std::span<const double> recording,
                                       const std::vector<std::vector<double>>& simulations,
                                       double false_alarms) {
    const std::size_t count = simulations.size();
    const std::size_t rank = band_rank(count);
    ComparedCurve curve;
    std::vector<int> sides;
    std::vector<std::size_t> outside_of_others(count, 0);  // points, of each simulation
    std::vector<double> values(count);
    std::vector<double> even(count);
    for (std::size_t point = 0; point < at.size(); ++point) {
        for (std::size_t i = 0; i < count; ++i) { values[i] = simulations[i][point]; }
        if (!all_positive(values) || !all_positive(recording.subspan(point, 1))) { continue; }
        std::vector<double> sorted = values;
        std::ranges::sort(sorted);
        const double lo = sorted[rank - 1];
        const double hi = sorted[count - rank];
        curve.at.push_back(at[point]);
        curve.recording.push_back(recording[point]);
        curve.lo.push_back(lo);
        curve.other.push_back(0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]));
        curve.hi.push_back(hi);
        sides.push_back(side_of(recording[point], lo, hi));
        for (std::size_t i = 0; i < count; ++i) {
            if (values[i] <= lo || values[i] >= hi) { ++outside_of_others[i]; }
        }
        std::ranges::transform(values, even.begin(), evenly_scattered);
        const double here = distance_from(even, evenly_scattered(recording[point]));
        if (here > curve.gap.distance) {
            curve.gap = {at[point], curve.ratio_dB(curve.at.size() - 1), here, false};
        }
    }
    if (curve.at.empty()) { return curve; }
    collect_ranges(curve, sides);
    const auto points = static_cast<double>(curve.at.size());
    curve.points_by_chance = (1.0 - band_probability(count)) * points;
    curve.simulations_outside_as_often = static_cast<std::size_t>(std::ranges::count_if(
        outside_of_others, [&](std::size_t other) { return other >= curve.points_outside(); }));
    curve.gap.stands_out = curve.gap.distance > distance_by_chance(count, false_alarms / points);
    return curve;
}

ComparedCurve compare_with_intervals(const CurveWithInterval& recording, const CurveWithInterval& other,
                                     double false_alarms) {
    ComparedCurve curve;
    std::vector<int> sides;
    for (std::size_t i = 0; i < recording.at.size(); ++i) {
        const double at = recording.at[i];
        const double values[] = {recording.value[i],
                                 recording.lo[i],
                                 recording.hi[i],
                                 interpolated(other.at, other.value, at),
                                 interpolated(other.at, other.lo, at),
                                 interpolated(other.at, other.hi, at)};
        if (!all_positive(values)) { continue; }
        curve.at.push_back(at);
        curve.recording.push_back(values[0]);
        curve.recording_lo.push_back(values[1]);
        curve.recording_hi.push_back(values[2]);
        curve.other.push_back(values[3]);
        curve.lo.push_back(values[4]);
        curve.hi.push_back(values[5]);
        int side = 0;
        if (values[2] < values[4]) { side = -1; }
        if (values[1] > values[5]) { side = 1; }
        sides.push_back(side);
        const double sd = 0.5 * std::hypot(std::log(values[2] / values[1]), std::log(values[5] / values[4]));
        const double distance = std::fabs(std::log(values[0] / values[3])) / sd;
        if (distance > curve.gap.distance) {
            curve.gap = {at, in_dB(values[0] / values[3]), distance, false};
        }
    }
    if (curve.at.empty()) { return curve; }
    collect_ranges(curve, sides);
    const auto points = static_cast<double>(curve.at.size());
    curve.points_by_chance = std::erfc(1.0) * points;  // P(|z| > sqrt 2)
    curve.gap.stands_out = curve.gap.distance > normal_quantile(1.0 - 0.5 * false_alarms / points);
    return curve;
}

}  // namespace gyrolog
