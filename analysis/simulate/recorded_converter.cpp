#include "analysis/simulate/recorded_converter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/grid_step.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {
namespace {

constexpr double codes_of_a_side = 32768.0;  // of a 16-bit converter
constexpr std::array usual_ranges_dps = {250.0, 500.0, 1000.0, 2000.0};

double largest_rad_s(const Column& column) {
    double largest = 0.0;
    for (std::size_t i = 0; i < column.size(); ++i) {
        largest = std::max(largest, std::abs(column.value(i)));
    }
    return largest;
}

}  // namespace

RecordedConverter recorded_converter(const Column& column, double step_rad_s, double range_least_rad_s) {
    const double largest = largest_rad_s(column);
    if (step_rad_s > 0.0 && largest <= codes_of_a_side * step_rad_s) {
        return {step_rad_s, codes_of_a_side * step_rad_s, (codes_of_a_side - 1.0) * step_rad_s};
    }
    const double reached = std::max(largest, range_least_rad_s);
    const auto* const range_dps =
        std::ranges::find_if(usual_ranges_dps, [&](double dps) { return dps * rad_per_deg >= reached; });
    const double range_rad_s = range_dps == usual_ranges_dps.end() ? reached : *range_dps * rad_per_deg;
    return {step_rad_s, range_rad_s, range_rad_s};
}

std::optional<RecordedConverter> recorded_converter(const Recording& recording) {
    RecordedConverter converter;
    for (const char* axis : axis_names) {
        const Column* column = recording.find(std::string("g") + axis);
        if (column == nullptr || column->unit != "rad/s" || converter.step_rad_s > 0.0) { continue; }
        // Also a step so coarse that its error is no white noise, which converter_step() does not give.
        const auto* reals = std::get_if<std::vector<double>>(&column->data);
        const double step = std::abs(column->scale) * (reals != nullptr ? grid_step(*reals) : 1.0);
        converter = recorded_converter(*column, step, converter.full_scale_rad_s);
    }
    return converter.full_scale_rad_s > 0.0 ? std::optional(converter) : std::nullopt;
}

}  // namespace gyrolog
