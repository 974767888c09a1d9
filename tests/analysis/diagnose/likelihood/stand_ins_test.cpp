#include "analysis/diagnose/likelihood/stand_ins.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;
constexpr std::size_t length = 1 << 15;
constexpr double phi = 0.9;
const InverseCovariance autoregression = {{1.0 + phi * phi, -phi}, (1.0 - phi) * (1.0 - phi)};

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
    const std::vector<double> inverse = inverse_covariance(bins, density, rate_hz, length, 8).by_lag;
    EXPECT_NEAR(inverse[0], 25.0, 1e-9);
    for (std::size_t k = 1; k <= 8; ++k) { EXPECT_NEAR(inverse[k], 0.0, 1e-9) << k; }
}

// G. E. P. Box, G. M. Jenkins, G. C. Reinsel, Time Series Analysis, A7.5: tridiagonal, 1 + phi^2 and -phi.
TEST(InverseCovariance, OfAFirstOrderAutoregressionIsTridiagonal) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    const InverseCovariance inverse =
        inverse_covariance(bins, autoregression_density(bins), rate_hz, length, 6);
    EXPECT_NEAR(inverse.by_lag[0], 1.0 + phi * phi, 0.01);
    EXPECT_NEAR(inverse.by_lag[1], -phi, 0.01);
    for (std::size_t k = 2; k <= 6; ++k) { EXPECT_NEAR(inverse.by_lag[k], 0.0, 0.01) << k; }
    EXPECT_NEAR(inverse.least, autoregression.least, 1e-4);
}

// The product of the autoregression's inverse covariance with the values, away from the ends.
std::vector<double> weighted_by_autoregression(std::span<const float> values) {
    const std::vector<double>& inverse = autoregression.by_lag;
    std::vector<double> weighted(values.size(), 0.0);
    for (std::size_t i = 1; i + 1 < values.size(); ++i) {
        weighted[i] = inverse[0] * static_cast<double>(values[i]) +
                      inverse[1] * (static_cast<double>(values[i - 1]) + static_cast<double>(values[i + 1]));
    }
    return weighted;
}

void draw(std::span<float> values, std::span<const std::size_t> slots) {
    draw_stand_ins(values, slots, weighted_by_autoregression(values), autoregression, autoregression,
                   RandomStream(3, 4));
}

// Between neighbours a and b the missing one is phi (a + b) / (1 + phi^2) with variance 1 / (1 + phi^2).
TEST(StandIns, OfSingleSamplesHaveTheMeanAndTheVarianceThatTheirNeighboursLeave) {
    std::vector<float> values(length);
    std::vector<std::size_t> slots;
    const RandomStream draws(1, 2);
    double before = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
        before = phi * before + draws.normal(i);
        values[i] = static_cast<float>(before);
        if (i % 8 != 5) { continue; }
        slots.push_back(i);
        values[i] = 1e3F;  // a guess counts for nothing
    }
    draw(values, slots);
    double sum = 0.0;
    double square = 0.0;
    const double precision = autoregression.by_lag[0];
    for (const std::size_t i : slots) {
        const double mean =
            phi * (static_cast<double>(values[i - 1]) + static_cast<double>(values[i + 1])) / precision;
        const double off = (static_cast<double>(values[i]) - mean) * std::sqrt(precision);
        sum += off;
        square += off * off;
    }
    const auto count = static_cast<double>(slots.size());
    EXPECT_NEAR(sum / count, 0.0, 4.0 / std::sqrt(count));
    EXPECT_NEAR(square / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

// A hole of many samples is drawn in parts: each differs from what the one before tells of it by independent
// noise.
TEST(StandIns, OfALongHoleAreAnAutoregressionThroughout) {
    std::vector<float> values(length, 0.0F);
    std::vector<std::size_t> slots;
    for (std::size_t i = 100; i < 30000; ++i) { slots.push_back(i); }
    draw(values, slots);
    double square = 0.0;
    double product = 0.0;
    double largest = 0.0;
    double last = 0.0;
    for (std::size_t i = 100; i < 29900; ++i) {
        const double innovation = static_cast<double>(values[i]) - phi * static_cast<double>(values[i - 1]);
        square += innovation * innovation;
        product += innovation * last;
        largest = std::max(largest, std::abs(innovation));
        last = innovation;
    }
    const double count = 29800.0;
    EXPECT_NEAR(square / count, 1.0, 4.0 * std::sqrt(2.0 / count));
    EXPECT_NEAR(product / count, 0.0, 4.0 / std::sqrt(count));
    EXPECT_LT(largest, 5.5);  // of 30 000 normal numbers one in a thousand such sets has a larger one
}

// Of m samples of an autoregression between two that are known the inverse covariance has the determinant
// 1 + phi^2 + ... + phi^(2 m). The longest of these holes is drawn in parts.
TEST(StandIns, HaveTheDensityThatTheyWereDrawnFrom) {
    std::vector<float> values(length, 0.5F);
    std::vector<std::size_t> slots;
    double wanted_nats = 0.0;
    const std::vector<std::size_t> holes = {1, 1, 2, 3, 10, 300, 9000, 1, 5};
    std::size_t slot = 1;
    for (const std::size_t hole : holes) {
        double determinant = 1.0;
        for (std::size_t i = 0; i < hole; ++i, ++slot) {
            determinant = 1.0 + phi * phi * determinant;
            slots.push_back(slot);
            const double normal = RandomStream(3, 4).normal(slot);
            wanted_nats -= 0.5 * normal * normal;
        }
        wanted_nats += 0.5 * std::log(determinant);
        ++slot;
    }
    draw(values, slots);
    const double nats = stand_ins_log_density_nats(slots, weighted_by_autoregression(values), autoregression);
    EXPECT_NEAR(nats, wanted_nats, 1e-3);  // values have seven digits
}

// Beside a strong band with sharp edges the series is cut off where it matters.
TEST(StandIns, OfALongHoleBesideStrongSlowNoiseAreNoLarger) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    std::vector<double> density;
    for (const SpectralBin& bin : bins) { density.push_back((bin.f_hz < 0.8 ? 1e4 : 1.0) / rate_hz); }
    const InverseCovariance inverse = inverse_covariance(bins, density, rate_hz, length, 64);
    std::vector<float> values(length, 0.0F);
    std::vector<std::size_t> slots;
    for (std::size_t i = 100; i < 9000; ++i) { slots.push_back(i); }
    draw_stand_ins(values, slots, std::vector<double>(length, 0.0), inverse, inverse, RandomStream(3, 4));
    const double sd = std::sqrt(1e4 * 0.8 / (0.5 * rate_hz) + 1.0);
    for (const float value : values) { ASSERT_LT(std::fabs(value), 6.0 * sd); }
}

