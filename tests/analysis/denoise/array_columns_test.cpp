#include "analysis/denoise/array_columns.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

Recording ramp(std::size_t rows, double rate_hz, double from = 0.0) {
    Recording recording;
    recording.name = "ramp";
    recording.rate_hz = rate_hz;
    Signal x(rows);
    for (std::size_t i = 0; i < rows; ++i) { x[i] = from + static_cast<double>(i) / rate_hz; }
    recording.columns = {{"gx", "rad/s", x}};
    recording.segments = {{0, rows, 0}};
    return recording;
}

TEST(ArrayColumns, AreOrderedByTheirNumber) {
    Recording recording = ramp(3, 100.0);
    recording.columns.clear();
    for (const char* name : {"gx10", "gx2", "gz1", "ax1", "gx1", "temp", "gxx"}) {
        recording.columns.push_back({name, "rad/s", Signal(3, 0.0)});
    }
    const std::vector<ArrayAxis> axes = array_axes(recording);
    ASSERT_EQ(axes.size(), 2U);
    EXPECT_EQ(axes[0].name, "x");
    EXPECT_EQ(axes[0].unit_names, (std::vector<std::string>{"1", "2", "10"}));
    EXPECT_EQ(axes[1].unit_names, (std::vector<std::string>{"1"}));
}

TEST(JoinRecordings, TakesTheSampleNearestInTime) {
    const Recording a = ramp(1000, 100.0);
    const Recording b = ramp(1000, 100.0, 0.203);  // its values are the shared clock, too
    const JoinedArray joined = join_recordings(std::vector<ArrayMember>{{&a, 0.0}, {&b, 0.203}});
    ASSERT_EQ(joined.failure, "");
    const Column& first = *joined.recording.find("gx1");
    const Column& second = *joined.recording.find("gx2");
    EXPECT_TRUE(std::isnan(second.value(0)));
    for (std::size_t i = 21; i < 1000; ++i) {
        ASSERT_NEAR(second.value(i), first.value(i), 0.005 + 1e-9) << i;
    }
}

TEST(JoinRecordings, FollowsClocksThatRunApart) {
    const Recording a = ramp(20'000, 100.0);
    const Recording b = ramp(20'000, 100.05);
    const JoinedArray joined = join_recordings(std::vector<ArrayMember>{{&a, 0.0}, {&b, 0.0}});
    ASSERT_EQ(joined.failure, "");
    const Column& second = *joined.recording.find("gx2");
    std::size_t known = 0;
    for (std::size_t i = 0; i < 20'000; ++i) {
        if (std::isnan(second.value(i))) { continue; }
        ++known;
        ASSERT_NEAR(second.value(i), static_cast<double>(i) / 100.0, 0.005 + 1e-9);
    }
    EXPECT_GT(known, 19'980U);
    // The last ones lie behind the other clock's end, and ten are left out.
    ASSERT_EQ(joined.recording.warnings.size(), 2U);
    EXPECT_NE(joined.recording.warnings[1].find("difference of the clocks: 10"), std::string::npos)
        << joined.recording.warnings[1];
}

TEST(JoinRecordings, SaysWhyNot) {
    const Recording a = ramp(100, 100.0);
    const Recording b = ramp(100, 102.0);
    EXPECT_NE(join_recordings(std::vector<ArrayMember>{{&a, 0.0}, {&b, 0.0}}).failure, "");
    EXPECT_NE(join_recordings(std::vector<ArrayMember>{{&a, 0.0}, {&a, 500.0}}).failure, "");
}

TEST(JoinRecordings, NumbersUnitsThroughAllMembersAndKeepsTheOtherColumns) {
    Recording a = ramp(10, 100.0);
    a.columns.push_back({"gy1", "rad/s", Signal(10, 1.0)});
    a.columns.push_back({"gy2", "rad/s", Signal(10, 2.0)});
    a.columns.push_back({"ref_x", "rad/s", Signal(10, 9.0)});
    Recording b = ramp(10, 100.0);
    b.columns.push_back({"gy", "rad/s", Signal(10, 3.0)});
    b.columns.push_back({"temp", "degC", Signal(10, 20.0)});
    const Recording joined = join_recordings(std::vector<ArrayMember>{{&a, 0.0}, {&b, 0.0}}).recording;
    EXPECT_EQ(joined.find("gy3")->value(5), 3.0);
    EXPECT_NE(joined.find("gx2"), nullptr);
    EXPECT_NE(joined.find("ref_x"), nullptr);
    EXPECT_EQ(joined.find("temp"), nullptr);
}

TEST(SegmentsKnown, AreCutWhereAUnitHasNoSample) {
    Recording recording = ramp(100, 100.0);
    recording.columns.push_back({"gx2", "rad/s", Signal(100, 0.0)});
    std::get<Signal>(recording.columns[1].data)[40] = std::nan("");
    const std::vector<const Column*> columns{&recording.columns[0], &recording.columns[1]};
    const std::vector<Segment> known = segments_known(columns, recording.segments);
    ASSERT_EQ(known.size(), 2U);
    EXPECT_EQ(known[0].count, 40U);
    EXPECT_EQ(known[1].first_index, 41);
    const Recording part = rows_of(recording, columns, known);
    EXPECT_EQ(part.rows(), 99U);
    EXPECT_NEAR(part.columns[0].value(40), 0.41, 1e-12);
    EXPECT_EQ(part.segments[1].first, 40U);
}

}  // namespace
}  // namespace gyrolog
