#include "analysis/simulate/counter_random.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {
namespace {

double upper_tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

std::vector<double> draw(const RandomStream& stream, std::size_t count) {
    std::vector<double> values(count);
    stream.normals(0, values);
    return values;
}

// sqrt(n) times the largest distance between the empirical distribution and the uniform one.
double kolmogorov_statistic(std::vector<double> uniforms) {
    std::sort(uniforms.begin(), uniforms.end());
    const auto n = static_cast<double>(uniforms.size());
    double distance = 0.0;
    for (std::size_t i = 0; i < uniforms.size(); ++i) {
        distance = std::max({distance, static_cast<double>(i + 1) / n - uniforms[i],
                             uniforms[i] - static_cast<double>(i) / n});
    }
    return std::sqrt(n) * distance;
}
constexpr double kolmogorov_1_in_10000 = 2.225;

// tests/kat_vectors of the Random123 distribution, lines "philox4x32 10".
TEST(CounterRandom, ReproducesThePublishedVectorsOfPhilox) {
    EXPECT_EQ(philox4x32_10({0, 0, 0, 0}, {0, 0}),
              (PhiloxCounter{0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8}));
    EXPECT_EQ(philox4x32_10({0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF}, {0xFFFFFFFF, 0xFFFFFFFF}),
              (PhiloxCounter{0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD}));
    EXPECT_EQ(philox4x32_10({0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344}, {0xA4093822, 0x299F31D0}),
              (PhiloxCounter{0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1}));
}

TEST(CounterRandom, UniformDrawsAreTheWordsOfTheGenerator) {
    const RandomStream stream(0x299F31D0A4093822, 5);
    const PhiloxCounter words = philox4x32_10({7, 0, 5, 0}, {0xA4093822, 0x299F31D0});
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(stream.uniform(28 + k), (words[k] + 0.5) / 4294967296.0);
    }
}

TEST(CounterRandom, NormalDrawsHaveTheMomentsOfTheNormalDistribution) {
    const auto z = draw({11, 1}, 4'000'000);
    const auto n = static_cast<double>(z.size());
    double m1 = 0.0;
    double m2 = 0.0;
    double m3 = 0.0;
    double m4 = 0.0;
    for (const double value : z) {
        m1 += value / n;
        m2 += value * value / n;
        m3 += value * value * value / n;
        m4 += value * value * value * value / n;
    }
    // Standard errors: sqrt of (1, 2, 15, 96) / n.
    EXPECT_NEAR(m1, 0.0, 4.0 * std::sqrt(1.0 / n));
    EXPECT_NEAR(m2, 1.0, 4.0 * std::sqrt(2.0 / n));
    EXPECT_NEAR(m3, 0.0, 4.0 * std::sqrt(15.0 / n));
    EXPECT_NEAR(m4, 3.0, 4.0 * std::sqrt(96.0 / n));
}

TEST(CounterRandom, NormalDrawsFollowTheNormalDistributionFunction) {
    std::vector<double> uniforms = draw({12, 2}, 2'000'000);
    for (double& value : uniforms) { value = upper_tail(value); }
    EXPECT_LT(kolmogorov_statistic(std::move(uniforms)), kolmogorov_1_in_10000);
}

TEST(CounterRandom, TailsBeyondFourSigmaHaveTheirWeightAndShape) {
    const auto z = draw({13, 3}, 20'000'000);
    std::vector<double> beyond;
    for (const double value : z) {
        if (std::fabs(value) > 4.0) { beyond.push_back(upper_tail(std::fabs(value)) / upper_tail(4.0)); }
    }
    const double expected = 2.0 * upper_tail(4.0) * static_cast<double>(z.size());
    EXPECT_NEAR(static_cast<double>(beyond.size()), expected, 4.0 * std::sqrt(expected));
    EXPECT_LT(kolmogorov_statistic(std::move(beyond)), kolmogorov_1_in_10000);
}

// The draws are the quantile of their word, to the table's error.
TEST(CounterRandom, TheQuantileTableAgreesWithTheExactQuantile) {
    const RandomStream stream(14, 4);
    for (std::uint64_t k = 0; k < 200'000; ++k) {
        const double u = stream.uniform(k);  // its top bit is the sign
        const double p = u < 0.5 ? u : u - 0.5;
        const double expected = upper_normal_quantile(p) * (u < 0.5 ? 1.0 : -1.0);
        ASSERT_NEAR(stream.normal(k), expected, 2e-7) << "draw " << k;
    }
}

TEST(CounterRandom, AnyDrawIsReachedDirectlyAndInAnyPieces) {
    const RandomStream stream(15, 6);
    const std::uint64_t far = std::uint64_t{1} << 40U;
    std::vector<double> whole(5000);
    stream.normals(far, whole);
    for (const std::size_t piece : {1U, 3U, 64U, 255U, 256U, 1021U}) {
        std::vector<double> pieces(whole.size());
        for (std::size_t at = 0; at < pieces.size(); at += piece) {
            const std::size_t size = std::min(piece, pieces.size() - at);
            stream.normals(far + at, std::span(pieces).subspan(at, size));
        }
        EXPECT_EQ(pieces, whole) << "pieces of " << piece;
    }
    for (std::size_t i = 0; i < whole.size(); ++i) { ASSERT_EQ(stream.normal(far + i), whole[i]); }
}

TEST(CounterRandom, SeedsAndStreamsAreUncorrelated) {
    const auto a = draw({16, 1}, 1'000'000);
    for (const RandomStream& other : {RandomStream(16, 2), RandomStream(17, 1)}) {
        const auto b = draw(other, a.size());
        double correlation = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            correlation += a[i] * b[i] / static_cast<double>(a.size());
        }
        EXPECT_NEAR(correlation, 0.0, 4.0 / std::sqrt(static_cast<double>(a.size())));
    }
}

TEST(PortableMath, AgreesWithTheMathematicalLibrary) {
    for (double x = 1e-300; x < 1e300; x *= 1.37) {
        ASSERT_NEAR(portable_log(x), std::log(x), 1e-15 * std::max(1.0, std::fabs(std::log(x)))) << x;
    }
    for (double x = -700.0; x < 700.0; x += 0.137) {
        ASSERT_NEAR(portable_exp(x) / std::exp(x), 1.0, 1e-15) << x;
    }
}

TEST(PortableMath, TheNormalQuantileInvertsTheDistributionFunction) {
    for (double p = 1e-290; p < 0.5; p *= 1.07) {
        const double z = upper_normal_quantile(p);
        // An error e of z shows in p as about z e p.
        ASSERT_NEAR(upper_tail(z) / p, 1.0, 2e-15 * (1.0 + z * z)) << p;
    }
}

}  // namespace
}  // namespace gyrolog
