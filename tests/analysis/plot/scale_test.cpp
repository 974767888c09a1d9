#include "analysis/plot/scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using testing::ElementsAre;

std::vector<std::string> labels_of(const Ticks& ticks) {
    std::vector<std::string> labels;
    for (const Tick& tick : ticks.ticks) {
        if (!tick.label.empty()) { labels.push_back(tick.label); }
    }
    return labels;
}

// Reads a label the way a person does: "−2×10⁻³", "10⁴", "0.25".
double read_label(std::string_view text) {
    constexpr std::array<std::string_view, 11> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹", "⁻"};
    constexpr std::string_view plain = "0123456789-";
    std::string mantissa;
    std::string exponent;
    while (!text.empty()) {
        const auto at =
            std::find_if(raised.begin(), raised.end(), [&](auto sign) { return text.starts_with(sign); });
        if (at != raised.end()) {
            exponent.push_back(plain[static_cast<std::size_t>(at - raised.begin())]);
            text.remove_prefix(at->size());
        } else if (text.starts_with("−")) {
            mantissa.push_back('-');
            text.remove_prefix(std::string_view("−").size());
        } else if (text.starts_with("×10")) {
            text.remove_prefix(std::string_view("×10").size());
        } else {
            mantissa.push_back(text.front());
            text.remove_prefix(1);
        }
    }
    if (exponent.empty()) { return std::stod(mantissa); }
    if (mantissa == "10") { mantissa = "1"; }
    return std::stod(mantissa.append("e").append(exponent));
}

Range random_range(std::mt19937_64& random, ScaleKind kind) {
    std::uniform_real_distribution<double> exponent(-12.0, 12.0);
    std::uniform_real_distribution<double> decades(-3.0, 1.3);
    if (kind == ScaleKind::logarithmic) {
        const double lo = std::pow(10.0, exponent(random));
        return {lo, lo * std::pow(10.0, std::pow(10.0, decades(random)))};
    }
    const double length = std::pow(10.0, exponent(random));
    const double middle = length * std::uniform_real_distribution<double>(-1000.0, 1000.0)(random);
    return {middle - length / 2.0, middle + length / 2.0};
}

class AnyScale : public testing::TestWithParam<ScaleKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, AnyScale, testing::Values(ScaleKind::linear, ScaleKind::logarithmic),
                         [](const auto& kind) {
                             return kind.param == ScaleKind::linear ? "Linear" : "Logarithmic";
                         });

TEST_P(AnyScale, TicksRiseAndStayOnTheAxis) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 3000; ++i) {
        const Range range = random_range(random, GetParam());
        const Ticks found = find_ticks(GetParam(), range, 2 + i % 11);
        const double slack = 1e-8 * (range.hi - range.lo);
        ASSERT_FALSE(found.ticks.empty()) << range.lo << " to " << range.hi;
        ASSERT_GE(found.ticks.front().value, range.lo - slack);
        ASSERT_LE(found.ticks.back().value, range.hi + slack);
        ASSERT_TRUE(std::is_sorted(found.ticks.begin(), found.ticks.end(),
                                   [](const Tick& a, const Tick& b) { return a.value <= b.value; }));
    }
}

TEST_P(AnyScale, HasNeitherMoreLabelsThanAskedNorSoFewThatNothingCanBeRead) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 3000; ++i) {
        const Range range = random_range(random, GetParam());
        const int max_labels = 5 + i % 8;
        const auto count = static_cast<int>(labels_of(find_ticks(GetParam(), range, max_labels)).size());
        ASSERT_LE(count, max_labels) << range.lo << " to " << range.hi;
        ASSERT_GE(count, 2) << range.lo << " to " << range.hi;
    }
}

TEST_P(AnyScale, EveryLabelReadsAsItsTicksValue) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 3000; ++i) {
        const Range range = random_range(random, GetParam());
        const Ticks found = find_ticks(GetParam(), range, 8);
        for (const Tick& tick : found.ticks) {
            if (tick.label.empty()) { continue; }
            const double read = read_label(tick.label) * std::pow(10.0, found.exponent);
            ASSERT_NEAR(read, tick.value, 1e-6 * (range.hi - range.lo)) << tick.label;
        }
    }
}

TEST_P(AnyScale, PixelAndValueAreInverse) {
    std::mt19937_64 random(4);
    for (int i = 0; i < 1000; ++i) {
        const Scale scale{GetParam(), random_range(random, GetParam()), 900.0, 100.0};
        EXPECT_DOUBLE_EQ(scale.pixel(scale.range.lo), 900.0);
        EXPECT_NEAR(scale.pixel(scale.range.hi), 100.0, 1e-9);
        const double pixel = std::uniform_real_distribution<double>(100.0, 900.0)(random);
        EXPECT_NEAR(scale.pixel(scale.value(pixel)), pixel, 1e-6);
    }
}

