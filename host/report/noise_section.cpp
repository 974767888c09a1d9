#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include "host/formats/noise_text.hpp"
#include "host/formats/noise_unit.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {
namespace {

// As many numbers with their uncertainties stand side by side on A4.
constexpr std::size_t columns_most = 4;
constexpr double integrated_s = 60.0;

using State = FittedCoefficient::State;
using Axes = std::span<const AxisReport>;

// Of the axes on which it is identified; 0 where it is on none.
double largest(Axes axes, NoiseTerm term) {
    double most = 0.0;
    for (const AxisReport& axis : axes) {
        const FittedCoefficient& fitted = axis.fit[term];
        if (fitted.state == State::identified) { most = std::max(most, fitted.value); }
    }
    return most;
}

const char* title_of(NoiseTerm term, bool is_gyro) {
    switch (term) {
        case NoiseTerm::N:
            return is_gyro ? "N  angle random walk" : "N  velocity random walk";
        case NoiseTerm::B:
            return "B  bias instability";
        case NoiseTerm::K:
            return is_gyro ? "K  rate random walk" : "K  acceleration random walk";
        case NoiseTerm::Q:
            return "Q  quantisation";
        case NoiseTerm::R:
            return is_gyro ? "R  rate ramp" : "R  acceleration ramp";
    }
    return "";
}

// What the noisiest axis has integrated to, from its N; empty where that is not known.
std::string integrated_text(double N, const SensorUnit& unit) {
    if (unit.is_counts() || !(N > 0.0)) { return {}; }
    const double integrated = N * std::sqrt(integrated_s);
    return unit.sensor == SensorKind::gyro
               ? fmt::format("; after 1 min the angle is off by {:.2g}° (1 σ, the noisiest axis)",
                             integrated * deg_per_rad)
               : fmt::format("; after 1 min the velocity is off by {:.2g} m/s (1 σ, the noisiest axis)",
                             integrated);
}

// What the term is to a filter, with the size of it where that says more; `size` is in the column's unit.
std::string meaning_of(NoiseTerm term, double size, const SensorUnit& unit) {
    const bool is_gyro = unit.sensor == SensorKind::gyro;
    const char* sensor = is_gyro ? "gyro" : "accelerometer";
    const char* integral = is_gyro ? "angle" : "velocity";
    switch (term) {
        case NoiseTerm::N:
            return fmt::format(
                "The filter's {} noise density: the variance of the {} grows by N² each second{}.", sensor,
                integral, integrated_text(size, unit));
        case NoiseTerm::B:
            return "The floor of the Allan deviation is 0.664 B: no longer rest makes the bias better known "
                   "than that. A filter without a state for it takes a larger K, or a Gauss-Markov state.";
        case NoiseTerm::K:
            return "The process noise of the filter's bias state: the variance of the bias grows by K² each "
                   "second.";
        case NoiseTerm::Q:
            return fmt::format("An error of the {} that does not grow: it matters to short increments only.",
                               integral);
        case NoiseTerm::R:
            return "A bias that runs away steadily: the bias state has to follow it, or a temperature model "
                   "take it out.";
    }
    return "";
}

HtmlRow heads_of(Axes axes) {
    HtmlRow heads = cells_of({"unit"});
    for (const AxisReport& axis : axes) { heads.push_back(Html::text(axis.axis)); }
    return heads;
}

void add_term(HtmlTable& list, Axes axes, NoiseTerm term, const SensorUnit& unit) {
    list.rows.push_back({element("b", Html::text(title_of(term, unit.sensor == SensorKind::gyro))) +
                         Html::markup("<br>") + Html::text(meaning_of(term, largest(axes, term), unit))});
    for (const ScaledUnit& printed : printed_units(term, unit)) {
        HtmlRow row = cells_of({printed.name});
        for (const AxisReport& axis : axes) {
            row.push_back(
                Html::text(coefficient_text(axis.fit[term], printed.per_column_unit, &with_uncertainty)));
        }
        list.rows.push_back(std::move(row));
    }
}

void add_rows(HtmlTable& list, const char* title, std::span<const TextRow> rows) {
    if (rows.empty()) { return; }
    list.rows.push_back({element("b", Html::text(title))});
    for (const TextRow& row : rows) {
        HtmlRow cells{Html::text(row.label + ", " + row.unit)};
        for (const std::string& cell : row.cells) { cells.push_back(Html::text(cell)); }
        list.rows.push_back(std::move(cells));
    }
}

Html coefficients_of(Axes axes, const SensorUnit& unit) {
    HtmlTable list{heads_of(axes), {}, "numbers"};
    for (const NoiseTerm term : {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K, NoiseTerm::Q, NoiseTerm::R}) {
        add_term(list, axes, term, unit);
    }
    std::vector<FitOfColumn> fits;
    for (const AxisReport& axis : axes) { fits.push_back({&axis.fit, &axis.slopes}); }
    add_rows(list, "Further noise", shaped_rows(fits, unit, &with_uncertainty));
    add_rows(list, "The same read off the slopes, as textbooks do", slope_rows(fits, unit));
    return table(list);
}

}  // namespace

Html figures_section(const SensorPart& part) {
    return element("h2", Html::text("Allan deviation and spectrum" + part.of)) +
           figure(part.figures.deviation_png,
                  "Allan deviation" + part.of + " of each axis over the averaging time, with the model",
                  fmt::format("The deviation with intervals of {:.3g} % and the fitted model (dashed).",
                              100.0 * part.page.analysis.confidence)) +
           figure(part.figures.spectrum_png,
                  "Noise density" + part.of + " of each axis over the frequency, with the model",
                  "The root of the two-sided noise density and the fitted model (dashed). A data sheet's "
                  "one-sided density is √2 times as large.");
}

Html coefficients_section(const SensorPart& part) {
    Html section = element("h2", Html::text("Noise coefficients" + part.of)) +
                   paragraph(fmt::format("± one standard uncertainty; \"<\" stands before the upper limit at "
                                         "{:.3g} % of what this record cannot identify.",
                                         100.0 * part.page.analysis.confidence),
                             "muted");
    const Axes axes = part.axes;
    for (std::size_t at = 0; at < axes.size(); at += columns_most) {
        section += coefficients_of(axes.subspan(at, std::min(columns_most, axes.size() - at)), part.unit);
    }
    return section;
}

}  // namespace gyrolog
