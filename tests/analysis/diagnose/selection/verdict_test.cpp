#include "analysis/diagnose/selection/verdict.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

Cause cause(double score, double share) {
    Cause cause;
    cause.score = score;
    cause.share.value = share;
    return cause;
}

TEST(Verdict, IsKnownWhereNothingOrLittleIsLeft) {
    const std::vector<Cause> causes = {cause(0.9, 0.6), cause(0.8, 0.3)};
    EXPECT_EQ(verdict_of(causes, true, 0.8), Verdict::known);
    EXPECT_EQ(verdict_of(causes, false, 0.95), Verdict::known);
    EXPECT_EQ(verdict_of(causes, false, 0.8), Verdict::partly);
}

TEST(Verdict, IsNotChangedByADoubtedCauseThatHardlyMatters) {
    const std::vector<Cause> little = {cause(0.9, 0.9), cause(0.0, 0.01)};
    EXPECT_EQ(verdict_of(little, false, 0.97), Verdict::known);
    const std::vector<Cause> much = {cause(0.9, 0.6), cause(0.1, 0.3)};
    EXPECT_EQ(verdict_of(much, true, 0.85), Verdict::partly);
}

// In part means that more than a tenth is left.
TEST(Verdict, IsNeverInPartWhereNextToNothingIsLeft) {
    const std::vector<Cause> doubted = {cause(0.9, 0.6), cause(0.1, 0.3)};
    EXPECT_EQ(verdict_of(doubted, false, 0.97), Verdict::known);
    const std::vector<Cause> guesses = {cause(0.9, 0.05), cause(0.1, 0.9)};
    EXPECT_EQ(verdict_of(guesses, false, 0.97), Verdict::unexplained);
}

TEST(Verdict, IsUnexplainedWhereNoLikelyCauseClosesATenth) {
    EXPECT_EQ(verdict_of({}, true, 0.0), Verdict::unexplained);
    const std::vector<Cause> guess = {cause(0.2, 0.95)};
    EXPECT_EQ(verdict_of(guess, true, 0.95), Verdict::unexplained);
    const std::vector<Cause> small = {cause(0.9, 0.05)};
    EXPECT_EQ(verdict_of(small, false, 0.05), Verdict::unexplained);
}

TEST(Verdict, CountsACauseWithItsTies) {
    Cause tied = cause(0.4, 0.9);
    tied.tie_group = {{"temp_lag", 0.0}, {"temp_linear", 0.2}};
    const std::vector<Cause> causes = {tied};
    EXPECT_EQ(verdict_of(causes, true, 0.9), Verdict::known);
}

}  // namespace
}  // namespace gyrolog
