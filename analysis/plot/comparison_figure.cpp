#include "analysis/plot/comparison_figure.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

constexpr int comparison_heading_px = 130;
constexpr int panel_row_px = 350;

// In grey the one is darker, and it is drawn over the other.
constexpr Colour recording_colour = colours::blue;
constexpr Colour other_colour = colours::orange;

class ComparedAxisPanels {
public:
    ComparedAxisPanels(const Comparison& comparison, const AxisComparison& axis)
        : comparison_(comparison),
          axis_(axis),
          unit_(comparison.unit.sensor == SensorKind::gyro ? "°/s" : comparison.unit.name),
          quantity_(comparison.unit.sensor == SensorKind::gyro ? "rate" : "specific force"),
          is_first_(&axis == comparison.axes.data()),
          is_first_outside_(&axis == std::find_if(comparison.axes.data(), &axis + 1, has_outside)) {}

    void add_to(Figure& figure) const {
        const bool simulated = comparison_.simulations > 0;
        figure.panels.push_back(
            series(axis_.recording_averages, recording_colour, axis_.axis + ": the recording"));
        figure.panels.push_back(series(axis_.other_averages, other_colour,
                                       axis_.axis + (simulated ? ": one simulation" : ": the other")));
        figure.panels.push_back(histograms());
        figure.panels.push_back(
            curves(axis_.allan, "Allan deviation", "averaging time τ (s)", "σ(τ) (" + unit_ + ")"));
        if (is_first_) { add_legend(figure.panels.back()); }
        figure.panels.push_back(curves(axis_.spectrum, "spectrum (root of the density)", "frequency (Hz)",
                                       "√S ((" + unit_ + ")/√Hz)"));
        figure.panels.push_back(ratios());
    }

private:
    double on_paper(double value) const { return value * comparison_.unit.per_column_unit; }

    std::vector<double> on_paper(std::vector<double> values) const {
        for (double& value : values) { value = on_paper(value); }
        return values;
    }

    static bool has_outside(const AxisComparison& axis) { return axis.allan.points_outside() > 0; }

    // The legend's word for the other curve, and what its band is.
    std::vector<std::string> other_legend() const {
        if (comparison_.simulations == 0) { return {"other, 68 %"}; }
        return {"simulated, " + rounded_number(100.0 * comparison_.band_probability, 3) + " %"};
    }

    Panel series(const BlockAverages& averages, Colour colour, const std::string& caption) const {
        Panel panel;
        const double longest_s =
            std::max(axis_.recording_averages.middle_s(axis_.recording_averages.rate.size()),
                     axis_.other_averages.middle_s(axis_.other_averages.rate.size()));
        const double time_unit_s = longest_s > 7200.0 ? 3600.0 : 1.0;
        panel.caption = caption + ", means of " + rounded_number(averages.block_s) + " s";
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
        other.stroke = {mixed(other_colour, colours::ink, 0.25), 2.0, {9.0, 5.0}};
        other.band_opacity = 0.35;
        Curve recording;
        recording.x = compared.at;
        recording.y = on_paper(compared.recording);
        recording.lo = on_paper(compared.recording_lo);
        recording.hi = on_paper(compared.recording_hi);
        recording.stroke = {recording_colour, 2.2, {}};
        panel.curves.push_back(std::move(other));
        panel.curves.push_back(std::move(recording));
        return panel;
    }

    // With room above the curves, where the legend is to lie.
    void add_legend(Panel& panel) const {
        panel.curves[0].legend = other_legend();
        panel.curves[1].legend = {"recording"};
        RangeFinder finder(ScaleKind::logarithmic);
        for (const Curve& curve : panel.curves) {
            for (const std::vector<double>* values : {&curve.y, &curve.lo, &curve.hi}) {
                for (const double value : *values) { finder.add(value); }
            }
        }
        const Range shown = finder.padded(0.05, 1.0);
        panel.y.range = Range{shown.lo, shown.hi * std::pow(shown.hi / shown.lo, 0.6)};
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
        Curve outside;
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
        band.stroke = {mixed(other_colour, colours::ink, 0.25), 1.5, {9.0, 5.0}};
        band.band_opacity = 0.35;
        recording.stroke = {recording_colour, 2.2, {}};
        outside.stroke = {colours::vermillion, 0.0, {}};
        outside.marker = Marker::circle;
        outside.marker_size_px = 7.0;
        outside.markers_apart_px = 0.0;
        if (is_first_outside_) { outside.legend = {"outside"}; }
        panel.curves = {std::move(band), std::move(recording)};
        if (!outside.x.empty()) { panel.curves.push_back(std::move(outside)); }
        return panel;
    }

    const Comparison& comparison_;
    const AxisComparison& axis_;
    std::string unit_;
    std::string quantity_;
    bool is_first_;
    bool is_first_outside_;  // of those with points outside
};

}  // namespace

Figure figure_of(const ComparisonFigure& request) {
    const Comparison& comparison = request.comparison;
    Figure figure;
    figure.title = comparison.simulations > 0 ? "The sensor and its simulation" : "Two recordings";
    figure.source = comparison.recording_name + "  |  " + comparison.other_name;
    figure.facts = request.facts;
    figure.columns = 3;
    figure.scale = request.scale;
    for (const AxisComparison& axis : comparison.axes) {
        ComparedAxisPanels(comparison, axis).add_to(figure);
    }
    const auto rows = 2 * static_cast<int>(comparison.axes.size());
    figure.width_px = request.width_px;
    figure.height_px =
        static_cast<int>(std::lround((comparison_heading_px + rows * panel_row_px) * request.scale));
    return figure;
}

Rendering render(const ComparisonFigure& comparison) { return render(figure_of(comparison)); }

}  // namespace gyrolog
