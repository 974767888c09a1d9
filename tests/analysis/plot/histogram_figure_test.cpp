#include "analysis/plot/histogram_figure.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/plot/lettering.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;

HistogramTrace trace_of(const std::string& name, double step = 0.5) {
    HistogramTrace trace;
    trace.name = name;
    trace.expanded_uncertainty = 0.0123;
    AmplitudeHistogram& histogram = trace.histogram;
    histogram.samples = 1000;
    histogram.mean = 10.0;
    histogram.standard_deviation = 2.0;
    histogram.excess_kurtosis = 0.25;
    histogram.skewness = -0.125;
    histogram.step = step;
    histogram.bin_width = 1.0;
    histogram.first_edge = 4.0;
    for (std::size_t i = 0; i < 12; ++i) {
        histogram.counts.push_back(static_cast<std::uint64_t>(std::lround(histogram.expected(i))));
    }
    histogram.counts[11] = 0;
    return trace;
}

// Half of the size, in letters of half the size: drawn four times as fast.
HistogramFigure small_figure(std::vector<HistogramTrace> traces) {
    HistogramFigure histograms;
    histograms.traces = std::move(traces);
    histograms.paper = small_paper;
    return histograms;
}

TEST(HistogramFigure, SaysBiasDeviationAndHowGaussianTheSamplesAre) {
    HistogramFigure histograms;
    histograms.per_unit_of_data = 2.0;
    histograms.traces = {trace_of("x")};
    const Panel panel = figure_of(histograms).panels.at(0);
    EXPECT_THAT(panel.notes, ElementsAre("bias 20.000 ± 0.025 °/s (k = 2)", "standard deviation 4.000 °/s",
                                         "excess kurtosis 0.250, skewness −0.125", "bins of 2 counts"));
    EXPECT_EQ(panel.x.title, "x − bias (°/s)");
    // From the first bin's edge, about the bias.
    EXPECT_DOUBLE_EQ(panel.curves.at(0).x.front(), 2.0 * (4.0 - 10.0));
    EXPECT_DOUBLE_EQ(panel.curves.at(0).x.back(), 2.0 * (16.0 - 10.0));
    EXPECT_NEAR(panel.curves.at(1).y.at(5), trace_of("x").histogram.expected(5), 1e-12);
}

TEST(HistogramFigure, HasAPanelForEachAxisWithItsNotesBeside) {
    const Rendering rendering = render(small_figure({trace_of("x"), trace_of("y", 0.0), trace_of("z")}));
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    ASSERT_EQ(rendering.panels.size(), 3U);
    for (const PanelPlace& panel : rendering.panels) {
        ASSERT_TRUE(panel.legend.has_value());
        EXPECT_EQ(panel.plot.right, rendering.panels[0].plot.right);
        EXPECT_GT(panel.legend->left, panel.plot.right);
    }
}

TEST(HistogramFigure, FillsTheStepsAndNotWhatIsBetweenThem) {
    HistogramFigure histograms;
    histograms.traces = {trace_of("x")};
    const Rendering rendering = render(histograms);
    const PanelPlace& panel = rendering.panels.at(0);
    const Picture picture(rendering);
    const Colour fill = mixed(colours::paper, colours::blue, 0.25);
    // Below the Gaussian, which crosses the second bin.
    const double y = panel.y.pixel(0.4 * static_cast<double>(histograms.traces[0].histogram.counts[1]));
    // Just right of the second bin's left edge, and just left of its right one.
    EXPECT_TRUE(picture.has(fill, {panel.x.pixel(-4.9), y}, 12));
    EXPECT_TRUE(picture.has(fill, {panel.x.pixel(-4.1), y}, 12));
    // The first bin is lower.
    EXPECT_FALSE(picture.has(fill, {panel.x.pixel(-5.1), y}, 12));
}

TEST(HistogramFigure, OfAnArrayHasThreeColumns) {
    HistogramFigure histograms = small_figure({});
    for (int i = 0; i < 24; ++i) {
        histograms.traces.push_back(trace_of(std::string("x").append(std::to_string(i))));
    }
    // Small panels share a legend.
    const std::vector<Curve> key = figure_of(histograms).key;
    ASSERT_EQ(key.size(), 2U);
    EXPECT_EQ(key[0].legend, std::vector<std::string>{"samples"});
    EXPECT_EQ(key[1].legend, std::vector<std::string>{"Gaussian of equal deviation"});
    const Rendering rendering = render(histograms);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    ASSERT_EQ(rendering.panels.size(), 24U);
    EXPECT_EQ(rendering.panels[0].plot.top, rendering.panels[2].plot.top);
    EXPECT_EQ(rendering.panels[0].plot.left, rendering.panels[21].plot.left);
    EXPECT_LT(rendering.panels[0].plot.right, rendering.panels[1].plot.left);
    EXPECT_LT(rendering.panels[0].plot.bottom, rendering.panels[3].plot.top);
}

TEST(HistogramFigure, InANarrowColumnHasItsNumbersAboveThePanels) {
    HistogramFigure histograms = small_figure({trace_of("x"), trace_of("y")});
    histograms.paper = {88.0, 300.0};
    const Figure figure = figure_of(histograms);
    EXPECT_EQ(figure.columns, 1);
    EXPECT_EQ(figure.key.size(), 2U);
    for (const Panel& panel : figure.panels) { EXPECT_THAT(panel.caption, testing::HasSubstr("mean")); }
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_THAT(faults_of_letters(rendering.drawing), testing::IsEmpty());
}

TEST(HistogramFigure, RendersConstantAndEmptyColumns) {
    HistogramTrace constant;
    constant.name = "x";
    constant.histogram = amplitude_histogram({"gx", "rad/s", std::vector<double>(100, 0.5)});
    EXPECT_TRUE(render(small_figure({constant, HistogramTrace{}})).ok());
}

}  // namespace
}  // namespace gyrolog
