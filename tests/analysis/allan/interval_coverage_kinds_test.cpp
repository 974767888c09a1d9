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

// White noise behind a running mean, as a sensor's filter is: no power law, until averages are much longer.
test::NoiseRecords filtered_records(Eigen::Index length, std::uint64_t seed) {
    const test::NoiseRecords white = test::white_records(samples + length, records, seed);
    const double weight = 1.0 / static_cast<double>(length);
    test::NoiseRecords filtered{Eigen::MatrixXd::Zero(samples, records), {}};
    for (Eigen::Index j = 0; j < length; ++j) {
        filtered.records += weight * white.records.middleRows(j, samples);
    }
    filtered.expected_square = [length, weight](const Eigen::VectorXd& weights) {
        Eigen::VectorXd of_white = Eigen::VectorXd::Zero(weights.size() + length);
        for (Eigen::Index j = 0; j < length; ++j) { of_white.segment(j, weights.size()) += weight * weights; }
        return of_white.squaredNorm();
    };
    return filtered;
}

TEST(IntervalCoverageOfKinds, AfterAFilterIsOnTheSafeSideAtLongTimes) {
    constexpr double stated = 68.3;
    const test::Coverage result =
        test::coverage(filtered_records(8, 41), DeviationKind::overlapping, stated / 100.0, {});
    std::cout << std::fixed << std::setprecision(1) << "| overlapping, white behind a mean of 8 | 68.3 %";
    for (std::size_t i = 0; i < result.percent.size(); ++i) {
        std::cout << " | " << result.percent[i];
        if ((std::size_t{1} << i) >= 32) {
            EXPECT_GT(result.percent[i], stated - 3.0);
            EXPECT_LT(result.percent[i], stated + 13.0);
        } else {
            EXPECT_GT(result.percent[i], stated - 15.0);
        }
    }
    std::cout << " |" << std::endl;
}

}  // namespace
}  // namespace gyrolog
