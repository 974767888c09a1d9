// Test side only: gap curves of ordinary recordings some of whose codes are changed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/diagnose/measures/gap_curves.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {

inline constexpr std::uint64_t samples = 120'000;  // 20 min at 100 Hz
inline constexpr std::size_t changed_axis = 0;

// What is done to the codes of one axis.
using Change = std::function<void(std::vector<double>& codes)>;

inline std::vector<GapCurve> curves_of(std::uint64_t seed, const Change& change,
                                       const std::vector<std::size_t>& axes = {changed_axis}) {
    const SensorModel model = calibrated_sensor();
    Recording recording = *recorded(model, samples, seed);
    for (const std::size_t axis : axes) {
        Column& column = *std::ranges::find(recording.columns, std::string(gyro_columns.at(axis)),
                                            [](const Column& c) { return c.name; });
        std::vector<double> codes;
        for (std::size_t row = 0; row < column.size(); ++row) {
            codes.push_back(std::round((column.value(row) - column.offset) / column.scale));
        }
        if (change) { change(codes); }
        column.data = std::move(codes);
    }
    return gap_curves(Observation(prediction_of(std::make_shared<const Recording>(recording), model),
                                  std::make_shared<const Recording>(recording), 1));
}

inline const GapCurve& curve_of(const std::vector<GapCurve>& curves, const Measure& measure,
                                std::size_t axis) {
    return *std::ranges::find_if(
        curves, [&](const GapCurve& curve) { return curve.measure == &measure && curve.axis == axis; });
}

inline const GapCurve& shared_curve_of(const std::vector<GapCurve>& curves, const Measure& measure) {
    return *std::ranges::find_if(
        curves, [&](const GapCurve& curve) { return curve.measure == &measure && curve.of_all_axes; });
}

inline double most(const GapCurve& curve) { return std::ranges::max(curve.value); }

inline double white_sd_codes(const std::vector<double>& codes) {
    double squares = 0.0;
    for (std::size_t i = 1; i < codes.size(); ++i) { squares += std::pow(codes[i] - codes[i - 1], 2.0); }
    return std::sqrt(0.5 * squares / static_cast<double>(codes.size() - 1));
}

// The deviations from the mean, times a factor of the sample's number.
inline void scale_noise(std::vector<double>& codes, const std::function<double(std::size_t)>& factor) {
    double mean = 0.0;
    for (const double code : codes) { mean += code / static_cast<double>(codes.size()); }
    for (std::size_t i = 0; i < codes.size(); ++i) { codes[i] = mean + factor(i) * (codes[i] - mean); }
}

}  // namespace gyrolog
