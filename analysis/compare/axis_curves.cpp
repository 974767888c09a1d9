#include "analysis/compare/axis_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/allan/allan_deviation.hpp"

namespace gyrolog {

BlockAverages block_averages(const Column& column, std::span<const Segment> segments, double rate_hz,
                             std::size_t blocks) {
    BlockAverages averages;
    if (segments.empty() || blocks == 0) { return averages; }
    const std::int64_t begin = segments.front().first_index;
    const std::int64_t end = segments.back().first_index + static_cast<std::int64_t>(segments.back().count);
    const auto wanted = static_cast<std::int64_t>(blocks);
    const std::int64_t slots_per_block = std::max<std::int64_t>(1, (end - begin + wanted - 1) / wanted);
    const auto count = static_cast<std::size_t>((end - begin + slots_per_block - 1) / slots_per_block);

    std::vector<double> sums(count, 0.0);
    std::vector<std::size_t> samples(count, 0);
    for (const Segment& segment : segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const std::int64_t slot = segment.first_index + static_cast<std::int64_t>(i) - begin;
            const auto block = static_cast<std::size_t>(slot / slots_per_block);
            sums[block] += column.value(segment.first + i);
            ++samples[block];
        }
    }
    double all = 0.0;
    std::size_t all_samples = 0;
    for (std::size_t block = 0; block < count; ++block) {
        all += sums[block];
        all_samples += samples[block];
    }
    const double mean = all / static_cast<double>(all_samples);
    averages.block_s = static_cast<double>(slots_per_block) / rate_hz;
    for (std::size_t block = 0; block < count; ++block) {
        averages.rate.push_back(samples[block] == 0
                                    ? std::numeric_limits<double>::quiet_NaN()
                                    : sums[block] / static_cast<double>(samples[block]) - mean);
    }
    return averages;
}

AxisCurves axis_curves(const Column& column, std::span<const Segment> segments, double rate_hz,
                       const AxisCurvesOptions& options) {
    AxisCurves curves;
    AllanOptions allan;
    allan.m = options.m;
    allan.threads = options.threads;
    allan.intervals = options.intervals;
    curves.allan = allan_deviation(column, segments, rate_hz, allan);
    curves.spectrum =
        power_spectrum(column, segments, rate_hz, {.points_per_decade = spectrum_points_per_decade});
    curves.histogram = amplitude_histogram(column);
    curves.averages = block_averages(column, segments, rate_hz, options.blocks);
    return curves;
}

double interpolated(std::span<const double> x, std::span<const double> y, double at) {
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    const auto above = std::lower_bound(x.begin(), x.end(), at);
    if (above == x.end()) { return nowhere; }
    const auto right = static_cast<std::size_t>(above - x.begin());
    if (*above == at) { return y[right]; }
    if (right == 0 || !(y[right - 1] > 0.0) || !(y[right] > 0.0)) { return nowhere; }
    const double share = std::log(at / x[right - 1]) / std::log(x[right] / x[right - 1]);
    return y[right - 1] * std::pow(y[right] / y[right - 1], share);
}

}  // namespace gyrolog