// Kept factors answer as those that are worked out anew, whatever the values.
TEST(StandIns, ExpectedOnceAreThoseOfEveryDraw) {
    const SpectralBins bins = spectral_bins(length, rate_hz);
    std::vector<double> density;
    for (const SpectralBin& bin : bins) { density.push_back((bin.f_hz < 0.8 ? 1e2 : 1.0) / rate_hz); }
    const InverseCovariance inverse = inverse_covariance(bins, density, rate_hz, length, 64);
    std::vector<std::size_t> slots;
    for (std::size_t i = 100; i < 9000; i += i % 7 == 0 ? 40 : 3) { slots.push_back(i); }
    const ExpectedStandIns expected(slots, inverse);
    for (const std::uint64_t seed : {1U, 2U}) {
        const RandomStream draws(seed, 2);
        std::vector<double> weighted(length);
        for (std::size_t i = 0; i < length; ++i) { weighted[i] = draws.normal(i); }
        std::vector<float> kept(length, 1.0F);
        expected.expect(kept, weighted);
        scatter_stand_ins(kept, slots, autoregression, RandomStream(3, 4));
        std::vector<float> drawn(length, 1.0F);
        draw_stand_ins(drawn, slots, weighted, inverse, autoregression, RandomStream(3, 4));
        for (const std::size_t slot : slots) { ASSERT_FLOAT_EQ(kept[slot], drawn[slot]) << slot; }
        EXPECT_NE(kept[slots.front()], 1.0F);
    }
}

// Of every 97 rows one is left out, of every ninth 97 five more, and once half a second.
std::shared_ptr<const Recording> with_holes(Recording recording) {
    const Segment whole = recording.segments.front();
    recording.segments.clear();
    std::size_t from = 0;
    const auto leave_out = [&](std::size_t row, std::size_t rows) {
        recording.segments.push_back({from, row - from, whole.first_index + static_cast<std::int64_t>(from)});
        from = row + rows;
    };
    for (std::size_t k = 1; 97 * k + 60 < whole.count; ++k) {
        leave_out(97 * k, k == 100 ? 50 : k % 9 == 0 ? 6 : 1);
    }
    recording.segments.push_back(
        {from, whole.count - from, whole.first_index + static_cast<std::int64_t>(from)});
    return std::make_shared<const Recording>(std::move(recording));
}

void expect_as_modelled(const Observation& seen, double from_hz, double to_hz) {
    const SpectralBins& bins = seen.prediction().bins();
    for (const std::size_t axis : seen.prediction().axes()) {
        double ratio = 0.0;
        double count = 0.0;
        for (std::size_t i = 0; i < bins.size(); ++i) {
            if (bins[i].f_hz < from_hz || bins[i].f_hz > to_hz) { continue; }
            ratio += bins[i].count() * seen.axis(axis).power[i] / seen.axis(axis).density[i];
            count += bins[i].count();
        }
        EXPECT_NEAR(ratio / count, 1.0, 4.0 * std::sqrt(2.0 / count)) << axis;
    }
}

