#include "analysis/allan/allan_deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "analysis/allan/averaging_factors.hpp"
#include "analysis/allan/confidence.hpp"
#include "analysis/allan/degrees_of_freedom.hpp"
#include "analysis/allan/deviation_sums.hpp"
#include "analysis/allan/power_law.hpp"

namespace gyrolog {
namespace {

// Contiguous averages of m samples on the grid, NaN where one has a hole; but for the factor 1 / m.
std::vector<double> averages(const IntegratedSignal& signal, std::int64_t m) {
    constexpr std::int64_t enough = std::int64_t{1} << 17;
    std::vector<double> all;
    for (std::size_t s = 0; s < signal.stretches.size(); ++s) {
        const PrefixSum& theta = signal.stretches[s].theta;
        const std::int64_t samples = static_cast<std::int64_t>(theta.points()) - 1;
        std::int64_t k = (signal.first_index[s] + m - 1) / m * m - signal.first_index[s];
        if (!all.empty()) { all.push_back(std::numeric_limits<double>::quiet_NaN()); }
        for (; k + m <= samples && static_cast<std::int64_t>(all.size()) < enough; k += m) {
            all.push_back(theta[static_cast<std::size_t>(k + m)] - theta[static_cast<std::size_t>(k)]);
        }
    }
    return all;
}

std::int64_t total(const std::vector<std::int64_t>& terms) {
    return std::accumulate(terms.begin(), terms.end(), std::int64_t{0});
}

void set_interval(AllanPoint& point, const Interval& interval) {
    point.lo = interval.lo;
    point.hi = interval.hi;
}

std::vector<std::int64_t> factors_of(const AllanOptions& options, std::int64_t longest) {
    std::vector<std::int64_t> factors = options.m;
    if (factors.empty()) {
        factors = averaging_factors(longest);
        if (rule_of(options.kind).halving) {
            std::erase_if(factors, [](std::int64_t m) { return (m & (m - 1)) != 0; });
        }
    }
    std::ranges::sort(factors);
    factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
    std::erase_if(factors, [&](std::int64_t m) { return m < 1 || m > longest; });
    return factors;
}

}  // namespace

AllanCurve allan_deviation(const Column& column, std::span<const Segment> segments, double rate_hz,
                           const AllanOptions& options) {
    AllanCurve curve{options.kind, options.convention, options.confidence, {}};
    if (segments.empty()) { return curve; }
    const DeviationRule& rule = rule_of(options.kind);
    const IntegratedSignal signal(column, segments, options.convention);
    std::vector<std::int64_t> factors = factors_of(options, signal.longest);
    std::erase_if(factors, [&](std::int64_t m) { return total(signal.terms(rule, m)) == 0; });
    const std::vector<double> sums = deviation_sums(signal, rule, factors, options.threads);
    // In a sum of power laws, whichever dominates at a longer time has the longer memory: the law only ever
    // moves that way. A chance reading of angle noise at a long time would claim far too narrow an interval.
    std::optional<PowerLaw> law;
    for (std::size_t f = 0; f < factors.size(); ++f) {
        const std::int64_t m = factors[f];
        AllanPoint point;
        point.m = m;
        point.tau_s = static_cast<double>(m) / rate_hz;
        const std::vector<std::int64_t> runs = signal.terms(rule, m);
        point.terms = total(runs);
        point.deviation =
            std::abs(column.scale) * std::sqrt(sums[f] / (rule.norm(m) * static_cast<double>(point.terms)));
        if (rule.halving) {
            const auto unbroken = std::ranges::count_if(runs, [](std::int64_t terms) { return terms > 0; });
            const auto averages = static_cast<double>(point.terms + unbroken);
            point.edf = averages - 1.0;
            set_interval(point, textbook_interval(point.deviation, averages, options.confidence));
            curve.points.push_back(point);
            continue;
        }
        law = std::max(law, identify_power_law(averages(signal, m)));
        const std::array<PowerLaw, 1> dominating = {law.value_or(PowerLaw::white_rate)};
        point.edf = DegreesOfFreedom(dominating, rule, m, runs).of(dominating.front());
        set_interval(point, chi_square_interval(point.deviation, point.edf, options.confidence));
        curve.points.push_back(point);
    }
    return curve;
}

}  // namespace gyrolog
