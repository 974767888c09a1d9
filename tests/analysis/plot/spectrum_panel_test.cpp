#include "analysis/plot/spectrum_panel.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

constexpr double N = 0.005 / deg_per_rad;  // 0.3 °/√h

AllanTrace white_trace(const std::string& name, double height = 1.0) {
    AllanTrace trace;
    trace.name = name;
    trace.group = name.substr(0, 1);
    trace.N = PlottedCoefficient{height * N};
    for (double x = 0.01; x < 50.0; x *= 1.5) {
        trace.curve.points.push_back({1, x, height * N / std::sqrt(x), 0.0, 0.0, 1.0, 1});
        const double density = std::pow(height * N, 2);
        trace.spectrum.points.push_back({x, density, 0.8 * density, 1.3 * density, 50.0, 0.4 * x});
        trace.model_spectrum.push_back({x, density});
    }
    return trace;
}

AllanFigure figure_with(std::vector<AllanTrace> traces) {
    AllanFigure figure;
    figure.traces = std::move(traces);
    figure.paper = small_paper;
    figure.height_mm = 163.4;
    figure.spectrum_height_mm = 95.1;
    return figure;
}

// A data sheet's reader looks for N: the level of white noise in the left-hand unit, and in °/√h on the
// right.
TEST(SpectrumPanel, ShowsWhiteNoiseAtTheHeightOfN) {
    const Panel panel = spectrum_panel(figure_with({white_trace("x")}));
    ASSERT_EQ(panel.curves.size(), 2U);
    for (const Curve& curve : panel.curves) {
        for (const double y : curve.y) { EXPECT_NEAR(y, 0.005, 1e-12); }
    }
    EXPECT_NEAR(panel.curves[0].lo[0], 0.005 * std::sqrt(0.8), 1e-12);
    EXPECT_NEAR(panel.curves[0].y[0] * panel.right->factor, 0.3, 1e-9);
}

TEST(SpectrumPanel, IsBelowTheAllanCurvesInTheSameColours) {
    const AllanFigure allan = figure_with({white_trace("x"), white_trace("y", 2.0)});
    const Figure figure = figure_of(allan);
    ASSERT_EQ(figure.panels.size(), 2U);
    EXPECT_EQ(figure.height_px, 550 + 320);
    EXPECT_EQ(figure.panels[1].curves[0].stroke.colour, colours::blue);
    EXPECT_EQ(figure.panels[1].curves[2].stroke.colour, colours::vermillion);
    for (const Curve& curve : figure.panels[1].curves) { EXPECT_TRUE(curve.legend.empty()); }
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    // The Allan panel is as large as without the spectrum.
    AllanFigure alone = allan;
    for (AllanTrace& trace : alone.traces) { trace.spectrum.points.clear(); }
    const Rendering without = render(alone);
    EXPECT_EQ(without.panels.size(), 1U);
    EXPECT_NEAR(rendering.panels[0].plot.height(), without.panels[0].plot.height(),
                0.05 * without.panels[0].plot.height());
}

TEST(SpectrumPanel, HasAKeyToItsModelWhetherOrNotTheDeviationHasOne) {
    const auto keys = [](const AllanTrace& trace) {
        const Figure figure = figure_of(figure_with({trace}));
        std::vector<std::string> names;
        for (const Curve& curve : figure.panels[0].curves) {
            if (curve.legend.size() == 1) { names.push_back(curve.legend[0]); }
        }
        return names;
    };
    AllanTrace trace = white_trace("x");
    EXPECT_THAT(keys(trace), Contains("model of the spectrum"));
    trace.model = {{1.0, N}};
    EXPECT_THAT(keys(trace), Contains("model"));
    EXPECT_THAT(keys(trace), Not(Contains("model of the spectrum")));
    trace.model.clear();
    trace.model_spectrum.clear();
    EXPECT_THAT(keys(trace), Not(Contains(testing::StartsWith("model"))));
}

