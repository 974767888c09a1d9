// The intervals of every kind of deviation but the overlapping one, which has a test of its own, and those of
// records with holes.

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

// The stretches on both sides of a hole count as independent, which flicker and a walk make them not.
TEST(IntervalCoverageOfKinds, IsAsStatedForARecordWithHoles) {
    const std::vector<Segment> segments = {{0, 300, 0}, {300, 40, 310}, {340, 150, 360}};
    const std::vector<std::pair<std::string, test::NoiseRecords>> noises = {
        {"white", test::white_records(samples, records, 31)},
        {"flicker", test::flicker_records(samples, records, 32)},
        {"random walk", test::walk_records(samples, records, 33)}};
    for (const auto& [name, noise] : noises) {
        test::expect_coverage("overlapping, holes, " + name, noise, DeviationKind::overlapping,
                              tolerance_points, segments);
    }
}

}  // namespace
}  // namespace gyrolog
