#include "analysis/plot/unit_spread_figure.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/plot/lettering.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr double least_value = 1.0;
constexpr double step = 0.01;

// Evenly apart, in no order.
AxisUnits even_units(std::size_t count, const std::string& axis = "x") {
    AxisUnits units{axis, {}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        const auto place = static_cast<double>((i * 7) % count);
        units.units.push_back({"S" + std::to_string(i), least_value + step * place, 0.002, false});
    }
    units.spread = PlottedSpread{least_value + step * static_cast<double>(count - 1) / 2.0, 0.02};
    return units;
}

UnitSpreadFigure of_one(AxisUnits axis) { return {{{"bias (°/s)", {std::move(axis)}}}, small_paper}; }

const Curve* with_marker(const Panel& panel, Marker marker) {
    for (const Curve& curve : panel.curves) {
        if (curve.marker == marker) { return &curve; }
    }
    return nullptr;
}

std::vector<std::string> words_of(const std::vector<Curve>& key) {
    std::vector<std::string> words;
    for (const Curve& row : key) { words.push_back(row.legend.at(0)); }
    return words;
}

TEST(UnitSpreadFigure, HasTheUnitsInTheOrderOfTheirValuesOverTheMedian) {
    const Figure figure = figure_of(of_one(even_units(5)));
    const Panel& panel = figure.panels.at(0);
    const Curve* dots = with_marker(panel, Marker::circle);
    ASSERT_NE(dots, nullptr);
    EXPECT_THAT(dots->y, ElementsAre(1.0, 1.01, 1.02, 1.03, 1.04));
    EXPECT_TRUE(std::ranges::is_sorted(dots->x));
    EXPECT_GT(dots->x.front(), 0.0);
    EXPECT_LT(dots->x.back(), 1.0);
    const auto spread =
        std::ranges::find_if(panel.curves, [](const Curve& curve) { return !curve.lo.empty(); });
    ASSERT_NE(spread, panel.curves.end());
    EXPECT_DOUBLE_EQ(spread->y.at(0), 1.02);
    EXPECT_DOUBLE_EQ(spread->lo.at(0), 1.0);
    EXPECT_DOUBLE_EQ(spread->hi.at(0), 1.04);
    EXPECT_THAT(words_of(figure.key),
                ElementsAre("unit ± standard uncertainty", "median ± spread between units"));
}

TEST(UnitSpreadFigure, TellsAnOutlierByItsShapeAndName) {
    AxisUnits units = even_units(9);
    units.units.at(0).value = 1.15;
    units.units.at(0).stands_out = true;
    const Figure figure = figure_of(of_one(units));
    const Panel& panel = figure.panels.at(0);
    const Curve* outliers = with_marker(panel, Marker::diamond);
    ASSERT_NE(outliers, nullptr);
    EXPECT_THAT(outliers->y, ElementsAre(1.15));
    EXPECT_EQ(with_marker(panel, Marker::circle)->y.size(), 8U);
    ASSERT_EQ(panel.callouts.size(), 1U);
    EXPECT_EQ(panel.callouts[0].text, "S0");
    EXPECT_THAT(words_of(figure.key), Contains("stands out"));
}

// One of a hundred times the value must not press the others flat.
TEST(UnitSpreadFigure, PutsWhatIsFarAwayAtTheEdgeWithItsValue) {
    for (const double far : {100.0, -100.0}) {
        AxisUnits units = even_units(9);
        units.units.at(0).value = far;
        units.units.at(0).stands_out = true;
        const Figure figure = figure_of(of_one(units));
        const Panel& panel = figure.panels.at(0);
        const Curve* edge = with_marker(panel, far > 0.0 ? Marker::triangle : Marker::triangle_down);
        ASSERT_NE(edge, nullptr);
        const Range shown = *panel.y.range;
        EXPECT_GT(edge->y.at(0), shown.lo);
        EXPECT_LT(edge->y.at(0), shown.hi);
        EXPECT_LT(shown.hi - shown.lo, 4.0 * 8.0 * step);
        EXPECT_EQ(panel.callouts.at(0).text, far > 0.0 ? "S0: 100" : "S0: −100");
        EXPECT_THAT(words_of(figure.key), Contains(far > 0.0 ? "above the panel" : "below the panel"));
    }
}

