#include "analysis/plot/histogram_figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t most_in_one_column = 4;
constexpr int histogram_heading_px = 130;
constexpr int histogram_key_px = 44;
constexpr int wide_panel_px = 430;
constexpr int small_panel_px = 380;

constexpr double samples_opacity = 0.25;
constexpr const char* gaussian_name = "Gaussian of equal deviation";
const Stroke gaussian_line{colours::ink, 2.0, {14.0, 7.0}};

// A bin of one sample still stands above the foot of a logarithmic axis.
constexpr double foot = 0.5;

// To two digits of the uncertainty: "0.30812 ± 0.00026".
std::string with_expanded_uncertainty(double value, double uncertainty) {
    if (!(uncertainty > 0.0) || !std::isfinite(uncertainty)) { return rounded_number(value, 6); }
    const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 12);
    return fixed_decimal(value, decimals) + " ± " + fixed_decimal(uncertainty, decimals);
}

std::string coverage_text(double factor) {
    return fixed_decimal(factor, factor == std::round(factor) ? 0 : 2);
}

std::vector<std::string> notes_of(const HistogramTrace& trace, const HistogramFigure& figure) {
    const AmplitudeHistogram& histogram = trace.histogram;
    const auto on_paper = [&](double value) { return value * figure.per_unit_of_data; };
    const std::string unit = " " + figure.unit_name;
    std::vector<std::string> notes;
    notes.push_back(
        figure.mean_name + " " +
        with_expanded_uncertainty(on_paper(histogram.mean), on_paper(trace.expanded_uncertainty)) + unit +
        " (k = " + coverage_text(trace.coverage_factor) + ")");
    notes.push_back("standard deviation " + rounded_number(on_paper(histogram.standard_deviation), 4) + unit);
    notes.push_back("excess kurtosis " + fixed_decimal(histogram.excess_kurtosis, 3) + ", skewness " +
                    fixed_decimal(histogram.skewness, 3));
    if (histogram.step > 0.0) {
        const auto steps = std::lround(histogram.bin_width / histogram.step);
        std::string note = "bins of " + std::to_string(steps) + (steps == 1 ? " count" : " counts");
        if (on_paper(histogram.step) != 1.0) {
            note += " of " + rounded_number(on_paper(histogram.step), 4) + unit;
        }
        notes.push_back(std::move(note));
    } else {
        notes.push_back("bins of " + rounded_number(on_paper(histogram.bin_width)) + unit);
    }
    return notes;
}

Panel panel_of(const HistogramTrace& trace, const HistogramFigure& figure, Colour colour, bool is_small) {
    const AmplitudeHistogram& histogram = trace.histogram;
    const auto about_bias = [&](double value) { return (value - histogram.mean) * figure.per_unit_of_data; };
    Panel panel;
    panel.x = {trace.name + " − " + figure.mean_name + " (" + figure.unit_name + ")", ScaleKind::linear, {}};
    panel.y = {"samples in a bin", ScaleKind::logarithmic, {}};
    if (histogram.counts.empty()) { return panel; }

    Curve samples;
    samples.shape = CurveShape::steps;
    Curve gaussian;
    double most = 1.0;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        const auto count = std::max(static_cast<double>(histogram.counts[i]), foot);
        most = std::max({most, count, histogram.expected(i)});
        samples.x.push_back(about_bias(histogram.edge(i)));
        samples.y.push_back(count);
        gaussian.x.push_back(about_bias(histogram.edge(i) + 0.5 * histogram.bin_width));
        gaussian.y.push_back(histogram.expected(i));
    }
    samples.x.push_back(about_bias(histogram.edge(histogram.counts.size())));
    samples.y.push_back(foot);
    samples.lo.assign(samples.x.size(), foot);
    samples.hi = samples.y;
    samples.stroke = {colour, 1.8, {}};
    samples.band_opacity = samples_opacity;
    samples.legend = {"samples of " + trace.name};
    gaussian.stroke = gaussian_line;
    gaussian.sets_range = false;
    gaussian.legend = {gaussian_name};
    panel.y.range = Range{foot, 4.0 * most};
    panel.curves.push_back(std::move(samples));
    if (histogram.standard_deviation > 0.0) { panel.curves.push_back(std::move(gaussian)); }
    if (is_small) {
        for (Curve& curve : panel.curves) { curve.legend.clear(); }
        panel.caption = "mean " + rounded_number(histogram.mean * figure.per_unit_of_data) + ", sd " +
                        rounded_number(histogram.standard_deviation * figure.per_unit_of_data) + " " +
                        figure.unit_name + ", kurt " + rounded_number(histogram.excess_kurtosis, 2);
    } else {
        panel.legend_place = LegendPlace::beside;
        panel.notes = notes_of(trace, figure);
    }
    return panel;
}

}  // namespace

namespace {

// Of panels that have no room for a legend of their own.
std::vector<Curve> key_of_small_panels() {
    std::vector<Curve> key(2);
    key[0].stroke = {colours::muted_ink, 1.8, {}};
    key[0].lo = key[0].hi = {0.0};
    key[0].band_opacity = samples_opacity;
    key[0].legend = {"samples"};
    key[1].stroke = gaussian_line;
    key[1].legend = {gaussian_name};
    return key;
}

}  // namespace

Figure figure_of(const HistogramFigure& histograms) {
    Figure figure;
    figure.title = histograms.title;
    figure.source = histograms.source;
    figure.facts = histograms.facts;
    figure.scale = histograms.paper.scale();
    const bool are_many = histograms.traces.size() > most_in_one_column;
    // In a narrow column the numbers have no room beside a panel.
    const bool are_small = are_many || histograms.paper.columns_up_to(2) == 1;
    figure.columns = are_many ? histograms.paper.columns_up_to(3) : 1;
    for (std::size_t i = 0; i < histograms.traces.size(); ++i) {
        figure.panels.push_back(
            panel_of(histograms.traces[i], histograms, colours::cycle.at(i % (are_many ? 3 : 6)), are_small));
    }
    if (are_small) { figure.key = key_of_small_panels(); }
    const auto columns = static_cast<std::size_t>(figure.columns);
    const auto rows = static_cast<int>((figure.panels.size() + columns - 1) / columns);
    figure.width_px = histograms.paper.width_px();
    const int key_px = are_small ? histogram_key_px : 0;
    figure.height_px = histograms.paper.scaled_pixels(histogram_heading_px + key_px +
                                                      rows * (are_small ? small_panel_px : wide_panel_px));
    return figure;
}

Rendering render(const HistogramFigure& histograms) { return render(figure_of(histograms)); }

}  // namespace gyrolog
