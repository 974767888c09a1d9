#include "analysis/noise/analyze.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {
namespace {

bool is_gyro(const Column& column) { return column.name.size() >= 2 && column.name[0] == 'g'; }

RateUnit unit_of(const Column& column) {
    if (column.unit == "lsb") { return {"lsb", 1.0}; }
    if (column.source_unit == "rad_s") { return {"rad/s", 1.0}; }
    return {"dps", deg_per_rad};
}

AxisReport analyze_axis(const Column& column, const Recording& recording, const AnalysisOptions& options) {
    AxisReport axis;
    axis.axis = column.name.substr(1);
    axis.curve = allan_deviation(column, recording.segments, recording.rate_hz, options);
    // What the user picked selects what is shown, not what the coefficients are made of.
    AllanCurve whole = axis.curve;
    if (!options.m.empty() || options.kind != DeviationKind::overlapping) {
        AnalysisOptions best = options;
        best.m.clear();
        best.kind = DeviationKind::overlapping;
        whole = allan_deviation(column, recording.segments, recording.rate_hz, best);
    }
    const auto periodograms = averaged_periodograms(column, recording.segments, recording.rate_hz);
    axis.spectrum = power_spectrum(periodograms, {.confidence = options.confidence});
    axis.lines = find_lines(periodograms, column, recording.segments, recording.rate_hz);
    axis.fit = fit_noise(whole, options.confidence);
    axis.slopes = read_slopes(whole);
    axis.bias = static_bias(column, recording.rate_hz, axis.fit.sparse);
    return axis;
}

// Averaging factors that were asked for and cannot be answered.
std::vector<std::string> refused_factors(const AnalysisOptions& options, const AllanCurve& curve) {
    std::vector<std::string> warnings;
    for (const std::int64_t m : options.m) {
        if (std::ranges::find(curve.points, m, &AllanPoint::m) == curve.points.end()) {
            warnings.push_back("m = " + std::to_string(m) +
                               " left out: the record has no unbroken stretch long enough for it");
        }
    }
    return warnings;
}

// Coefficients of a curve that the model does not follow are no property of the sensor.
void warn_of_misfit(const AxisReport& axis, std::vector<std::string>& warnings) {
    constexpr double allowed_sd = 5.0;
    if (axis.fit.worst_residual_sd > allowed_sd) {
        warnings.push_back(
            "axis " + axis.axis + ": the curve is up to " +
            std::to_string(std::lround(axis.fit.worst_residual_sd)) +
            " standard deviations away from the five noise terms (a tone, a filter or motion does that): "
            "the uncertainties of its coefficients do not cover it");
    }
}

}  // namespace

AnalysisReport analyze(const Recording& recording, const AnalysisOptions& options) {
    AnalysisReport report;
    report.name = recording.name;
    report.rate_hz = recording.rate_hz;
    report.rate_sd_hz = recording.rate_sd_hz;
    report.nominal_rate_hz = recording.nominal_rate_hz;
    report.stamps = recording.stamps;
    report.duration_s = recording.duration_s();
    report.samples = recording.rows();
    report.dropouts = recording.dropouts.size();
    report.samples_missing = recording.missing_samples();
    report.segments = recording.segments.size();
    report.kind = options.kind;
    report.convention = options.convention;
    report.confidence = options.confidence;
    report.warnings = recording.warnings;
    if (recording.rows() < 2) {
        report.warnings.emplace_back("fewer than two samples: nothing to analyse");
        return report;
    }
    for (const Column& column : recording.columns) {
        if (!is_gyro(column)) { continue; }
        if (report.axes.empty()) { report.unit = unit_of(column); }
        report.axes.push_back(analyze_axis(column, recording, options));
        warn_of_misfit(report.axes.back(), report.warnings);
    }
    if (report.axes.empty()) {
        report.warnings.emplace_back("no gyro column: nothing to analyse");
        return report;
    }
    const auto refused = refused_factors(options, report.axes.front().curve);
    report.warnings.insert(report.warnings.end(), refused.begin(), refused.end());
    return report;
}

}  // namespace gyrolog
