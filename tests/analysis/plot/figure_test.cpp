#include "analysis/plot/figure.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/plot/lettering.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Curve curve_of(std::vector<double> x, std::vector<double> y, Colour colour = colours::blue) {
    Curve curve;
    curve.x = std::move(x);
    curve.y = std::move(y);
    curve.stroke.colour = colour;
    return curve;
}

Figure figure_with(std::vector<Curve> curves, ScaleKind kind) {
    Panel panel;
    panel.x = {"x (s)", kind, {}};
    panel.y = {"y (°/s)", kind, {}};
    panel.curves = std::move(curves);
    Figure figure;
    figure.title = "A figure";
    figure.panels.push_back(std::move(panel));
    figure.width_px = 800;
    figure.height_px = 550;
    figure.scale = 0.5;
    return figure;
}

Point place_of(const PanelPlace& panel, double x, double y) { return {panel.x.pixel(x), panel.y.pixel(y)}; }

Figure random_walks(std::mt19937_64& random, int curves, int points) {
    std::normal_distribution<double> step;
    std::vector<Curve> walks;
    for (int i = 0; i < curves; ++i) {
        Curve walk;
        double y = 3.0 * step(random);
        for (int k = 0; k < points; ++k) {
            y += step(random) * 3.0 / std::sqrt(points);
            walk.x.push_back(k);
            walk.y.push_back(y);
            walk.lo.push_back(y - 0.2);
            walk.hi.push_back(y + 0.4);
        }
        walk.stroke.colour = colours::cycle[static_cast<std::size_t>(i)];
        walk.legend = {"walk " + std::to_string(i)};
        walks.push_back(std::move(walk));
    }
    return figure_with(std::move(walks), ScaleKind::linear);
}

TEST(Figure, DecodesToTheSizeAskedForAndIsNotBlank) {
    Figure figure = figure_with({curve_of({1, 10, 100}, {3, 1, 2})}, ScaleKind::logarithmic);
    figure.width_px = 801;
    figure.height_px = 603;
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    const Picture picture(rendering);
    EXPECT_EQ(picture.width_px(), 801);
    EXPECT_EQ(picture.height_px(), 603);
    EXPECT_GT(picture.count(colours::ink, 10), 500);
    EXPECT_GT(picture.count(colours::blue, 10), 300);
}

// Of a PNG's pHYs: pixels in a metre, both ways, and the unit.
TEST(Figure, SaysInItsFileHowLargeItIsToBePrinted) {
    Figure figure = figure_with({curve_of({1, 10, 100}, {3, 1, 2})}, ScaleKind::logarithmic);
    const PaperSize paper{180.0, 300.0};
    figure.width_px = paper.width_px();
    figure.height_px = paper.pixels(100.0);
    figure.scale = paper.scale();
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    const std::string png(rendering.png.begin(), rendering.png.end());
    const std::size_t at = png.find("pHYs");
    ASSERT_EQ(at, 37U) << "behind the signature, IHDR and its own length";
    using namespace std::string_literals;
    EXPECT_EQ(png.substr(at + 4, 9), "\0\0\x2e\x23\0\0\x2e\x23\1"s)
        << "300 to the inch are 11811 to the metre";
    EXPECT_EQ(Picture(rendering).width_px(), 2126);
    EXPECT_EQ(Picture(rendering).height_px(), 1181);
}

TEST(Figure, IsTheSameBytesEveryTime) {
    std::mt19937_64 random(1);
    const Figure figure = random_walks(random, 3, 200);
    EXPECT_EQ(render(figure).png, render(figure).png);
}

TEST(Figure, DrawsEveryCurveWhereItsValuesSay) {
    for (const ScaleKind kind : {ScaleKind::linear, ScaleKind::logarithmic}) {
        const std::vector<double> x{1, 3, 10, 40, 100, 700, 1000};
        const std::vector<double> y{0.5, 0.2, 0.02, 0.01, 0.3, 0.04, 0.05};
        const Rendering rendering = render(figure_with({curve_of(x, y)}, kind));
        const Picture picture(rendering);
        const PanelPlace& panel = rendering.panels.at(0);
        for (std::size_t i = 0; i + 1 < x.size(); ++i) {
            const Point a = place_of(panel, x[i], y[i]);
            const Point b = place_of(panel, x[i + 1], y[i + 1]);
            for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                const Point p{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
                EXPECT_TRUE(picture.has(colours::blue, p)) << "after x = " << x[i];
            }
            EXPECT_FALSE(picture.has(colours::blue, {(a.x + b.x) / 2.0, std::fmin(a.y, b.y) - 12.0}));
        }
    }
}

