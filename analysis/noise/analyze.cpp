#include "analysis/noise/analyze.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <list>
#include <sstream>
#include <string_view>

#include "analysis/noise/axis_warnings.hpp"
#include "analysis/noise/clipping.hpp"
#include "analysis/noise/converter_step.hpp"
#include "analysis/noise/likelihood_fit.hpp"
#include "analysis/noise/sensor_columns.hpp"
#include "analysis/parallel/parallel_for.hpp"

namespace gyrolog {
namespace {

SensorUnit unit_of(SensorKind sensor, const Column& column) {
    if (column.unit == "lsb") { return SensorUnit::counts_of(sensor); }
    if (sensor == SensorKind::gyro) {
        return column.source_unit == "rad_s" ? SensorUnit::rad_per_s() : SensorUnit::dps();
    }
    return column.source_unit == "m_s2" ? SensorUnit::m_per_s2() : SensorUnit::g();
}

// An axis on its way: what its column is analysed as, and the curve that the fit starts from.
struct Work {
    SensorKind sensor = SensorKind::gyro;
    const Recording* recording = nullptr;
    const Column* column = nullptr;
    Column without_outliers{};     // empty unless robust
    Column without_drift{};        // empty unless a drift with temperature was taken off
    const Column* read = nullptr;  // before that: on the converter's steps, and clipped where it clips
    AllanCurve whole{};            // overlapping, at the usual averaging factors
    AxisReport report{};
};

void mend_outliers(Work& work) {
    work.without_outliers = *work.column;
    work.report.outliers = replace_outliers(work.without_outliers, work.recording->segments);
    work.column = &work.without_outliers;
}

// The axes of one sensor: they have the same rows.
void find_drifts(std::list<Work>& axes, SensorKind sensor, const AnalysisOptions& options) {
    std::vector<Work*> works;
    std::vector<const Column*> columns;
    for (Work& axis : axes) {
        if (axis.sensor != sensor) { continue; }
        works.push_back(&axis);
        columns.push_back(axis.column);
    }
    if (works.empty()) { return; }
    const Recording& recording = *works.front()->recording;
    const auto drifts = temperature_drifts(recording, columns, options.temperature);
    for (std::size_t i = 0; i < works.size(); ++i) {
        Work& work = *works[i];
        work.report.temperature = drifts[i];
        if (!drifts[i] || !drifts[i]->is_there || options.keep_temperature) { continue; }
        work.report.temperature->is_taken_off = true;
        work.without_drift = without_drift(recording, *work.column, *drifts[i], options.temperature);
        work.column = &work.without_drift;
    }
}

void prepare(std::list<Work>& axes, const AnalysisOptions& options) {
    for (Work& axis : axes) {
        if (options.robust) { mend_outliers(axis); }
        axis.read = axis.column;
    }
    for (const SensorKind sensor : {SensorKind::gyro, SensorKind::accelerometer}) {
        find_drifts(axes, sensor, options);
    }
}

void find_curves(Work& work, const AnalysisOptions& options) {
    const Recording& recording = *work.recording;
    AxisReport& axis = work.report;
    axis.axis = work.column->name.substr(1);
    axis.curve = allan_deviation(*work.column, recording.segments, recording.rate_hz, options);
    work.whole = axis.curve;
    if (!options.m.empty() || options.every_m || options.kind != DeviationKind::overlapping) {
        AllanOptions usual{.confidence = options.confidence, .m = {}, .threads = options.threads};
        usual.convention = options.convention;
        work.whole = allan_deviation(*work.column, recording.segments, recording.rate_hz, usual);
    }
    axis.slopes = read_slopes(work.whole);
}

void find_spectrum(Work& work, const AnalysisOptions& options) {
    const Recording& recording = *work.recording;
    const auto periodograms = averaged_periodograms(*work.column, recording.segments, recording.rate_hz);
    work.report.spectrum = power_spectrum(periodograms, {.confidence = options.confidence});
    work.report.lines = find_lines(periodograms, *work.column, recording.segments, recording.rate_hz);
}

void find_coefficients(Work& work, const AnalysisOptions& options) {
    const Recording& recording = *work.recording;
    const Column& column = *work.column;
    AxisReport& axis = work.report;
    axis.fit = fit_noise(work.whole, options.confidence);
    LikelihoodFitOptions fit;
    fit.confidence = options.confidence;
    fit.step = converter_step(*work.read);
    fit.bandwidth_hz = column.bandwidth_hz;
    for (const SpectralLine& line : axis.lines) {
        fit.lines.push_back({{line.amplitude, line.f_hz}, line.amplitude_sd, line.f_sd_hz});
    }
    if (auto likely = fit_likelihood(column, recording.segments, recording.rate_hz, axis.fit, fit)) {
        axis.fit = *std::move(likely);
    }
    // Of a few samples only their own scatter is known.
    if (axis.fit.method == FitMethod::curve) { axis.fit.mean_dof = static_cast<double>(column.size()) - 1.0; }
    axis.bias = static_bias(column, recording.rate_hz, axis.fit);
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

std::string rounded(double value, int digits = 2) {
    std::ostringstream text;
    text << std::setprecision(digits) << value;
    return text.str();
}

// Coefficients of a spectrum that the model does not follow are no property of the sensor.
void warn_of_misfit(const AxisReport& axis, AxisWarnings& warnings) {
    constexpr double allowed_error = 0.05;
    const NoiseFit& fit = axis.fit;
    if (fit.bandwidth_hz > 0.0) {
        warnings.add(axis.axis,
                     "the sensor's low-pass filter of " + rounded(fit.bandwidth_hz, 4) +
                         " Hz is not part of the model; the coefficients are those of what lies far below it",
                     "up to " + rounded(fit.upper_frequency_hz) + " Hz");
    } else if (fit.upper_frequency_hz > 0.0) {
        warnings.add(axis.axis,
                     "at high frequencies the spectrum does not follow the model (a filter or vibration "
                     "does that); the coefficients are those of what lies below",
                     "above " + rounded(fit.upper_frequency_hz) + " Hz");
    }
    if (fit.is_of_motion()) {
        warnings.add(axis.axis,
                     "this is not the noise of a sensor at rest (motion, vibration?): the "
                     "coefficients mean nothing");
    } else if (fit.method == FitMethod::likelihood && fit.model_error > allowed_error) {
        warnings.add(axis.axis,
                     "the spectrum departs from the model (a filter, vibration or temperature does "
                     "that); the uncertainties allow for it as well as they can");
    }
    if (axis.outliers.samples > 0) {
        warnings.add(axis.axis, "outliers were replaced by the median of their neighbours",
                     std::to_string(axis.outliers.samples));
    }
    constexpr double heavy_tails = 1.0;
    if (axis.bias.excess_kurtosis > heavy_tails) {
        warnings.add(axis.axis, "the samples have heavy tails or outliers: see what --robust changes",
                     "excess kurtosis " + rounded(axis.bias.excess_kurtosis));
    }
    if (!axis.curve.points.empty() && axis.bias.sample_sd == 0.0) {
        warnings.add(axis.axis,
                     "all samples are equal: the axis is stuck, or its noise is below the resolution");
    }
}

// A clock that is off makes every averaging time wrong by as much.
void warn_of_rate(const AnalysisReport& report, std::vector<std::string>& warnings) {
    constexpr double allowed = 1e-3;
    if (!report.nominal_rate_hz || !(*report.nominal_rate_hz > 0.0)) { return; }
    const double error = report.rate_hz / *report.nominal_rate_hz - 1.0;
    const double sd = report.rate_sd_hz ? *report.rate_sd_hz / report.rate_hz : 0.0;
    if (std::abs(error) < std::max(allowed, 5.0 * sd)) { return; }
    std::ostringstream text;
    text << "the rate is " << std::setprecision(6) << report.rate_hz << " Hz, " << std::showpos
         << std::setprecision(2) << error * 100.0 << std::noshowpos << std::setprecision(6)
         << " % off the nominal " << *report.nominal_rate_hz
         << " Hz; averaging times follow the measured rate";
    warnings.push_back(text.str());
}

// The accelerometer's rows, where they are not the recording's, go to `complete`.
const Recording* recording_of(SensorKind sensor, const Recording& recording,
                              std::optional<Recording>& complete, AnalysisReport& report) {
    if (sensor == SensorKind::gyro) { return &recording; }
    complete = rows_with_accelerometer(recording);
    if (!complete) { return &recording; }
    report.warnings.push_back("accelerometer: " + std::to_string(recording.rows() - complete->rows()) +
                              " of the rows have no value of it and are missing to it");
    return complete->rows() < 2 ? nullptr : &*complete;
}

// A list, because what is at work refers to its own columns.
std::list<Work> axes_of(const Recording& recording, const AnalysisOptions& options,
                        std::optional<Recording>& complete, AnalysisReport& report) {
    std::list<Work> axes;
    for (const SensorKind sensor : {SensorKind::gyro, SensorKind::accelerometer}) {
        const auto is_its = [&](const Column& column) { return is_of(sensor, column); };
        const auto first = std::ranges::find_if(recording.columns, is_its);
        if (!includes(options.sensors, sensor) || first == recording.columns.end()) { continue; }
        const Recording* rows = recording_of(sensor, recording, complete, report);
        if (rows == nullptr) { continue; }
        const SensorUnit unit = unit_of(sensor, *first);
        if (sensor == SensorKind::gyro) {
            report.unit = unit;
        } else {
            report.accelerometer = AccelerometerReport{unit, {}, {}};
        }
        for (const Column& column : rows->columns) {
            if (is_its(column)) { axes.push_back({.sensor = sensor, .recording = rows, .column = &column}); }
        }
    }
    return axes;
}

template <typename Do>
void for_each_axis(std::list<Work>& axes, unsigned threads, Do what) {
    std::vector<Work*> all;
    for (Work& axis : axes) { all.push_back(&axis); }
    parallel_for(all.size(), threads, [&](std::size_t i) { what(*all[i]); });
}

// What it does to the noise: K with it and without.
void warn_of_drift(const AxisReport& axis, const SensorUnit& unit, AxisWarnings& warnings) {
    if (!axis.temperature || !axis.temperature->is_there) { return; }
    const TemperatureDrift& drift = *axis.temperature;
    const std::string detail = rounded(drift.slope_per_C * unit.per_column_unit) + " " + unit.name +
                               "/degC, as K " + rounded(drift.walk_left_in * unit.per_column_unit) + " " +
                               unit.name + "*sqrt(Hz)";
    warnings.add(axis.axis,
                 drift.is_taken_off
                     ? "the bias follows the temperature, which would look like so much random walk: it was "
                       "taken off before the noise was analysed (--keep-temperature leaves it in)"
                     : "the bias follows the temperature and was left in: it looks like so much random walk",
                 detail);
}

void warn_of_axes(SensorKind sensor, const SensorUnit& unit, const std::list<Work>& axes,
                  std::vector<std::string>& to) {
    AxisWarnings warnings;
    for (const Work& axis : axes) {
        if (axis.sensor != sensor) { continue; }
        warn_of_misfit(axis.report, warnings);
        warn_of_drift(axis.report, unit, warnings);
        const double filter_hz = axis.read->bandwidth_hz;
        const double alike = filter_hz > 0.0 ? axis.recording->rate_hz / (2.0 * filter_hz) : 1.0;
        if (is_clipped(*axis.read, std::max(alike, 1.0))) {
            warnings.add(axis.report.axis,
                         "the samples are clipped: more lie at their limit than next to it, and "
                         "the noise is larger than these coefficients say");
        }
    }
    for (const std::string& line : warnings.lines()) {
        to.push_back(sensor == SensorKind::accelerometer ? "accelerometer " + line : line);
    }
}

std::optional<AxisMean> accelerometer_mean(const AccelerometerReport& report, const std::string& axis) {
    const auto found = std::ranges::find(report.axes, axis, &AxisReport::axis);
    if (found == report.axes.end()) { return std::nullopt; }
    return AxisMean{found->bias, found->fit.mean_dof};
}

void warn_of_gravity(const AccelerometerReport& report, std::vector<std::string>& warnings) {
    constexpr double allowed = 0.2;  // three axes of the worst kind: 80 mg and 3 % (PS-MPU-9250A-01, table 2)
    if (report.unit.is_counts()) { return; }
    std::string units;
    for (const AccelerometerReport::UnitGravity& of : report.gravity) {
        const double size = of.gravity.size.value / standard_gravity_m_s2;
        if (std::abs(size - 1.0) < allowed) { continue; }
        units += (units.empty() ? " " : ", ") + (of.unit.empty() ? of.unit : of.unit + " ") + "(" +
                 rounded(size) + " g)";
    }
    if (units.empty()) { return; }
    warnings.push_back("accelerometer" + units +
                       ": the mean over the record is not gravity: it moved or was turned, or its scale is "
                       "wrong");
}

void find_gravity(AccelerometerReport& report, std::vector<std::string>& warnings) {
    for (const AxisReport& axis : report.axes) {
        if (axis.axis[0] != 'x') { continue; }
        const std::string unit = axis.axis.substr(1);
        const auto x = accelerometer_mean(report, axis.axis);
        const auto y = accelerometer_mean(report, "y" + unit);
        const auto z = accelerometer_mean(report, "z" + unit);
        if (y && z) { report.gravity.push_back({unit, gravity_of({*x, *y, *z})}); }
    }
    warn_of_gravity(report, warnings);
}

const char* sensors_text(Sensors sensors) {
    switch (sensors) {
        case Sensors::gyro:
            return "gyro";
        case Sensors::accelerometer:
            return "accelerometer";
        case Sensors::all:
            break;
    }
    return "gyro or accelerometer";
}

void count_holes(const Recording& recording, AnalysisReport& report) {
    const Stops stops = recording.stops();
    report.stops = stops.events;
    report.stopped_s = stops.s;
    report.dropouts = recording.dropouts.size() - stops.events;
    report.samples_missing = recording.missing_samples() - stops.instants;
}

}  // namespace

bool AnalysisReport::is_of_motion() const {
    const auto moved = [](const AxisReport& axis) { return axis.fit.is_of_motion(); };
    return std::ranges::any_of(axes, moved) ||
           (accelerometer && std::ranges::any_of(accelerometer->axes, moved));
}

AnalysisReport analyze(const Recording& recording, const AnalysisOptions& options) {
    AnalysisReport report;
    report.name = recording.name;
    report.rate_hz = recording.rate_hz;
    report.rate_sd_hz = recording.rate_sd_hz;
    report.nominal_rate_hz = recording.nominal_rate_hz;
    report.stamps = recording.stamps;
    report.duration_s = recording.duration_s();
    report.samples = recording.rows();
    count_holes(recording, report);
    report.segments = recording.segments.size();
    report.kind = options.kind;
    report.convention = options.convention;
    report.confidence = options.confidence;
    report.warnings = recording.warnings;
    if (recording.rows() < 2) {
        report.warnings.emplace_back("fewer than two samples: nothing to analyse");
        return report;
    }
    warn_of_rate(report, report.warnings);
    std::optional<Recording> complete;
    std::list<Work> axes = axes_of(recording, options, complete, report);
    prepare(axes, options);
    for (Work& axis : axes) { find_curves(axis, options); }
    options.on_stage("spectrum");
    for_each_axis(axes, options.threads, [&](Work& axis) { find_spectrum(axis, options); });
    options.on_stage("fit");
    for_each_axis(axes, options.threads, [&](Work& axis) { find_coefficients(axis, options); });
    for (const SensorKind sensor : {SensorKind::gyro, SensorKind::accelerometer}) {
        const bool is_gyro = sensor == SensorKind::gyro;
        if (!is_gyro && !report.accelerometer) { continue; }
        warn_of_axes(sensor, is_gyro ? report.unit : report.accelerometer->unit, axes, report.warnings);
    }
    const std::vector<std::string> refused =
        axes.empty() ? std::vector<std::string>{} : refused_factors(options, axes.front().report.curve);
    for (Work& axis : axes) {
        const bool is_gyro = axis.sensor == SensorKind::gyro;
        (is_gyro ? report.axes : report.accelerometer->axes).push_back(std::move(axis.report));
    }
    if (report.accelerometer) { find_gravity(*report.accelerometer, report.warnings); }
    if (!report.has_axes()) {
        report.warnings.push_back(std::string("no ") + sensors_text(options.sensors) +
                                  " column: nothing to analyse");
    }
    report.warnings.insert(report.warnings.end(), refused.begin(), refused.end());
    return report;
}

}  // namespace gyrolog
