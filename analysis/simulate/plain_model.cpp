#include "analysis/simulate/plain_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/simulate/recorded_converter.hpp"

namespace gyrolog {
namespace {

double mean_within(const Column& column, const std::vector<Segment>& parts) {
    double sum = 0.0;
    double count = 0.0;
    for (const Segment& part : parts) {
        for (std::size_t i = 0; i < part.count; ++i) { sum += column.value(part.first + i); }
        count += static_cast<double>(part.count);
    }
    return sum / count;
}

AxisModel plain_axis(const Column& column, const std::vector<Segment>& parts, double rate_hz,
                     std::int64_t m) {
    AllanOptions options;
    options.m = {m};
    AxisModel axis;
    axis.bias_rad_s = mean_within(column, parts);
    const AllanCurve curve = allan_deviation(column, parts, rate_hz, options);
    if (curve.points.empty()) { return axis; }
    const AllanPoint& point = curve.points.front();
    axis.noise.N_rad_per_sqrt_s = point.deviation * std::sqrt(point.tau_s);
    // Of a deviation: half that of its chi-square variance.
    if (point.edf > 0.0) { axis.sd_rel["N"] = 1.0 / std::sqrt(2.0 * point.edf); }
    return axis;
}

}  // namespace

std::optional<PlainModel> plain_model(const Recording& recording, const PlainModelOptions& options) {
    std::vector<std::pair<std::size_t, const Column*>> gyros;
    std::vector<std::vector<double>> signals;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const Column* column = recording.find(std::string("g") + axis_names[axis]);
        if (column == nullptr || column->unit != "rad/s") { continue; }
        gyros.emplace_back(axis, column);
        signals.push_back(column->values());
    }
    if (gyros.empty()) { return std::nullopt; }
    PlainModel plain;
    plain.still = still_part(recording, signals);
    if (!(plain.still.to_s > plain.still.from_s)) { return std::nullopt; }
    const std::vector<Segment> parts = segments_within(recording.segments, recording.rate_hz, plain.still);
    plain.model.rate_hz = recording.rate_hz * static_cast<double>(recording.samples_per_row);
    plain.model.full_scale_rad_s = plain.model.saturation_rad_s = no_range_rad_s;
    if (const auto converter = recorded_converter(recording)) {
        plain.model.lsb_rad_s = converter->step_rad_s;
        plain.model.full_scale_rad_s = converter->full_scale_rad_s;
        plain.model.saturation_rad_s = converter->saturation_rad_s;
    }
    const std::int64_t m = std::max<std::int64_t>(1, std::llround(options.read_at_s * recording.rate_hz));
    plain.tau_s = static_cast<double>(m) / recording.rate_hz;
    for (const auto& [axis, column] : gyros) {
        plain.model.axes[axis] = plain_axis(*column, parts, recording.rate_hz, m);
    }
    return plain;
}

}  // namespace gyrolog