TEST(Figure, DrawsStepsLevelThenUpright) {
    Curve curve = curve_of({0, 1, 2}, {1, 3, 2});
    curve.shape = CurveShape::steps;
    const Rendering rendering = render(figure_with({curve}, ScaleKind::linear));
    const Picture picture(rendering);
    const PanelPlace& panel = rendering.panels.at(0);
    EXPECT_TRUE(picture.has(colours::blue, place_of(panel, 0.5, 1.0)));
    EXPECT_TRUE(picture.has(colours::blue, place_of(panel, 1.0, 2.0)));
    EXPECT_TRUE(picture.has(colours::blue, place_of(panel, 1.5, 3.0)));
    EXPECT_FALSE(picture.has(colours::blue, place_of(panel, 0.5, 2.0)));
}

TEST(Figure, FillsTheBandBetweenItsEndsOnly) {
    Curve curve = curve_of({0, 10}, {5, 5});
    curve.lo = {4, 4};
    curve.hi = {8, 8};
    curve.band_opacity = 1.0;
    const Rendering rendering = render(figure_with({curve}, ScaleKind::linear));
    const Picture picture(rendering);
    const PanelPlace& panel = rendering.panels.at(0);
    EXPECT_TRUE(picture.has(colours::blue, place_of(panel, 3.3, 7.7), 2));
    EXPECT_TRUE(picture.has(colours::blue, place_of(panel, 3.3, 4.2), 2));
    EXPECT_FALSE(
        picture.has(colours::blue, {place_of(panel, 3.3, 8.0).x, place_of(panel, 3.3, 8.0).y - 4.0}));
}

TEST(Figure, ABandOfThatOpacityMixesWithThePaper) {
    Curve curve = curve_of({0, 10}, {5, 5});
    curve.lo = {4, 4};
    curve.hi = {8, 8};
    curve.band_opacity = 0.25;
    const Rendering rendering = render(figure_with({curve}, ScaleKind::linear));
    const Picture picture(rendering);
    EXPECT_GT(picture.count(mixed(colours::paper, colours::blue, 0.25), 1), 10'000);
}

TEST(Figure, DrawsNothingOutsideThePlot) {
    Figure figure =
        figure_with({curve_of({-100, 5, 300}, {-1e6, 3, 1e9}, colours::vermillion)}, ScaleKind::linear);
    figure.panels[0].x.range = Range{0, 10};
    figure.panels[0].y.range = Range{0, 10};
    figure.panels[0].curves[0].stroke.width_px = 8.0;
    figure.panels[0].curves[0].lo = {-1e7, 2, 1e8};
    figure.panels[0].curves[0].hi = {-1e5, 4, 1e10};
    const Rendering rendering = render(figure);
    const Picture picture(rendering);
    const Box plot = rendering.panels.at(0).plot.grown(4.0);
    EXPECT_GT(picture.count(colours::vermillion, 30), 100);
    for (int x = 0; x < picture.width_px(); x += 2) {
        for (int y = 0; y < picture.height_px(); y += 2) {
            const Point p{static_cast<double>(x), static_cast<double>(y)};
            if (!plot.contains(p)) {
                ASSERT_FALSE(picture.has(colours::vermillion, p, 60)) << x << ", " << y;
            }
        }
    }
}

TEST(Figure, LegendCoversNoDataWhereverTheCurvesRun) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 40; ++round) {
        const Figure figure = random_walks(random, 1 + round % 5, 10 + 13 * round);
        const Rendering rendering = render(figure);
        ASSERT_TRUE(rendering.ok()) << rendering.problem;
        const PanelPlace& panel = rendering.panels.at(0);
        ASSERT_TRUE(panel.legend.has_value());
        ASSERT_TRUE((Box{0, 0, 800, 550}.contains(*panel.legend)));
        ASSERT_FALSE(panel.legend->overlaps(panel.plot) && !panel.plot.contains(*panel.legend));
        for (const Curve& curve : figure.panels[0].curves) {
            for (std::size_t i = 0; i < curve.x.size(); ++i) {
                ASSERT_FALSE(panel.legend->contains(place_of(panel, curve.x[i], curve.y[i])));
                ASSERT_FALSE(panel.legend->contains(place_of(panel, curve.x[i], curve.lo[i])));
                ASSERT_FALSE(panel.legend->contains(place_of(panel, curve.x[i], curve.hi[i])));
            }
        }
        for (const Box& label : panel.labels) { ASSERT_FALSE(panel.legend->overlaps(label)); }
    }
}

