#include "host/base/byte_size.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

TEST(ByteSize, HasThreeDigitsAndADecimalMultiple) {
    EXPECT_EQ(format_bytes(0), "0 B");
    EXPECT_EQ(format_bytes(999), "999 B");
    EXPECT_EQ(format_bytes(1'500), "1.5 kB");
    EXPECT_EQ(format_bytes(999'700), "1 MB");
    EXPECT_EQ(format_bytes(123'456'789), "123 MB");
    EXPECT_EQ(format_bytes(std::numeric_limits<std::uint64_t>::max()), "1.84e+07 TB");
}

}  // namespace
}  // namespace gyrolog
