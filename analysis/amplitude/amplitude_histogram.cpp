#include "analysis/amplitude/amplitude_histogram.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <variant>

#include "analysis/recording/grid_step.hpp"

namespace gyrolog {
namespace {

// Central moments, of sums about a value near the mean.
class Moments {
public:
    explicit Moments(double centre) : centre_(centre) {}

    void add(double value, double times) {
        const double d = value - centre_;
        double power = times;
        for (double& sum : sums_) {
            sum += power;
            power *= d;
        }
    }

    void write_to(AmplitudeHistogram& histogram) const {
        const double n = sums_[0];
        if (n == 0.0) { return; }
        const double m1 = sums_[1] / n;
        const double m2 = sums_[2] / n - m1 * m1;
        const double m3 = sums_[3] / n - 3.0 * m1 * sums_[2] / n + 2.0 * m1 * m1 * m1;
        const double m4 =
            sums_[4] / n - 4.0 * m1 * sums_[3] / n + 6.0 * m1 * m1 * sums_[2] / n - 3.0 * m1 * m1 * m1 * m1;
        histogram.samples = static_cast<std::size_t>(n);
        histogram.mean = centre_ + m1;
        if (!(m2 > 0.0) || n < 2.0) { return; }
        histogram.standard_deviation = std::sqrt(m2 * n / (n - 1.0));
        histogram.skewness = m3 / std::pow(m2, 1.5);
        histogram.excess_kurtosis = m4 / (m2 * m2) - 3.0;
    }

private:
    double centre_;
    std::array<double, 5> sums_{};
};

// Bins of whole steps, their edges half a step beside the values.
void lay_out_steps(AmplitudeHistogram& histogram, double least, double most, std::size_t most_bins) {
    const double steps = std::round((most - least) / histogram.step) + 1.0;
    const double steps_per_bin = std::max(1.0, std::ceil(steps / static_cast<double>(most_bins)));
    histogram.bin_width = steps_per_bin * histogram.step;
    histogram.first_edge = least - 0.5 * histogram.step;
    histogram.counts.assign(static_cast<std::size_t>(std::ceil(steps / steps_per_bin)), 0);
}

// Scott 1979: 3.49 sd n^(-1/3) shows the most of a Gaussian.
void lay_out_reals(AmplitudeHistogram& histogram, double least, double most, std::size_t most_bins) {
    const double width =
        3.49 * histogram.standard_deviation / std::cbrt(static_cast<double>(histogram.samples));
    const double wanted = width > 0.0 ? std::ceil((most - least) / width) : 1.0;
    const double bins = std::clamp(wanted, 1.0, static_cast<double>(most_bins));
    histogram.bin_width = most > least ? (most - least) / bins : std::max(std::abs(most) * 1e-6, 1e-300);
    histogram.first_edge = most > least ? least : least - 0.5 * histogram.bin_width;
    histogram.counts.assign(static_cast<std::size_t>(bins), 0);
}

void tally(AmplitudeHistogram& histogram, double value, std::uint64_t times) {
    const double bin = std::floor((value - histogram.first_edge) / histogram.bin_width);
    const auto last = static_cast<double>(histogram.counts.size() - 1);
    histogram.counts[static_cast<std::size_t>(std::clamp(bin, 0.0, last))] += times;
}

AmplitudeHistogram of_counts(const std::vector<std::int16_t>& counts, const Column& column,
                             std::size_t most_bins) {
    constexpr int lowest = -32768;
    std::vector<std::uint64_t> times(65536, 0);
    for (const std::int16_t count : counts) { ++times[static_cast<std::size_t>(count - lowest)]; }
    AmplitudeHistogram histogram;
    const auto first = std::ranges::find_if(times, [](std::uint64_t n) { return n > 0; }) - times.begin();
    const auto end =
        times.rend() - std::find_if(times.rbegin(), times.rend(), [](std::uint64_t n) { return n > 0; });
    const auto value_of = [&](std::ptrdiff_t i) {
        return static_cast<double>(i + lowest) * column.scale + column.offset;
    };
    Moments moments(value_of((first + end) / 2));
    for (std::ptrdiff_t i = first; i < end; ++i) {
        moments.add(value_of(i), static_cast<double>(times[static_cast<std::size_t>(i)]));
    }
    moments.write_to(histogram);
    histogram.step = std::abs(column.scale);
    lay_out_steps(histogram, std::min(value_of(first), value_of(end - 1)),
                  std::max(value_of(first), value_of(end - 1)), most_bins);
    for (std::ptrdiff_t i = first; i < end; ++i) {
        const std::uint64_t n = times[static_cast<std::size_t>(i)];
        if (n > 0) { tally(histogram, value_of(i), n); }
    }
    return histogram;
}

AmplitudeHistogram of_reals(const std::vector<double>& values, const Column& column, std::size_t most_bins) {
    AmplitudeHistogram histogram;
    std::vector<double>::const_iterator first = values.begin();
    while (first != values.end() && std::isnan(*first)) { ++first; }
    if (first == values.end()) { return histogram; }
    double least = *first * column.scale + column.offset;
    double most = least;
    Moments moments(least);
    for (const double raw : values) {
        if (std::isnan(raw)) { continue; }
        const double value = raw * column.scale + column.offset;
        least = std::min(least, value);
        most = std::max(most, value);
        moments.add(value, 1.0);
    }
    moments.write_to(histogram);
    histogram.step = grid_step(values) * std::abs(column.scale);
    if (histogram.step > 0.0) {
        lay_out_steps(histogram, least, most, most_bins);
    } else {
        lay_out_reals(histogram, least, most, most_bins);
    }
    for (const double raw : values) {
        if (!std::isnan(raw)) { tally(histogram, raw * column.scale + column.offset, 1); }
    }
    return histogram;
}

}  // namespace

double AmplitudeHistogram::expected(std::size_t bin) const {
    if (!(standard_deviation > 0.0)) { return 0.0; }
    const auto above = [&](double value) {
        return 0.5 * std::erfc((value - mean) / (standard_deviation * std::numbers::sqrt2));
    };
    // On the side where the tail is small, so that the difference keeps its digits.
    const double lo = edge(bin);
    const double hi = edge(bin + 1);
    const double share = lo > mean ? above(lo) - above(hi) : above(2.0 * mean - hi) - above(2.0 * mean - lo);
    return static_cast<double>(samples) * share;
}

AmplitudeHistogram amplitude_histogram(const Column& column, std::size_t most_bins) {
    if (column.size() == 0) { return {}; }
    if (const auto* counts = std::get_if<std::vector<std::int16_t>>(&column.data)) {
        return of_counts(*counts, column, most_bins);
    }
    return of_reals(std::get<std::vector<double>>(column.data), column, most_bins);
}

}  // namespace gyrolog
