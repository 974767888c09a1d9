#include "analysis/diagnose/likelihood/denoised_reference.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/likelihood/spectral_bins.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog::resolution {

// Over which a true motion without jerk is a straight line.
constexpr double half_window_s = 0.25;
// The widest window, of up to this many times the narrowest, in which there is nothing but noise about a
// line.
constexpr std::size_t widest_window = 16;
constexpr std::size_t rows_to_transform = 256;
constexpr std::size_t block_samples_smoothed = 64;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct Line {
    double value;           // in the middle
    double value_variance;  // of it, per unit of noise variance
    double slope;
    double slope_variance;  // likewise
    double variance;        // of the samples about it
};

// Of values[first] ... values[end - 1] as seen from `middle`, each with its weight.
struct Sums {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;

    double x_scatter() const { return xx - x * x / n; }
    double slope() const { return x_scatter() > 0.0 ? (xy - x * y / n) / x_scatter() : 0.0; }
    // Of the line, in the middle.
    double value() const { return (y - slope() * x) / n; }
};

template <typename Weight>
Sums sums_about(const std::vector<double>& values, std::size_t first, std::size_t end, std::size_t middle,
                Weight weight_at) {
    Sums sums;
    for (std::size_t i = first; i < end; ++i) {
        const double x = static_cast<double>(i) - static_cast<double>(middle);
        const double y = values[i] - values[middle];
        const double weight = weight_at(x);
        sums.n += weight;
        sums.x += weight * x;
        sums.y += weight * y;
        sums.xx += weight * x * x;
        sums.xy += weight * x * y;
        sums.yy += weight * y * y;
    }
    return sums;
}

Line line_through(const std::vector<double>& values, std::size_t first, std::size_t end, std::size_t middle) {
    const Sums sums = sums_about(values, first, end, middle, [](double) { return 1.0; });
    const double x_scatter = sums.x_scatter();
    const double slope = sums.slope();
    const double rest = std::max(0.0, sums.yy - sums.y * sums.y / sums.n - slope * slope * x_scatter);
    const double slope_variance = x_scatter > 0.0 ? 1.0 / x_scatter : 0.0;
    const double x_mean = sums.x / sums.n;
    return {values[middle] + sums.value(), 1.0 / sums.n + x_mean * x_mean * slope_variance, slope,
            slope_variance, rest / std::max(sums.n - 2.0, 1.0)};
}

// In the middle of a line through the neighbours within `reach`, by Tukey's biweight. A filter without side
// lobes: of the noise it keeps a share between none and all of every frequency. What is kept passes the
// model, what is not is taken as it was read; where the model delays the one against the other, they would
// not make up the noise again that was read.
double smooth_line(const std::vector<double>& values, std::size_t first, std::size_t end, std::size_t middle,
                   std::size_t reach) {
    const Sums sums = sums_about(values, first, end, middle, [&](double x) {
        const double share = x / static_cast<double>(reach + 1);
        return (1.0 - share * share) * (1.0 - share * share);
    });
    return values[middle] + sums.value();
}

// A table at rest turns at no rate at all, not at what is left of the noise: a sensor that does not follow
// that rest of the noise would seem to have a dead zone.
bool at_rest(const Line& line, double noise_variance) {
    return line.value * line.value <= square(decisions.seen_sigma) * noise_variance * line.value_variance &&
           line.slope * line.slope <= square(decisions.seen_sigma) * noise_variance * line.slope_variance;
}

double denoised_rate(const std::vector<double>& values, const std::vector<double>& smooth,
                     const Segment& segment, std::size_t i, double noise_variance, std::size_t reach) {
    for (std::size_t factor = resolution::widest_window; factor > 0; factor /= 2) {
        const std::size_t wanted = factor * reach;
        const std::size_t first = i - std::min(wanted, i - segment.first);
        const std::size_t end = std::min(i + wanted + 1, segment.first + segment.count);
        const auto count = static_cast<double>(end - first);
        if (count < 5.0) { return smooth[i]; }
        const Line line = line_through(values, first, end, i);
        if (!std::isfinite(line.variance)) { continue; }
        const bool only_noise =
            line.variance <= noise_variance * (1.0 + decisions.certain_sigma * std::sqrt(2.0 / count));
        if (only_noise) {
            return at_rest(line, noise_variance) ? 0.0 : smooth_line(values, first, end, i, wanted);
        }
        if (factor == 1) {
            const double kept = std::max(0.0, 1.0 - (1.0 + decisions.seen_sigma * std::sqrt(2.0 / count)) *
                                                        noise_variance / line.variance);
            const double value = smooth_line(values, first, end, i, wanted);
            return value + kept * (smooth[i] - value);
        }
    }
    return smooth[i];
}

