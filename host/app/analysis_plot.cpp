#include "host/app/analysis_plot.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/plot/allan_figure.hpp"
#include "host/app/quantity.hpp"
#include "host/base/file_output.hpp"

namespace gyrolog {
namespace {

std::optional<PlottedCoefficient> plotted(const NoiseFit& fit, NoiseTerm term) {
    const FittedCoefficient& coefficient = fit[term];
    if (coefficient.state != FittedCoefficient::State::identified) { return std::nullopt; }
    return PlottedCoefficient{coefficient.value, coefficient.sd};
}

AllanTrace trace_of(const AxisReport& axis) {
    AllanTrace trace;
    trace.name = axis.axis;
    trace.curve = axis.curve;
    trace.N = plotted(axis.fit, NoiseTerm::N);
    trace.B = plotted(axis.fit, NoiseTerm::B);
    if (trace.B && axis.slopes.B) { trace.B->tau_s = axis.slopes.B->tau_s; }
    trace.K = plotted(axis.fit, NoiseTerm::K);
    for (const AllanPoint& point : axis.curve.points) {
        const double variance = axis.fit.best.allan_variance(point.tau_s);
        if (variance > 0.0) { trace.model.push_back({point.tau_s, std::sqrt(variance)}); }
    }
    return trace;
}

std::string completeness(const AnalysisReport& report) {
    if (report.stamps == StampKind::arrival) { return "stamped on arrival"; }
    if (report.samples_missing == 0) { return "none missing"; }
    return fmt::format("{} missing in {} dropouts", report.samples_missing, report.dropouts);
}

AllanFigure figure_of(const AnalysisReport& report, const std::string& source) {
    AllanFigure figure;
    figure.source = source;
    figure.facts = {fmt::format("{:.6g} Hz", report.rate_hz), format_duration(report.duration_s),
                    format_count(report.samples) + " samples", completeness(report)};
    if (report.unit.name == "lsb") { figure.unit = DeviationUnit::as_given("lsb"); }
    for (const AxisReport& axis : report.axes) { figure.traces.push_back(trace_of(axis)); }
    return figure;
}

}  // namespace

Status write_analysis_plot(const AnalysisReport& report, const std::string& path) {
    const Rendering rendering = render(figure_of(report, report.name));
    if (!rendering.ok()) { return Error{ErrorCode::failed, "draw '" + path + "': " + rendering.problem}; }
    return write_file(path, rendering.png);
}

}  // namespace gyrolog
