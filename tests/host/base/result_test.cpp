#include "host/base/result.hpp"

#include <memory>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

Result<std::unique_ptr<int>> halved(int value) {
    if (value % 2 != 0) { return Error{ErrorCode::invalid_argument, "odd"}; }
    return std::make_unique<int>(value / 2);
}

Result<int> quartered(int value) {
    GYROLOG_TRY(const std::unique_ptr<int> half, halved(value));
    GYROLOG_TRY(const std::unique_ptr<int> quarter, halved(*half));
    return *quarter;
}

Status divisible_by_four(int value) {
    GYROLOG_CHECK(quartered(value));
    return {};
}

TEST(Result, PassesValuesAndTheFirstErrorUpwards) {
    EXPECT_EQ(quartered(12).value(), 3);
    ASSERT_FALSE(quartered(6).ok());
    EXPECT_EQ(quartered(6).error().code, ErrorCode::invalid_argument);
    EXPECT_TRUE(divisible_by_four(8).ok());
    EXPECT_EQ(divisible_by_four(7).error().message, "odd");
}

TEST(Result, ContextStandsInFrontOfTheMessage) {
    EXPECT_EQ(in_context("open 'x'", Error{ErrorCode::busy, "in use"}).message, "open 'x': in use");
    EXPECT_EQ(in_context("open 'x'", Error{ErrorCode::busy, "in use"}).code, ErrorCode::busy);
}

}  // namespace
}  // namespace gyrolog
