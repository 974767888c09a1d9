#include "analysis/plot/allan_figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "tests/analysis/plot/lettering.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;

// A gyro of 0.005 °/s/√Hz, 0.001 °/s and 5e-5 °/s/√s, in rad.
constexpr double gyro_N = 0.005 * rad_per_deg;
constexpr double gyro_B = 0.001 * rad_per_deg;
constexpr double gyro_K = 5e-5 * rad_per_deg;

double deviation_of_gyro(double tau_s) {
    return std::sqrt(gyro_N * gyro_N / tau_s + 0.4413 * gyro_B * gyro_B + gyro_K * gyro_K * tau_s / 3.0);
}

AllanTrace trace_of(const std::string& name, double tau_min_s, double tau_max_s, int points,
                    double factor = 1.0) {
    AllanTrace trace;
    trace.name = name;
    for (int i = 0; i < points; ++i) {
        const double tau_s =
            tau_min_s * std::pow(tau_max_s / tau_min_s, points == 1 ? 0.0 : i / (points - 1.0));
        const double sigma = factor * deviation_of_gyro(tau_s);
        const double spread = 0.5 * std::sqrt(tau_s / tau_max_s);
        trace.curve.points.push_back(
            {i + 1, tau_s, sigma, sigma * (1.0 - spread), sigma * (1.0 + spread), 10.0, 10});
        trace.model.push_back({tau_s, sigma});
    }
    trace.N = PlottedCoefficient{factor * gyro_N, 0.01 * gyro_N};
    trace.B = PlottedCoefficient{factor * gyro_B};
    trace.K = PlottedCoefficient{factor * gyro_K};
    return trace;
}

AllanFigure small_figure(std::vector<AllanTrace> traces) {
    AllanFigure figure;
    figure.source = "run7.pcapng";
    figure.facts = {"1 kHz", "12 h"};
    figure.traces = std::move(traces);
    figure.paper = small_paper;
    figure.height_mm = 163.4;
    return figure;
}

const Callout* callout_named(const Panel& panel, const std::string& name) {
    const auto found = std::find_if(panel.callouts.begin(), panel.callouts.end(),
                                    [&](const Callout& callout) { return callout.text == name; });
    return found == panel.callouts.end() ? nullptr : &*found;
}

