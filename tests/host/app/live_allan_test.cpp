// What a live view works out and draws, and what its keys do. The terminal itself: tests/end_to_end.
#include "host/app/live_allan.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "host/app/allan_chart.hpp"
#include "host/app/live_keys.hpp"

namespace gyrolog {
namespace {

glp_config config_of(std::uint32_t rate_mHz) {
    glp_config config{};
    config.rate_mHz = rate_mHz;
    config.gyro_ndps_per_lsb = 15'258'789;
    return config;
}

// Frames of ten samples: white noise of 5 counts on x, of 10 on y, a walk on z.
class Feed {
public:
    explicit Feed(std::uint32_t rate_mHz) : config_(config_of(rate_mHz)) {}

    void frames(LiveAllan& allan, int count) {
        for (int i = 0; i < count; ++i) { frame(allan); }
    }
    void lose(std::uint64_t samples) { index_ += samples; }
    const std::vector<std::int16_t>& x() const { return x_; }

private:
    void frame(LiveAllan& allan) {
        std::vector<std::uint8_t> bytes;
        bytes.reserve(60);
        const auto put = [&](double count) {
            const auto whole = static_cast<std::uint16_t>(std::lround(count));
            bytes.push_back(static_cast<std::uint8_t>(whole & 0xFFU));
            bytes.push_back(static_cast<std::uint8_t>(whole >> 8U));
            return static_cast<std::int16_t>(whole);
        };
        for (int i = 0; i < 10; ++i) {
            x_.push_back(put(100.0 + 5.0 * normal_(random_)));
            put(10.0 * normal_(random_));
            walk_ += normal_(random_);
            put(walk_ + 5.0 * normal_(random_));
        }
        glp_samples samples{};
        samples.first_index = index_;
        samples.count = 10;
        samples.layout = glp_layout_gyro;
        samples.samples = bytes.data();
        allan.on_samples({}, samples, config_);
        index_ += 10;
    }

