#include "analysis/plot/spectrum_panel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "analysis/noise/noise_model.hpp"
#include "analysis/numerics/robust_spread.hpp"
#include "analysis/plot/number_text.hpp"
#include "analysis/plot/trace_look.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t most_lines_named = 3;  // of each trace
constexpr double octave = 2.0;
constexpr double seen_from = 4.0;    // times the density about it
constexpr double stem_most = 100.0;  // times the band's density: the noise stays readable

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

// The band that shows the line best, or none.
const SpectrumPoint* band_of(const SpectralLine& line, const std::vector<SpectrumPoint>& bands) {
    const SpectrumPoint* top = nullptr;
    for (const SpectrumPoint& band : bands) {
        if (std::abs(band.f_hz - line.f_hz) > std::max(band.width_hz, line.width_hz)) { continue; }
        if (top == nullptr || band.density > top->density) { top = &band; }
    }
    return top;
}

// Of the bands about it, within an octave.
double density_around(const SpectrumPoint& band, const std::vector<SpectrumPoint>& bands) {
    std::vector<double> around;
    for (const SpectrumPoint& other : bands) {
        const bool is_near = other.f_hz < band.f_hz * octave && other.f_hz > band.f_hz / octave;
        if (is_near && &other != &band) { around.push_back(other.density); }
    }
    return around.empty() ? band.density : median_of(around);
}

// Of a spectrum as fine as the record allows: half the band's degrees of freedom are its bins. Half of the
// line's power, A^2 / 2, is at the negative frequency.
double peak_density(const SpectralLine& line, const SpectrumPoint& band) {
    const double bin_hz = 2.0 * band.width_hz / std::max(band.dof, 2.0);
    const double width_hz = std::max(bin_hz, line.width_hz * std::sqrt(2.0 * pi));
    return band.density + line.amplitude * line.amplitude / 4.0 / width_hz;
}

// Up from what the bands show of the line to its peak.
Curve stem(const SpectralLine& line, double from, double to, Colour colour) {
    Curve curve;
    curve.x = {line.f_hz, line.f_hz};
    curve.y = {from, to};
    curve.stroke = {colour, 2.0, {}};
    curve.sets_range = false;
    return curve;
}

// On top of what the spectrum shows of the line; where averaging has hidden it, on the peak that it has
// without.
void add_lines(Panel& panel, const AllanTrace& trace, const TraceLook& look, const DeviationUnit& unit) {
    const Colour colour = mixed(look.colour, colours::ink, 0.25);
    for (std::size_t i = 0; i < std::min(trace.lines.size(), most_lines_named); ++i) {
        const SpectralLine& line = trace.lines[i];
        const SpectrumPoint* band = band_of(line, trace.spectrum.points);
        if (band == nullptr) { continue; }
        Point top{band->f_hz, density_on_paper(band->density, unit)};
        if (band->density < seen_from * density_around(*band, trace.spectrum.points)) {
            const double most = stem_most * band->density;
            const Point peak{line.f_hz, density_on_paper(std::min(peak_density(line, *band), most), unit)};
            panel.curves.push_back(stem(line, top.y, peak.y, colour));
            top = peak;
        }
        panel.callouts.push_back(
            {top.x, top.y, rounded_number(line.f_hz, 4) + " Hz", colour, Marker::triangle_down});
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
