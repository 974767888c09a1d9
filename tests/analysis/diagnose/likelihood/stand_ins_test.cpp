#include "analysis/diagnose/likelihood/stand_ins.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;
constexpr std::size_t length = 1 << 15;
constexpr double phi = 0.9;

// x_k = phi x_{k-1} + e_k with var e = 1: S rate = 1 / |1 - phi exp(-i w)|^2.
std::vector<double> autoregression_density(const SpectralBins& bins) {
    std::vector<double> density;
    for (const SpectralBin& bin : bins) {
        const double angle = 2.0 * pi * bin.f_hz / rate_hz;
        density.push_back(1.0 / (rate_hz * (1.0 + phi * phi - 2.0 * phi * std::cos(angle))));
    }
    return density;
}

TEST(InverseCovariance, OfWhiteNoiseIsThatOfSingleSamples) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    const std::vector<double> density(bins.size(), 0.04 / rate_hz);
    const std::vector<double> inverse = inverse_covariance(bins, density, rate_hz, length, 8);
    EXPECT_NEAR(inverse[0], 25.0, 1e-9);
    for (std::size_t k = 1; k <= 8; ++k) { EXPECT_NEAR(inverse[k], 0.0, 1e-9) << k; }
}

// G. E. P. Box, G. M. Jenkins, G. C. Reinsel, Time Series Analysis, A7.5: tridiagonal, 1 + phi^2 and -phi.
TEST(InverseCovariance, OfAFirstOrderAutoregressionIsTridiagonal) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    const std::vector<double> inverse =
        inverse_covariance(bins, autoregression_density(bins), rate_hz, length, 6);
    EXPECT_NEAR(inverse[0], 1.0 + phi * phi, 0.01);
    EXPECT_NEAR(inverse[1], -phi, 0.01);
    for (std::size_t k = 2; k <= 6; ++k) { EXPECT_NEAR(inverse[k], 0.0, 0.01) << k; }
}

// Between neighbours a and b the missing one is phi (a + b) / (1 + phi^2) with variance 1 / (1 + phi^2).
TEST(StandIns, OfSingleSamplesHaveTheMeanAndTheVarianceThatTheirNeighboursLeave) {
    const std::vector<double> inverse = {1.0 + phi * phi, -phi};
    std::vector<float> values(length);
    std::vector<bool> present(length, true);
    const RandomStream draws(1, 2);
    double before = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
        before = phi * before + draws.normal(i);
        values[i] = static_cast<float>(before);
        present[i] = i % 8 != 5;
    }
    for (std::size_t i = 0; i < length; ++i) {
        if (!present[i]) { values[i] = 1e3F; }  // a guess counts for nothing
    }
    draw_stand_ins(values, present, inverse, RandomStream(3, 4));
    double sum = 0.0;
    double square = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
        if (present[i]) { continue; }
        const double mean =
            phi * (static_cast<double>(values[i - 1]) + static_cast<double>(values[i + 1])) / inverse[0];
        const double off = (static_cast<double>(values[i]) - mean) * std::sqrt(inverse[0]);
        sum += off;
        square += off * off;
        count += 1.0;
    }
    EXPECT_NEAR(sum / count, 0.0, 4.0 / std::sqrt(count));
    EXPECT_NEAR(square / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

// Slow noise goes far: what is drawn in a hole does not depend on how far from zero the level is.
TEST(StandIns, FollowAnyLevel) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    std::vector<double> density;
    for (const SpectralBin& bin : bins) { density.push_back((1.0 + 0.5 / (bin.f_hz * bin.f_hz)) / rate_hz); }
    const std::vector<double> inverse = inverse_covariance(bins, density, rate_hz, length, 64);
    const RandomStream draws(5, 6);
    std::vector<float> near(length);
    std::vector<float> far(length);
    std::vector<bool> present(length, true);
    for (std::size_t i = 0; i < length; ++i) {
        near[i] = static_cast<float>(draws.normal(i));
        far[i] = near[i] + 100.0F;
        present[i] = i % 50 > 2;
    }
    draw_stand_ins(near, present, inverse, RandomStream(3, 4));
    draw_stand_ins(far, present, inverse, RandomStream(3, 4));
    for (std::size_t i = 0; i < length; ++i) { ASSERT_NEAR(far[i] - near[i], 100.0F, 1e-3F) << i; }
}

// Behind a low-pass filter the density near half of the rate is some ten thousandth of that of slow noise:
// one sample in a hundred that does not follow its neighbours would be most of it.
TEST(StandIns, BehindALowPassLeaveTheSpectrumAsItIs) {
    SensorModel model = calibrated_sensor();
    model.lsb_rad_s = 0.0;
    model = with_effect(model, "lowpass", {{"fc_hz", 6.0}, {"order", 2.0}}, {});
    Recording holed = *recorded(model, 90'000, 31);
    const Segment whole = holed.segments.front();
    holed.segments.clear();
    // Of every 97 rows one, of every ninth 97 five more, and once half a second.
    std::size_t from = 0;
    const auto leave_out = [&](std::size_t row, std::size_t rows) {
        holed.segments.push_back({from, row - from, whole.first_index + static_cast<std::int64_t>(from)});
        from = row + rows;
    };
    for (std::size_t k = 1; 97 * k + 60 < whole.count; ++k) {
        leave_out(97 * k, k == 100 ? 50 : k % 9 == 0 ? 6 : 1);
    }
    holed.segments.push_back({from, whole.count - from, whole.first_index + static_cast<std::int64_t>(from)});
    const auto recording = std::make_shared<const Recording>(std::move(holed));
    const Observation seen(prediction_of(recording, model), recording, 1);
    const SpectralBins& bins = seen.prediction().bins();
    for (const std::size_t axis : seen.prediction().axes()) {
        double ratio = 0.0;
        double count = 0.0;
        for (std::size_t i = 0; i < bins.size(); ++i) {
            if (bins[i].f_hz < 20.0) { continue; }
            ratio += bins[i].count() * seen.axis(axis).power[i] / seen.axis(axis).density[i];
            count += bins[i].count();
        }
        EXPECT_NEAR(ratio / count, 1.0, 4.0 * std::sqrt(2.0 / count)) << axis;
    }
}

}  // namespace
}  // namespace gyrolog