// Rows at either end of a segment over which it is faded for its spectrum. Cut off sharply, a strong slow
// swing leaks into all frequencies.
std::size_t faded_rows(std::size_t length) { return std::min<std::size_t>(128, length / 16); }

// The first coefficient beyond the last bin that stands out of the noise.
std::size_t end_of_motion(std::vector<double> values, double noise_variance, CosineTransform& transform) {
    const std::size_t fade = faded_rows(values.size());
    for (std::size_t i = 0; i < fade; ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(fade);
        const double weight = 0.5 - 0.5 * std::cos(pi * share);
        values[i] *= weight;
        values[values.size() - 1 - i] *= weight;
    }
    transform.forward(values);
    std::size_t end = 1;
    for (const SpectralBin& bin : spectral_bins(values.size(), 1.0)) {
        double sum = 0.0;
        for (std::size_t k = bin.first; k < bin.end; ++k) { sum += values[k] * values[k]; }
        if (sum > noise_variance * (bin.count() + 5.0 * std::sqrt(2.0 * bin.count()))) { end = bin.end; }
    }
    return end;
}

// All of the coefficients up to `end`, none far above it.
void cut_noise(std::vector<double>& cosines, std::size_t end) {
    const double from = 1.25 * static_cast<double>(end);
    const double to = 1.6 * static_cast<double>(end);
    for (std::size_t k = end; k < cosines.size(); ++k) {
        const double place = std::clamp((static_cast<double>(k) - from) / (to - from), 0.0, 1.0);
        cosines[k] *= 0.5 + 0.5 * std::cos(pi * place);
    }
}

// `result` takes over what was smoothed of `values`, where no more than noise is off: not at the ends, if it
// rings there for what leaked and was cut.
void take_over(std::span<const double> values, const std::vector<double>& smooth, double noise_variance,
               std::span<double> result) {
    for (std::size_t from = 0; from < smooth.size(); from += resolution::block_samples_smoothed) {
        const std::size_t end = std::min(from + resolution::block_samples_smoothed, smooth.size());
        double squares = 0.0;
        for (std::size_t i = from; i < end; ++i) { squares += std::pow(values[i] - smooth[i], 2.0); }
        const auto count = static_cast<double>(end - from);
        if (squares > noise_variance * (count + 4.0 * std::sqrt(2.0 * count))) { continue; }
        for (std::size_t i = from; i < end; ++i) { result[i] = smooth[i]; }
    }
}

// Without what the noise has beyond the motion's frequencies.
std::vector<double> smoothed(const std::vector<double>& values, const std::vector<Segment>& segments,
                             double noise_variance) {
    std::vector<double> result = values;
    for (const Segment& segment : segments) {
        if (segment.count < resolution::rows_to_transform || !(noise_variance > 0.0)) { continue; }
        const std::size_t length = fast_length(segment.count);
        CosineTransform transform(length);
        // The last rows that a fast length leaves over come from a second pass, aligned to the end.
        for (const std::size_t first : {segment.first + segment.count - length, segment.first}) {
            const std::span<const double> before = std::span(values).subspan(first, length);
            std::vector<double> work(before.begin(), before.end());
            const std::size_t end_of_motion_k = end_of_motion(work, noise_variance, transform);
            transform.forward(work);
            cut_noise(work, end_of_motion_k);
            transform.inverse(work);
            take_over(before, work, noise_variance, std::span(result).subspan(first, length));
            if (length == segment.count) { break; }
        }
    }
    return result;
}

std::vector<double> filtered(const std::vector<double>& values, const std::vector<Segment>& segments,
                             double noise_variance, std::size_t reach) {
    const std::vector<double> smooth = smoothed(values, segments, noise_variance);
    std::vector<double> result = values;
    for (const Segment& segment : segments) {
        for (std::size_t i = segment.first; i < segment.first + segment.count; ++i) {
            result[i] = denoised_rate(values, smooth, segment, i, noise_variance, reach);
        }
    }
    return result;
}

}  // namespace

std::shared_ptr<const RecordedWorld> without_reference_noise(const RecordedWorld& world,
                                                             double noise_sd_rad_s) {
    auto recording = std::make_shared<Recording>(world.recording());
    const auto reach =
        static_cast<std::size_t>(std::max(4.0, resolution::half_window_s * recording->rate_hz));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto column =
            std::ranges::find(recording->columns, std::string("ref_") + axis_names[axis], &Column::name);
        const std::vector<double>& known = world.rate_rad_s(axis);
        if (column == recording->columns.end() || known.empty()) { continue; }
        column->data = filtered(known, recording->segments, noise_sd_rad_s * noise_sd_rad_s, reach);
        column->scale = 1.0;
        column->offset = 0.0;
    }
    return std::make_shared<const RecordedWorld>(std::move(recording));
}

}  // namespace gyrolog
