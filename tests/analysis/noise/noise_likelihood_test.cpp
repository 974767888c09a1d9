#include "analysis/noise/noise_likelihood.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/noise/likelihood_maximum.hpp"
#include "analysis/numerics/cholesky.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 10.0;
constexpr NoiseCoefficients truth = {0.0, 0.01, 0.004, 1e-3, 0.0};

Column column_of(std::vector<double> samples) {
    return {"gx", "rad/s", std::move(samples), 1.0, 0.0, "rad_s"};
}

ContrastPyramid pyramid_of(const Column& column, std::size_t most_top) {
    const std::vector<Segment> whole = {{0, column.size(), 0}};
    return contrast_pyramid(column, whole, rate_hz, most_top);
}

NoiseLikelihood with_terms(const ContrastPyramid& pyramid, std::initializer_list<NoiseTerm> terms,
                           bool ramp = false) {
    NoiseLikelihood likelihood(pyramid, ramp);
    for (const NoiseTerm term : terms) { likelihood.add(average_covariance(term)); }
    return likelihood;
}

std::vector<double> squares_of(const NoiseCoefficients& noise) {
    return {noise.N_rad_per_sqrt_s * noise.N_rad_per_sqrt_s, noise.B_rad_per_s * noise.B_rad_per_s,
            noise.K_rad_per_s_sqrt_s * noise.K_rad_per_s_sqrt_s};
}

TEST(AverageCovariance, GivesTheAllanVariance) {
    for (const double span_s : {0.01, 1.0, 300.0}) {
        const auto allan = [&](NoiseTerm term) {
            const auto c = average_covariance(term).of_unit_square;
            return c(0, span_s) - c(1, span_s);
        };
        const auto expected = [&](NoiseCoefficients one) { return one.allan_variance(span_s); };
        EXPECT_NEAR(allan(NoiseTerm::Q) / expected({1, 0, 0, 0, 0}), 1.0, 1e-12);
        EXPECT_NEAR(allan(NoiseTerm::N) / expected({0, 1, 0, 0, 0}), 1.0, 1e-12);
        EXPECT_NEAR(allan(NoiseTerm::B) / expected({0, 0, 1, 0, 0}), 1.0, 1e-12);
        EXPECT_NEAR(allan(NoiseTerm::K) / expected({0, 0, 0, 1, 0}), 1.0, 1e-12);
        for (const double correlation_s : {0.5, 20.0, 1e4}) {
            const auto c = gauss_markov_covariance(correlation_s).of_unit_square;
            const GaussMarkov noise{1.0, correlation_s};
            EXPECT_NEAR((c(0, span_s) - c(1, span_s)) / noise.allan_variance(span_s), 1.0, 1e-5);
        }
    }
    const auto c = sinusoid_covariance(0.03, 1000.0).of_unit_square;
    const Sinusoid line{1.0, 0.03};
    EXPECT_NEAR((c(0, 7.0) - c(1, 7.0)) / line.allan_variance(7.0), 1.0, 1e-6);
}

// Sums over the samples' own covariance, which is that of white noise behind a Butterworth filter.
TEST(AverageCovariance, OfFilteredWhiteNoiseIsTheSumOverItsSamples) {
    constexpr double sampled_hz = 200.0;
    for (const double bandwidth_hz : {1.0, 20.0, 70.0}) {
        const auto c = filtered_white_covariance(bandwidth_hz, sampled_hz).of_unit_square;
        const double a_T = std::sqrt(2.0) * pi * bandwidth_hz / sampled_hz;
        const auto sample = [&](std::int64_t k) {
            const double x = a_T * static_cast<double>(std::abs(k));
            return std::exp(-x) * (std::cos(x) + std::sin(x));
        };
        double density = 0.0;
        for (std::int64_t k = -5000; k <= 5000; ++k) { density += sample(k) / sampled_hz; }
        for (const std::int64_t m : {1, 3, 16}) {
            for (const std::int64_t lag : {0, 1, 2, 5}) {
                double sum = 0.0;
                for (std::int64_t i = 0; i < m; ++i) {
                    for (std::int64_t j = 0; j < m; ++j) { sum += sample(lag * m + j - i); }
                }
                const double expected = sum / static_cast<double>(m * m) / density;
                EXPECT_NEAR(c(lag, static_cast<double>(m) / sampled_hz), expected, 1e-12 * sampled_hz)
                    << bandwidth_hz << ' ' << m << ' ' << lag;
            }
        }
    }
}

