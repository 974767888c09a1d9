#include "analysis/plot/comparison_figure.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "tests/analysis/plot/lettering.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

AmplitudeHistogram bell() {
    AmplitudeHistogram histogram;
    histogram.samples = 1000;
    histogram.mean = 0.1 * rad_per_deg;
    histogram.standard_deviation = 0.02 * rad_per_deg;
    histogram.bin_width = 0.01 * rad_per_deg;
    histogram.first_edge = 0.04 * rad_per_deg;
    for (std::size_t bin = 0; bin < 12; ++bin) {
        histogram.counts.push_back(static_cast<std::uint64_t>(std::lround(histogram.expected(bin))));
    }
    return histogram;
}

ComparedCurve falling_curve(bool with_own_interval) {
    ComparedCurve curve;
    for (int i = 0; i < 30; ++i) {
        const double at = 0.01 * std::pow(1.4, i);
        const double value = 0.005 * rad_per_deg / std::sqrt(at);
        curve.at.push_back(at);
        curve.other.push_back(value);
        curve.lo.push_back(0.9 * value);
        curve.hi.push_back(1.1 * value);
        curve.recording.push_back(i < 10 ? 2.0 * value : value);
        if (with_own_interval) {
            curve.recording_lo.push_back(0.95 * curve.recording.back());
            curve.recording_hi.push_back(1.05 * curve.recording.back());
        }
    }
    curve.outside = {{curve.at[0], curve.at[9], curve.at[0], 6.02, 10}};
    return curve;
}

Comparison comparison_of(const std::vector<std::string>& axes, bool with_model) {
    Comparison comparison;
    comparison.recording_name = "night.csv";
    comparison.other_name = "model.json";
    comparison.simulations = with_model ? 40 : 0;
    comparison.band_probability = 1.0 - 2.0 / 41.0;
    for (const std::string& name : axes) {
        AxisComparison& axis = comparison.axes.emplace_back();
        axis.axis = name;
        axis.allan = falling_curve(!with_model);
        axis.spectrum = falling_curve(!with_model);
        axis.recording_histogram = axis.other_histogram = bell();
        axis.recording_averages = {1.0, {0.001, -0.002, std::nan(""), 0.001}};
        axis.other_averages = {1.0, {0.004, -0.001, 0.000, -0.003}};
    }
    return comparison;
}

TEST(ComparisonFigure, HasTwoRowsOfThreePanelsForEachAxis) {
    const Comparison comparison = comparison_of({"x", "y", "z"}, true);
    const Figure figure = figure_of(ComparisonFigure{comparison, {"100 Hz"}});
    EXPECT_EQ(figure.columns, 3);
    EXPECT_EQ(figure.panels.size(), 18U);
    EXPECT_EQ(figure.width_px, 2126) << "180 mm, 300 to the inch";
    EXPECT_EQ(figure.source, "night.csv  |  model.json");
}

TEST(ComparisonFigure, HasLettersThatCanBeReadAndCoverNothing) {
    const Comparison comparison = comparison_of({"x", "y", "z"}, true);
    const Rendering rendering = render(ComparisonFigure{comparison, {"100 Hz"}});
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_THAT(faults_of_letters(rendering.drawing), testing::IsEmpty());
}

TEST(ComparisonFigure, FitsASheetAlsoOnNarrowPaper) {
    const Comparison comparison = comparison_of({"gx", "gy", "gz"}, true);
    for (const double width_mm : {88.0, 120.0, 130.0, 180.0, 420.0}) {
        const PaperSize paper{width_mm, 100.0};
        const Figure figure =
            figure_of(ComparisonFigure{.comparison = comparison, .facts = {}, .paper = paper});
        EXPECT_LE(figure.height_px, paper.pixels(sheet_height_mm)) << width_mm;
        EXPECT_TRUE(render(figure).ok()) << width_mm;
        const std::size_t of_columns[] = {6U, 12U, 18U};
        EXPECT_EQ(figure.panels.size(), of_columns[figure.columns - 1]) << "not over time on narrow paper";
    }
}

