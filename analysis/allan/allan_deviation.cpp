#include "analysis/allan/allan_deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/allan/averaging_factors.hpp"
#include "analysis/allan/confidence.hpp"
#include "analysis/allan/difference_sums.hpp"
#include "analysis/allan/power_law.hpp"

namespace gyrolog {
namespace {

struct Signal {
    std::vector<Stretch> stretches;
    std::vector<std::int64_t>
        first_index;           // of each stretch's theta_0 on the grid, counted from the record's start
    std::int64_t longest = 0;  // samples
};

Signal integrate(const Column& column, std::span<const Segment> segments, PhaseConvention convention) {
    Signal signal;
    const double centre = raw_mean(column);
    for (const Segment& segment : segments) {
        signal.stretches.push_back({PrefixSum(column, centre, segment.first, segment.count),
                                    convention == PhaseConvention::matlab ? std::size_t{1} : std::size_t{0}});
        signal.first_index.push_back(segment.first_index - segments.front().first_index);
        signal.longest = std::max(signal.longest, static_cast<std::int64_t>(segment.count));
    }
    return signal;
}

// The first k of a stretch, and its number of differences, when one is taken at every `stride` samples of the
// grid.
struct Run {
    std::int64_t begin = 0;
    std::int64_t terms = 0;
};

Run run_of(const Signal& signal, std::size_t stretch, std::int64_t m, std::int64_t stride) {
    const auto offset = static_cast<std::int64_t>(signal.stretches[stretch].begin);
    const std::int64_t aligned = (signal.first_index[stretch] + stride - 1) / stride * stride;
    const std::int64_t begin = aligned - signal.first_index[stretch] + offset;
    const std::int64_t span =
        static_cast<std::int64_t>(signal.stretches[stretch].theta.points()) - 2 * m - begin;
    return {begin, span <= 0 ? 0 : (span + stride - 1) / stride};
}

std::vector<double> sums_of_standard_differences(const Signal& signal,
                                                 std::span<const std::int64_t> factors) {
    std::vector<double> sums;
    for (const std::int64_t m : factors) {
        double sum = 0.0;
        for (std::size_t s = 0; s < signal.stretches.size(); ++s) {
            const PrefixSum& theta = signal.stretches[s].theta;
            const Run run = run_of(signal, s, m, m);
            for (std::int64_t j = 0; j < run.terms; ++j) {
                const auto k = static_cast<std::size_t>(run.begin + j * m);
                const auto step = static_cast<std::size_t>(m);
                const double d = (theta[k + 2 * step] - theta[k + step]) - (theta[k + step] - theta[k]);
                sum += d * d;
            }
        }
        sums.push_back(sum);
    }
    return sums;
}

// Contiguous averages of m samples on the grid, NaN where one has a hole; but for the factor 1 / m.
std::vector<double> averages(const Signal& signal, std::int64_t m) {
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

}  // namespace

AllanCurve allan_deviation(const Column& column, std::span<const Segment> segments, double rate_hz,
                           const AllanOptions& options) {
    AllanCurve curve{options.kind, options.convention, options.confidence, {}};
    if (segments.empty()) { return curve; }
    const Signal signal = integrate(column, segments, options.convention);
    std::vector<std::int64_t> factors = options.m.empty() ? averaging_factors(signal.longest) : options.m;
    std::ranges::sort(factors);
    factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
    std::erase_if(factors, [&](std::int64_t m) { return m < 1 || 2 * m > signal.longest; });

    const bool overlapping = options.kind == DeviationKind::overlapping;
    const std::vector<double> sums =
        overlapping ? sums_of_squared_differences(signal.stretches, factors, options.threads)
                    : sums_of_standard_differences(signal, factors);
    // In a sum of power laws, whichever dominates at a longer time has the longer memory: the law only ever
    // moves that way. A chance reading of angle noise at a long time would claim far too narrow an interval.
    std::optional<PowerLaw> law;
    for (std::size_t f = 0; f < factors.size(); ++f) {
        const std::int64_t m = factors[f];
        const std::int64_t stride = overlapping ? 1 : m;
        AllanPoint point;
        point.m = m;
        point.tau_s = static_cast<double>(m) / rate_hz;
        std::vector<std::int64_t> runs;
        for (std::size_t s = 0; s < signal.stretches.size(); ++s) {
            runs.push_back(run_of(signal, s, m, stride).terms);
            point.terms += runs.back();
        }
        if (point.terms == 0) { continue; }
        const auto samples = static_cast<double>(m);
        point.deviation = std::abs(column.scale) *
                          std::sqrt(sums[f] / (2.0 * samples * samples * static_cast<double>(point.terms)));
        law = std::max(law, identify_power_law(averages(signal, m)));
        const std::array<PowerLaw, 1> dominating = {law.value_or(PowerLaw::white_rate)};
        point.edf = DegreesOfFreedom(dominating, m, stride, runs).of(dominating.front());
        const Interval interval = chi_square_interval(point.deviation, point.edf, options.confidence);
        point.lo = interval.lo;
        point.hi = interval.hi;
        curve.points.push_back(point);
    }
    return curve;
}

}  // namespace gyrolog
