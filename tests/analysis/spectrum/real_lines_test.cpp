// Tones that the descriptions of real recordings name.

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/spectrum/spectral_lines.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::Ge;
using testing::Le;

class RealLines : public testing::Test {
protected:
    void SetUp() override {
        if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    }

    Recording read(const std::string& file) const {
        CsvReadOptions options;
        options.allow_unscaled_counts = true;
        Result<Recording> recording = read_recording_csv(shared_data(file), options);
        EXPECT_TRUE(recording.ok());
        return recording.ok() ? std::move(recording).value() : Recording{};
    }
};

auto lies_between(double lo_hz, double hi_hz) {
    return Field("f_hz", &SpectralLine::f_hz, AllOf(Ge(lo_hz), Le(hi_hz)));
}

// "TONE on gz 31.27-31.62 Hz (15x floor, wandering)".
TEST_F(RealLines, AWanderingToneIsOneLineOnItsAxisAndNotOnTheOthers) {
    const Recording r = read("mpu6050_frdm/static_11min.csv.xz");
    ASSERT_NE(r.find("gz"), nullptr);
    const auto on_z = find_lines(*r.find("gz"), r.segments, r.rate_hz);
    ASSERT_EQ(on_z.size(), 1U);
    EXPECT_THAT(on_z, Contains(lies_between(31.27, 31.62)));
    EXPECT_FALSE(on_z[0].steady);
    for (const char* other : {"gx", "gy"}) {
        EXPECT_THAT(find_lines(*r.find(other), r.segments, r.rate_hz),
                    testing::Not(Contains(lies_between(30.0, 33.0))));
    }
}

// "IMU4 y 6.4 Hz", "IMU7 x 23.1 Hz", "IMU7 y 28.4 Hz", drifting by 1 Hz between runs: while the array lies
// still, the first 22 s.
TEST_F(RealLines, EverySensorOfAnArrayHasItsOwnTone) {
    const Recording r = read("mimu8_array/exp1.csv.xz");
    ASSERT_GT(r.rows(), 1400U);
    const auto lines_of = [&](const char* name) {
        Column still = *r.find(name);
        std::get<std::vector<std::int16_t>>(still.data).resize(1400);
        const std::vector<Segment> segments{{0, 1400, 0}};
        return find_lines(still, segments, r.rate_hz);
    };
    EXPECT_THAT(lines_of("gy4"), Contains(lies_between(5.9, 6.9)));
    EXPECT_THAT(lines_of("gx7"), Contains(lies_between(22.6, 23.6)));
    EXPECT_THAT(lines_of("gy7"), Contains(lies_between(27.9, 28.9)));
}

// In the last 100 s the array is moved by hand at up to 2000 °/s: bursts, of which nothing but the beat of
// the hand is a line.
TEST_F(RealLines, MotionIsNotTakenForLines) {
    const Recording r = read("mimu8_array/exp1.csv.xz");
    for (const char* name : {"gx1", "gy4", "gz8"}) {
        EXPECT_LE(find_lines(*r.find(name), r.segments, r.rate_hz).size(), 1U) << name;
    }
}

}  // namespace
}  // namespace gyrolog