// Behind a low-pass filter the density near half of the rate is some ten thousandth of that of slow noise:
// one sample in a hundred that does not follow its neighbours would be most of it.
TEST(StandIns, BehindALowPassLeaveTheSpectrumAsItIs) {
    SensorModel model = calibrated_sensor();
    model.lsb_rad_s = 0.0;
    model = with_effect(model, "lowpass", {{"fc_hz", 6.0}, {"order", 2.0}}, {});
    const auto recording = with_holes(*recorded(model, 90'000, 31));
    expect_as_modelled(Observation(prediction_of(recording, model), recording, 1), 20.0, rate_hz);
}

// Slow noise goes far: a stand-in about another level would be an outlier of a hundred standard deviations.
TEST(StandIns, BesideARandomWalkLeaveTheSpectrumAsItIs) {
    SensorModel model = calibrated_sensor();
    model.lsb_rad_s = 0.0;
    for (AxisModel& axis : model.axes) { axis.noise.K_rad_per_s_sqrt_s = 0.05 * rad_per_deg; }
    const auto recording = with_holes(*recorded(model, 90'000, 33));
    const Observation seen(prediction_of(recording, model), recording, 1);
    expect_as_modelled(seen, 0.0, 5.0);
    expect_as_modelled(seen, 20.0, rate_hz);
}

std::shared_ptr<const Recording> without_every(Recording recording, std::size_t rows) {
    const Segment whole = recording.segments.front();
    recording.segments.clear();
    for (std::size_t row = 0; row + rows <= whole.count; row += rows) {
        recording.segments.push_back({row, rows - 1, whole.first_index + static_cast<std::int64_t>(row)});
    }
    return std::make_shared<const Recording>(std::move(recording));
}

// Where no cause explains a drift yet, stand-ins follow it all the same: it is seen nearly as well as without
// holes.
TEST(StandIns, HideNoDriftThatTheModelLacks) {
    SensorModel model = calibrated_sensor();
    model.lsb_rad_s = 0.0;
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = axis.noise.K_rad_per_s_sqrt_s = 0.0; }
    SensorModel drifting = model;
    for (AxisModel& axis : drifting.axes) { axis.noise.K_rad_per_s_sqrt_s = 0.02 * rad_per_deg; }
    const Recording whole = *recorded(drifting, 30'000, 34);
    const auto gain_nats = [&](const std::shared_ptr<const Recording>& recording) {
        const Observation seen(prediction_of(recording, model), recording, 1);
        return log_likelihood_nats(seen.under(drifting)) - log_likelihood_nats(seen);
    };
    const double whole_nats = gain_nats(std::make_shared<const Recording>(whole));
    const double holed_nats = gain_nats(without_every(whole, 5));
    EXPECT_GT(whole_nats, 1000.0);
    EXPECT_NEAR(holed_nats / whole_nats, 0.8, 0.05);
    // On the stand-ins of the model without the drift.
    const auto recording = without_every(whole, 5);
    const Observation seen(prediction_of(recording, model), recording, 1);
    double same_nats = 0.0;
    for (const std::size_t axis : seen.prediction().axes()) {
        const auto parts = seen.prediction().parts_of(drifting, axis);
        same_nats += fit_nuisance(seen.prediction().bins(), parts, seen.axis(axis).power,
                                  noise_uncertainty(drifting, axis), seen.axis(axis).noise)
                         .log_likelihood_nats -
                     seen.axis(axis).noise.log_likelihood_nats;
    }
    EXPECT_NEAR(same_nats / holed_nats, 1.0, 0.2);
}

// Nor do they add slow noise where there is none.
TEST(StandIns, AddNoSlowNoise) {
    SensorModel model = calibrated_sensor();
    model.lsb_rad_s = 0.0;
    double ratio = 0.0;
    double count = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto recording = without_every(*recorded(model, 30'000, 1000 + seed), 10);
        const Observation seen(prediction_of(recording, model), recording, seed);
        const SpectralBins& bins = seen.prediction().bins();
        for (const std::size_t axis : seen.prediction().axes()) {
            for (std::size_t i = 0; i < bins.size() && bins[i].f_hz < 0.5; ++i) {
                ratio += bins[i].count() * seen.axis(axis).power[i] / seen.axis(axis).density[i];
                count += bins[i].count();
            }
        }
    }
    EXPECT_NEAR(ratio / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

}  // namespace
}  // namespace gyrolog