    glp_config config_;
    std::mt19937 random_{5};
    std::normal_distribution<double> normal_;
    std::vector<std::int16_t> x_;
    double walk_ = 0.0;
    std::uint64_t index_ = 0;
};

TEST(LiveAllan, IsTheDeviationOfTheSamplesThatCame) {
    LiveAllan allan;
    Feed feed(100'000);
    feed.frames(allan, 1000);
    EXPECT_EQ(allan.samples(), 10'000U);
    const auto axes = allan.axes();
    Column column;
    column.data = feed.x();
    column.scale = 0.015258789;
    AllanOptions options;
    options.m = {1, 16};
    const AllanCurve batch = allan_deviation(column, std::vector<Segment>{{0, 10'000, 0}}, 100.0, options);
    EXPECT_NEAR(axes[0].curve.points[0].deviation, batch.points[0].deviation, 1e-12);
    EXPECT_NEAR(axes[0].curve.points[4].deviation, batch.points[1].deviation, 1e-12);
    EXPECT_NEAR(axes[0].curve.points[4].lo, batch.points[1].lo, 0.02 * batch.points[1].lo);
    EXPECT_NEAR(axes[0].curve.points[4].hi, batch.points[1].hi, 0.02 * batch.points[1].hi);
    EXPECT_NEAR(axes[1].curve.points[0].deviation / axes[0].curve.points[0].deviation, 2.0, 0.1);
}

TEST(LiveAllan, SaysHowMuchLongerUntilTheWalkIsKnown) {
    LiveAllan allan;
    Feed feed(100'000);
    feed.frames(allan, 3000);
    const auto axes = allan.axes();
    // K of z: one count a sample at 100 Hz. White noise of 5 counts: N / K = 0.05 s, and 5 min are plenty.
    EXPECT_TRUE(axes[2].walk_seen);
    EXPECT_NEAR(axes[2].K, 0.015258789 * 10.0, 0.05);
    EXPECT_LT(axes[2].K_relative_sd.value(), 0.2);
    EXPECT_EQ(axes[2].still_needed_s.value(), 0.0);
    EXPECT_NE(walk_text(axes[2]).find("known to ±20 %"), std::string::npos) << walk_text(axes[2]);
    // x has none: how long it would take cannot be said.
    EXPECT_FALSE(axes[0].walk_seen);
    EXPECT_FALSE(axes[0].still_needed_s);
    EXPECT_NE(walk_text(axes[0]).find("K not seen, < "), std::string::npos) << walk_text(axes[0]);
    EXPECT_EQ(walk_text(axes[0]).find("more"), std::string::npos) << walk_text(axes[0]);
}

TEST(LiveAllan, LostSamplesAreAHole) {
    LiveAllan holed;
    Feed feed(100'000);
    feed.frames(holed, 10);
    feed.lose(1000);
    feed.frames(holed, 10);
    const auto terms = holed.axes()[0].curve.points.front().terms;
    EXPECT_EQ(terms, 2 * 99);
}

TEST(LiveAllan, BeginsAnewWithAnotherSettingOrItsFirstStart) {
    LiveAllan allan;
    Feed slow(100'000);
    Feed fast(1'000'000);
    slow.frames(allan, 20);
    fast.frames(allan, 30);
    EXPECT_EQ(allan.samples(), 300U);
    EXPECT_DOUBLE_EQ(allan.axes()[0].curve.points.front().tau_s, 1e-3);
    allan.on_start();
    EXPECT_EQ(allan.samples(), 0U);
    EXPECT_TRUE(allan.axes()[0].curve.points.empty());
    EXPECT_EQ(walk_text(allan.axes()[0]), "K: too early to say");

    // The board comes back: its numbers begin anew, the recording goes on.
    Feed again(1'000'000);
    again.frames(allan, 30);
    allan.on_start();
    Feed third(1'000'000);
    third.frames(allan, 30);
    EXPECT_EQ(allan.samples(), 600U);
    EXPECT_EQ(allan.axes()[0].curve.points.front().terms, 2 * 299);
}

AllanCurve falling(double at_1_s) {
    AllanCurve curve;
    for (int j = 0; j < 11; ++j) {
        AllanPoint point;
        point.tau_s = std::pow(2.0, j) * 0.1;
        point.deviation = at_1_s / std::sqrt(point.tau_s);
        curve.points.push_back(point);
    }
    return curve;
}

TEST(AllanChart, ShowsThreeCurvesOnLogarithmicScales) {
    const AllanCurve x = falling(1.0);
    const AllanCurve y = falling(0.01);
    const AllanCurve z = falling(1.0);
    const auto lines = allan_chart({&x, &y, &z}, 52, 9);
    ASSERT_EQ(lines.size(), 9U);
    for (const std::string& line : lines) { EXPECT_LE(line.size(), 52U); }
    EXPECT_EQ(lines[0].substr(0, 11), "  3.2 dps x") << lines[0];
    EXPECT_EQ(lines[7].substr(0, 9), "  0.00099") << lines[7];
    EXPECT_EQ(lines[7].back(), 'y') << "the lowest is the last of y";
    EXPECT_EQ(lines[8], "          0.1           1            10            s") << lines[8];
    for (const std::string& line : lines) {
        EXPECT_EQ(line.find('z', 10), std::string::npos) << "x is above z";
    }
}

TEST(AllanChart, IsLeftOutWhereThereIsNoRoomOrNothingToShow) {
    const AllanCurve x = falling(1.0);
    const AllanCurve none;
    EXPECT_TRUE(allan_chart({&x, &x, &x}, 29, 9).empty());
    EXPECT_TRUE(allan_chart({&x, &x, &x}, 80, 4).empty());
    EXPECT_TRUE(allan_chart({&none, &none, &none}, 80, 20).empty());
    AllanCurve one;
    one.points.push_back({1, 1.0, 2.0, 0, 0, 0, 1});
    EXPECT_EQ(allan_chart({&one, &none, &none}, 40, 6).size(), 6U) << "a scale of no length";
}

class Keys : public testing::Test {
protected:
    CaptureControl control;
    LiveKeys keys{control};
    HostTime now{1000, 2000};
};

TEST_F(Keys, MarkHasTheTimeOfItsKeyAndTheTextUpToEnter) {
    keys.take("m", now);
    keys.take("lamp o", {5000, 6000});
    EXPECT_EQ(keys.note().value(), "lamp o");
    keys.take("ff\x7fn, 20 °C\x7f\x7f\x7fms\r", {7000, 8000});
    EXPECT_FALSE(keys.note().has_value());
    const auto marks = control.take_marks();
    ASSERT_EQ(marks.size(), 1U);
    EXPECT_EQ(marks[0].text, "lamp ofn, 20ms") << "keys are text while a mark is written";
    EXPECT_EQ(marks[0].time.monotonic_ns, 1000);
    EXPECT_EQ(marks[0].time.realtime_ns, 2000);
    EXPECT_TRUE(control.take_marks().empty());
}

TEST_F(Keys, EscapeDropsTheMarkAndOtherKeysAreNoText) {
    keys.take("mabc\x1b", now);
    EXPECT_FALSE(keys.note().has_value());
    keys.take(
        "m\x1b[Aa\x1bOPb\x1b[3~\tc\x15"
        "d\n",
        now);
    const auto marks = control.take_marks();
    ASSERT_EQ(marks.size(), 1U);
    EXPECT_EQ(marks[0].text, "d");
}

TEST_F(Keys, EndKeepsTheMarkThatIsBeingWritten) {
    keys.take("mhalf", now);
    keys.finish();
    keys.finish();
    const auto marks = control.take_marks();
    ASSERT_EQ(marks.size(), 1U);
    EXPECT_EQ(marks[0].text, "half");
}

TEST_F(Keys, StopStartAndEnd) {
    EXPECT_TRUE(control.streaming_wanted());
    keys.take("s", now);
    EXPECT_FALSE(control.streaming_wanted());
    keys.take("xs", now);
    EXPECT_TRUE(control.streaming_wanted());
    EXPECT_FALSE(keys.end_wanted());
    keys.take("q", now);
    EXPECT_TRUE(keys.end_wanted());
}

TEST_F(Keys, TextHasAnEnd) {
    keys.take("m" + std::string(2000, 'a') + "\r", now);
    EXPECT_EQ(control.take_marks().at(0).text.size(), 500U);
}

}  // namespace
}  // namespace gyrolog
