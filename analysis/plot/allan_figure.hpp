// The Allan deviation figure: curves of one or several axes with their confidence bands, the lines by which
// N, B and K are read (IEEE Std 952-1997, C.1), a model beside them, and a table of the coefficients. Below
// it, where there are spectra, the same noise by frequency.
//
// More than six traces, an array's, are drawn as thin lines in one colour for each group, and the table says
// the smallest and the largest coefficient in each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"
#include "analysis/spectrum/power_spectrum.hpp"
#include "analysis/spectrum/spectral_lines.hpp"

namespace gyrolog {

// From the unit of the curve's numbers to the unit on paper.
struct DeviationUnit {
    std::string name;  // of the left-hand axis
    double per_unit_of_data = 1.0;
    // What one unit of `name` is on the right-hand axis, and one of `name`/√Hz; no name: no such axis.
    struct Second {
        std::string name;
        double factor = 0.0;
    };
    Second deviation{};        // "°/h"
    Second density{};          // "°/√h"
    bool has_second_B = true;  // B in the table in `deviation`, too

    static DeviationUnit rad_per_s_as_deg_per_s();  // data in rad/s, drawn in °/s
    static DeviationUnit rad_per_s();               // data in rad/s, drawn as they are
    static DeviationUnit m_per_s2_as_micro_g();     // data in m/s^2, drawn in µg
    static DeviationUnit as_given(std::string name) { return {std::move(name), 1.0, {}, {}, false}; }
};

struct PlottedCoefficient {
    double value = 0.0;  // unit of the curve: times √s for N, as it is for B, over √s for K
    std::optional<double> uncertainty = {};  // standard uncertainty in the same unit
    std::optional<double> tau_s = {};        // B: where the curve is flat; absent: where it is least
};

struct ModelPoint {
    double tau_s = 0.0;
    double deviation = 0.0;  // unit of the curve
};

struct ModelDensity {
    double f_hz = 0.0;
    double density = 0.0;  // two-sided, unit of the curve squared, per Hz
};

// What carries the model beside N, B and K, in the unit of the curve.
struct PlottedGaussMarkov {
    double sigma = 0.0;
    double correlation_s = 0.0;
};
struct PlottedSinusoid {
    double amplitude = 0.0;
    double f_hz = 0.0;
};

struct AllanTrace {
    std::string name;  // "x"
    AllanCurve curve;
    std::optional<PlottedCoefficient> N, B, K;
    std::vector<ModelPoint> model;  // by rising tau
    PowerSpectrum spectrum;
    std::vector<ModelDensity> model_spectrum;  // by rising frequency
    std::vector<SpectralLine> lines;           // strongest first
    std::vector<PlottedGaussMarkov> gauss_markov{};
    std::vector<PlottedSinusoid> sinusoids{};
    std::string group;  // "x" for every x axis of an array; empty: its name
};

struct AllanFigure {
    std::string title = "Allan deviation";
    std::string deviation = "Allan deviation";  // what the curves are, on their axis
    std::string source;                         // file or device
    std::vector<std::string> facts;             // "1 kHz", "12 h", "43 200 000 samples", "no dropouts"
    DeviationUnit unit = DeviationUnit::rad_per_s_as_deg_per_s();
    std::vector<AllanTrace> traces;
    bool slope_lines = true;
    PaperSize paper{};
    double height_mm = 125.0;
    double spectrum_height_mm = 78.0;  // added where a trace has a spectrum
};

// The figure as panels and curves: to draw it with others, or to change what is not to taste.
Figure figure_of(const AllanFigure& allan);

Rendering render(const AllanFigure& allan);

}  // namespace gyrolog
