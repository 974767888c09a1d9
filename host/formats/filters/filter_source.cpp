#include "host/formats/filters/filter_source.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/formats/filters/filter_advice.hpp"

namespace gyrolog {
namespace {

std::string axes_text(const std::vector<ExportedAxis>& axes, ExportedTerm ExportedAxis::*term) {
    std::string text;
    for (const ExportedAxis& axis : axes) {
        const ExportedTerm& one = axis.*term;
        text += fmt::format("{}{} ", text.empty() ? "" : ", ", axis.name);
        if (one.identified) {
            text += fmt::format("{:.4g}", one.value);
        } else if (one.upper) {
            text += fmt::format("< {:.2g}", *one.upper);
        } else {
            text += "none";
        }
    }
    return text;
}

FilterTerm filter_term(const std::vector<ExportedAxis>& axes, ExportedTerm ExportedAxis::*term,
                       bool upper_limits) {
    const ExportedTerm most = largest(axes, term);
    FilterTerm filter;
    if (most.identified) {
        filter.value = most.value;
    } else if (upper_limits && most.upper) {
        filter.value = most.upper;
        filter.is_upper = true;
    } else {
        filter.upper = most.upper;
    }
    filter.axes = axes_text(axes, term);
    filter.of_axes = axes;
    return filter;
}

std::vector<ExportedAxis> filter_axes(std::vector<ExportedAxis> axes, double step,
                                      const ExportSource& source) {
    const double step_density = step / std::sqrt(12.0 * source.rate_hz);
    for (ExportedAxis& axis : axes) {
        if (axis.N.identified) { axis.N.value = std::hypot(axis.N.value, step_density); }
        if (source.upper_limits && axis.N.upper) { axis.N.upper = std::hypot(*axis.N.upper, step_density); }
        for (ExportedTerm* term : {&axis.N, &axis.K}) {
            term->value *= source.inflate;
            if (term->upper) { *term->upper *= source.inflate; }
        }
    }
    return axes;
}

}  // namespace

const FilterTerm& FilterSource::term(SensorKind sensor, NoiseTerm term) const {
    if (sensor == SensorKind::gyro) { return term == NoiseTerm::N ? gyro_N : gyro_K; }
    return term == NoiseTerm::N ? accelerometer_N : accelerometer_K;
}

FilterSource filter_source(const ExportSource& source) {
    FilterSource filter;
    filter.name = source.name;
    filter.rate_hz = source.rate_hz;
    filter.confidence = source.confidence;
    filter.inflate = source.inflate;
    filter.has_accelerometer = !source.accelerometer.empty();
    filter.accelerometer_has_counts = source.accelerometer_has_counts;
    const double gyro_step = source.lsb_rad_s.value_or(0.0);
    const double accelerometer_step = source.lsb_m_s2.value_or(0.0);
    filter.has_converter_step = gyro_step > 0.0 || accelerometer_step > 0.0;
    const std::vector<ExportedAxis> gyro = filter_axes(source.gyro, gyro_step, source);
    const std::vector<ExportedAxis> accelerometer =
        filter_axes(source.accelerometer, accelerometer_step, source);
    filter.gyro_N = filter_term(gyro, &ExportedAxis::N, source.upper_limits);
    filter.gyro_K = filter_term(gyro, &ExportedAxis::K, source.upper_limits);
    filter.accelerometer_N = filter_term(accelerometer, &ExportedAxis::N, source.upper_limits);
    filter.accelerometer_K = filter_term(accelerometer, &ExportedAxis::K, source.upper_limits);
    filter.advice = filter_advice(source);
    return filter;
}

}  // namespace gyrolog