TEST(ComparisonFigure, DrawsBothTimeSeriesOnTheSameScale) {
    const Comparison comparison = comparison_of({"x"}, true);
    const Figure figure = figure_of(ComparisonFigure{comparison, {}});
    const Range first = *figure.panels.at(0).y.range;
    const Range second = *figure.panels.at(1).y.range;
    EXPECT_EQ(first.lo, second.lo);
    EXPECT_EQ(first.hi, second.hi);
    EXPECT_LT(first.lo, -0.003 * deg_per_rad);
    EXPECT_GT(first.hi, 0.004 * deg_per_rad);
}

TEST(ComparisonFigure, MarksWhatLiesOutsideInDecibels) {
    const Comparison comparison = comparison_of({"x"}, true);
    const Panel ratio = figure_of(ComparisonFigure{comparison, {}}).panels.at(5);
    ASSERT_EQ(ratio.curves.size(), 3U);
    EXPECT_EQ(ratio.curves[2].x.size(), 10U);
    EXPECT_NEAR(ratio.curves[2].y.front(), 6.02, 0.01);
    EXPECT_NEAR(ratio.curves[0].hi.front(), 20.0 * std::log10(1.1), 1e-9);
    Comparison inside = comparison;
    inside.axes[0].allan.outside.clear();
    EXPECT_EQ(figure_of(ComparisonFigure{inside, {}}).panels.at(5).curves.size(), 2U);
}

TEST(ComparisonFigure, HasOneKeyOfAllPanels) {
    Comparison comparison = comparison_of({"x", "y", "z"}, true);
    const auto names = [&] {
        std::vector<std::string> found;
        for (const Curve& curve : figure_of(ComparisonFigure{comparison, {}}).key) {
            found.push_back(curve.legend.at(0));
        }
        return found;
    };
    comparison.axes[0].allan.outside.clear();
    EXPECT_EQ(names(), (std::vector<std::string>{"simulated, 95.1 %", "recording", "recording, outside"}));
    for (AxisComparison& axis : comparison.axes) { axis.allan.outside.clear(); }
    EXPECT_EQ(names().size(), 2U);
    for (const Panel& panel : figure_of(ComparisonFigure{comparison, {}}).panels) {
        for (const Curve& curve : panel.curves) { EXPECT_TRUE(curve.legend.empty()); }
    }
}

// So a point between them that cannot be shown, which would break a line, changes no pixel.
TEST(ComparisonFigure, JoinsNoMarksByALine) {
    const Comparison comparison = comparison_of({"x"}, true);
    Figure figure = figure_of(ComparisonFigure{comparison, {}});
    figure.panels = {figure.panels.at(5)};
    Panel& panel = figure.panels.front();
    panel.curves = {panel.curves.at(2)};
    Curve& marks = panel.curves.front();
    marks.x = {1.0, 10.0};
    marks.y = {0.0, 0.5};
    const Rendering together = render(figure);
    ASSERT_TRUE(together.ok()) << together.problem;
    EXPECT_GT(Picture(together).count(colours::vermillion, 60), 20);
    marks.x = {1.0, 3.0, 10.0};
    marks.y = {0.0, std::nan(""), 0.5};
    EXPECT_EQ(render(figure).png, together.png);
}

TEST(ComparisonFigure, ScalesADistributionToUnitArea) {
    const Comparison comparison = comparison_of({"x"}, true);
    const Curve curve = figure_of(ComparisonFigure{comparison, {}}).panels.at(2).curves.at(0);
    double area = 0.0;
    for (const double density : curve.y) { area += density * 0.01; }
    EXPECT_NEAR(area, 1.0, 0.01);
    EXPECT_NEAR(curve.x.front(), -0.06, 1e-12);  // about the mean
}

TEST(ComparisonFigure, ShowsBothCurvesBandsAndALegendInTheirColours) {
    for (const bool with_model : {true, false}) {
        const Comparison comparison = comparison_of({"x"}, with_model);
        ComparisonFigure figure{comparison, {"100 Hz", "1 h"}};
        figure.paper = small_paper;
        const Rendering rendering = render(figure);
        ASSERT_TRUE(rendering.ok()) << rendering.problem;
        const Picture picture(rendering);
        EXPECT_EQ(picture.width_px(), 800);
        EXPECT_GT(picture.count(colours::blue, 30), 300);
        EXPECT_GT(picture.count(colours::orange, 80), 100);
        EXPECT_GT(picture.count(colours::vermillion, 30), 20);
        EXPECT_TRUE(rendering.key.has_value());
    }
}

}  // namespace
}  // namespace gyrolog
