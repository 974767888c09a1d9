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

const char* title_of(NoiseTerm term) {
    switch (term) {
        case NoiseTerm::N:
            return "N  angle random walk";
        case NoiseTerm::B:
            return "B  bias instability";
        case NoiseTerm::K:
            return "K  rate random walk";
        case NoiseTerm::Q:
            return "Q  quantisation";
        case NoiseTerm::R:
            return "R  rate ramp";
    }
    return "";
}

// What the term is to a filter, with the size of it where that says more; `size` is in the column's unit.
std::string meaning_of(NoiseTerm term, double size, const RateUnit& unit) {
    const bool has_angle = unit.name != "lsb" && size > 0.0;
    switch (term) {
        case NoiseTerm::N:
            return "The filter's gyro noise density: the variance of the angle grows by N² each second" +
                   (has_angle
                        ? fmt::format("; after 1 min the angle is off by {:.2g}° (1 σ, the noisiest axis)",
                                      size * deg_per_rad * std::sqrt(integrated_s))
                        : std::string()) +
                   ".";
        case NoiseTerm::B:
            return "The floor of the Allan deviation is 0.664 B: no longer rest makes the bias better known "
                   "than that. A filter without a state for it takes a larger K, or a Gauss-Markov state.";
        case NoiseTerm::K:
            return "The process noise of the filter's bias state: the variance of the bias grows by K² each "
                   "second.";
        case NoiseTerm::Q:
            return "An error of the angle that does not grow: it matters to short increments only.";
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

void add_term(HtmlTable& list, Axes axes, NoiseTerm term, const RateUnit& unit) {
    list.rows.push_back({element("b", Html::text(title_of(term))) + Html::markup("<br>") +
                         Html::text(meaning_of(term, largest(axes, term), unit))});
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

Html coefficients_of(Axes axes, const RateUnit& unit) {
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

Html figures_section(const ReportPage& page) {
    return element("h2", Html::text("Allan deviation and spectrum")) +
           figure(page.deviation_png, "Allan deviation of each axis over the averaging time, with the model",
                  fmt::format("The deviation with intervals of {:.3g} % and the fitted model (dashed).",
                              100.0 * page.analysis.confidence)) +
           figure(page.spectrum_png, "Noise density of each axis over the frequency, with the model",
                  "The root of the two-sided noise density and the fitted model (dashed). A data sheet's "
                  "one-sided density is √2 times as large.");
}

Html coefficients_section(const ReportPage& page) {
    const AnalysisReport& analysis = page.analysis;
    Html section = element("h2", Html::text("Noise coefficients")) +
                   paragraph(fmt::format("± one standard uncertainty; \"<\" stands before the upper limit at "
                                         "{:.3g} % of what this record cannot identify.",
                                         100.0 * analysis.confidence),
                             "muted");
    const Axes axes = analysis.axes;
    for (std::size_t at = 0; at < axes.size(); at += columns_most) {
        section += coefficients_of(axes.subspan(at, std::min(columns_most, axes.size() - at)), analysis.unit);
    }
    return section;
}

}  // namespace gyrolog
