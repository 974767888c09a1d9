#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "analysis/denoise/wavelet_denoiser.hpp"
#include "analysis/denoise/wavelet_transform.hpp"
#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

struct Transformed {
    std::vector<std::size_t> sizes;
    std::vector<Signal> details;
    Signal approximation;
};

Transformed transform(const Signal& signal, int levels) {
    Transformed t{{signal.size()}, {}, signal};
    for (int i = 0; i < levels; ++i) {
        Signal a(coefficients_of(t.approximation.size()));
        Signal d(a.size());
        analyse_level(t.approximation, a, d);
        t.approximation = a;
        t.details.push_back(d);
        t.sizes.push_back(a.size());
    }
    return t;
}

Signal restore(const Transformed& t) {
    Signal signal = t.approximation;
    for (std::size_t i = t.details.size(); i-- > 0;) {
        Signal finer(t.sizes[i]);
        restore_level(signal, t.details[i], 0, finer);
        signal = finer;
    }
    return signal;
}

// By PyWavelets 1.1.1, pywt.dwt(x, "db4", mode="symmetric").
TEST(WaveletTransform, AgreesWithAnotherImplementation) {
    Signal x(17);
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = static_cast<double>(i * 7 % 11) - 3.0 + 0.25 * static_cast<double>(i);
    }
    const double a[] = {6.761204714387, 5.534537860330,  -2.902621329320, 1.911984085298,
                        6.807839888853, 6.068229429623,  3.739033250509,  6.462446236002,
                        3.263999462832, 10.013360987517, 8.146909892106,  6.363003631832};
    const double d[] = {-1.151577416482, -4.553896655343, -1.345542125567, 5.584757097100,
                        -4.335938107892, -1.132247569573, 5.468185677465,  3.527374168190,
                        -2.303985833067, 1.834921587413,  -5.782136312523, -3.450543005249};
    const Transformed t = transform(x, 1);
    ASSERT_EQ(t.approximation.size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_NEAR(t.approximation[i], a[i], 1e-11) << i;
        EXPECT_NEAR(t.details[0][i], d[i], 1e-11) << i;
    }
}

TEST(WaveletTransform, RestoresEverySignalToMachinePrecision) {
    for (const std::size_t samples : {1U, 2U, 7U, 8U, 13U, 64U, 255U, 256U, 1000U}) {
        Signal x(samples);
        RandomStream(11, 0).normals(0, x);
        for (const int levels : {1, 2, 4}) {
            const Signal y = restore(transform(x, levels));
            for (std::size_t i = 0; i < samples; ++i) {
                ASSERT_NEAR(y[i], x[i], 4e-15 * 16) << samples << " samples, " << levels << " levels, " << i;
            }
        }
    }
}

TEST(WaveletTransform, KeepsTheVarianceOfWhiteNoiseAndCubicsHaveNoDetail) {
    Signal x(20'000);
    RandomStream(12, 0).normals(0, x);
    const Transformed t = transform(x, 4);
    for (const Signal& detail : t.details) {
        const auto n = static_cast<double>(detail.size());
        EXPECT_NEAR(variance_of(detail), 1.0, 5.0 * std::sqrt(2.0 / n));
    }
    Signal cubic(200);
    for (std::size_t i = 0; i < cubic.size(); ++i) {
        const double at = 0.01 * static_cast<double>(i);
        cubic[i] = 1.0 + at - 2.0 * at * at + at * at * at;
    }
    const Signal detail = transform(cubic, 1).details[0];
    for (std::size_t i = 4; i + 4 < detail.size(); ++i) { EXPECT_NEAR(detail[i], 0.0, 1e-9) << i; }
}

// By PyWavelets 1.1.1: wavedec to level 3, hard threshold by the median of the finest details, waverec.
TEST(WaveletDenoiser, GivesTheLastSampleOfTheRestoredWindow) {
    WaveletDenoiser denoiser;
    double last = 0.0;
    for (int i = 0; i < 64; ++i) { last = denoiser.step(std::sin(i * 0.1) * 5.0 + (i * 37 % 17 - 8) * 0.1); }
    EXPECT_NEAR(last, -0.188810342038, 1e-11);
}

// What the denoiser leaves undone for speed, done in full.
TEST(WaveletDenoiser, IsTheFullTransformOfTheWindow) {
    for (const NoiseLevel noise : {NoiseLevel::finest, NoiseLevel::each}) {
        Signal x(700);
        RandomStream(13, 0).normals(0, x);
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += i > 400 ? 30.0 * std::sin(0.05 * static_cast<double>(i)) : 0.0;
        }
        WaveletDenoiser denoiser({256, 4, noise});
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double output = denoiser.step(x[k]);
            const std::size_t samples = std::min<std::size_t>(k + 1, 256);
            if (samples < 14 || k % 7 != 0) { continue; }
            const Signal window(x.begin() + static_cast<std::ptrdiff_t>(k + 1 - samples),
                                x.begin() + static_cast<std::ptrdiff_t>(k + 1));
            Transformed t = transform(window, std::min(4, levels_of(samples)));
            double sigma = 0.0;
            for (Signal& detail : t.details) {
                if (&detail == t.details.data() || noise == NoiseLevel::each) {
                    Signal sizes;
                    for (const double d : detail) { sizes.push_back(std::abs(d)); }
                    std::ranges::sort(sizes);
                    const std::size_t n = sizes.size();
                    sigma = 0.5 * (sizes[(n - 1) / 2] + sizes[n / 2]) / 0.6744897501960817;
                }
                const double threshold = sigma * std::sqrt(2.0 * std::log(static_cast<double>(samples)));
                for (double& d : detail) { d = std::abs(d) <= threshold ? 0.0 : d; }
            }
            ASSERT_NEAR(output, restore(t).back(), 1e-12) << k;
        }
    }
}

