// Gaps, rate and scatter of time stamps.
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/compare/model_draw.hpp"
#include "analysis/diagnose/estimators/stamp_gaps.hpp"
#include "analysis/diagnose/estimators/stamp_jitter.hpp"
#include "analysis/diagnose/estimators/stamp_rate.hpp"
#include "analysis/diagnose/estimators/stamp_scatter.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/recording/grid.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t ten_minutes = 60000;

SensorModel sensor() {
    SensorModel model = typical_mpu9250();
    model.timestamp_jitter_s = 2e-5;
    return model;
}

std::optional<Finding> gaps(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    return found(make_stamp_gap_estimator, "dropped", recording, model);
}
std::optional<Finding> rate(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    return found(make_stamp_rate_estimator, "clock_rate", recording, model);
}
std::optional<Finding> spread(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    return found(make_stamp_jitter_estimator, "clock_jitter", recording, model);
}

// The recording with other stamps, on the grid that they give.
std::shared_ptr<const Recording> stamped(const Recording& recording, std::vector<double> t_s) {
    Recording other = recording;
    Grid grid = grid_from_stamps(t_s);
    other.t_s = std::move(t_s);
    other.rate_hz = grid.rate_hz;
    other.rate_sd_hz = grid.rate_sd_hz;
    other.stamps = grid.stamps;
    other.segments = std::move(grid.segments);
    other.dropouts = std::move(grid.dropouts);
    return std::make_shared<const Recording>(std::move(other));
}

TEST(StampGaps, AreFoundWithTheirRateAndLength) {
    for (const double per_hour : {12.0, 60.0, 1200.0}) {
        const SensorModel lossy =
            with_effect(sensor(), "dropped", {{"per_hour", per_hour}, {"longest", 6.0}});
        const auto recording = recorded(lossy, ten_minutes, 5);
        const auto finding = gaps(recording, sensor());
        ASSERT_TRUE(finding) << per_hour;
        EXPECT_GT(finding->evidence_nats, 10.0);
        EXPECT_NEAR(finding->entries.front().params.at("per_hour"), per_hour,
                    4.0 * std::sqrt(6.0 * per_hour));  // Poisson, in a sixth of an hour
        EXPECT_LE(finding->entries.front().params.at("longest"), 12.0);
        EXPECT_EQ(finding->where.structure, "timestamp_gaps");
        EXPECT_LT(evidence(gaps(recording, with_cause(sensor(), *finding))), 0.0);
    }
}

TEST(StampGaps, OfWhichThereIsOneAreEnough) {
    Recording recording = *recorded(sensor(), ten_minutes, 5);
    std::vector<double> t_s = recording.t_s;
    for (std::size_t row = 20000; row < t_s.size(); ++row) { t_s[row] += 0.03; }
    const auto finding = gaps(stamped(recording, t_s), sensor());
    ASSERT_TRUE(finding);
    EXPECT_GT(finding->evidence_nats, 10.0);
    EXPECT_EQ(finding->entries.front().params.at("longest"), 3.0);
}

TEST(StampGaps, ThatAModelExpectsMoreOftenOrShorterAreAGapToo) {
    const SensorModel model = with_effect(sensor(), "dropped", {{"per_hour", 60.0}, {"longest", 2.0}});
    const auto often =
        recorded(with_effect(sensor(), "dropped", {{"per_hour", 1200.0}, {"longest", 2.0}}), ten_minutes, 5);
    EXPECT_GT(evidence(gaps(often, model)), 100.0);
    const auto longer =
        recorded(with_effect(sensor(), "dropped", {{"per_hour", 60.0}, {"longest", 12.0}}), ten_minutes, 5);
    EXPECT_GT(evidence(gaps(longer, model)), 10.0);
}

