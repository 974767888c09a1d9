#include "host/app/curve_plot.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/plot/allan_figure.hpp"
#include "host/app/analysis_plot.hpp"
#include "host/app/figure_file.hpp"

namespace gyrolog {
namespace {

AllanTrace trace_of(const PrintedCurveReport& curve) {
    AllanTrace trace;
    trace.name = curve.name;
    trace.curve = curve.curve;
    trace.N = plotted_coefficient(curve.fit.noise, NoiseTerm::N);
    trace.B = plotted_coefficient(curve.fit.noise, NoiseTerm::B);
    if (trace.B && curve.slopes.B) { trace.B->tau_s = curve.slopes.B->tau_s; }
    trace.K = plotted_coefficient(curve.fit.noise, NoiseTerm::K);
    add_shaped_terms(trace, curve.fit.noise);
    for (const AllanPoint& point : curve.curve.points) {
        const double variance = curve.fit.noise.best.allan_variance(point.tau_s);
        if (variance > 0.0) { trace.model.push_back({point.tau_s, std::sqrt(variance)}); }
    }
    return trace;
}

}  // namespace

Status write_curve_plot(const CurveReport& report, const PaperSize& paper, const std::string& path) {
    AllanFigure figure;
    figure.paper = paper;
    if (report.unit.sensor == SensorKind::accelerometer) {
        figure.title += " of the accelerometer";
        figure.unit = DeviationUnit::m_per_s2_as_micro_g();
    }
    figure.source = report.name;
    for (const PrintedCurveReport& curve : report.curves) {
        figure.traces.push_back(trace_of(curve));
        figure.facts.push_back(
            fmt::format("{}: model within {:.2f} dB RMS", curve.name, curve.fit.residual.rms_db));
    }
    return write_figure(render(figure), path);
}

}  // namespace gyrolog
