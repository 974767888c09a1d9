// A sensor's timing as its motion tells it.
#include "analysis/diagnose/estimators/lag.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/stamp_gaps.hpp"
#include "analysis/diagnose/estimators/stamp_jitter.hpp"
#include "analysis/diagnose/estimators/stamp_rate.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/lag_course.hpp"
#include "analysis/noise/noise_model.hpp"
#include "tests/analysis/diagnose/observed.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t five_minutes = 30000;

// Slow swings and a quicker wobble, with a rest of half a minute that comes and goes gently.
std::shared_ptr<FormulaWorld> swinging_world() {
    return world_turning([](double t_s) {
        const double from_rest = std::fabs(t_s - 115.0) - 15.0;
        const double on = rad_per_deg * 0.5 * (1.0 + std::tanh(from_rest));
        const double wobble = std::sin(2.0 * pi * 1.3 * t_s) + std::sin(2.0 * pi * 2.17 * t_s + 1.0);
        return Vector3{on * (80.0 * std::sin(t_s / 3.0) + 8.0 * wobble),
                       on * (50.0 * std::sin(t_s / 4.1 + 1.0) + 5.0 * wobble),
                       on * (120.0 * std::sin(t_s / 7.0 + 2.0) - 6.0 * wobble)};
    });
}

SensorModel sensor() {
    SensorModel model = typical_mpu9250();
    model.ref_noise_rad_s = 0.02 * rad_per_deg;
    return model;
}

std::shared_ptr<const Recording> moved(const SensorModel& model, std::uint64_t seed) {
    return recorded(model, five_minutes, seed, swinging_world());
}

// Mean square of the whitened samples, less one.
double misfit(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    const Observation seen(prediction_of(recording, model), recording, 1);
    double square = 0.0;
    double count = 0.0;
    for (const std::size_t axis : seen.prediction().axes()) {
        for (const float white : seen.axis(axis).whitened) { square += static_cast<double>(white * white); }
        count += static_cast<double>(seen.axis(axis).whitened.size());
    }
    return square / count - 1.0;
}

TEST(LagSlope, OfAClockThatTheStampsHideIsFound) {
    for (const double rel : {-0.01, 0.001, 0.006}) {
        const auto recording =
            moved(with_effect(sensor(), "clock_rate", {{"rel", rel}, {"in_stamps", 0.0}}), 3);
        const auto finding = found(make_stamp_rate_estimator, "clock_rate", recording, sensor());
        ASSERT_TRUE(finding) << rel;
        EXPECT_GT(finding->evidence_nats, 50.0) << rel;
        EXPECT_EQ(finding->where.structure, "growing_lag");
        EXPECT_EQ(finding->entries.front().params.at("in_stamps"), 0.0);
        EXPECT_NEAR(finding->entries.front().params.at("rel"), rel, 5.0 * finding->sd.front().at("rel"));
        const auto left =
            found(make_stamp_rate_estimator, "clock_rate", recording, with_cause(sensor(), *finding));
        EXPECT_LT(evidence(left), 0.0);
    }
}

TEST(LagSteps, OfLossesThatTheStampsHideAreFound) {
    for (const double per_hour : {36.0, 120.0}) {
        const auto recording = moved(
            with_effect(sensor(), "dropped", {{"per_hour", per_hour}, {"longest", 8.0}, {"in_stamps", 0.0}}),
            7);
        const auto finding = found(make_stamp_gap_estimator, "dropped", recording, sensor());
        ASSERT_TRUE(finding) << per_hour;
        EXPECT_GT(finding->evidence_nats, 50.0);
        EXPECT_EQ(finding->where.structure, "growing_lag");
        EXPECT_NEAR(finding->entries.front().params.at("per_hour"), per_hour,
                    4.0 * finding->sd.front().at("per_hour"));
        EXPECT_LE(finding->entries.front().params.at("longest"), 16.0);
        // With the losses known, the samples stand where they belong: next to nothing of the misfit is left
        // (a step in the rest, or in the last second, cannot be placed to the sample).
        EXPECT_GT(misfit(recording, sensor()), 10.0);
        EXPECT_LT(misfit(recording, with_cause(sensor(), *finding)), 0.5);
        EXPECT_FALSE(found(make_stamp_gap_estimator, "dropped", recording, with_cause(sensor(), *finding)));
    }
}

TEST(LagSteps, FitLostSamplesBetterThanASlopeAndTheOtherWayRound) {
    const auto lossy = moved(
        with_effect(sensor(), "dropped", {{"per_hour", 60.0}, {"longest", 8.0}, {"in_stamps", 0.0}}), 7);
    EXPECT_GT(evidence(found(make_stamp_gap_estimator, "dropped", lossy, sensor())),
              evidence(found(make_stamp_rate_estimator, "clock_rate", lossy, sensor())) + 20.0);
    const auto slow = moved(with_effect(sensor(), "clock_rate", {{"rel", -0.004}, {"in_stamps", 0.0}}), 7);
    EXPECT_GT(evidence(found(make_stamp_rate_estimator, "clock_rate", slow, sensor())),
              evidence(found(make_stamp_gap_estimator, "dropped", slow, sensor())) + 20.0);
}

TEST(Lags, OfARightModelAreNone) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto recording = moved(sensor(), seed);
        EXPECT_LE(evidence(found(make_stamp_gap_estimator, "dropped", recording, sensor())), 0.0);
        EXPECT_LE(evidence(found(make_stamp_rate_estimator, "clock_rate", recording, sensor())), 0.0);
    }
}

TEST(SamplingJitter, OfInstantsThatTheStampsHideIsFound) {
    for (const double sd_s : {5e-4, 2e-3}) {
        const auto recording =
            moved(with_effect(sensor(), "clock_jitter", {{"sd_s", sd_s}, {"in_stamps", 0.0}}), 3);
        const auto finding = found(make_stamp_jitter_estimator, "clock_jitter", recording, sensor());
        ASSERT_TRUE(finding) << sd_s;
        EXPECT_GT(finding->evidence_nats, 20.0) << sd_s;
        EXPECT_EQ(finding->where.structure, "timestamp_jitter");
        EXPECT_EQ(finding->entries.front().params.at("in_stamps"), 0.0);
        EXPECT_NEAR(finding->entries.front().params.at("sd_s"), sd_s, 5.0 * finding->sd.front().at("sd_s"));
        const auto prediction = prediction_of(recording, with_cause(sensor(), *finding));
        const Observation seen(prediction, recording, 1);
        EXPECT_GT(log_likelihood_nats(seen),
                  log_likelihood_nats(Observation(prediction_of(recording, sensor()), recording, 1)));
    }
}

// What a lag of seconds does to a fast motion is no spread of instants, however large its squares.
TEST(SamplingJitter, ClaimsNoMoreThanAClockThatIsOffHas) {
    const auto recording =
        moved(with_effect(sensor(), "clock_rate", {{"rel", -0.001}, {"in_stamps", 0.0}}), 9);
    const auto clock = found(make_stamp_rate_estimator, "clock_rate", recording, sensor());
    ASSERT_TRUE(clock);
    EXPECT_GT(clock->evidence_nats,
              evidence(found(make_stamp_jitter_estimator, "clock_jitter", recording, sensor())) + 20.0);
}

TEST(SamplingJitter, OfARightModelIsNone) {
    int above_zero = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        above_zero += evidence(found(make_stamp_jitter_estimator, "clock_jitter", moved(sensor(), seed),
                                     sensor())) > 0.0
                          ? 1
                          : 0;
    }
    EXPECT_EQ(above_zero, 0);
}

}  // namespace
}  // namespace gyrolog