TEST(StampRate, OffByMoreThanTheModelKnowsIsFound) {
    for (const double rel : {-0.0068, 0.01, 0.0005}) {
        const auto recording = recorded(with_effect(sensor(), "clock_rate", {{"rel", rel}}), ten_minutes, 2);
        const auto finding = rate(recording, sensor());
        ASSERT_TRUE(finding) << rel;
        EXPECT_NEAR(finding->entries.front().params.at("rel"), rel,
                    4.0 * finding->sd.front().at("rel") + 1e-9);
        EXPECT_NEAR(finding->gain_nats, std::min(5000.0, 0.5 * std::pow(rel / 5e-5, 2.0)),
                    0.01 * finding->gain_nats);
        EXPECT_EQ(finding->where.structure, "timestamp_rate");
        EXPECT_LT(evidence(rate(recording, with_cause(sensor(), *finding))), 0.0);
    }
}

// The probability of evidence above e nats is to fall like exp(-e).
TEST(StampRate, WithinItsUncertaintyIsNoGap) {
    SensorModel model = sensor();
    int above_zero = 0;
    constexpr int runs = 400;
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        const auto recording = recorded(
            with_effect(model, "clock_rate", {{"rel", 5e-5 * RandomStream(seed, 9).normal(0)}}), 2048, seed);
        above_zero += evidence(rate(recording, model)) > 0.0 ? 1 : 0;
    }
    EXPECT_LE(above_zero, 4);  // 1 in 700 expected
}

TEST(StampRate, OfAnotherSettingIsNotTestable) {
    SensorModel model = sensor();
    model.rate_hz = 200.0;
    const auto prediction = prediction_of(recorded(sensor(), 4096, 1), model);
    const MadeEstimator made = make_stamp_rate_estimator(*find_effect("clock_rate"), prediction);
    EXPECT_EQ(made.estimator, nullptr);
    EXPECT_EQ(made.untestable, "the recording was taken at another rate than the model's");
}

TEST(StampScatter, IsThatOfTheStampsWhateverTheClockDoesSlowly) {
    Recording recording = *recorded(sensor(), ten_minutes, 2);
    std::vector<double> t_s = recording.t_s;
    for (double& stamp_s : t_s) { stamp_s += 0.002 * std::sin(stamp_s / 50.0); }
    t_s[3000] += 0.004;  // one late stamp
    const auto scatter = stamp_scatter(*stamped(recording, t_s));
    ASSERT_TRUE(scatter);
    EXPECT_NEAR(scatter->sd_s, 2e-5, 2e-5 * 5.0 / std::sqrt(2.0 * scatter->independent));
}

// The stated weight is that of the estimate's own scatter: its variance over 200 seeds is chi-square.
TEST(StampScatter, StatesHowWellItIsKnown) {
    constexpr int runs = 200;
    double square = 0.0;
    double independent = 0.0;
    Recording recording = *recorded(sensor(), 2048, 2);
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        const RandomStream random(seed, 3);
        for (std::size_t i = 0; i < recording.t_s.size(); ++i) {
            recording.t_s[i] = 0.01 * static_cast<double>(i) + 3e-4 * random.normal(i);
        }
        const auto scatter = stamp_scatter(recording);
        independent = scatter->independent;
        square += std::pow(scatter->sd_s / 3e-4 - 1.0, 2.0);
    }
    EXPECT_NEAR(square / runs * 2.0 * independent, 1.0, 4.0 * std::sqrt(2.0 / runs) + 0.1);
}

TEST(StampJitter, BeyondTheModelsIsFound) {
    for (const double sd_s : {2e-5, 1e-4, 1e-3, 2.5e-3}) {
        const auto recording =
            recorded(with_effect(sensor(), "clock_jitter", {{"sd_s", sd_s}}), ten_minutes, 2);
        const auto finding = spread(recording, sensor());
        ASSERT_TRUE(finding) << sd_s;
        EXPECT_GT(finding->evidence_nats, 15.0) << sd_s;
        EXPECT_NEAR(finding->entries.front().params.at("sd_s"), sd_s, 4.0 * finding->sd.front().at("sd_s"));
        EXPECT_EQ(finding->where.structure, "timestamp_jitter");
        EXPECT_LE(evidence(spread(recording, with_cause(sensor(), *finding))), 0.0);
    }
}

