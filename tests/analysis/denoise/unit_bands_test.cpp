#include "analysis/denoise/unit_bands.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

struct Units {
    std::vector<Column> columns;
    std::vector<const Column*> pointers;

    explicit Units(const ArraySamples& samples) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            columns.push_back({"gx" + std::to_string(i + 1), "rad/s", samples[i]});
        }
        for (const Column& column : columns) { pointers.push_back(&column); }
    }
};

TEST(UnitBands, DiagonalIsTheAllanVariance) {
    const ArraySamples samples = array_samples(equal_units(2, 1.0, 0.01), Signal(4096, 0.0), 31);
    const Units units(samples);
    const std::vector<Segment> whole{{0, 4096, 0}};
    const std::vector<UnitBand> bands = unit_bands(units.pointers, whole, 100.0);
    const AllanCurve curve =
        allan_deviation(units.columns[1], whole, 100.0, {.kind = DeviationKind::standard_halving, .m = {}});
    ASSERT_GE(curve.points.size(), bands.size());
    ASSERT_GE(bands.size(), 8U);
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const double variance = std::pow(curve.points[i].deviation, 2);
        EXPECT_NEAR(bands[i].tau_s, curve.points[i].tau_s, 1e-12);
        // Every second difference of the curve's, which has twice as many.
        const double sd = std::sqrt(2.0 / static_cast<double>(bands[i].differences));
        EXPECT_NEAR(bands[i].covariance[3], variance, 4.0 * sd * variance) << i;
    }
}

TEST(UnitBands, FindTheCorrelationWhereItIs) {
    ArrayNoise noise = equal_units(4, 1.0, 0.05);
    noise.walk_correlation = equal_correlation(4, 0.8);
    const Units units(array_samples(noise, Signal(200'000, 0.0), 32));
    const std::vector<Segment> whole{{0, 200'000, 0}};
    const std::vector<UnitBand> bands = unit_bands(units.pointers, whole, 100.0);
    EXPECT_NEAR(bands.front().mean_correlation, 0.0, 5.0 * bands.front().correlation_sd + 1e-3);
    EXPECT_NEAR(bands.front().gain_mean, 4.0, 0.1);
    EXPECT_GT(bands.front().gain_limit(), 100.0);
    const UnitBand& slow = bands[10];
    EXPECT_NEAR(slow.mean_correlation, 0.8, 0.1);
    EXPECT_NEAR(slow.gain_limit(), 1.25, 0.2);
    EXPECT_NEAR(slow.gain_mean, 4.0 / (1.0 + 3.0 * slow.mean_correlation), 0.2);
}

TEST(UnitBands, GainOfTheBestWeightsIsNotInflatedByTheirFit) {
    // 8 equal independent units: 8, whatever the number of differences, on average.
    double gain = 0.0;
    double without_correction = 0.0;
    constexpr std::size_t seeds = 200;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Units units(array_samples(equal_units(8, 1.0, 0.0), Signal(64, 0.0), 100 + seed));
        const std::vector<Segment> whole{{0, 64, 0}};
        const double found = unit_bands(units.pointers, whole, 100.0).front().gain_best;
        gain += 1.0 / found / seeds;
        without_correction += 1.0 / (found * 32.0 / 25.0) / seeds;
    }
    EXPECT_NEAR(gain, 1.0 / 8.0, 0.01);
    EXPECT_LT(without_correction, 1.0 / 9.5);
}

TEST(UnitBands, DoNotBridgeHoles) {
    Signal x(200, 0.0);
    for (std::size_t i = 100; i < 200; ++i) { x[i] = 1000.0; }
    const Units units(ArraySamples{x, x});
    const std::vector<Segment> parts{{0, 100, 0}, {100, 100, 5000}};
    for (const UnitBand& band : unit_bands(units.pointers, parts, 100.0)) {
        EXPECT_EQ(band.covariance[0], 0.0) << band.tau_s;
    }
}

}  // namespace
}  // namespace gyrolog