TEST(UnitSpreadFigure, IsLogarithmicWhereTheUnitsAreDecadesApartAndPositive) {
    AxisUnits units = even_units(9);
    EXPECT_EQ(figure_of(of_one(units)).panels.at(0).y.kind, ScaleKind::linear);
    for (std::size_t i = 0; i < units.units.size(); ++i) {
        units.units[i].value = std::pow(2.0, static_cast<double>(i));
    }
    EXPECT_EQ(figure_of(of_one(units)).panels.at(0).y.kind, ScaleKind::logarithmic);
    units.units.at(3).value = -1.0;
    EXPECT_EQ(figure_of(of_one(units)).panels.at(0).y.kind, ScaleKind::linear);
}

// A unit at or below zero has no place on a logarithmic scale: it stands at its lower edge.
TEST(UnitSpreadFigure, KeepsAnOutlierThatALogarithmicScaleCannotShow) {
    AxisUnits units = even_units(9);
    for (std::size_t i = 0; i < units.units.size(); ++i) {
        units.units[i].value = std::pow(2.0, static_cast<double>(i));
    }
    units.units.at(3) = {"S3", 0.0, 0.0, true};
    units.spread = PlottedSpread{8.0, 20.0};
    const Panel panel = figure_of(of_one(units)).panels.at(0);
    ASSERT_EQ(panel.y.kind, ScaleKind::logarithmic);
    ASSERT_NE(with_marker(panel, Marker::triangle_down), nullptr);
    EXPECT_TRUE(render(of_one(units)).ok());
}

TEST(UnitSpreadFigure, OfThreeUnitsHasThemAlone) {
    AxisUnits units = even_units(3);
    units.spread.reset();
    const Figure figure = figure_of(of_one(units));
    EXPECT_EQ(with_marker(figure.panels.at(0), Marker::circle)->y.size(), 3U);
    EXPECT_THAT(words_of(figure.key), ElementsAre("unit ± standard uncertainty"));
    EXPECT_TRUE(render(figure).ok());
}

TEST(UnitSpreadFigure, OfEqualUnitsIsDrawn) {
    AxisUnits units = even_units(5);
    for (PlottedUnit& unit : units.units) { unit = {unit.name, 0.0, 0.0, false}; }
    units.spread = PlottedSpread{};
    const Rendering rendering = render(of_one(units));
    EXPECT_TRUE(rendering.ok()) << rendering.problem;
}

TEST(UnitSpreadFigure, OfTwoHundredUnitsIsReadable) {
    AxisUnits units = even_units(200);
    for (std::size_t i = 0; i < 6; ++i) { units.units.at(i).stands_out = true; }
    UnitSpreadFigure spread;
    for (const char* title : {"bias (°/s)", "N (°/s/√Hz)", "sampling rate (Hz)"}) {
        UnitParameter& parameter = spread.parameters.emplace_back(UnitParameter{title, {}});
        for (const char* axis : {"x", "y", "z"}) {
            units.axis = axis;
            parameter.axes.push_back(units);
        }
    }
    const Rendering rendering = render(spread);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_THAT(faults_of_letters(rendering.drawing), IsEmpty());
    // The dots touch, and paper about each would leave of them nothing but paper.
    const Picture picture(rendering);
    EXPECT_GT(picture.count(colours::blue), 2000);
    // More names than a few say nothing.
    EXPECT_THAT(figure_of(spread).panels.at(0).callouts, IsEmpty());
}

}  // namespace
}  // namespace gyrolog
