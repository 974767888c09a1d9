#include "analysis/compare/compared_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/allan/confidence.hpp"
#include "analysis/compare/axis_curves.hpp"

namespace gyrolog {

namespace {

constexpr double tail_probability = 0.025;
constexpr double gap_probability = 0.05;

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

// Sums over the simulations at one point, from which each can be taken out again.
struct Scatter {
    double n = 0.0;
    double mean = 0.0;
    double square = 0.0;  // sum of squares about the mean

    explicit Scatter(std::span<const double> values) : n(static_cast<double>(values.size())) {
        for (const double x : values) { mean += x / n; }
        for (const double x : values) { square += (x - mean) * (x - mean); }
    }

    // Of one more value.
    double distance(double x) const { return ratio(std::fabs(x - mean), n, square); }
    // Of one that is among them, from the others.
    double distance_of_own(double x) const {
        const double d = x - mean;
        return ratio(std::fabs(d) * n / (n - 1.0), n - 1.0, square - d * d * n / (n - 1.0));
    }

private:
    static double ratio(double d, double count, double sum_of_squares) {
        const double variance = std::max(sum_of_squares, 0.0) / (count - 1.0) * (1.0 + 1.0 / count);
        if (d == 0.0) { return 0.0; }
        return variance > 0.0 ? d / std::sqrt(variance) : std::numeric_limits<double>::infinity();
    }
};

bool all_positive(std::span<const double> values) {
    return std::ranges::all_of(values, [](double value) { return value > 0.0 && std::isfinite(value); });
}

// What the simulations show against each other.
struct AmongSimulations {
    std::vector<std::size_t> points_outside;  // of each
    std::vector<double> largest_distance;

    explicit AmongSimulations(std::size_t count) : points_outside(count, 0), largest_distance(count, 0.0) {}

    void add_point(std::span<const double> values, std::span<const double> even, const Scatter& scatter,
                   double lo, double hi) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            // The k outermost on either side lie outside the band of the others.
            if (values[i] <= lo || values[i] >= hi) { ++points_outside[i]; }
            largest_distance[i] = std::max(largest_distance[i], scatter.distance_of_own(even[i]));
        }
    }
};

template <typename Number>
std::size_t count_at_least(std::span<const Number> values, Number least) {
    return static_cast<std::size_t>(
        std::ranges::count_if(values, [&](Number value) { return value >= least; }));
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
                                       const std::vector<std::vector<double>>& simulations) {
    const std::size_t count = simulations.size();
    const std::size_t rank = band_rank(count);
    ComparedCurve curve;
    AmongSimulations among(count);
    std::vector<int> sides;
    std::vector<double> values(count);
    std::vector<double> even(count);
    for (std::size_t point = 0; point < at.size(); ++point) {
        for (std::size_t i = 0; i < count; ++i) { values[i] = simulations[i][point]; }
        if (!all_positive(values) || !all_positive(recording.subspan(point, 1))) { continue; }
        std::ranges::transform(values, even.begin(), evenly_scattered);
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

        const Scatter scatter(even);
        among.add_point(values, even, scatter, lo, hi);
        const double distance = scatter.distance(evenly_scattered(recording[point]));
        if (distance > curve.gap.distance) {
            curve.gap = {at[point], curve.ratio_dB(curve.at.size() - 1), distance, false};
        }
    }
    collect_ranges(curve, sides);
    curve.points_by_chance = (1.0 - band_probability(count)) * static_cast<double>(curve.at.size());
    const std::size_t as_often =
        count_at_least(std::span<const std::size_t>(among.points_outside), curve.points_outside());
    const std::size_t as_far =
        count_at_least(std::span<const double>(among.largest_distance), curve.gap.distance);
    curve.simulations_outside_as_often = as_often;
    const auto is_rare = [&](std::size_t as_much) {
        return static_cast<double>(as_much + 1) <= gap_probability * static_cast<double>(count + 1);
    };
    curve.gap.stands_out =
        curve.gap.distance > 0.0 && (is_rare(as_far) || (curve.points_outside() > 0 && is_rare(as_often)));
    return curve;
}

ComparedCurve compare_with_intervals(const CurveWithInterval& recording, const CurveWithInterval& other) {
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
    collect_ranges(curve, sides);
    const auto points = static_cast<double>(curve.at.size());
    curve.points_by_chance = std::erfc(1.0) * points;  // P(|z| > sqrt 2)
    curve.gap.stands_out =
        points > 0.0 && curve.gap.distance > normal_quantile(1.0 - 0.5 * gap_probability / points);
    return curve;
}

}  // namespace gyrolog
