#include "host/app/quantity.hpp"

#include <gtest/gtest.h>

#include "host/base/counted.hpp"

namespace gyrolog {
namespace {

TEST(Quantity, DurationsTakeEveryUnitOfTheManual) {
    EXPECT_DOUBLE_EQ(parse_duration_s("90").value(), 90.0);
    EXPECT_DOUBLE_EQ(parse_duration_s("90s").value(), 90.0);
    EXPECT_DOUBLE_EQ(parse_duration_s("15m").value(), 900.0);
    EXPECT_DOUBLE_EQ(parse_duration_s("6h").value(), 21600.0);
    EXPECT_DOUBLE_EQ(parse_duration_s("1d").value(), 86400.0);
    EXPECT_DOUBLE_EQ(parse_duration_s("1.5h").value(), 5400.0);
}

TEST(Quantity, RefusesWhatIsNoDuration) {
    for (const char* text : {"", "h", "-5s", "0", "5 m", "5parsecs", "nan", "inf", "1e400h", "5mm"}) {
        EXPECT_FALSE(parse_duration_s(text).ok()) << text;
    }
}

TEST(Quantity, WholeNumbersAreSeparatedByCommas) {
    EXPECT_EQ(parse_whole_numbers("1,10,100").value(), (std::vector<std::int64_t>{1, 10, 100}));
    for (const char* text : {"", "1,", ",1", "0", "-1", "1.5", "1;2", "1, 2", "99999999999999999999"}) {
        EXPECT_FALSE(parse_whole_numbers(text).ok()) << text;
    }
}

TEST(Quantity, SpeaksInRoundedUnits) {
    EXPECT_EQ(format_elapsed(3723.4), "1:02:03");
    EXPECT_EQ(format_duration(43200.0), "12 h");
    EXPECT_EQ(format_duration(655.1), "10.9 min");
    EXPECT_EQ(format_count(4'320'000), "4,320,000");
    EXPECT_EQ(format_count(999), "999");
    EXPECT_EQ(counted(0, "sample"), "0 samples");
    EXPECT_EQ(counted(1, "sample"), "1 sample");
    EXPECT_EQ(counted(4'320'000, "sample"), "4,320,000 samples");
}

}  // namespace
}  // namespace gyrolog
