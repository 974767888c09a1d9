#include "analysis/diagnose/measures/amplitude.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"

namespace gyrolog::resolution {

constexpr double sigmas[] = {0.5, 1.0, 2.0, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0};
// Counted one threshold after the other, with the samples near at hand: no branch depends on their
// values.
constexpr std::size_t piece_samples = 1024;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

void append_amplitude_curves(const Observation& observation, std::size_t axis,
                             std::vector<GapCurve>& curves) {
    GapCurve curve{
        &measures::amplitude, axis, axis, {std::begin(resolution::sigmas), std::end(resolution::sigmas)}, {}};
    std::vector<double> beyond(curve.x.size(), 0.0);
    double all_cubes = 0.0;
    double count = 0.0;
    const std::vector<float>& white = observation.axis(axis).whitened;
    std::array<float, resolution::piece_samples> values{};
    for (std::size_t first = 0; first < white.size(); first += resolution::piece_samples) {
        std::size_t known = 0;
        for (std::size_t slot = first; slot < std::min(first + resolution::piece_samples, white.size());
             ++slot) {
            values[known] = white[slot];
            known += std::size_t{observation.present()[slot]};
        }
        double cubes = 0.0;
        for (std::size_t i = 0; i < known; ++i) {
            const auto value = static_cast<double>(values[i]);
            cubes += value * value * value;
        }
        all_cubes += cubes;
        for (std::size_t s = 0; s < beyond.size(); ++s) {
            const auto least = static_cast<float>(curve.x[s]);
            int more = 0;
            for (std::size_t i = 0; i < known; ++i) { more += std::fabs(values[i]) > least ? 1 : 0; }
            beyond[s] += static_cast<double>(more);
        }
        count += static_cast<double>(known);
    }
    for (const double number : beyond) { curve.value.push_back(2.0 * std::sqrt(number + 0.375)); }
    curves.push_back(std::move(curve));
    const double skewness = all_cubes / std::sqrt(15.0 * std::max(count, 1.0));
    curves.push_back({&measures::skewness, axis, axis, {0.0}, {skewness}});
}

void locate_amplitudes(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    where.amplitude_sigma = span_outside(curve, z);
}

// All sizes make it.
void locate_nowhere(const GapCurve&, const std::vector<double>&, Place&) {}

}  // namespace

const Measure measures::amplitude{.name = "tails",
                                  .x_name = "standard deviations",
                                  .y_name = "2√count over model",
                                  .shown_x = as_it_is,
                                  .shown_y = as_it_is,
                                  .locate = locate_amplitudes,
                                  .over_mean = true,
                                  // One sample further out than any of the simulations' is no wonder.
                                  .least_sd = 0.5,
                                  .is_of_noise = true};

const Measure measures::skewness{.name = "skewness",
                                 .x_name = "",
                                 .y_name = "skewness (its sd)",
                                 .shown_x = as_it_is,
                                 .shown_y = as_it_is,
                                 .locate = locate_nowhere,
                                 .is_course = false,
                                 .least_sd = 0.5,
                                 .is_of_noise = true};

void add_amplitude_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    if (observation.prediction().world().recording().samples_per_row != 1) { return; }
    append_amplitude_curves(observation, axis, curves);
}

}  // namespace gyrolog
