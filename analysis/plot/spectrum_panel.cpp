#include "analysis/plot/spectrum_panel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/plot/number_text.hpp"
#include "analysis/plot/trace_look.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t most_lines_named = 3;  // of each trace

double density_on_paper(double density, const DeviationUnit& unit) {
    return std::sqrt(density) * unit.per_unit_of_data;
}

Curve measured(const AllanTrace& trace, const TraceLook& look, const DeviationUnit& unit) {
    Curve curve;
    for (const SpectrumPoint& p : trace.spectrum.points) {
        curve.x.push_back(p.f_hz);
        curve.y.push_back(density_on_paper(p.density, unit));
        if (look.is_one_of_many) { continue; }
        curve.lo.push_back(density_on_paper(p.lo, unit));
        curve.hi.push_back(density_on_paper(p.hi, unit));
    }
    curve.stroke = {look.colour, look.is_one_of_many ? look.width_px : 1.8, {}};
    curve.marker = look.marker;
    curve.marker_size_px = 8.0;
    curve.markers_apart_px = 90.0;
    return curve;
}

Curve model(const AllanTrace& trace, const TraceLook& look, const DeviationUnit& unit) {
    Curve curve;
    for (const ModelDensity& p : trace.model_spectrum) {
        curve.x.push_back(p.f_hz);
        curve.y.push_back(density_on_paper(p.density, unit));
    }
    curve.stroke = {look.model_colour(), 2.0, model_dash_px};
    curve.sets_range = false;
    return curve;
}

// On top of what the spectrum shows of the line.
void add_lines(Panel& panel, const AllanTrace& trace, const TraceLook& look, const DeviationUnit& unit) {
    for (std::size_t i = 0; i < std::min(trace.lines.size(), most_lines_named); ++i) {
        const SpectralLine& line = trace.lines[i];
        const SpectrumPoint* top = nullptr;
        for (const SpectrumPoint& p : trace.spectrum.points) {
            if (std::abs(p.f_hz - line.f_hz) > std::max(p.width_hz, line.width_hz)) { continue; }
            if (top == nullptr || p.density > top->density) { top = &p; }
        }
        if (top == nullptr) { continue; }
        panel.callouts.push_back({top->f_hz, density_on_paper(top->density, unit),
                                  rounded_number(line.f_hz, 4) + " Hz",
                                  mixed(look.colour, colours::ink, 0.25), Marker::triangle_down});
    }
}

}  // namespace

bool has_spectrum(const AllanFigure& allan) {
    return std::any_of(allan.traces.begin(), allan.traces.end(), [](const AllanTrace& trace) {
        return std::any_of(trace.spectrum.points.begin(), trace.spectrum.points.end(),
                           [](const SpectrumPoint& p) { return p.density > 0.0; });
    });
}

Panel spectrum_panel(const AllanFigure& allan) {
    Panel panel;
    panel.x = {"frequency f (Hz)", ScaleKind::logarithmic, {}};
    panel.y = {"√S(f), two-sided ((" + allan.unit.name + ")/√Hz)", ScaleKind::logarithmic, {}};
    if (const DeviationUnit::Second& second = allan.unit.density; !second.name.empty()) {
        panel.right = SecondUnit{"√S(f) (" + second.name + ")", second.factor};
    }
    const std::vector<TraceLook> looks = passes_of(allan.traces);
    for (std::size_t i = 0; i < looks.size(); ++i) {
        const AllanTrace& trace = allan.traces[i];
        if (trace.spectrum.points.empty()) { continue; }
        panel.curves.push_back(measured(trace, looks[i], allan.unit));
        if (looks[i].is_one_of_many) { continue; }
        if (!trace.model_spectrum.empty()) { panel.curves.push_back(model(trace, looks[i], allan.unit)); }
        add_lines(panel, trace, looks[i], allan.unit);
    }
    return panel;
}

}  // namespace gyrolog