TEST(StampJitter, WithinItsUncertaintyIsNoGap) {
    int above_zero = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SensorModel model = sensor();
        model.timestamp_jitter_s *= 1.0 + 0.05 * RandomStream(seed, 9).normal(0);
        above_zero += evidence(spread(recorded(model, 2048, seed), sensor())) > 0.0 ? 1 : 0;
    }
    EXPECT_LE(above_zero, 6);
}

TEST(StampJitter, OfRoundedStampsIsTheirRounding) {
    Recording recording = *recorded(sensor(), ten_minutes, 2);
    for (const double resolution_s : {1e-6, 1e-4, 1e-3}) {
        std::vector<double> t_s = recording.t_s;
        for (std::size_t i = 0; i < t_s.size(); ++i) {
            t_s[i] = std::round(static_cast<double>(i) / 99.37 / resolution_s) * resolution_s;
        }
        EXPECT_LE(evidence(spread(stamped(recording, t_s), sensor())), 0.0) << resolution_s;
    }
}

TEST(StampJitter, OfBurstsIsTheHosts) {
    Recording recording = *recorded(sensor(), 4096, 2);
    std::vector<double> t_s = recording.t_s;
    for (std::size_t i = 0; i < t_s.size(); ++i) {
        t_s[i] = 0.16 * std::ceil(static_cast<double>(i + 1) / 16.0) + 1e-3 * static_cast<double>(i % 16);
    }
    const auto bursts = stamped(recording, t_s);
    ASSERT_EQ(bursts->stamps, StampKind::arrival);
    const auto prediction = prediction_of(bursts, sensor());
    EXPECT_EQ(make_stamp_jitter_estimator(*find_effect("clock_jitter"), prediction).untestable,
              "the time stamps are arrival times that come in bursts");
    EXPECT_EQ(make_stamp_gap_estimator(*find_effect("dropped"), prediction).untestable,
              "the time stamps are arrival times: they show no gaps");
    EXPECT_TRUE(make_stamp_rate_estimator(*find_effect("clock_rate"), prediction).estimator);
}

TEST(Stamps, ThatAreNotThereTellNothing) {
    Recording recording = *recorded(sensor(), 4096, 2);
    recording.t_s.clear();
    recording.stamps = StampKind::none;
    const auto prediction = prediction_of(std::make_shared<const Recording>(recording), sensor());
    for (const EstimatorMaker make :
         {make_stamp_gap_estimator, make_stamp_rate_estimator, make_stamp_jitter_estimator}) {
        const char* effect = make == make_stamp_gap_estimator    ? "dropped"
                             : make == make_stamp_rate_estimator ? "clock_rate"
                                                                 : "clock_jitter";
        EXPECT_EQ(make(*find_effect(effect), prediction).untestable, "the recording has no time stamps");
    }
}

// A simulation like a recording has the recording's stamps: they are no draw of chance.
TEST(Stamps, OfASimulationLikeTheRecordingTellNothing) {
    const auto recording = recorded(with_effect(sensor(), "clock_rate", {{"rel", 0.01}}), 4096, 2);
    const auto prediction = prediction_of(recording, sensor());
    SimulationRequest request;
    request.like = prediction->shared_world();
    const auto simulated = std::make_shared<const Recording>(simulate_recording(sensor(), request));
    const MadeEstimator made = make_stamp_rate_estimator(*find_effect("clock_rate"), prediction);
    EXPECT_TRUE(made.estimator->find(Observation(prediction, recording, 1)));
    EXPECT_FALSE(made.estimator->find(Observation(prediction, simulated, 1)));
}

}  // namespace
}  // namespace gyrolog
