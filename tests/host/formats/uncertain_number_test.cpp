#include "host/formats/uncertain_number.hpp"

#include <array>

#include <gtest/gtest.h>

#include "host/formats/text_table.hpp"

namespace gyrolog {
namespace {

TEST(UncertainNumber, HasTwoDigitsOfTheUncertaintyAndTheValueToThem) {
    EXPECT_EQ(with_uncertainty(0.0131449, 0.0000213), "0.013145 ± 0.000021");
    EXPECT_EQ(with_uncertainty(1.579e-4, 1.04e-6), "(1.579 ± 0.010)e-04");
    EXPECT_EQ(with_uncertainty(12345.678, 34.0), "12346 ± 34");
    EXPECT_EQ(with_uncertainty(2.5e7, 1.2e5), "(2.500 ± 0.012)e+07");
    EXPECT_EQ(with_uncertainty(0.001952, 9.97e-5), "0.00195 ± 0.00010");
    EXPECT_EQ(with_uncertainty(0.25, 0.0), "0.25");
    EXPECT_EQ(with_uncertainty(285.7142857142857, 1e-13), "285.714286") << "stamps that are computed";
}

TEST(UncertainNumber, LargerThanItsValueIsRoundedAsWell) {
    EXPECT_EQ(with_uncertainty(-0.3, 178.0), "0 ± 180");
    EXPECT_EQ(with_uncertainty(-123.0, 178.0), "-120 ± 180");
    EXPECT_EQ(with_uncertainty(-1e-9, 0.5), "0.00 ± 0.50");
}

TEST(UncertainNumber, ShortFormHasTheLastTwoDigitsInBrackets) {
    EXPECT_EQ(in_short_form(100.02147, 0.00035), "100.02147(35)") << "GUM:2008 7.2.2";
    EXPECT_EQ(in_short_form(0.0131449, 0.0000213), "0.013145(21)");
    EXPECT_EQ(in_short_form(1.579e-4, 1.04e-6), "1.579(10)e-04");
    EXPECT_EQ(in_short_form(142.66, 2.51), "142.7(25)");
    EXPECT_EQ(in_short_form(12345.678, 34.0), "12346(34)");
    EXPECT_EQ(in_short_form(12345.678, 340.0), "1.235(34)e+04");
    EXPECT_EQ(in_short_form(-123.0, 178.0), "-1.2(18)e+02");
    EXPECT_EQ(in_short_form(2.5e7, 1.2e5), "2.500(12)e+07");
    EXPECT_EQ(in_short_form(-1e-9, 0.5), "0.00(50)");
    EXPECT_EQ(in_short_form(0.001952, 9.97e-5), "0.00195(10)");
    EXPECT_EQ(in_short_form(12345.678, 99.7), "1.235(10)e+04");
    EXPECT_EQ(in_short_form(0.25, 0.0), "0.25");
}

TEST(UncertainNumber, DigitsNeedNoExponentWhereTheyFit) {
    EXPECT_EQ(in_digits(211.3, 2), "210");
    EXPECT_EQ(in_digits(5134.0, 3), "5130");
    EXPECT_EQ(in_digits(999.9, 2), "1000");
    EXPECT_EQ(in_digits(-211.3, 2), "-210");
    EXPECT_EQ(in_digits(8.23, 2), "8.2");
    EXPECT_EQ(in_digits(0.00254, 2), "0.0025");
    EXPECT_EQ(in_digits(4.31e-5, 2), "4.3e-05");
    EXPECT_EQ(in_digits(2.13e6, 2), "2.1e+06");
    EXPECT_EQ(in_digits(0.0, 2), "0");
}

TEST(UncertainNumber, DurationsHaveTheUnitThatSuitsThem) {
    EXPECT_EQ(duration_text(0.012589), "12.6 ms");
    EXPECT_EQ(duration_text(79.43), "79.4 s");
    EXPECT_EQ(duration_text(600.0), "10 min");
    EXPECT_EQ(duration_text(43200.0), "12 h");
}

TEST(TextTable, ColumnsThatDoNotFitGoBelow) {
    const std::array<std::string, 3> heads = {"x", "y", "z"};
    const std::array rows = {TextRow{"rate", "°/s", {"1 ± 0", "2", "3"}}};
    EXPECT_EQ(text_table(heads, rows), "             x      y  z\n  rate  °/s  1 ± 0  2  3\n");
    EXPECT_EQ(text_table(heads, rows, 20),
              "             x\n  rate  °/s  1 ± 0\n\n             y  z\n  rate  °/s  2  3\n");
}

}  // namespace
}  // namespace gyrolog