TEST_P(AnyScale, FittedLabelsKeepTheirDistance) {
    const auto extent_px = [](const std::string& label) { return 9.0 * static_cast<double>(label.size()); };
    std::mt19937_64 random(5);
    for (int i = 0; i < 500; ++i) {
        const Scale scale{GetParam(), random_range(random, GetParam()), 0.0, 900.0};
        double previous_end = -1e9;
        for (const Tick& tick : fit_ticks(scale, 10.0, extent_px).ticks) {
            if (tick.label.empty()) { continue; }
            ASSERT_GE(scale.pixel(tick.value) - extent_px(tick.label) / 2.0, previous_end + 10.0);
            previous_end = scale.pixel(tick.value) + extent_px(tick.label) / 2.0;
        }
    }
}

TEST(LogarithmicScale, LabelsEveryPowerOfTenWhereThereIsRoom) {
    const Ticks found = find_ticks(ScaleKind::logarithmic, {1e-3, 1e2}, 12);
    EXPECT_THAT(labels_of(found), ElementsAre("10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹", "10²"));
    EXPECT_EQ(found.ticks.size(), 5U * 9U + 1U);
}

TEST(LogarithmicScale, LeavesOutPowersWhereThereAreTooMany) {
    EXPECT_THAT(labels_of(find_ticks(ScaleKind::logarithmic, {1e-9, 1e9}, 5)),
                ElementsAre("10⁻⁵", "10⁰", "10⁵"));
}

TEST(LogarithmicScale, LabelsTwoAndFiveOnAShortAxis) {
    EXPECT_THAT(labels_of(find_ticks(ScaleKind::logarithmic, {0.4, 25.0}, 8)),
                ElementsAre("0.5", "1", "2", "5", "10", "20"));
    EXPECT_THAT(labels_of(find_ticks(ScaleKind::logarithmic, {4e-7, 2.5e-6}, 8)),
                ElementsAre("5×10⁻⁷", "10⁻⁶", "2×10⁻⁶"));
}

TEST(LogarithmicScale, LabelsThreeWhereTwoAndFiveHaveNoRoom) {
    EXPECT_THAT(labels_of(find_ticks(ScaleKind::logarithmic, {1.5e-3, 0.06}, 4)),
                ElementsAre("0.003", "0.01", "0.03"));
}

TEST(LogarithmicScale, TakesLinearStepsWithinAFractionOfADecade) {
    EXPECT_THAT(labels_of(find_ticks(ScaleKind::logarithmic, {1.05, 1.45}, 5)),
                ElementsAre("1.1", "1.2", "1.3", "1.4"));
}

TEST(LogarithmicScale, CannotShowZeroNegativeOrNoNumber) {
    const Scale scale{ScaleKind::logarithmic, {1.0, 10.0}, 0.0, 100.0};
    for (const double value :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_TRUE(std::isnan(scale.pixel(value))) << value;
    }
}

TEST(LinearScale, StepsByOneTwoOrFive) {
    EXPECT_THAT(labels_of(find_ticks(ScaleKind::linear, {0.0, 1.0}, 6)),
                ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
    EXPECT_THAT(labels_of(find_ticks(ScaleKind::linear, {-7.0, 7.0}, 4)), ElementsAre("−5", "0", "5"));
}

TEST(LinearScale, TakesACommonPowerOfTenOutOfLongLabels) {
    const Ticks found = find_ticks(ScaleKind::linear, {0.0, 3e-6}, 5);
    EXPECT_EQ(found.exponent, -6);
    EXPECT_THAT(labels_of(found), ElementsAre("0", "1", "2", "3"));
}

TEST(RangeFinder, IgnoresWhatTheScaleCannotShow) {
    RangeFinder finder(ScaleKind::logarithmic);
    for (const double value : {0.0, -5.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity(), 5e-324}) {
        finder.add(value);
    }
    EXPECT_TRUE(finder.empty());
    finder.add(10.0);
    finder.add(1e5);
    const Range range = finder.padded(0.25, 1.0);
    EXPECT_NEAR(range.lo, 1.0, 1e-12);
    EXPECT_NEAR(range.hi, 1e6, 1e-6);
}

TEST(RangeFinder, GivesASingleValueSomeRoom) {
    for (const double value : {-3.0, 0.0, 5e-324, 1e-9, 1e12, 1e250}) {
        RangeFinder finder(ScaleKind::linear);
        finder.add(value);
        const Range range = finder.padded(0.05, 0.0);
        EXPECT_LT(range.lo, value);
        EXPECT_GT(range.hi, value);
        EXPECT_TRUE(can_scale(ScaleKind::linear, range)) << value;
    }
    RangeFinder finder(ScaleKind::logarithmic);
    finder.add(91.22945);
    const Range range = finder.padded(0.05, 1.0);
    EXPECT_NEAR(range.hi / range.lo, 10.0, 1e-9);
}

}  // namespace
}  // namespace gyrolog
