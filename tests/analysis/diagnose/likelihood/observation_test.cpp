#include "analysis/diagnose/likelihood/observation.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/compare/model_draw.hpp"
#include "analysis/diagnose/calibration/replicates.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

// Of every `period` rows of a recording in one piece the first `kept`.
std::shared_ptr<const Recording> with_holes(Recording recording, std::size_t period, std::size_t kept) {
    const Segment all = recording.segments.front();
    recording.segments.clear();
    for (std::size_t row = 0; row + period <= all.count; row += period) {
        recording.segments.push_back({row, kept, all.first_index + static_cast<std::int64_t>(row)});
    }
    return std::make_shared<const Recording>(std::move(recording));
}

TEST(Observation, IsWhiteWhereTheModelIsRight) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(draw_within_uncertainty(model, 3), 180000, 11);
    const Observation seen(prediction_of(recording, model), recording, 1);
    for (const std::size_t axis : seen.prediction().axes()) {
        const std::vector<float>& white = seen.axis(axis).whitened;
        double square = 0.0;
        double product = 0.0;
        for (std::size_t i = 1; i < white.size(); ++i) {
            square += static_cast<double>(white[i] * white[i]);
            product += static_cast<double>(white[i] * white[i - 1]);
        }
        const auto n = static_cast<double>(white.size());
        EXPECT_NEAR(square / n, 1.0, 4.0 * std::sqrt(2.0 / n));
        EXPECT_NEAR(product / n, 0.0, 4.0 / std::sqrt(n));
        // By bin: chi-square, its mean over all bins with tolerance from their count.
        double misfit = 0.0;
        const SpectralBins& bins = seen.prediction().bins();
        for (std::size_t i = 0; i < bins.size(); ++i) {
            const double ratio = seen.axis(axis).power[i] / seen.axis(axis).density[i] - 1.0;
            misfit += 0.5 * bins[i].count() * ratio * ratio;
        }
        const auto count = static_cast<double>(bins.size());
        // A single coefficient's square has the fourth moment 60 about its mean: variance of ratio^2 / 2
        // is 14.
        EXPECT_NEAR(misfit / count, 1.0, 4.0 * std::sqrt(6.0 / count)) << axis;
    }
}

TEST(Observation, FindsTheNoiseWithinItsUncertainty) {
    const SensorModel model = calibrated_sensor();
    SensorModel louder = model;
    for (AxisModel& axis : louder.axes) { axis.noise.N_rad_per_sqrt_s *= 1.01; }
    const auto recording = recorded(louder, 180000, 12);
    const Observation seen(prediction_of(recording, model), recording, 1);
    // 180 000 samples know N to 0.17 %, the model to 0.5 %: +1 % is 2 sd, of which the prior keeps a tenth.
    for (const std::size_t axis : seen.prediction().axes()) {
        EXPECT_NEAR(seen.axis(axis).noise.z[0], 1.8, 1.2) << axis;
    }
}

// The stated uncertainty of the clock is what the fits of replicates show of it: the prior beside the fit is
// the one that replicates are drawn from.
TEST(Observation, OfReplicatesHasAClockWithinItsUncertainty) {
    SensorModel model = calibrated_sensor();
    model.ref_noise_rad_s = 0.02 * rad_per_deg;
    model.sd_abs = {{"latency_s", 1e-4}, {"rate_rel", 5e-5}};
    const auto recording = recorded(
        model, 6000, 5, world_turning([](double t_s) {
            return Vector3{1.5 * std::sin(3.1 * t_s), 1.2 * std::sin(2.3 * t_s), std::sin(1.7 * t_s)};
        }));
    const auto prediction = prediction_of(recording, model);
    ASSERT_TRUE(prediction->moves());
    constexpr int replicates = 40;
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= replicates; ++seed) {
        const auto simulated =
            std::make_shared<const Recording>(replicate_recording(*prediction, model, seed));
        const Observation seen(prediction, simulated, seed, Observation::ReferenceNoise::drawn);
        // The last response is the clock's.
        const double rel = seen.axis(0).uncertain_fit.back();
        squares += rel * rel / (5e-5 * 5e-5);
    }
    EXPECT_NEAR(squares / replicates, 1.0, 4.0 * std::sqrt(2.0 / replicates));
    EXPECT_GT(squares / replicates, 0.3);
}

// Whatever was drawn for a replicate is the same under another model: only the models differ.
TEST(Observation, OfAReplicateUnderItsOwnModelIsTheSame) {
    SensorModel model = with_effect(calibrated_sensor(), "dropped", {{"per_hour", 600.0}, {"longest", 30.0}});
    model.ref_noise_rad_s = 0.5 * rad_per_deg;
    const auto recording =
        recorded(model, 6000, 5, world_turning([](double t_s) {
                     return Vector3{std::sin(3.1 * t_s), std::sin(2.3 * t_s), std::sin(1.7 * t_s)};
                 }));
    const auto prediction = prediction_of(recording, model);
    const auto simulated = std::make_shared<const Recording>(replicate_recording(*prediction, model, 8));
    const Observation seen(prediction, simulated, 8, Observation::ReferenceNoise::drawn);
    EXPECT_DOUBLE_EQ(log_likelihood_nats(seen.under(model)), log_likelihood_nats(seen));
}

