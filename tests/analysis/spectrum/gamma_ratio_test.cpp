#include "analysis/spectrum/gamma_ratio.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>

namespace gyrolog {
namespace {

AveragedPeriodogram periodogram_of(std::size_t pieces) {
    AveragedPeriodogram periodogram;
    periodogram.length = 1024;
    periodogram.pieces = pieces;
    periodogram.overlaps = pieces - 1;
    return periodogram;
}

// The ratio of two gamma variables has the F distribution.
TEST(GammaRatio, OfOnePartIsFishersF) {
    for (const double shape : {1.0, 2.0, 30.0}) {
        for (const double reference_shape : {4.0, 64.0, 1000.0}) {
            const std::array<GammaPart, 1> part{{{1.0 / shape, shape}}};
            const boost::math::fisher_f exact(2.0 * shape, 2.0 * reference_shape);
            for (const double tail : {1e-2, 1e-4, 1e-8, 1e-12}) {
                const double ratio = quantile(complement(exact, tail));
                EXPECT_NEAR(log_tail_of_ratio(part, reference_shape, ratio), std::log(tail), 0.08)
                    << shape << ' ' << reference_shape << ' ' << tail;
            }
        }
    }
}

// Of tapered white noise, worked out the long way.
TEST(GammaRatio, OfNeighbouringBinsIsThatOfTaperedNoise) {
    constexpr std::size_t bins = 4;
    constexpr std::size_t pieces = 3;
    constexpr int rounds = 200'000;
    constexpr double reference_shape = 50.0;
    constexpr std::array<double, 3> ratios{1.8, 2.4, 3.0};
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    std::gamma_distribution<double> reference(reference_shape, 1.0 / reference_shape);
    std::array<int, ratios.size()> beyond{};
    for (int round = 0; round < rounds; ++round) {
        double sum = 0.0;
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            // The taper mixes each bin of the untapered transform with its neighbours: -1/4, 1/2, -1/4.
            std::array<double, bins + 2> re{}, im{};
            for (double& value : re) { value = normal(random); }
            for (double& value : im) { value = normal(random); }
            for (std::size_t k = 1; k <= bins; ++k) {
                const double real = 0.5 * re.at(k) - 0.25 * (re.at(k - 1) + re.at(k + 1));
                const double imaginary = 0.5 * im.at(k) - 0.25 * (im.at(k - 1) + im.at(k + 1));
                sum += (real * real + imaginary * imaginary) / 0.75;
            }
        }
        const double ratio = sum / (bins * pieces) / reference(random);
        for (std::size_t i = 0; i < ratios.size(); ++i) { beyond.at(i) += ratio > ratios.at(i) ? 1 : 0; }
    }
    AveragedPeriodogram independent = periodogram_of(pieces);
    independent.overlaps = 0;
    const std::vector<GammaPart> parts = mean_of_bins(independent, bins);
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        ASSERT_GT(beyond.at(i), 20);
        const double share = static_cast<double>(beyond.at(i)) / rounds;
        EXPECT_NEAR(std::exp(log_tail_of_ratio(parts, reference_shape, ratios.at(i))) / share, 1.0,
                    0.06 + 4.0 / std::sqrt(beyond.at(i)))
            << ratios.at(i);
    }
}

TEST(GammaRatio, PartsHaveMeanOneAndTheVarianceOfTheDegreesOfFreedom) {
    for (const std::size_t pieces : {1U, 2U, 7U, 100U}) {
        for (const std::size_t bins : {1U, 4U, 16U}) {
            double mean = 0.0;
            double variance = 0.0;
            for (const GammaPart& part : mean_of_bins(periodogram_of(pieces), bins)) {
                mean += part.scale * part.shape;
                variance += part.scale * part.scale * part.shape;
            }
            EXPECT_NEAR(mean, 1.0, 1e-9);
            // Pieces and bins are taken as a product, which they are not quite.
            EXPECT_NEAR(variance * periodogram_of(pieces).degrees_of_freedom(bins) / 2.0, 1.0, 0.06);
        }
    }
}

TEST(GammaRatio, StaysFiniteFarOut) {
    const std::array<GammaPart, 1> part{{{1.0, 1.0}}};
    const double log_probability = log_tail_of_ratio(part, 1e6, 1e5);
    EXPECT_TRUE(std::isfinite(log_probability));
    EXPECT_LT(log_probability, -9e4);
    EXPECT_EQ(log_tail_of_ratio(part, 100.0, 0.5), 0.0);
}

}  // namespace
}  // namespace gyrolog