TEST(SpectrumPanel, MarksTheStrongestLinesWithTheirFrequency) {
    AllanTrace trace = white_trace("x");
    for (const double f_hz : {31.4, 12.25, 5.0, 1.0}) {
        SpectralLine line;
        line.f_hz = f_hz;
        trace.lines.push_back(line);
    }
    const Panel panel = spectrum_panel(figure_with({trace}));
    std::vector<std::string> words;
    for (const Callout& callout : panel.callouts) { words.push_back(callout.text); }
    EXPECT_THAT(words, ElementsAre("31.40 Hz", "12.25 Hz", "5.000 Hz"));
    EXPECT_NEAR(panel.callouts[0].x, 31.4, 0.4 * 31.4);
}

const Curve* upright_at(const Panel& panel, double f_hz) {
    for (const Curve& curve : panel.curves) {
        if (curve.x == std::vector<double>{f_hz, f_hz}) { return &curve; }
    }
    return nullptr;
}

// A weak steady line is lost in its band's average: its marker stands on the peak of the unaveraged spectrum.
TEST(SpectrumPanel, DrawsALineThatAveragingHides) {
    AllanTrace trace = white_trace("x");
    SpectralLine line;
    line.f_hz = 31.4;
    // Of a bin of 0.5 Hz, 2 x 12.6 Hz / 50: a density of 10 N^2, and 0.4 N^2 of the band.
    const double bin_hz = 2.0 * trace.spectrum.points.back().width_hz / 50.0;
    line.amplitude = 2.0 * N * std::sqrt(10.0 * bin_hz);
    trace.lines.push_back(line);
    const Panel panel = spectrum_panel(figure_with({trace}));
    const Curve* stem = upright_at(panel, 31.4);
    ASSERT_NE(stem, nullptr);
    EXPECT_NEAR(stem->y.at(0), 0.005, 1e-9);
    EXPECT_GT(stem->y.at(1), 0.005 * 3.0);
    EXPECT_LT(stem->y.at(1), 0.005 * 4.0);
    EXPECT_DOUBLE_EQ(panel.callouts.at(0).y, stem->y.at(1));
    EXPECT_DOUBLE_EQ(panel.callouts.at(0).x, 31.4);
}

TEST(SpectrumPanel, DrawsNoStemWhereTheBandsShowTheLine) {
    AllanTrace trace = white_trace("x");
    SpectrumPoint& top = trace.spectrum.points.at(18);
    top.density *= 9.0;
    SpectralLine line;
    line.f_hz = top.f_hz;
    line.amplitude = N;
    trace.lines.push_back(line);
    const Panel panel = spectrum_panel(figure_with({trace}));
    EXPECT_EQ(upright_at(panel, line.f_hz), nullptr);
    EXPECT_NEAR(panel.callouts.at(0).y, 0.015, 1e-9);
}

TEST(AllanFigure, DrawsAnArrayInOneColourForEachAxis) {
    std::vector<AllanTrace> traces;
    for (int unit = 1; unit <= 8; ++unit) {
        for (const char* axis : {"x", "y", "z"}) {
            traces.push_back(white_trace(axis + std::to_string(unit), 1.0 + 0.1 * unit));
        }
    }
    const Figure figure = figure_of(figure_with(traces));
    std::vector<std::vector<std::string>> rows;
    for (const Curve& curve : figure.panels[0].curves) {
        if (!curve.legend.empty()) { rows.push_back(curve.legend); }
    }
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_THAT(rows[0], ElementsAre("8 × x", "0.00550 … 0.00900", "0.330 … 0.540"));
    EXPECT_EQ(figure.panels[0].curves[0].stroke.colour, figure.panels[0].curves[3].stroke.colour);
    EXPECT_EQ(figure.panels[1].curves.size(), 24U);
    EXPECT_TRUE(render(figure).ok());
}

TEST(AllanFigure, HasNoSpectrumOfConstantData) {
    AllanTrace trace = white_trace("x");
    for (SpectrumPoint& p : trace.spectrum.points) { p.density = p.lo = p.hi = 0.0; }
    EXPECT_EQ(figure_of(figure_with({trace})).panels.size(), 1U);
}

}  // namespace
}  // namespace gyrolog
