#include "analysis/plot/comparison_figure.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/noise/noise_model.hpp"
#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

constexpr double comparison_heading_px = 150.0;  // and the key
constexpr double panel_row_px = 262.0;
constexpr int compared_columns_most = 3;

// In grey the one is darker, and it is drawn over the other.
constexpr Colour recording_colour = colours::blue;
constexpr Colour other_colour = colours::orange;

const Stroke recording_line{recording_colour, 2.2, {}};
const Stroke other_line{mixed(other_colour, colours::ink, 0.25), 1.8, {9.0, 5.0}};
constexpr double other_opacity = 0.35;

// Of the points of the recording that lie outside.
Curve marks_look() {
    Curve marks;
    marks.stroke = {colours::vermillion, 0.0, {}};
    marks.marker = Marker::circle;
    marks.marker_size_px = 7.0;
    marks.markers_apart_px = 0.0;
    return marks;
}

// What the panels show, each once: the other with its band first.
std::vector<Curve> key_of(const Comparison& comparison) {
    std::vector<Curve> key(2);
    key[0].stroke = other_line;
    key[0].band_opacity = other_opacity;
    key[0].lo = key[0].hi = {0.0};
    key[0].legend = {comparison.simulations == 0
                         ? "other, 68 %"
                         : "simulated, " + short_number(100.0 * comparison.band_probability) + " %"};
    key[1].stroke = recording_line;
    key[1].legend = {"recording"};
    const auto has_outside = [](const AxisComparison& axis) { return axis.allan.points_outside() > 0; };
    if (std::ranges::any_of(comparison.axes, has_outside)) {
        key.push_back(marks_look());
        key.back().legend = {"recording, outside"};
    }
    return key;
}

class ComparedAxisPanels {
public:
    ComparedAxisPanels(const Comparison& comparison, const AxisComparison& axis)
        : comparison_(comparison),
          axis_(axis),
          unit_(comparison.unit.sensor == SensorKind::gyro ? "°/s" : comparison.unit.name),
          quantity_(comparison.unit.sensor == SensorKind::gyro ? "rate" : "specific force") {}

    // Both over time, side by side.
    void add_series_to(Figure& figure) const {
        const bool simulated = comparison_.simulations > 0;
        figure.panels.push_back(
            series(axis_.recording_averages, recording_colour, axis_.axis + ": the recording"));
        figure.panels.push_back(series(axis_.other_averages, other_colour,
                                       axis_.axis + (simulated ? ": one simulation" : ": the other")));
    }

    void add_statistics_to(Figure& figure) const {
        figure.panels.push_back(histograms());
        add_curves_to(figure);
        figure.panels.push_back(ratios());
    }

    void add_curves_to(Figure& figure) const {
        figure.panels.push_back(
            curves(axis_.allan, "Allan deviation", "averaging time τ (s)", "σ(τ) (" + unit_ + ")"));
        figure.panels.push_back(curves(axis_.spectrum, "spectrum (root of the density)", "frequency (Hz)",
                                       "√S ((" + unit_ + ")/√Hz)"));
    }

private:
    double on_paper(double value) const { return value * comparison_.unit.per_column_unit; }

    std::vector<double> on_paper(std::vector<double> values) const {
        for (double& value : values) { value = on_paper(value); }
        return values;
    }

    Panel series(const BlockAverages& averages, Colour colour, const std::string& caption) const {
        Panel panel;
        const double longest_s =
            std::max(axis_.recording_averages.middle_s(axis_.recording_averages.rate.size()),
                     axis_.other_averages.middle_s(axis_.other_averages.rate.size()));
        const double time_unit_s = longest_s > hours_from_s ? s_per_h : 1.0;
        panel.caption = caption + ", means of " + short_number(averages.block_s) + " s";
        panel.x = {time_unit_s > 1.0 ? "time (h)" : "time (s)", ScaleKind::linear, {}};
        panel.y = {quantity_ + " − mean (" + unit_ + ")", ScaleKind::linear, common_range()};
        Curve curve;
        for (std::size_t block = 0; block < averages.rate.size(); ++block) {
            curve.x.push_back(averages.middle_s(block) / time_unit_s);
            curve.y.push_back(on_paper(averages.rate[block]));
        }
        curve.stroke = {colour, 1.2, {}};
        panel.curves.push_back(std::move(curve));
        return panel;
    }

    // Of both time series.
    Range common_range() const {
        RangeFinder finder(ScaleKind::linear);
        for (const BlockAverages* averages : {&axis_.recording_averages, &axis_.other_averages}) {
            for (const double rate : averages->rate) { finder.add(on_paper(rate)); }
        }
        return finder.padded(0.05, 0.0);
    }