TEST(Figure, LabelsNeitherOverlapNorLeaveThePicture) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-9.0, 9.0);
    for (int round = 0; round < 60; ++round) {
        const ScaleKind kind = round % 2 == 0 ? ScaleKind::linear : ScaleKind::logarithmic;
        std::vector<double> x, y;
        for (int i = 0; i < 2 + round % 7; ++i) {
            x.push_back(std::pow(10.0, exponent(random)));
            y.push_back(std::pow(10.0, exponent(random)));
        }
        Figure figure = figure_with({curve_of(x, y)}, kind);
        figure.panels[0].right = SecondUnit{"y (°/h)", 3600.0};
        const Rendering rendering = render(figure);
        ASSERT_TRUE(rendering.ok()) << rendering.problem;
        const auto& labels = rendering.panels.at(0).labels;
        ASSERT_GE(labels.size(), 6U);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            ASSERT_TRUE((Box{0, 0, 800, 550}.contains(labels[i])));
            ASSERT_FALSE(labels[i].overlaps(rendering.panels[0].plot));
            for (std::size_t k = 0; k < i; ++k) { ASSERT_FALSE(labels[i].overlaps(labels[k])); }
        }
    }
}

TEST(Figure, LeavesOutValuesItCannotShowAndBreaksTheCurveThere) {
    const Rendering rendering = render(figure_with(
        {curve_of({1, 2, 3, 4, 5, 6, 7, -8}, {1, 1, nan, 1, 1, 0, 2, 2})}, ScaleKind::logarithmic));
    const Picture picture(rendering);
    const PanelPlace& panel = rendering.panels.at(0);
    EXPECT_TRUE(picture.has(colours::blue, place_of(panel, 1.5, 1.0)));
    EXPECT_FALSE(picture.has(colours::blue, place_of(panel, 3.0, 1.0)));
    EXPECT_TRUE(picture.has(colours::blue, place_of(panel, 4.5, 1.0)));
    EXPECT_FALSE(picture.has(colours::blue, place_of(panel, 5.5, 1.0)));
}

TEST(Figure, BearsEveryOddInput) {
    const double tiny = std::numeric_limits<double>::denorm_min();
    const double huge = std::numeric_limits<double>::max();
    const std::vector<std::vector<double>> columns{{},
                                                   {nan},
                                                   {1.0},
                                                   {0.0},
                                                   {tiny, huge},
                                                   {-huge, huge},
                                                   {1.0, 1.0, 1.0},
                                                   {-infinity, infinity},
                                                   {1e300, 1e301},
                                                   {1e9, 1e9 + 1e-6},
                                                   {1.0, nan, 2.0}};
    for (const ScaleKind kind : {ScaleKind::linear, ScaleKind::logarithmic}) {
        for (const auto& x : columns) {
            for (const auto& y : columns) {
                Curve curve = curve_of(x, y);
                curve.lo = x;
                curve.hi = y;
                curve.marker = Marker::circle;
                curve.legend = {"x"};
                Figure figure = figure_with({curve}, kind);
                figure.width_px = 240;
                figure.height_px = 180;
                figure.scale = 0.4;
                figure.panels[0].callouts.push_back({nan, 1.0, "N", colours::ink, Marker::square});
                figure.panels[0].guides.push_back({-1.0, "1 s"});
                ASSERT_TRUE(render(figure).ok());
            }
        }
    }
}

TEST(Figure, SaysNoDataWhenThereIsNone) {
    const auto darkness = [](const Figure& figure) {
        return Picture(render(figure)).count(colours::muted_ink, 30);
    };
    Figure shown = figure_with({curve_of({1, 2}, {1, 2})}, ScaleKind::linear);
    Figure empty = figure_with({curve_of({1, 2}, {nan, nan})}, ScaleKind::linear);
    shown.panels[0].x.range = shown.panels[0].y.range = Range{0.0, 1.0};  // the same axes
    shown.panels[0].curves[0] = curve_of({0.1, 0.2}, {0.1, 0.2}, colours::paper);
    EXPECT_GT(darkness(empty), darkness(shown) + 100);
}

TEST(Figure, StacksPanelsWithTheirPlotsInLine) {
    Figure figure = figure_with({curve_of({1, 2}, {1, 2e6})}, ScaleKind::linear);
    figure.panels.push_back(figure_with({curve_of({1, 2}, {1e-7, 2})}, ScaleKind::logarithmic).panels[0]);
    const Rendering rendering = render(figure);
    ASSERT_EQ(rendering.panels.size(), 2U);
    EXPECT_EQ(rendering.panels[0].plot.left, rendering.panels[1].plot.left);
    EXPECT_EQ(rendering.panels[0].plot.right, rendering.panels[1].plot.right);
    EXPECT_LT(rendering.panels[0].plot.bottom, rendering.panels[1].plot.top);
}

