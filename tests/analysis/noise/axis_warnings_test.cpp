#include "analysis/noise/axis_warnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using testing::ElementsAre;

TEST(AxisWarnings, OfSeveralAxesAreOneLine) {
    AxisWarnings warnings;
    warnings.add("x", "stuck");
    warnings.add("y", "noisy");
    warnings.add("z", "stuck");
    EXPECT_THAT(warnings.lines(), ElementsAre("axes x z: stuck", "axis y: noisy"));
}

TEST(AxisWarnings, ShareALineWhateverTheirNumbersAre) {
    AxisWarnings warnings;
    warnings.add("x", "outliers", "12");
    warnings.add("y", "outliers", "7");
    warnings.add("z", "clipped");
    warnings.add("z", "outliers", "12");
    EXPECT_THAT(warnings.lines(), ElementsAre("axes x (12), y (7), z (12): outliers", "axis z: clipped"));
}

TEST(AxisWarnings, OfNothingAreNoLines) { EXPECT_THAT(AxisWarnings().lines(), testing::IsEmpty()); }

}  // namespace
}  // namespace gyrolog