    Curve distribution(const AmplitudeHistogram& histogram, Colour colour) const {
        Curve curve;
        curve.shape = CurveShape::steps;
        const double in_all = static_cast<double>(histogram.samples) * on_paper(histogram.bin_width);
        for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
            curve.x.push_back(on_paper(histogram.edge(bin) - histogram.mean));
            curve.y.push_back(static_cast<double>(histogram.counts[bin]) / in_all);
        }
        curve.stroke = {colour, 1.8, {}};
        return curve;
    }

    Panel histograms() const {
        Panel panel;
        panel.caption = axis_.axis + ": probability density";
        panel.x = {quantity_ + " − mean (" + unit_ + ")", ScaleKind::linear, {}};
        panel.y = {"1/(" + unit_ + ")", ScaleKind::logarithmic, {}};
        panel.curves.push_back(distribution(axis_.other_histogram, other_colour));
        panel.curves.back().stroke.width_px = 3.5;
        panel.curves.push_back(distribution(axis_.recording_histogram, recording_colour));
        return panel;
    }

    Panel curves(const ComparedCurve& compared, const std::string& name, const char* x,
                 const std::string& y) const {
        Panel panel;
        panel.caption = axis_.axis + ": " + name;
        panel.x = {x, ScaleKind::logarithmic, {}};
        panel.y = {y, ScaleKind::logarithmic, {}};
        Curve other;
        other.x = compared.at;
        other.y = on_paper(compared.other);
        other.lo = on_paper(compared.lo);
        other.hi = on_paper(compared.hi);
        other.stroke = other_line;
        other.band_opacity = other_opacity;
        Curve recording;
        recording.x = compared.at;
        recording.y = on_paper(compared.recording);
        recording.lo = on_paper(compared.recording_lo);
        recording.hi = on_paper(compared.recording_hi);
        recording.stroke = recording_line;
        panel.curves.push_back(std::move(other));
        panel.curves.push_back(std::move(recording));
        return panel;
    }

    Panel ratios() const {
        const ComparedCurve& compared = axis_.allan;
        Panel panel;
        panel.caption = axis_.axis + (comparison_.simulations > 0 ? ": σ(τ), recording / simulated"
                                                                  : ": σ(τ), recording / other");
        panel.x = {"averaging time τ (s)", ScaleKind::logarithmic, {}};
        panel.y = {"ratio (dB)", ScaleKind::linear, {}};
        Curve band;
        Curve recording;
        Curve outside = marks_look();
        for (std::size_t i = 0; i < compared.at.size(); ++i) {
            const auto over_other_dB = [&](double value) {
                return 20.0 * std::log10(value / compared.other[i]);
            };
            band.x.push_back(compared.at[i]);
            band.y.push_back(0.0);
            band.lo.push_back(over_other_dB(compared.lo[i]));
            band.hi.push_back(over_other_dB(compared.hi[i]));
            recording.x.push_back(compared.at[i]);
            recording.y.push_back(compared.ratio_dB(i));
            if (!compared.recording_lo.empty()) {
                recording.lo.push_back(over_other_dB(compared.recording_lo[i]));
                recording.hi.push_back(over_other_dB(compared.recording_hi[i]));
            }
            const bool is_outside = std::ranges::any_of(compared.outside, [&](const OutsideRange& range) {
                return range.from <= compared.at[i] && compared.at[i] <= range.to;
            });
            if (is_outside) {
                outside.x.push_back(compared.at[i]);
                outside.y.push_back(compared.ratio_dB(i));
            }
        }
        band.stroke = other_line;
        band.band_opacity = other_opacity;
        recording.stroke = recording_line;
        panel.curves = {std::move(band), std::move(recording)};
        if (!outside.x.empty()) { panel.curves.push_back(std::move(outside)); }
        return panel;
    }

    const Comparison& comparison_;
    const AxisComparison& axis_;
    std::string unit_;
    std::string quantity_;
};

}  // namespace

Figure figure_of(const ComparisonFigure& request) {
    const Comparison& comparison = request.comparison;
    Figure figure;
    figure.title = comparison.simulations > 0 ? "The sensor and its simulation" : "Two recordings";
    figure.source = comparison.recording_name + "  |  " + comparison.other_name;
    figure.facts = request.facts;
    figure.columns = request.paper.columns_up_to(compared_columns_most);
    figure.scale = request.paper.scale();
    for (const AxisComparison& axis : comparison.axes) {
        const ComparedAxisPanels panels(comparison, axis);
        const bool is_one = comparison.axes.size() == 1;
        // On narrow paper nothing else would have room on the sheet.
        if (figure.columns == compared_columns_most || is_one) { panels.add_series_to(figure); }
        if (figure.columns > 1 || is_one) {
            panels.add_statistics_to(figure);
        } else {
            panels.add_curves_to(figure);
        }
    }
    const auto columns = static_cast<std::size_t>(figure.columns);
    const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
    figure.key = key_of(comparison);
    figure.width_px = request.paper.width_px();
    figure.height_px =
        request.paper.scaled_pixels(comparison_heading_px + static_cast<double>(rows) * panel_row_px);
    return figure;
}

Rendering render(const ComparisonFigure& comparison) { return render(figure_of(comparison)); }

}  // namespace gyrolog