TEST(AverageCovariance, OfFlickerGoesOnSmoothlyWhereItsSeriesBegins) {
    const auto c = average_covariance(NoiseTerm::B).of_unit_square;
    const double step = c(1000, 1.0) - c(999, 1.0);
    EXPECT_NEAR(c(1001, 1.0) - c(1000, 1.0), step, 2e-3 * std::abs(step));
}

TEST(NoiseLikelihood, OfWhiteNoiseIsTheSameWithAndWithoutThePyramid) {
    const Column column = column_of(test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 1200, rate_hz, 5));
    const ContrastPyramid levels = pyramid_of(column, 60);
    const ContrastPyramid exact = pyramid_of(column, 1200);
    ASSERT_GT(levels.levels.size(), 1U);
    const auto gain = [](const ContrastPyramid& pyramid) {
        const NoiseLikelihood likelihood = with_terms(pyramid, {NoiseTerm::N});
        return likelihood.value(std::array{1.1e-4}) - likelihood.value(std::array{0.9e-4});
    };
    EXPECT_NEAR(gain(levels), gain(exact), 1e-6);
}

// The dense covariance of every sample against blocks: what the blocks neglect costs little.
TEST(NoiseLikelihood, OfMixedNoiseHasItsMaximumWhereTheExactOneHasIt) {
    for (const std::uint64_t seed : {1U, 2U}) {
        const Column column = column_of(test::sensor_noise(truth, 400, rate_hz, seed));
        const auto maximum = [&](std::size_t most_top, Matrix* information) {
            const ContrastPyramid pyramid = pyramid_of(column, most_top);
            const NoiseLikelihood likelihood =
                with_terms(pyramid, {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K});
            const LikelihoodMaximum found = maximise(likelihood, squares_of(truth));
            if (information != nullptr) { *information = likelihood.expected_information(found.squares); }
            return found.squares;
        };
        Matrix information;
        const std::vector<double> exact = maximum(400, &information);
        const std::vector<double> blocks = maximum(40, nullptr);
        const Matrix covariance = CholeskyFactor(information).inverse();
        for (std::size_t j = 0; j < exact.size(); ++j) {
            EXPECT_LT(std::abs(blocks[j] - exact[j]), 0.35 * std::sqrt(covariance(j, j)))
                << "seed " << seed << ", component " << j;
        }
    }
}

TEST(NoiseLikelihood, HasTheGradientOfItsValue) {
    const Column column = column_of(test::sensor_noise(truth, 5000, rate_hz, 9));
    const ContrastPyramid pyramid = pyramid_of(column, 100);
    const NoiseLikelihood likelihood = with_terms(pyramid, {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K});
    std::vector<double> at = squares_of(truth);
    for (double& square : at) { square *= 1.3; }
    const std::vector<double> gradient = likelihood.evaluate(at).gradient;
    for (std::size_t j = 0; j < 3; ++j) {
        std::vector<double> more = at;
        std::vector<double> less = at;
        more[j] *= 1.0 + 1e-5;
        less[j] *= 1.0 - 1e-5;
        const double slope = (likelihood.value(more) - likelihood.value(less)) / (more[j] - less[j]);
        EXPECT_NEAR(gradient[j] / slope, 1.0, 1e-4) << j;
    }
}

TEST(NoiseLikelihood, FindsARampAndItsStandardDeviation) {
    double square = 0.0;
    double sd = 0.0;
    constexpr int records = 100;
    constexpr double slope_per_s = 3e-6;
    for (std::uint64_t seed = 1; seed <= records; ++seed) {
        auto samples = test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 3000, rate_hz, seed);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            samples[i] += slope_per_s * static_cast<double>(i) / rate_hz;
        }
        const Column column = column_of(std::move(samples));
        const ContrastPyramid pyramid = pyramid_of(column, 100);
        const RampEstimate ramp = with_terms(pyramid, {NoiseTerm::N}, true).ramp(std::array{1e-4});
        square += std::pow(ramp.slope_per_s - slope_per_s, 2) / records;
        sd = ramp.sd_per_s;
    }
    // Least squares in white noise: N sqrt(12 / T^3).
    EXPECT_NEAR(sd, 0.01 * std::sqrt(12.0 / std::pow(300.0, 3)), 0.01 * sd);
    EXPECT_NEAR(std::sqrt(square), sd, 3.0 * sd / std::sqrt(2.0 * records));
}

TEST(NoiseLikelihood, OfImpossibleNoiseIsMinusInfinity) {
    const Column column = column_of(test::sensor_noise(truth, 2000, rate_hz, 1));
    const ContrastPyramid pyramid = pyramid_of(column, 100);
    const NoiseLikelihood likelihood = with_terms(pyramid, {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K});
    EXPECT_EQ(likelihood.value(std::array{0.0, 0.0, 0.0}), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace gyrolog
