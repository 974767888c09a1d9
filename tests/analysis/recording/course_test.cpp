#include "analysis/recording/course.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// Instants 0 to 3 and 8 to 11: of twelve, four are missing.
Recording with_a_hole(std::vector<double> values) {
    Recording recording;
    recording.rate_hz = 1.0;
    recording.columns = {{"gx", "rad/s", std::move(values)}};
    recording.segments = {{0, 4, 0}, {4, 4, 8}};
    return recording;
}

TEST(Course, HasTheMeanOfEachPartOfTheGrid) {
    Recording recording = with_a_hole({1.0, 2.0, 3.0, 4.0, 10.0, 20.0, 30.0, 50.0});
    recording.columns.front().scale = 2.0;
    const std::vector<double> course = course_of(recording, recording.columns.front(), 6);
    ASSERT_EQ(course.size(), 6U);
    EXPECT_EQ(course[0], 3.0);
    EXPECT_EQ(course[1], 7.0);
    EXPECT_TRUE(std::isnan(course[2]));
    EXPECT_TRUE(std::isnan(course[3]));
    EXPECT_EQ(course[4], 30.0);
    EXPECT_EQ(course[5], 80.0);
}

TEST(Course, LeavesOutWhatIsNotKnown) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const Recording recording = with_a_hole({1.0, unknown, unknown, unknown, 5.0, 5.0, 5.0, 5.0});
    const std::vector<double> course = course_of(recording, recording.columns.front(), 6);
    EXPECT_EQ(course[0], 1.0);
    EXPECT_TRUE(std::isnan(course[1]));
}

TEST(Course, OfOnePartIsTheMean) {
    const Recording recording = with_a_hole({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0});
    EXPECT_EQ(course_of(recording, recording.columns.front(), 1), std::vector<double>{4.5});
}

}  // namespace
}  // namespace gyrolog
