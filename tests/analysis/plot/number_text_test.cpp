#include "analysis/plot/number_text.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// GUM:2008 7.2.2, example 2; CODATA 2018 for the others.
TEST(NumberText, WritesPublishedValuesAsPublished) {
    EXPECT_EQ(number_with_uncertainty(100.02147, 0.00035), "100.02147(35)");
    EXPECT_EQ(number_with_uncertainty(6.67430e-11, 0.00015e-11), "6.67430(15)×10⁻¹¹");
    EXPECT_EQ(number_with_uncertainty(9.1093837015e-31, 0.0000000028e-31), "9.1093837015(28)×10⁻³¹");
    EXPECT_EQ(number_with_uncertainty(137.035999084, 0.000000021), "137.035999084(21)");
}

TEST(NumberText, GivesTheUncertaintyTwoDigitsAlsoAfterRounding) {
    EXPECT_EQ(number_with_uncertainty(9.996, 0.0996), "10.00(10)");
    EXPECT_EQ(number_with_uncertainty(0.0051, 0.000031), "0.005100(31)");
    EXPECT_EQ(number_with_uncertainty(2e-5, 4.2e-6), "2.00(42)×10⁻⁵");
    EXPECT_EQ(number_with_uncertainty(12346.0, 678.0), "1.235(68)×10⁴");
    EXPECT_EQ(number_with_uncertainty(1e-3, 0.2), "0.00(20)");
}

TEST(NumberText, LeavesOutAnUncertaintyThatSaysNothing) {
    for (const double nothing : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(), 1e-20}) {
        EXPECT_EQ(number_with_uncertainty(0.25, nothing), "0.250");
    }
    EXPECT_EQ(number_with_uncertainty(0.25, std::nullopt), "0.250");
}

TEST(NumberText, RoundsToSignificantDigitsAtAnySize) {
    EXPECT_EQ(rounded_number(0.0512), "0.0512");
    EXPECT_EQ(rounded_number(4.9), "4.90");
    EXPECT_EQ(rounded_number(999.6), "1000");
    EXPECT_EQ(rounded_number(12345.0), "1.23×10⁴");
    EXPECT_EQ(rounded_number(-2.1e-5), "−2.10×10⁻⁵");
    EXPECT_EQ(rounded_number(5e-324), "4.94×10⁻³²⁴");
    EXPECT_EQ(rounded_number(1.7976931348623157e308), "1.80×10³⁰⁸");
    EXPECT_EQ(rounded_number(0.0), "0");
    EXPECT_EQ(rounded_number(std::numeric_limits<double>::infinity()), "∞");
    EXPECT_EQ(rounded_number(std::numeric_limits<double>::quiet_NaN()), "–");
}

TEST(NumberText, WritesSettingsWithoutZerosAtTheirEnd) {
    EXPECT_EQ(short_number(10.0), "10");
    EXPECT_EQ(short_number(3.0), "3");
    EXPECT_EQ(short_number(12.5), "12.5");
    EXPECT_EQ(short_number(95.12), "95.1");
    EXPECT_EQ(short_number(200.0), "200");
    EXPECT_EQ(short_number(2.5e-5), "2.5×10⁻⁵");
    EXPECT_EQ(short_number(2e-5), "2×10⁻⁵");
}

TEST(NumberText, NeverWritesMinusNought) {
    EXPECT_EQ(fixed_decimal(-0.001, 1), "0.0");
    EXPECT_EQ(fixed_decimal(-0.1, 1), "−0.1");
}

TEST(NumberText, RaisesEveryDigitOfAnExponent) {
    EXPECT_EQ(power_of_ten(0), "10⁰");
    EXPECT_EQ(power_of_ten(-12), "10⁻¹²");
    EXPECT_EQ(power_of_ten(345), "10³⁴⁵");
    EXPECT_EQ(power_of_ten(6789), "10⁶⁷⁸⁹");
}

}  // namespace
}  // namespace gyrolog
