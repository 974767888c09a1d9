#include "analysis/allan/allan_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/allan/averaging_factors.hpp"
#include "analysis/allan/deviation_sums.hpp"
#include "analysis/allan/intervals.hpp"
#include "analysis/allan/power_law_levels.hpp"

namespace gyrolog {
namespace {

std::vector<std::int64_t> powers_of_two(std::int64_t samples) {
    std::vector<std::int64_t> factors;
    for (std::int64_t m = 1; m <= samples / 2; m *= 2) { factors.push_back(m); }
    return factors;
}

std::vector<std::int64_t> factors_of(const AllanOptions& options, std::int64_t longest) {
    std::vector<std::int64_t> factors = options.m;
    if (options.every_m) {
        factors.resize(static_cast<std::size_t>(longest / 2));
        std::iota(factors.begin(), factors.end(), 1);
    } else if (factors.empty()) {
        factors = rule_of(options.kind).halving ? powers_of_two(longest) : averaging_factors(longest);
    }
    std::ranges::sort(factors);
    factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
    std::erase_if(factors, [&](std::int64_t m) { return m < 1 || m > longest; });
    return factors;
}

std::int64_t total(const std::vector<std::int64_t>& terms) {
    return std::accumulate(terms.begin(), terms.end(), std::int64_t{0});
}

std::vector<AllanPoint> deviations(const IntegratedSignal& signal, const DeviationRule& rule,
                                   std::vector<std::int64_t> factors, double scale, double rate_hz,
                                   unsigned threads) {
    const auto terms_at = [&](std::int64_t m) {
        return total(terms_of_runs(rule, signal.segments, signal.convention, m));
    };
    std::erase_if(factors, [&](std::int64_t m) { return terms_at(m) == 0; });
    const std::vector<double> sums = deviation_sums(signal, rule, factors, threads);
    std::vector<AllanPoint> points;
    for (std::size_t f = 0; f < factors.size(); ++f) {
        AllanPoint point;
        point.m = factors[f];
        point.tau_s = static_cast<double>(point.m) / rate_hz;
        point.terms = terms_at(point.m);
        point.deviation =
            scale * std::sqrt(sums[f] / (rule.norm(point.m) * static_cast<double>(point.terms)));
        points.push_back(point);
    }
    return points;
}

// The points nearest to m = 1, 2, 4, ... of the default list of factors.
std::vector<AllanPoint> octaves_of(const std::vector<AllanPoint>& points) {
    std::vector<AllanPoint> octaves;
    for (const AllanPoint& point : points) {
        if (octaves.empty() || point.m >= 2 * octaves.back().m - octaves.back().m / 16) {
            octaves.push_back(point);
        }
    }
    return octaves;
}

}  // namespace

AllanCurve allan_deviation(const Column& column, std::span<const Segment> segments, double rate_hz,
                           const AllanOptions& options) {
    AllanCurve curve{options.kind, options.convention, options.confidence, {}};
    if (segments.empty()) { return curve; }
    const DeviationRule& rule = rule_of(options.kind);
    options.on_stage("integrate");
    const IntegratedSignal signal(column, segments, options.convention);
    options.on_stage("deviation");
    const std::int64_t longest =
        static_cast<std::int64_t>(std::ranges::max(segments, {}, &Segment::count).count);
    const double scale = std::abs(column.scale);
    curve.points = deviations(signal, rule, factors_of(options, longest), scale, rate_hz, options.threads);
    if (curve.points.empty() || !options.intervals) { return curve; }

    const bool whole_curve =
        options.kind == DeviationKind::overlapping && options.m.empty() && !options.every_m;
    const std::vector<AllanPoint> octaves =
        whole_curve ? octaves_of(curve.points)
                    : deviations(signal, rule_of(DeviationKind::overlapping), powers_of_two(longest), scale,
                                 rate_hz, options.threads);
    options.on_stage("intervals");
    const PowerLawLevels laws = fit_power_laws(octaves, segments, options.convention);
    set_intervals(curve, segments, [&](const AllanPoint& point) { return laws.shares(rule, point.m); });
    return curve;
}

}  // namespace gyrolog
