#include "analysis/allan/intervals.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "analysis/allan/confidence.hpp"
#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/variance_distribution.hpp"

namespace gyrolog {
namespace {

// Relative to the deviation.
struct Scatter {
    double lo = 0.0;
    double hi = 0.0;
    double edf = 0.0;
};

Scatter textbook_scatter(std::span<const std::int64_t> runs, double confidence) {
    double averages = 0.0;
    for (const std::int64_t terms : runs) { averages += static_cast<double>(terms + 1); }
    const Interval interval = textbook_interval(1.0, averages, confidence);
    return {interval.lo, interval.hi, averages - 1.0};
}

Scatter scatter_of(const AllanPoint& point, const AllanCurve& curve, std::span<const Segment> segments,
                   const SharesOfPoint& shares_of) {
    const DeviationRule& rule = rule_of(curve.kind);
    const std::vector<std::int64_t> runs = terms_of_runs(rule, segments, curve.convention, point.m);
    if (rule.halving) { return textbook_scatter(runs, curve.confidence); }
    const VarianceDistribution distribution(shares_of(point), rule, point.m, runs);
    const double tail = (1.0 - curve.confidence) / 2.0;
    return {1.0 / std::sqrt(distribution.quantile(1.0 - tail)), 1.0 / std::sqrt(distribution.quantile(tail)),
            distribution.edf()};
}

void set(AllanPoint& point, const Scatter& scatter) {
    point.lo = point.deviation * scatter.lo;
    point.hi = point.deviation * scatter.hi;
    point.edf = scatter.edf;
}

double between(double a, double b, double part) { return a * std::pow(b / a, part); }

}  // namespace

void set_intervals(AllanCurve& curve, std::span<const Segment> segments, const SharesOfPoint& shares) {
    constexpr std::size_t dense = 400;
    constexpr double step = 1.0442737824274138;  // 2^(1/16)
    std::vector<AllanPoint>& points = curve.points;
    std::size_t before = 0;
    Scatter at_before;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is_last = i + 1 == points.size();
        const auto m = static_cast<double>(points[i].m);
        if (points.size() > dense && i > 0 && !is_last &&
            static_cast<double>(points[i + 1].m) < step * static_cast<double>(points[before].m)) {
            continue;
        }
        const Scatter here = scatter_of(points[i], curve, segments, shares);
        const auto m_before = static_cast<double>(points[before].m);
        for (std::size_t j = before + 1; j < i; ++j) {
            const double part =
                std::log(static_cast<double>(points[j].m) / m_before) / std::log(m / m_before);
            set(points[j], {at_before.lo + part * (here.lo - at_before.lo),
                            between(at_before.hi, here.hi, part), between(at_before.edf, here.edf, part)});
        }
        set(points[i], here);
        before = i;
        at_before = here;
    }
}

}  // namespace gyrolog
