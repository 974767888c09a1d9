#include "analysis/diagnose/likelihood/level_changes.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "analysis/diagnose/measures/frequency_bands.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t length = 20'000;
constexpr double rate_hz = 100.0;

std::vector<float> white(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<float> normal;
    std::vector<float> cosines(length);
    for (float& cosine : cosines) { cosine = normal(random); }
    return cosines;
}

void amplify(std::vector<float>& cosines, std::size_t first, std::size_t end, float by) {
    for (std::size_t k = first; k < end; ++k) { cosines[k] *= by; }
}

std::size_t nearest(const std::vector<std::size_t>& changes, std::size_t to) {
    std::size_t least = length;
    for (const std::size_t change : changes) {
        least = std::min(least, change > to ? change - to : to - change);
    }
    return least;
}

// A bin of n coefficients has some 2 n windows, each of which pays ln(2 N n): a cut in one of N / n bins for
// each coefficient that a bin has, which is once in some hundred records.
TEST(LevelChanges, OfWhiteNoiseAreRare) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    const double expected = 400.0 * static_cast<double>(bins.size()) / static_cast<double>(length);
    int with_changes = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        with_changes += level_changes(white(seed), bins).empty() ? 0 : 1;
    }
    EXPECT_LT(with_changes, expected + 4.0 * std::sqrt(expected));
}

TEST(LevelChanges, StandAtBothEdgesOfANarrowBand) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    const std::size_t first = bins[250].first + 70;
    for (const std::size_t width : {12U, 50U, 130U}) {
        ASSERT_LT(first + width, bins[250].end);
        for (const float by : {5.0F, 0.08F}) {
            std::vector<float> cosines = white(width);
            amplify(cosines, first, first + width, by);
            const std::vector<std::size_t> changes = level_changes(cosines, bins);
            EXPECT_LE(nearest(changes, first), 3U) << width << ' ' << by;
            EXPECT_LE(nearest(changes, first + width), 3U) << width << ' ' << by;
            EXPECT_LE(changes.size(), 3U) << width << ' ' << by;
            EXPECT_TRUE(std::ranges::is_sorted(changes));
        }
    }
}

TEST(LevelChanges, DoNotDependOnTheUnit) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    std::vector<float> cosines = white(7);
    amplify(cosines, 15'000, 15'040, 4.0F);
    const std::vector<std::size_t> changes = level_changes(cosines, bins);
    ASSERT_FALSE(changes.empty());
    amplify(cosines, 0, length, 1e-4F);
    EXPECT_EQ(level_changes(cosines, bins), changes);
}

// Of a constant's spectrum nothing is left.
TEST(LevelChanges, AreNoneWhereThereIsNoPower) {
    std::vector<float> cosines(length, 0.0F);
    EXPECT_TRUE(level_changes(cosines, spectral_bins(length, rate_hz)).empty());
    cosines[9000] = 1.0F;
    EXPECT_TRUE(level_changes(cosines, spectral_bins(length, rate_hz)).empty());
}

TEST(SpectralBins, OnceCutHoldEveryCoefficientOnceAndMoveNoBand) {
    const std::vector<std::size_t> cuts = {20, 5'000, 5'003, 5'400, 12'345, length - 1};
    for (const Half half : {Half::both, Half::first, Half::second}) {
        const SpectralBins whole = spectral_bins(length, rate_hz, half);
        const SpectralBins bins = spectral_bins(length, rate_hz, half, cuts);
        EXPECT_GT(bins.size(), whole.size());
        double coefficients = 0.0;
        for (const SpectralBin& bin : bins) {
            coefficients += bin.count();
            for (const std::size_t cut : cuts) { EXPECT_FALSE(bin.first < cut && cut < bin.end); }
        }
        for (const SpectralBin& bin : whole) { coefficients -= bin.count(); }
        EXPECT_EQ(coefficients, 0.0);
        const std::vector<std::size_t> edges = band_edges(bins);
        const std::vector<std::size_t> whole_edges = band_edges(whole);
        ASSERT_EQ(edges.size(), whole_edges.size());
        for (std::size_t band = 0; band + 1 < edges.size(); ++band) {
            EXPECT_EQ(bins[edges[band]].first, whole[whole_edges[band]].first);
        }
    }
}

}  // namespace
}  // namespace gyrolog