TEST(WaveletDenoiser, PassesAConstantAndAStep) {
    WaveletDenoiser denoiser;
    for (int k = 0; k < 600; ++k) { ASSERT_NEAR(denoiser.step(3.25), 3.25, 1e-12); }
    EXPECT_NEAR(denoiser.step(100.0), 100.0, 1e-9);  // without noise every detail is above the threshold
}

TEST(WaveletDenoiser, LeavesOfWhiteNoiseWhatItsWeightsSay) {
    const std::vector<double> weights = WaveletDenoiser::smoothing_weights();
    double sum = 0.0;
    double squares = 0.0;
    double lag = 0.0;
    for (std::size_t age = 0; age < weights.size(); ++age) {
        sum += weights[age];
        squares += weights[age] * weights[age];
        lag += weights[age] * static_cast<double>(age);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_NEAR(squares, 0.1557, 1e-4);  // by PyWavelets, from the answers to 256 single samples
    EXPECT_NEAR(lag, 1.995, 1e-3);
    Signal x(30'000);
    RandomStream(14, 0).normals(0, x);
    WaveletDenoiser denoiser;
    for (double& sample : x) { sample = denoiser.step(sample); }
    // Chance puts about one detail in a thousand above the threshold; the details that the last sample rests
    // on bring up to 2 % of the noise back. Neighbours are alike over some ten samples.
    EXPECT_NEAR(variance_of(x, 256), squares + 0.012,
                0.012 + 5.0 * squares * std::sqrt(2.0 * 10.0 / 30'000.0));
}

TEST(WaveletDenoiser, ASlopeThatIsKnownIsFollowedWithoutLag) {
    WaveletDenoiser mirrored;
    WaveletDenoiser along;
    Signal noise(2000);
    RandomStream(15, 0).normals(0, noise);
    double lag_mirrored = 0.0;
    double lag_along = 0.0;
    for (std::size_t k = 0; k < noise.size(); ++k) {
        const double ramp = 0.1 * static_cast<double>(k);
        const double a = mirrored.step(ramp + noise[k]);
        const double b = along.step(ramp + noise[k], 0.1);
        if (k < 256) { continue; }
        lag_mirrored += (ramp - a) / 0.1 / (2000.0 - 256.0);
        lag_along += (ramp - b) / 0.1 / (2000.0 - 256.0);
    }
    EXPECT_NEAR(lag_mirrored, 1.995, 1.0);
    EXPECT_NEAR(lag_along, 0.0, 1.0);
    EXPECT_NEAR(lag_mirrored - lag_along, 1.995, 0.5);
}

TEST(WaveletDenoiser, StartsAnew) {
    WaveletDenoiser denoiser;
    for (int k = 0; k < 500; ++k) { denoiser.step(k % 5); }
    denoiser.reset();
    WaveletDenoiser fresh;
    for (int k = 0; k < 3000; ++k) { ASSERT_EQ(denoiser.step(k % 7), fresh.step(k % 7)) << k; }
}

}  // namespace
}  // namespace gyrolog
