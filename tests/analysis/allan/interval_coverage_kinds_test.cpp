// The intervals of every kind of deviation but the overlapping one, which has a test of its own.

#include "tests/analysis/allan/interval_coverage.hpp"

namespace gyrolog {
namespace {

constexpr Eigen::Index samples = 512;
constexpr Eigen::Index records = 2160;
constexpr double tolerance_points = 5.0;

void expect_coverage_of_kinds(const std::string& name, const test::NoiseRecords& noise) {
    for (const DeviationKind kind :
         {DeviationKind::standard, DeviationKind::modified, DeviationKind::hadamard,
          DeviationKind::overlapping_hadamard, DeviationKind::total}) {
        test::expect_coverage(std::string(name_of(kind)) + ", " + name, noise, kind, tolerance_points);
    }
}

TEST(IntervalCoverageOfKinds, IsAsStatedForWhiteNoise) {
    expect_coverage_of_kinds("white", test::white_records(samples, records, 21));
}

TEST(IntervalCoverageOfKinds, IsAsStatedForFlickerNoise) {
    expect_coverage_of_kinds("flicker", test::flicker_records(samples, records, 22));
}

TEST(IntervalCoverageOfKinds, IsAsStatedForARandomWalk) {
    expect_coverage_of_kinds("random walk", test::walk_records(samples, records, 23));
}

}  // namespace
}  // namespace gyrolog
