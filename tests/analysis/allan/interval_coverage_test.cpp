// An interval of 68.3 % (95 %) holds the true deviation in 68.3 % (95 %) of records, at every averaging time
// up to half of the record, whichever noise dominates.

#include "tests/analysis/allan/interval_coverage.hpp"

#include "tests/support/asked.hpp"

namespace gyrolog {
namespace {

constexpr Eigen::Index samples = 1024;
// By default 2160, of which three points are three binomial standard deviations at 68.3 %.
const auto records = static_cast<Eigen::Index>(asked("GYROLOG_COVERAGE_RECORDS", 2160.0));
const double tolerance_points = records < 10000 ? 3.0 : 1.5;

void expect_overlapping_coverage(const char* name, const test::NoiseRecords& noise) {
    test::expect_coverage(name, noise, DeviationKind::overlapping, tolerance_points);
}

TEST(IntervalCoverage, IsAsStatedForWhiteNoise) {
    expect_overlapping_coverage("white", test::white_records(samples, records, 1));
}

TEST(IntervalCoverage, IsAsStatedForFlickerNoise) {
    expect_overlapping_coverage("flicker", test::flicker_records(samples, records, 2));
}

TEST(IntervalCoverage, IsAsStatedForARandomWalk) {
    expect_overlapping_coverage("random walk", test::walk_records(samples, records, 13));
}

// White noise at short times, flicker in the middle, a walk at the end.
TEST(IntervalCoverage, IsAsStatedForAMixture) {
    expect_overlapping_coverage("mixture", test::sum_of({{1.0, test::white_records(samples, records, 4)},
                                                         {0.12, test::flicker_records(samples, records, 5)},
                                                         {0.02, test::walk_records(samples, records, 6)}}));
}

}  // namespace
}  // namespace gyrolog
