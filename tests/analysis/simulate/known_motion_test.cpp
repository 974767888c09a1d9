#include "analysis/simulate/known_motion.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// At 100 Hz; gx holds the row's number, and ten samples are missing before row 200.
Recording moving(std::size_t rows) {
    Recording recording;
    recording.rate_hz = 100.0;
    recording.stamps = StampKind::sampling;
    std::vector<double> numbers;
    for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t slot = row < 200 ? row : row + 10;
        numbers.push_back(static_cast<double>(row));
        recording.t_s.push_back(static_cast<double>(slot) / 100.0);
    }
    recording.columns = {{"gx", "rad/s", numbers},
                         {"ref_x", "rad/s", std::vector<double>(rows, 1.0)},
                         {"ref_y", "rad/s", std::vector<double>(rows, 2.0)}};
    recording.segments = {{0, 200, 0}, {200, rows - 200, 210}};
    recording.dropouts = {{2.0, 10, "time_stamps"}};
    return recording;
}

void forget(Recording& recording, const char* column, std::size_t first, std::size_t end) {
    for (Column& one : recording.columns) {
        if (one.name != column) { continue; }
        auto& values = std::get<std::vector<double>>(one.data);
        for (std::size_t row = first; row < end; ++row) { values[row] = nan; }
    }
}

std::vector<std::array<std::int64_t, 3>> segments_of(const Recording& recording) {
    std::vector<std::array<std::int64_t, 3>> segments;
    for (const Segment& each : recording.segments) {
        segments.push_back(
            {static_cast<std::int64_t>(each.first), static_cast<std::int64_t>(each.count), each.first_index});
    }
    return segments;
}

using Segments = std::vector<std::array<std::int64_t, 3>>;

TEST(KnownMotion, LeavesOutWhatIsLongUnknownOfAnyAxisAndATenthOfASecondAbout) {
    Recording recording = moving(400);
    forget(recording, "ref_x", 50, 70);
    forget(recording, "ref_y", 65, 80);
    forget(recording, "ref_y", 230, 260);
    const Recording known = with_known_motion(recording);
    EXPECT_EQ(segments_of(known), (Segments{{0, 40, 0}, {40, 110, 90}, {150, 20, 210}, {170, 130, 280}}));
    EXPECT_EQ(known.rows(), 300U);
    EXPECT_EQ(known.find("gx")->value(40), 90.0);
    EXPECT_EQ(known.find("gx")->value(170), 270.0);
    EXPECT_EQ(known.t_s.at(40), 0.90);
    EXPECT_EQ(known.t_s.at(170), 2.80);
    EXPECT_EQ(known.dropouts.size(), 1U) << "nobody lost them";
    ASSERT_EQ(known.warnings.size(), 1U);
    EXPECT_EQ(
        known.warnings[0],
        "the reference rate is not known in 60 of 400 samples for longer than a moment: they, and 0.1 s "
        "on either side, are left out");
}

TEST(KnownMotion, KeepsWhatIsKnownOrJoinedOrWithoutReference) {
    Recording recording = moving(400);
    EXPECT_EQ(segments_of(with_known_motion(recording)), segments_of(recording));
    forget(recording, "ref_x", 50, 60);
    forget(recording, "ref_y", 0, 400);
    const Recording known = with_known_motion(recording);
    EXPECT_EQ(segments_of(known), segments_of(recording));
    EXPECT_TRUE(known.warnings.empty());
    recording.columns.resize(1);
    EXPECT_EQ(with_known_motion(recording).rows(), 400U);
}

TEST(KnownMotion, MayLeaveNothing) {
    Recording recording = moving(400);
    forget(recording, "ref_x", 0, 195);
    forget(recording, "ref_x", 196, 400);
    const Recording known = with_known_motion(recording);
    EXPECT_EQ(known.rows(), 0U);
    EXPECT_TRUE(known.segments.empty());
    EXPECT_EQ(known.missing_samples(), 0);
}

}  // namespace
}  // namespace gyrolog
