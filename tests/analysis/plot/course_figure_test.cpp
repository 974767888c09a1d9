#include "analysis/plot/course_figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;

CourseFigure of_two_axes() {
    CourseFigure course;
    course.duration_s = 40.0;
    course.per_unit_of_data = 10.0;
    course.traces = {{"x", {1.0, 2.0, 3.0, 4.0}}, {"y", {-1.0, -2.0, -3.0, -4.0}}};
    course.paper = small_paper;
    return course;
}

TEST(CourseFigure, HasTheMeansInTheMiddleOfTheirParts) {
    const Figure figure = figure_of(of_two_axes());
    ASSERT_EQ(figure.panels.size(), 1U);
    const Curve& x = figure.panels[0].curves.at(0);
    EXPECT_THAT(x.x, ElementsAre(5.0, 15.0, 25.0, 35.0));
    EXPECT_THAT(x.y, ElementsAre(10.0, 20.0, 30.0, 40.0));
    EXPECT_EQ(figure.panels[0].x.title, "time (s)");
}

TEST(CourseFigure, CountsHoursOfALongRecord) {
    CourseFigure course = of_two_axes();
    course.duration_s = 4.0 * 3600.0;
    const Panel panel = figure_of(course).panels.at(0);
    EXPECT_EQ(panel.x.title, "time (h)");
    EXPECT_THAT(panel.curves.at(0).x, ElementsAre(0.5, 1.5, 2.5, 3.5));
}

TEST(CourseFigure, WithATemperatureShowsItAndTheMeansOverIt) {
    CourseFigure course = of_two_axes();
    course.temperature_degC = {20.0, 21.0, 22.0, 21.5};
    const Figure figure = figure_of(course);
    ASSERT_EQ(figure.panels.size(), 3U);
    EXPECT_THAT(figure.panels[1].curves.at(0).y, ElementsAre(20.0, 21.0, 22.0, 21.5));
    const Curve& over = figure.panels[2].curves.at(1);
    EXPECT_THAT(over.x, ElementsAre(20.0, 21.0, 22.0, 21.5));
    EXPECT_EQ(over.stroke.width_px, 0.0);  // points: between them is no course
    const Rendering rendering = render(course);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    const Picture picture(rendering);
    EXPECT_GT(picture.count(colours::blue), 20);
    EXPECT_GT(picture.count(colours::vermillion), 20);
}

}  // namespace
}  // namespace gyrolog
