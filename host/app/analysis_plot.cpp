#include "host/app/analysis_plot.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "analysis/plot/allan_figure.hpp"
#include "analysis/plot/histogram_figure.hpp"
#include "host/app/figure_file.hpp"
#include "host/app/quantity.hpp"
#include "host/base/counted.hpp"
#include "host/formats/stops_text.hpp"

namespace gyrolog {
namespace {

// What the curve is called, and whether the model's Allan variance is what it estimates.
struct DrawnDeviation {
    std::string name;
    bool is_allan = true;
};

DrawnDeviation drawn_deviation(DeviationKind kind) {
    switch (kind) {
        case DeviationKind::modified:
            return {"Modified Allan deviation", false};
        case DeviationKind::hadamard:
            return {"Hadamard deviation", false};
        case DeviationKind::overlapping_hadamard:
            return {"Overlapping Hadamard deviation", false};
        case DeviationKind::total:
            return {"Total deviation", true};
        case DeviationKind::overlapping:
        case DeviationKind::standard:
        case DeviationKind::standard_halving:
            break;
    }
    return {"Allan deviation", true};
}

AllanTrace trace_of(const AxisReport& axis, bool is_allan) {
    AllanTrace trace;
    trace.name = axis.axis;
    trace.curve = axis.curve;
    trace.N = plotted_coefficient(axis.fit, NoiseTerm::N);
    trace.B = plotted_coefficient(axis.fit, NoiseTerm::B);
    if (trace.B && axis.slopes.B) { trace.B->tau_s = axis.slopes.B->tau_s; }
    trace.K = plotted_coefficient(axis.fit, NoiseTerm::K);
    for (const AllanPoint& point : axis.curve.points) {
        const double variance = is_allan ? axis.fit.best.allan_variance(point.tau_s) : 0.0;
        if (variance > 0.0) { trace.model.push_back({point.tau_s, std::sqrt(variance)}); }
    }
    trace.spectrum = axis.spectrum;
    // A ramp is no noise: pieces of the record do not show it as its power law.
    NoiseModel noise = axis.fit.best;
    noise.coefficients.R_rad_per_s2 = 0.0;
    for (const SpectrumPoint& point : axis.spectrum.points) {
        trace.model_spectrum.push_back({point.f_hz, noise.psd(point.f_hz)});
    }
    trace.lines = axis.lines;
    if (is_allan) { add_shaped_terms(trace, axis.fit); }
    trace.group = axis.axis.substr(0, 1);
    return trace;
}

std::string completeness(const AnalysisReport& report) {
    if (report.stamps == StampKind::arrival) { return "stamped on arrival"; }
    if (report.samples_missing == 0) { return "none missing"; }
    return fmt::format("{} missing in {}", format_count(static_cast<std::uint64_t>(report.samples_missing)),
                       counted(report.dropouts, "dropout"));
}

std::vector<std::string> facts_of(const AnalysisReport& report) {
    std::vector<std::string> facts = {fmt::format("{:.6g} Hz", report.rate_hz),
                                      format_duration(report.duration_s), counted(report.samples, "sample"),
                                      completeness(report)};
    if (report.stops > 0) { facts.push_back(stops_text(report.stops, report.stopped_s)); }
    return facts;
}

// What was taken off the samples before their deviation was worked out; empty: nothing.
std::string taken_off(const std::vector<AxisReport>& axes) {
    std::string names;
    for (const AxisReport& axis : axes) {
        if (!axis.temperature || !axis.temperature->is_taken_off) { continue; }
        names += (names.empty() ? "" : ", ") + axis.axis;
    }
    return names.empty() ? names : "without the drift with temperature of " + names;
}

// What of a report a figure shows.
struct DrawnSensor {
    SensorKind sensor;
    const std::vector<AxisReport>& axes;
    const SensorUnit& unit;
};

DrawnSensor drawn_sensor(const AnalysisReport& report, SensorKind sensor) {
    if (sensor == SensorKind::gyro) { return {sensor, report.axes, report.unit}; }
    return {sensor, report.accelerometer->axes, report.accelerometer->unit};
}

DeviationUnit deviation_unit(const DrawnSensor& drawn) {
    if (drawn.unit.is_counts()) { return DeviationUnit::as_given("lsb"); }
    return drawn.sensor == SensorKind::gyro ? DeviationUnit::rad_per_s_as_deg_per_s()
                                            : DeviationUnit::m_per_s2_as_micro_g();
}

}  // namespace

AllanFigure analysis_figure(const AnalysisReport& report, SensorKind sensor) {
    const DrawnSensor drawn = drawn_sensor(report, sensor);
    AllanFigure figure;
    const DrawnDeviation deviation = drawn_deviation(report.kind);
    figure.title = deviation.name + " and noise density";
    if (sensor == SensorKind::accelerometer) { figure.title += " of the accelerometer"; }
    figure.deviation = deviation.name;
    figure.slope_lines = deviation.is_allan;
    figure.source = report.name;
    figure.facts = facts_of(report);
    if (report.is_of_motion()) { figure.facts.emplace_back("the sensor moved: no noise coefficients"); }
    if (const std::string off = taken_off(drawn.axes); !off.empty()) { figure.facts.push_back(off); }
    figure.unit = deviation_unit(drawn);
    for (const AxisReport& axis : drawn.axes) { figure.traces.push_back(trace_of(axis, deviation.is_allan)); }
    return figure;
}

HistogramFigure samples_figure(const AnalysisReport& report, const Recording& recording, SensorKind sensor) {
    const DrawnSensor drawn = drawn_sensor(report, sensor);
    const bool is_gyro = sensor == SensorKind::gyro;
    HistogramFigure figure;
    if (!is_gyro) {
        figure.mean_name = "mean";
        figure.title = "Samples of the accelerometer about the mean";
    }
    figure.source = report.name;
    figure.facts = facts_of(report);
    const bool is_lsb = drawn.unit.is_counts();
    figure.unit_name = is_lsb ? "lsb" : is_gyro ? "°/s" : "g";
    figure.per_unit_of_data = is_lsb ? 1.0 : is_gyro ? deg_per_rad : SensorUnit::g().per_column_unit;
    for (const AxisReport& axis : drawn.axes) {
        const Column* column = recording.find((is_gyro ? "g" : "a") + axis.axis);
        if (column == nullptr) { continue; }
        figure.traces.push_back({axis.axis, amplitude_histogram(*column), axis.bias.expanded_uncertainty,
                                 axis.bias.coverage_factor});
    }
    return figure;
}

void add_shaped_terms(AllanTrace& trace, const NoiseFit& fit) {
    for (const FittedGaussMarkov& noise : fit.gauss_markov) {
        trace.gauss_markov.push_back({noise.value.sigma_rad_per_s, noise.value.correlation_s});
    }
    for (const FittedSinusoid& line : fit.sinusoids) {
        trace.sinusoids.push_back({line.value.amplitude_rad_per_s, line.value.frequency_hz});
    }
}

std::optional<PlottedCoefficient> plotted_coefficient(const NoiseFit& fit, NoiseTerm term) {
    const FittedCoefficient& coefficient = fit[term];
    if (coefficient.state != FittedCoefficient::State::identified) { return std::nullopt; }
    return PlottedCoefficient{coefficient.value, coefficient.sd};
}

Status write_analysis_plot(const AnalysisReport& report, SensorKind sensor, const PaperSize& paper,
                           const std::string& path) {
    AllanFigure figure = analysis_figure(report, sensor);
    figure.paper = paper;
    return write_figure(render(figure), path);
}

Status write_histogram_plot(const AnalysisReport& report, const Recording& recording, SensorKind sensor,
                            const PaperSize& paper, const std::string& path) {
    HistogramFigure figure = samples_figure(report, recording, sensor);
    figure.paper = paper;
    return write_figure(render(figure), path);
}

}  // namespace gyrolog