TEST(Figure, APanelThatSpansItsRowHasItForItself) {
    Figure figure = figure_with({curve_of({1, 2}, {1, 2})}, ScaleKind::linear);
    figure.panels.resize(4, figure.panels[0]);
    figure.columns = 2;
    figure.panels[1].spans_row = true;
    figure.panels[1].y.names = {{1.0, "a rather long name"}, {2.0, "b"}};
    figure.width_px = figure.height_px = 1200;
    const Rendering rendering = render(figure);
    ASSERT_EQ(rendering.panels.size(), 4U) << rendering.problem;
    const auto& [alone, spanning, left, right] = std::tie(rendering.panels[0].plot, rendering.panels[1].plot,
                                                          rendering.panels[2].plot, rendering.panels[3].plot);
    EXPECT_GT(spanning.width(), 1.5 * left.width());
    EXPECT_LT(alone.bottom, spanning.top);
    EXPECT_LT(spanning.bottom, left.top);
    EXPECT_EQ(left.top, right.top);
    EXPECT_EQ(alone.left, left.left) << "its names widen no other panel's margin";
    EXPECT_GT(spanning.left, left.left);
    EXPECT_GT(right.left, left.right);
}

TEST(Figure, ACaptionStandsAboveTheWordsOfGuidesAndBesideNoOtherPanels) {
    Figure figure = figure_with({curve_of({1, 2}, {1, 2})}, ScaleKind::linear);
    figure.panels[0].caption = "x: white noise that is left, by the bandwidth of the rate";
    figure.panels[0].guides = {{1.2, "1.2 Hz"}, {1.99, "1.99 Hz"}};
    figure.panels.resize(2, figure.panels[0]);
    figure.columns = 2;
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_EQ(rendering.panels[0].words.size(), 2U);
    EXPECT_THAT(faults_of_letters(rendering.drawing), testing::IsEmpty());
}

TEST(Figure, AnAxisHasWordsInPlaceOfNumbers) {
    Figure figure = figure_with({curve_of({1, 2}, {1, 2})}, ScaleKind::linear);
    figure.panels[0].y.names = {{1.0, "one"}, {1.5, "one and a half"}};
    figure.panels[0].x.names = {{1.0, "here"}};
    const Rendering rendering = render(figure);
    ASSERT_EQ(rendering.panels.size(), 1U) << rendering.problem;
    EXPECT_EQ(rendering.panels[0].labels.size(), 3U);
}

TEST(Figure, TwiceTheScaleIsTheSameLayoutTwiceAsFine) {
    Figure figure = figure_with({curve_of({1, 20, 3000}, {5, 2, 1})}, ScaleKind::logarithmic);
    const Box small = render(figure).panels.at(0).plot;
    figure.width_px *= 2;
    figure.height_px *= 2;
    figure.scale *= 2.0;
    const Box large = render(figure).panels.at(0).plot;
    EXPECT_NEAR(large.left, 2.0 * small.left, 2.0);
    EXPECT_NEAR(large.right, 2.0 * small.right, 2.0);
    EXPECT_NEAR(large.top, 2.0 * small.top, 2.0);
    EXPECT_NEAR(large.bottom, 2.0 * small.bottom, 2.0);
}

TEST(Figure, RefusesWhatCannotBeDrawnAndSaysWhy) {
    Figure figure = figure_with({}, ScaleKind::linear);
    figure.font_directory = "/nowhere";
    EXPECT_THAT(render(figure).problem, HasSubstr("install fonts-dejavu-core"));
    EXPECT_TRUE(render(figure).png.empty());

    figure = figure_with({}, ScaleKind::linear);
    figure.width_px = 100;
    EXPECT_THAT(render(figure).problem, HasSubstr("180 x 140 to 16384 x 16384"));
    figure.width_px = 20'000;
    EXPECT_FALSE(render(figure).ok());
    figure = figure_with({}, ScaleKind::linear);
    figure.scale = nan;
    EXPECT_FALSE(render(figure).ok());
    for (const Range range : {Range{1.0, 1.0}, Range{2.0, 1.0}, Range{nan, 1.0}, Range{1e20, 1e20 + 1e5}}) {
        figure = figure_with({}, ScaleKind::linear);
        figure.panels[0].y.range = range;
        EXPECT_THAT(render(figure).problem, HasSubstr("not a range"));
    }
}

TEST(Figure, LongTitlesAndSourcesAreShortenedNotCutOff) {
    Figure figure = figure_with({curve_of({1, 2}, {1, 2})}, ScaleKind::linear);
    figure.title = std::string(500, 'W');
    figure.source = std::string(500, 'M') + ".pcapng";
    for (int i = 0; i < 12; ++i) { figure.facts.push_back("fact number " + std::to_string(i)); }
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok());
    const Picture picture(rendering);
    for (int y = 0; y < static_cast<int>(rendering.panels[0].plot.top); ++y) {
        for (const double from_edge : {2.0, 6.0, 10.0}) {
            ASSERT_TRUE(
                picture.has(colours::paper, {picture.width_px() - from_edge, static_cast<double>(y)}, 0));
        }
    }
}

}  // namespace
}  // namespace gyrolog
