#include "host/base/nearest_name.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

TEST(NearestName, IsTheOneThatWasMeant) {
    const std::vector<std::string> names = {"analyze", "capture", "check", "compare", "info", "list"};
    EXPECT_EQ(nearest_name("analyse", names), "analyze");
    EXPECT_EQ(nearest_name("cpature", names), "capture");
    EXPECT_EQ(nearest_name("chek", names), "check");
    EXPECT_EQ(nearest_name("ifno", names), "info");
    EXPECT_EQ(nearest_name("compare", names), "compare");
}

TEST(NearestName, LettersMayBeSmallOrCapital) {
    const std::vector<std::string> names = {"N", "B", "K", "bias"};
    EXPECT_EQ(nearest_name("k", names), "K");
    EXPECT_EQ(nearest_name("BIAS", names), "bias");
    EXPECT_EQ(nearest_name("R", names), "");
}

TEST(NearestName, IsNoneOfWhatIsFarFromAll) {
    const std::vector<std::string> names = {"analyze", "list"};
    EXPECT_EQ(nearest_name("frobnicate", names), "");
    EXPECT_EQ(nearest_name("", names), "");
    EXPECT_EQ(nearest_name(std::string(100'000, 'a'), names), "");
    EXPECT_EQ(nearest_name("lit", {}), "");
}

}  // namespace
}  // namespace gyrolog
