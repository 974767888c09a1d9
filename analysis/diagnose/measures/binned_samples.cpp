#include "analysis/diagnose/measures/binned_samples.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/square.hpp"

namespace gyrolog::resolution {

constexpr double samples_of_bin_least = 30.0;
// Quantiles are those of as many samples as this, spread over all.
constexpr std::size_t samples_for_quantiles = 20'000;
constexpr std::size_t drive_blocks = 16;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct BinTotals {
    double at = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    double count = 0.0;
};

}  // namespace

Edges equal_ranges(const std::vector<float>& at) {
    const auto [least, most] = std::ranges::minmax(at);
    Edges edges{};
    for (std::size_t i = 0; i < edges.size(); ++i) {
        edges[i] =
            least + (most - least) * static_cast<float>(i + 1) / static_cast<float>(resolution::value_bins);
    }
    return edges;
}

Edges equal_counts(const Observation& observation, const std::vector<float>& at) {
    const std::size_t stride = std::max<std::size_t>(1, at.size() / resolution::samples_for_quantiles);
    std::vector<float> some;
    for (std::size_t slot = 0; slot < at.size(); slot += stride) {
        if (observation.present()[slot]) { some.push_back(at[slot]); }
    }
    if (some.empty()) { some.push_back(0.0F); }
    std::ranges::sort(some);
    Edges edges{};
    for (std::size_t i = 0; i < edges.size(); ++i) {
        edges[i] = some[(i + 1) * some.size() / resolution::value_bins];
    }
    return edges;
}

ValueBins by_value(const Observation& observation, std::size_t axis, const std::vector<float>& at,
                   const Edges& edges) {
    ValueBins bins;
    const std::vector<float>& white = observation.axis(axis).whitened;
    // What drives a sensor changes slowly: neighbours mostly share a bin.
    std::size_t bin = 0;
    BinTotals here;
    const auto put_down = [&] {
        bins.at[bin] += here.at;
        bins.sum[bin] += here.sum;
        bins.squares[bin] += here.squares;
        bins.count[bin] += here.count;
        here = {};
    };
    for (std::size_t slot = 0; slot < white.size(); ++slot) {
        if (!observation.present()[slot]) { continue; }
        const bool is_below = bin > 0 && !(at[slot] >= edges[bin - 1]);
        if (is_below || (bin < edges.size() && at[slot] >= edges[bin])) {
            put_down();
            bin = static_cast<std::size_t>(std::ranges::upper_bound(edges, at[slot]) - edges.begin());
        }
        const auto value = static_cast<double>(white[slot]);
        here.at += static_cast<double>(at[slot]);
        here.sum += value;
        here.squares += square(value);
        here.count += 1.0;
    }
    put_down();
    for (bin = 0; bin < resolution::value_bins; ++bin) {
        const double nearest = static_cast<double>(edges[std::min(bin, edges.size() - 1)]);
        bins.at[bin] = bins.count[bin] > 0.0 ? bins.at[bin] / bins.count[bin] : nearest;
        if (bins.count[bin] <= resolution::samples_of_bin_least) { bins.count[bin] = 0.0; }
    }
    return bins;
}

GapCurve mean_curve(const Measure& measure, std::size_t axis, std::size_t other, const ValueBins& bins) {
    GapCurve curve{&measure, axis, other, {bins.at.begin(), bins.at.end()}, {}};
    for (std::size_t bin = 0; bin < resolution::value_bins; ++bin) {
        const double count = bins.count[bin];
        curve.value.push_back(count > 0.0 ? bins.sum[bin] / std::sqrt(count) : 0.0);
    }
    return curve;
}

GapCurve variance_curve(const Measure& measure, std::size_t axis, const ValueBins& bins) {
    GapCurve curve{&measure, axis, axis, {bins.at.begin(), bins.at.end()}, {}};
    for (std::size_t bin = 0; bin < resolution::value_bins; ++bin) {
        const double count = bins.count[bin];
        curve.value.push_back(count > 0.0 ? std::log(std::max(bins.squares[bin] / count, 1e-12)) : 0.0);
    }
    return curve;
}

GapCurve drive_curve(const Measure& measure, const Observation& observation, std::size_t axis,
                     const std::vector<float>& drive) {
    GapCurve curve{&measure, axis, axis, {}, {}};
    const std::vector<float>& white = observation.axis(axis).whitened;
    for (std::size_t block = 0; block < resolution::drive_blocks; ++block) {
        const std::size_t first = block * white.size() / resolution::drive_blocks;
        const std::size_t end = (block + 1) * white.size() / resolution::drive_blocks;
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

bool varies(const std::vector<float>& values) {
    if (values.empty()) { return false; }
    const auto [least, most] = std::ranges::minmax(values);
    return most > least;
}

}  // namespace gyrolog