// IEEE Std 952-1997 C.1: N is the line's value at 1 s, K at 3 s, and the flat part is 0.664 B.
TEST(AllanFigure, MarksCoefficientsWhereTheStandardReadsThem) {
    const Figure figure = figure_of(small_figure({trace_of("x", 0.01, 10'000.0, 60)}));
    const Panel& panel = figure.panels.at(0);
    const Callout* n = callout_named(panel, "N");
    const Callout* b = callout_named(panel, "B");
    const Callout* k = callout_named(panel, "K");
    ASSERT_TRUE(n != nullptr && b != nullptr && k != nullptr);
    EXPECT_EQ(n->x, 1.0);
    EXPECT_NEAR(n->y, 0.005, 1e-15);
    EXPECT_EQ(k->x, 3.0);
    EXPECT_NEAR(k->y, 5e-5, 1e-17);
    EXPECT_NEAR(b->y / 0.001, 0.664, 0.0005);
    // The least of N^2/tau + K^2 tau/3 is at sqrt(3) N/K.
    const double least_s = std::sqrt(3.0) * 0.005 / 5e-5;
    EXPECT_NEAR(std::log10(b->x / least_s), 0.0, 0.5 * 6.0 / 59.0);
}

TEST(AllanFigure, SlopeLinesHaveTheSlopesOfTheirNoise) {
    const Figure figure = figure_of(small_figure({trace_of("x", 0.01, 10'000.0, 60)}));
    std::vector<double> slopes;
    for (const Curve& curve : figure.panels.at(0).curves) {
        if (curve.x.size() == 2) {
            slopes.push_back(std::log(curve.y[1] / curve.y[0]) / std::log(curve.x[1] / curve.x[0]));
        }
    }
    ASSERT_EQ(slopes.size(), 3U);
    EXPECT_NEAR(slopes[0], -0.5, 1e-12);
    EXPECT_NEAR(slopes[1], 0.0, 1e-12);
    EXPECT_NEAR(slopes[2], 0.5, 1e-12);
}

TEST(AllanFigure, WritesCoefficientsInTheUnitsOfTheirColumns) {
    const Figure figure = figure_of(small_figure({trace_of("x", 0.01, 10'000.0, 60)}));
    const Panel& panel = figure.panels.at(0);
    EXPECT_THAT(panel.legend_header, ElementsAre("", "N  (°/s)/√Hz", "N  °/√h", "B  °/h", "K  (°/s)√Hz"));
    const auto row = std::find_if(panel.curves.begin(), panel.curves.end(),
                                  [](const Curve& curve) { return curve.legend.size() == 5; });
    ASSERT_NE(row, panel.curves.end());
    // 0.005 °/s/√Hz = 0.3 °/√h; 0.001 °/s = 3.6 °/h.
    EXPECT_THAT(row->legend, ElementsAre("x", "0.005000(50)", "0.3000(30)", "3.60", "5.00×10⁻⁵"));
}

// What makes humps in the dashed curve is told.
TEST(AllanFigure, TellsWhatTheModelHasBesideItsCoefficients) {
    AllanTrace trace = trace_of("x", 0.01, 1000.0, 30);
    trace.gauss_markov = {{0.002 * rad_per_deg, 12.5}};
    trace.sinusoids = {{0.01 * rad_per_deg, 0.25}};
    EXPECT_THAT(figure_of(small_figure({trace})).panels[0].notes,
                ElementsAre("x: Gauss-Markov, σ 0.00200 °/s, correlation time 12.5 s",
                            "x: sinusoid, amplitude 0.0100 °/s, 0.250 Hz"));
    trace.sinusoids.assign(9, trace.sinusoids[0]);
    const std::vector<std::string> many = figure_of(small_figure({trace})).panels[0].notes;
    ASSERT_EQ(many.size(), 6U);
    EXPECT_EQ(many.back(), "and 5 more terms");
}

TEST(AllanFigure, ADegreePerSecondIs3600DegreesPerHourOnTheRight) {
    EXPECT_DOUBLE_EQ(figure_of(small_figure({})).panels.at(0).right->factor, 3600.0);
    AllanFigure in_rad = small_figure({});
    in_rad.unit = DeviationUnit::rad_per_s();
    EXPECT_NEAR(figure_of(in_rad).panels.at(0).right->factor, 206264.806 * 1.0,
                1e-3);  // arc seconds in a radian
    AllanFigure acceleration = small_figure({});
    acceleration.unit = DeviationUnit::as_given("m/s²");
    EXPECT_FALSE(figure_of(acceleration).panels.at(0).right.has_value());
}

TEST(AllanFigure, LeavesOutColumnsNobodyHasAValueFor) {
    AllanTrace with_n = trace_of("x", 0.01, 100.0, 20);
    with_n.B.reset();
    with_n.K.reset();
    AllanFigure allan = small_figure({with_n, trace_of("y", 0.01, 100.0, 20)});
    allan.traces[1].N.reset();
    allan.traces[1].B.reset();
    allan.traces[1].K.reset();
    allan.unit = DeviationUnit::as_given("m/s²");
    const Panel panel = figure_of(allan).panels.at(0);
    EXPECT_THAT(panel.legend_header, ElementsAre("", "N  (m/s²)/√Hz"));
    std::vector<std::vector<std::string>> rows;
    for (const Curve& curve : panel.curves) {
        if (curve.legend.size() == 2) { rows.push_back(curve.legend); }
    }
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[1][1], "–");
}

TEST(AllanFigure, DoesNotShrinkTheDataForAMarkFarAway) {
    const Figure figure = figure_of(small_figure({trace_of("x", 1e-6, 1e-4, 20)}));
    EXPECT_TRUE(figure.panels.at(0).callouts.empty());
    EXPECT_TRUE(figure.panels.at(0).guides.empty());
}

TEST(AllanFigure, DrawsEachTraceInItsOwnColourAndMarker) {
    std::vector<AllanTrace> traces;
    for (int i = 0; i < 6; ++i) {
        traces.push_back(trace_of("axis " + std::to_string(i), 0.01, 1e4, 40, std::pow(2.0, i)));
    }
    AllanFigure allan = small_figure(traces);
    for (AllanTrace& trace : allan.traces) { trace.model.clear(); }
    const Rendering rendering = render(allan);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    const Picture picture(rendering);
    const PanelPlace& panel = rendering.panels.at(0);
    for (std::size_t i = 0; i < 6; ++i) {
        const AllanPoint& first = traces[i].curve.points.front();
        const Point at{panel.x.pixel(first.tau_s), panel.y.pixel(first.deviation * deg_per_rad)};
        EXPECT_TRUE(picture.has(colours::cycle[i], at, 3)) << i;
    }
}

TEST(AllanFigure, RendersWhateverAnAnalysisMayReturn) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<AllanFigure> figures{small_figure({}),
                                     small_figure({AllanTrace{}}),
                                     small_figure({trace_of("one point", 1.0, 1.0, 1)}),
                                     small_figure({trace_of("three", 0.5, 2.0, 3)}),
                                     small_figure({trace_of("nine decades", 1e-4, 1e5, 90)}),
                                     small_figure({trace_of("fourteen", 1e-7, 1e7, 90)}),
                                     small_figure({trace_of("huge", 0.01, 100.0, 20, 1e200)}),
                                     small_figure({trace_of("small", 0.01, 100.0, 20, 1e-200)})};
    AllanFigure holes = small_figure({trace_of("x", 0.01, 1e4, 40), trace_of("y", 0.01, 1e4, 40)});
    auto& points = holes.traces[0].curve.points;
    points[3].deviation = nan;
    points[7].deviation = 0.0;
    points[9].tau_s = -1.0;
    points[11].lo = 0.0;
    points[13].hi = infinity;
    holes.traces[0].N->value = nan;
    holes.traces[0].K->value = 0.0;
    holes.traces[1].B->value = infinity;
    holes.traces[1].N->uncertainty = nan;
    holes.traces[1].name = std::string(300, 'y');
    figures.push_back(holes);
    AllanFigure equal = small_figure({trace_of("x", 1.0, 100.0, 9)});
    for (AllanPoint& p : equal.traces[0].curve.points) { p.deviation = p.lo = p.hi = 1.0; }
    figures.push_back(equal);
    for (const AllanFigure& figure : figures) {
        const Rendering rendering = render(figure);
        EXPECT_TRUE(rendering.ok()) << rendering.problem;
        EXPECT_EQ(Picture(rendering).width_px(), 800);
    }
}

// As it is printed: 180 mm wide.
TEST(AllanFigure, HasLettersThatCanBeReadAndCoverNothing) {
    AllanFigure figure = small_figure({trace_of("x", 0.01, 1e4, 40, 0.4), trace_of("y", 0.01, 1e4, 40, 1.0),
                                       trace_of("z", 0.01, 1e4, 40, 2.2)});
    for (const double width_mm : {180.0, 240.0}) {
        figure.paper = {width_mm, 300.0};
        figure.height_mm = AllanFigure().height_mm;
        const Rendering rendering = render(figure);
        ASSERT_TRUE(rendering.ok()) << rendering.problem;
        EXPECT_EQ(Picture(rendering).width_px(), std::lround(width_mm / 25.4 * 300.0));
        EXPECT_THAT(faults_of_letters(rendering.drawing), testing::IsEmpty());
    }
}

// One column of a journal. The table may have letters of 7 pt.
TEST(AllanFigure, CanBeReadInANarrowColumn) {
    AllanFigure figure = small_figure({trace_of("x", 0.01, 1e4, 40, 0.4), trace_of("y", 0.01, 1e4, 40, 1.0),
                                       trace_of("z", 0.01, 1e4, 40, 2.2)});
    figure.title = "Allan deviation and noise density of the accelerometer";
    figure.source = "night.pcapng";
    figure.facts = {"100 Hz", "6 h", "2,160,000 samples", "stopped by the user for 2.0 s, none missing"};
    figure.unit = DeviationUnit::rad_per_s_as_deg_per_s();
    for (AllanTrace& trace : figure.traces) {
        trace.N = PlottedCoefficient{1.7463e-4, 8.5e-8};
        trace.B = PlottedCoefficient{3.4e-5, 1.9e-6};
        trace.K = PlottedCoefficient{1.7e-6, 3.7e-7};
    }
    figure.paper = {88.0, 300.0};
    figure.height_mm = AllanFigure().height_mm;
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_THAT(faults_of_letters(rendering.drawing, 7.0), testing::IsEmpty());
    EXPECT_TRUE(rendering.panels.at(0).legend.has_value());
}

TEST(AllanFigure, WordsCoverNeitherEachOtherNorTheLegend) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> factor(0.3, 3.0);
    for (int round = 0; round < 12; ++round) {
        const Rendering rendering = render(small_figure({trace_of("x", 0.01, 1e4, 40, factor(random)),
                                                         trace_of("y", 0.01, 1e4, 40, factor(random)),
                                                         trace_of("z", 0.01, 1e4, 40, factor(random))}));
        const PanelPlace& panel = rendering.panels.at(0);
        ASSERT_TRUE(panel.legend.has_value());
        ASSERT_GE(panel.words.size(), 4U);
        for (std::size_t i = 0; i < panel.words.size(); ++i) {
            EXPECT_FALSE(panel.words[i].overlaps(*panel.legend));
            for (std::size_t k = 0; k < i; ++k) { EXPECT_FALSE(panel.words[i].overlaps(panel.words[k])); }
        }
    }
}

}  // namespace
}  // namespace gyrolog
