#include "analysis/diagnose/measures/narrow_lines.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/frequency_bands.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/numerics/tail_probability.hpp"

namespace gyrolog::resolution {

// In coefficients, half a line's natural width each.
constexpr std::array<std::size_t, 4> narrow_widths = {4, 16, 64, 256};
// Below the bands that hold the broadest of them.
constexpr std::array<std::size_t, 3> slow_widths = {2, 4, 16};

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct Window {
    double surprise_nats = 0.0;
    double place = 0.0;  // its middle, in coefficients from the first
};

// `sums`: of the whitened power, from 0. `level`: what is expected of one coefficient.
Window most_surprising(const std::vector<double>& sums, std::span<const std::size_t> widths, double level) {
    const auto all = static_cast<double>(sums.size() - 1);
    Window best{0.0, 0.5 * all};
    for (const std::size_t width : widths) {
        double most = 0.0;
        std::size_t at = 0;
        for (std::size_t from = 0; from + width < sums.size(); from += width / 2) {
            const double sum = sums[from + width] - sums[from];
            if (sum > most) { most = sum, at = from; }
        }
        // Windows that overlap by half are nearly as good as independent.
        const double tries = 2.0 * all / static_cast<double>(width) * static_cast<double>(widths.size());
        const double surprise = surprise_of_largest(most / level, static_cast<double>(width), tries);
        if (surprise > best.surprise_nats) {
            best = {surprise, static_cast<double>(at) + 0.5 * static_cast<double>(width)};
        }
    }
    return best;
}

std::vector<double> whitened_sums(const Observation& observation, std::size_t axis, std::size_t from_bin,
                                  std::size_t end_bin) {
    const Prediction& prediction = observation.prediction();
    const AxisObservation& seen = observation.axis(axis);
    std::vector<double> sums(1, 0.0);
    for (std::size_t i = from_bin; i < end_bin; ++i) {
        const double expected = seen.density[i] * prediction.rate_hz();
        for (std::size_t k = prediction.bins()[i].first; k < prediction.bins()[i].end; ++k) {
            if (!prediction.bins()[i].has(k)) { continue; }
            sums.push_back(sums.back() + square(static_cast<double>(seen.cosines[k])) / expected);
        }
    }
    return sums;
}

GapCurve narrow_curve(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    const std::vector<std::size_t> edges = band_edges(prediction.bins());
    GapCurve curve{&measures::narrow, axis, axis, {}, {}};
    const auto add = [&](std::size_t first, const Window& window) {
        curve.x.push_back(0.5 * (static_cast<double>(first) + window.place) / prediction.duration_s());
        curve.value.push_back(deviate_of(window.surprise_nats));
    };
    std::size_t band = 0;
    const auto coefficients = [&](std::size_t of) {
        return prediction.bins()[edges[of + 1] - 1].end - prediction.bins()[edges[of]].first;
    };
    while (band + 1 < edges.size() && coefficients(band) < resolution::narrow_widths.back()) { ++band; }
    const std::vector<double> slow = whitened_sums(observation, axis, 0, edges[band]);
    if (slow.size() > resolution::slow_widths.back()) {
        add(prediction.bins()[0].first, most_surprising(slow, resolution::slow_widths, 1.0));
    }
    for (; band + 1 < edges.size(); ++band) {
        const std::vector<double> sums = whitened_sums(observation, axis, edges[band], edges[band + 1]);
        // Of a broad excess, what stands out of it.
        const double level = std::max(1.0, sums.back() / static_cast<double>(sums.size() - 1));
        add(prediction.bins()[edges[band]].first, most_surprising(sums, resolution::narrow_widths, level));
    }
    return curve;
}

}  // namespace

const Measure measures::narrow{.name = "narrow lines",
                               .x_name = "frequency (Hz)",
                               .y_name = "excess (its sd)",
                               .shown_x = as_it_is,
                               .shown_y = as_it_is,
                               .locate = locate_frequencies,
                               .log_x = true,
                               .is_of_noise = true};

void add_narrow_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    curves.push_back(narrow_curve(observation, axis));
}

}  // namespace gyrolog
