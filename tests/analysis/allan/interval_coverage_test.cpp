// An interval of 68.3 % (95 %) holds the true deviation in 68.3 % (95 %) of records, at every averaging time
// up to half of the record, whichever noise dominates.

#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "tests/analysis/allan/gaussian_noise.hpp"

namespace gyrolog {
namespace {

constexpr Eigen::Index samples = 1024;
// Three points are three binomial standard deviations at 68.3 %: sqrt(0.683 * 0.317 / 2160) = 1.0 %.
constexpr Eigen::Index records = 2160;
constexpr double tolerance_points = 3.0;

// The Allan variance of samples with an autocovariance: the difference of two means of m, squared.
double allan_variance(const std::vector<double>& r, std::size_t m) {
    double sum = 0.0;
    const auto lag = [](std::size_t i, std::size_t j) { return i > j ? i - j : j - i; };
    for (std::size_t i = 0; i < 2 * m; ++i) {
        for (std::size_t j = 0; j < 2 * m; ++j) { sum += ((i < m) == (j < m) ? 1.0 : -1.0) * r[lag(i, j)]; }
    }
    const auto count = static_cast<double>(m);
    return sum / (2.0 * count * count);
}

struct Noise {
    Eigen::MatrixXd records;             // one a column
    std::vector<double> allan_variance;  // at m = 1, 2, 4, ...
};

std::vector<std::int64_t> octaves() {
    std::vector<std::int64_t> m;
    for (std::int64_t i = 1; i <= samples / 2; i *= 2) { m.push_back(i); }
    return m;
}

Noise white_noise(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Noise noise{Eigen::MatrixXd::NullaryExpr(samples, records, [&](auto, auto) { return normal(random); }),
                {}};
    for (const std::int64_t m : octaves()) { noise.allan_variance.push_back(1.0 / static_cast<double>(m)); }
    return noise;
}

Noise walk(std::uint64_t seed) {
    Noise noise = white_noise(seed);
    for (Eigen::Index i = 1; i < samples; ++i) { noise.records.row(i) += noise.records.row(i - 1); }
    noise.allan_variance.clear();
    for (const std::int64_t octave : octaves()) {
        const auto m = static_cast<double>(octave);
        noise.allan_variance.push_back((2.0 * m * m + 1.0) / (6.0 * m));
    }
    return noise;
}

Noise flicker(std::uint64_t seed) {
    const std::vector<double> r = test::flicker_autocovariance(samples, 1e-3 / static_cast<double>(samples));
    Noise noise{test::stationary_records(r, records, seed), {}};
    for (const std::int64_t m : octaves()) {
        noise.allan_variance.push_back(allan_variance(r, static_cast<std::size_t>(m)));
    }
    return noise;
}

Noise sum_of(const std::vector<std::pair<double, Noise>>& parts) {
    Noise sum{Eigen::MatrixXd::Zero(samples, records), std::vector<double>(octaves().size())};
    for (const auto& [factor, noise] : parts) {
        sum.records += factor * noise.records;
        for (std::size_t i = 0; i < sum.allan_variance.size(); ++i) {
            sum.allan_variance[i] += factor * factor * noise.allan_variance[i];
        }
    }
    return sum;
}

// At each octave, the share of records whose interval covers the truth.
std::vector<double> coverage(const Noise& noise, DeviationKind kind, double confidence,
                             const std::function<double(std::size_t octave)>& true_variance) {
    std::vector<double> covered(octaves().size());
    AllanOptions options;
    options.kind = kind;
    options.confidence = confidence;
    options.m = octaves();
    for (Eigen::Index record = 0; record < records; ++record) {
        const auto column = noise.records.col(record);
        const Column y{"gx", "rad/s", std::vector<double>(column.begin(), column.end()), 1.0, 0.0, "rad_s"};
        const AllanCurve curve =
            allan_deviation(y, {{{0, static_cast<std::size_t>(samples), 0}}}, 1.0, options);
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const double truth = std::sqrt(true_variance(i));
            covered[i] += curve.points[i].lo <= truth && truth <= curve.points[i].hi ? 1.0 : 0.0;
        }
    }
    for (double& share : covered) { share /= static_cast<double>(records); }
    return covered;
}

void expect_coverage(const char* name, const Noise& noise) {
    for (const double confidence : {0.683, 0.95}) {
        const std::vector<double> covered = coverage(noise, DeviationKind::overlapping, confidence,
                                                     [&](std::size_t i) { return noise.allan_variance[i]; });
        std::cout << std::fixed << std::setprecision(1) << "| " << name << " | " << 100.0 * confidence
                  << " %";
        for (const double share : covered) {
            std::cout << " | " << 100.0 * share;
            EXPECT_NEAR(100.0 * share, 100.0 * confidence, tolerance_points);
        }
        std::cout << " |" << std::endl;
    }
}

TEST(IntervalCoverage, IsAsStatedForWhiteNoise) { expect_coverage("white", white_noise(1)); }

TEST(IntervalCoverage, IsAsStatedForFlickerNoise) { expect_coverage("flicker", flicker(2)); }

TEST(IntervalCoverage, IsAsStatedForARandomWalk) { expect_coverage("random walk", walk(13)); }

// All three seen: white at short times, flicker in the middle, walk at the end.
TEST(IntervalCoverage, IsAsStatedForAMixture) {
    expect_coverage("mixture", sum_of({{1.0, white_noise(4)}, {0.12, flicker(5)}, {0.02, walk(6)}}));
}

}  // namespace
}  // namespace gyrolog
