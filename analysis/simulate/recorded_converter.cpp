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
constexpr std::array usual_ranges_g = {2.0, 4.0, 8.0, 16.0};

double largest_of(const Column& column) {
    double largest = 0.0;
    for (std::size_t i = 0; i < column.size(); ++i) {
        largest = std::max(largest, std::abs(column.value(i)));
    }
    return largest;
}

}  // namespace

RecordedConverter recorded_converter(const Column& column, double step, double range_least,
                                     SensorKind sensor) {
    const double largest = largest_of(column);
    if (step > 0.0 && largest <= codes_of_a_side * step) {
        return {step, codes_of_a_side * step, (codes_of_a_side - 1.0) * step};
    }
    const double reached = std::max(largest, range_least);
    const bool is_gyro = sensor == SensorKind::gyro;
    const double unit = is_gyro ? rad_per_deg : standard_gravity_m_s2;
    const auto& usual = is_gyro ? usual_ranges_dps : usual_ranges_g;
    const auto* const holds =
        std::ranges::find_if(usual, [&](double range) { return range * unit >= reached; });
    const double range = holds == usual.end() ? reached : *holds * unit;
    return {step, range, range};
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