TEST(Observation, FillsHolesWithoutLosingPower) {
    const SensorModel model = calibrated_sensor();
    SensorModel dropping = model;
    dropping.effects.push_back({"dropped", {}, {{"per_hour", 600.0}, {"longest", 30.0}}, ""});
    const auto recording = recorded(dropping, 180000, 13);
    const Observation seen(prediction_of(recording, model), recording, 1);
    std::size_t missing = 0;
    for (std::size_t slot = 0; slot < seen.prediction().length(); ++slot) {
        missing += !seen.present()[slot];
    }
    EXPECT_GT(missing, 1000U);
    for (const std::size_t axis : seen.prediction().axes()) {
        double square = 0.0;
        for (const float w : seen.axis(axis).whitened) { square += static_cast<double>(w * w); }
        const auto n = static_cast<double>(seen.prediction().length());
        EXPECT_NEAR(square / n, 1.0, 5.0 * std::sqrt(2.0 / n)) << axis;
    }
}

// A twentieth of the samples are missing, and the sensor's filter leaves a thousandth of the noise near half
// the rate. What a model without the filter puts in their place is many times louder there.
TEST(Observation, CompletedUnderABetterModelHasNoNoiseOfItsOwnInTheHoles) {
    SensorModel model = calibrated_sensor();
    model.lsb_rad_s = 0.0;
    const SensorModel filtered = with_effect(model, "lowpass", {{"fc_hz", 8.0}, {"order", 2.0}});
    const auto whole = recorded(filtered, 40000, 33);
    const auto recording = with_holes(*whole, 200, 190);
    const auto without_filter = prediction_of(recording, model);
    const Observation with_filter(without_filter->with(filtered), recording, 1);
    const auto power_near_half_the_rate = [](const Observation& seen) {
        double power = 0.0;
        double count = 0.0;
        const SpectralBins& bins = seen.prediction().bins();
        for (std::size_t i = 0; i < bins.size(); ++i) {
            if (bins[i].f_hz < 35.0) { continue; }
            power += bins[i].count() * seen.axis(0).power[i];
            count += bins[i].count();
        }
        return power / count;
    };
    const double wanted = power_near_half_the_rate(Observation(prediction_of(whole, filtered), whole, 1));
    EXPECT_NEAR(power_near_half_the_rate(Observation(without_filter, with_filter)) / wanted, 1.0, 0.1);
    EXPECT_GT(power_near_half_the_rate(Observation(without_filter, recording, 1)) / wanted, 3.0);
}

// What stands in for missing samples is no evidence: the likelihoods of two levels of white noise differ by
// those of the samples that are there. With every fifth one missing, stand-ins would add some 200 nats of
// their own.
TEST(Observation, HasTheLikelihoodOfTheSamplesThatAreThere) {
    SensorModel model = calibrated_sensor();
    model.lsb_rad_s = 0.0;
    model.sd_rel = {{"N", 0.0}, {"B", 0.0}, {"K", 0.0}};
    for (AxisModel& axis : model.axes) {
        axis.noise.B_rad_per_s = 0.0;
        axis.noise.K_rad_per_s_sqrt_s = 0.0;
    }
    const auto recording = with_holes(*recorded(model, 20000, 32), 5, 4);
    SensorModel louder = model;
    for (AxisModel& axis : louder.axes) { axis.noise.N_rad_per_sqrt_s *= 1.02; }
    const Observation seen(prediction_of(recording, model), recording, 1);
    const double difference_nats = log_likelihood_nats(seen.under(louder)) - log_likelihood_nats(seen);
    double wanted_nats = 0.0;
    for (const std::size_t axis : seen.prediction().axes()) {
        const double N = model.axes[axis].noise.N_rad_per_sqrt_s;
        const double variance = N * N * seen.prediction().rate_hz();
        for (std::size_t slot = 0; slot < seen.present().size(); ++slot) {
            if (!seen.present()[slot]) { continue; }
            const auto residual = static_cast<double>(seen.axis(axis).residual_rad_s[slot]);
            const double ratio = residual * residual / variance;
            wanted_nats -= 0.5 * (std::log(1.02 * 1.02) + ratio / (1.02 * 1.02) - ratio);
        }
    }
    EXPECT_NEAR(difference_nats, wanted_nats, 0.5);
}

}  // namespace
}  // namespace gyrolog
