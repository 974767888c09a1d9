#include "analysis/diagnose/measures/repeats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "analysis/diagnose/likelihood/repeat_patterns.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

constexpr std::size_t repeat_lags = 2;
constexpr std::size_t compared_lags = 4;  // after those

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

using RepeatCounts =
    std::array<double, resolution::repeat_lags + resolution::compared_lags>;  // by lag, from 1 on

RepeatCounts count_repeats(const Recording& recording, std::size_t axis) {
    std::array<std::size_t, resolution::repeat_lags + resolution::compared_lags> repeats{};
    std::visit(
        [&](const auto& data) {
            const ValueRange range(data);
            for (const Segment& segment : recording.segments) {
                const std::size_t end = segment.first + segment.count;
                for (std::size_t row = segment.first + 1; row < end; ++row) {
                    const auto value = data[row];
                    const bool counts_here = !range.ends_at(value);
                    const std::size_t lags = std::min(repeats.size(), row - segment.first);
                    for (std::size_t lag = 1; lag <= lags; ++lag) {
                        repeats[lag - 1] += std::size_t{counts_here && data[row - lag] == value};
                    }
                }
            }
        },
        recording.find(gyro_columns.at(axis))->data);
    RepeatCounts counts{};
    std::ranges::copy(repeats, counts.begin());
    return counts;
}

GapCurve repeats_curve(const Observation& observation, std::size_t axis) {
    const RepeatCounts counts = count_repeats(observation.recording(), axis);
    double compared = 0.0;
    for (std::size_t lag = resolution::repeat_lags; lag < counts.size(); ++lag) {
        compared += counts[lag] / static_cast<double>(resolution::compared_lags);
    }
    GapCurve curve{&measures::repeats, axis, axis, {}, {}};
    for (std::size_t lag = 0; lag < resolution::repeat_lags; ++lag) {
        curve.x.push_back(static_cast<double>(lag + 1));  // in samples
        const double variance = counts[lag] + compared / static_cast<double>(resolution::compared_lags) + 1.0;
        curve.value.push_back((counts[lag] - compared) / std::sqrt(variance));
    }
    return curve;
}

void locate_repeats(const GapCurve& /*curve*/, const std::vector<double>& /*z*/, Place& where) {
    where.structure = "duplicated_samples";
}

}  // namespace

const Measure measures::repeats{.name = "repeated samples",
                                .x_name = "lag (samples)",
                                .y_name = "excess (its sd)",
                                .shown_x = as_it_is,
                                .shown_y = as_it_is,
                                .locate = locate_repeats,
                                .is_course = false,
                                .least_sd = 1.0,
                                .is_normal_far_out = false,
                                .is_of_noise = true};

void add_repeats_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    if (observation.prediction().world().recording().samples_per_row != 1) { return; }
    curves.push_back(repeats_curve(observation, axis));
}

}  // namespace gyrolog
