#include "analysis/diagnose/estimators/repeats.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/simulate/effect.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t ten_minutes = 60000;

std::optional<Finding> repeats(const std::shared_ptr<const Recording>& recording, const SensorModel& model) {
    return found(make_repeat_estimator, "stale", recording, model);
}

Recording without_temperature(Recording recording) {
    std::erase_if(recording.columns, [](const Column& column) { return column.name == "temp"; });
    return recording;
}

TEST(Repeats, AreFoundWithTheirShareOnAllAxes) {
    const SensorModel model = typical_mpu9250();
    for (const double eps : {0.001, 0.01, 0.0987, 0.4}) {
        const auto recording = recorded(with_effect(model, "stale", {{"eps", eps}}), ten_minutes, 3);
        const auto finding = repeats(recording, model);
        ASSERT_TRUE(finding) << eps;
        EXPECT_GT(finding->evidence_nats, 100.0 * eps / 0.001) << eps;
        EXPECT_NEAR(finding->entries.front().params.at("eps"), eps,
                    4.0 * finding->sd.front().at("eps") + 2.0 / ten_minutes);
        EXPECT_EQ(finding->where.axes, (std::vector<std::size_t>{0, 1, 2}));
        EXPECT_EQ(finding->where.structure, "duplicated_samples");
        EXPECT_FALSE(effect_refusal(finding->entries.front()));
    }
}

// What says one thing all the time belongs to the sensor as well, and what is not recorded.
TEST(Repeats, OfAllAxesThatMoveAreTheSensors) {
    const SensorModel model = typical_mpu9250();
    Recording recording = *recorded(with_effect(model, "stale", {{"eps", 0.05}}), ten_minutes, 3);
    std::ranges::fill(std::get<std::vector<std::int16_t>>(recording.columns[1].data), std::int16_t{3});
    recording.columns.erase(recording.columns.begin());
    const auto finding = repeats(std::make_shared<const Recording>(std::move(recording)), model);
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->where.axes, (std::vector<std::size_t>{2}));
    EXPECT_EQ(finding->entries.front().axes, (std::vector<std::string>{"x", "y", "z"}));
}

TEST(Repeats, AtRandomHaveTheLengthOfTheirRuns) {
    const SensorModel model = typical_mpu9250();
    for (const auto& [eps, length] : {std::pair{0.01, 1.0}, std::pair{0.05, 2.5}, std::pair{0.3, 1.5}}) {
        const auto recording =
            recorded(with_effect(model, "stale", {{"eps", eps}, {"run_length", length}}), ten_minutes, 4);
        const auto finding = repeats(recording, model);
        ASSERT_TRUE(finding) << eps;
        const EffectModel& entry = finding->entries.front();
        EXPECT_NEAR(entry.params.at("eps"), eps, 4.0 * length * finding->sd.front().at("eps"));
        ASSERT_TRUE(entry.params.contains("run_length")) << eps;
        EXPECT_NEAR(entry.params.at("run_length"), length, 4.0 * finding->sd.front().at("run_length"));
        EXPECT_FALSE(effect_refusal(entry));
    }
}

// A beat may be as slow as one in a thousand, and as fast as four in ten.
TEST(Repeats, InABeatHaveNoRuns) {
    const SensorModel model = typical_mpu9250();
    for (const double eps : {0.001, 0.0137, 0.0987, 0.4}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const auto finding =
                repeats(recorded(with_effect(model, "stale", {{"eps", eps}}), ten_minutes, seed), model);
            ASSERT_TRUE(finding) << eps;
            EXPECT_FALSE(finding->entries.front().params.contains("run_length")) << eps << ' ' << seed;
        }
    }
}

// Sixty repeats among sixty thousand samples, without the temperature's word: the axes' own chance repeats
// are 0.4 in a thousand for three axes together.
TEST(Repeats, AreFoundByTheAxesAlone) {
    const SensorModel model = typical_mpu9250();
    const auto recording = std::make_shared<const Recording>(
        without_temperature(*recorded(with_effect(model, "stale", {{"eps", 0.002}}), ten_minutes, 3)));
    const auto finding = repeats(recording, model);
    ASSERT_TRUE(finding);
    EXPECT_GT(finding->evidence_nats, 50.0);
    EXPECT_NEAR(finding->entries.front().params.at("eps"), 0.002, 4.0 * finding->sd.front().at("eps"));
}

TEST(Repeats, OfSomeAxesAreToldFromThoseOfAll) {
    const SensorModel model = typical_mpu9250();
    const auto pair =
        repeats(recorded(with_effect(model, "stale", {{"eps", 0.02}}, {"x", "z"}), ten_minutes, 5), model);
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->where.axes, (std::vector<std::size_t>{0, 2}));
    const auto one = repeats(std::make_shared<const Recording>(without_temperature(*recorded(
                                 with_effect(model, "stale", {{"eps", 0.1}}, {"y"}), ten_minutes, 5))),
                             model);
    ASSERT_TRUE(one);
    EXPECT_EQ(one->where.axes, (std::vector<std::size_t>{1}));
    EXPECT_GT(one->evidence_nats, 20.0);
}

TEST(Repeats, AreNotSeenWhereRoundedNoiseRepeatsByChance) {
    SensorModel coarse = typical_mpu9250();
    coarse = with_effect(coarse, "quantization", {{"lsb_dps", 6.0 / 65.5}});
    const SensorModel smooth = with_effect(typical_mpu9250(), "lowpass", {{"fc_hz", 10.0}, {"order", 2.0}});
    int above_zero = 0;
    int above_three = 0;
    constexpr int runs = 60;
    for (int run = 0; run < runs; ++run) {
        const auto seed = static_cast<std::uint64_t>(run);
        const SensorModel& model = run % 3 == 0 ? typical_mpu9250() : run % 3 == 1 ? coarse : smooth;
        const double nats = evidence(repeats(recorded(model, 12000, seed), typical_mpu9250()));
        above_zero += nats > 0.0 ? 1 : 0;
        above_three += nats > 3.0 ? 1 : 0;
    }
    EXPECT_LE(above_zero, 3);
    EXPECT_EQ(above_three, 0);
}

TEST(Repeats, ThatTheModelHasAreExplained) {
    const SensorModel model = typical_mpu9250();
    const auto recording = recorded(with_effect(model, "stale", {{"eps", 0.05}}), ten_minutes, 8);
    const auto finding = repeats(recording, model);
    ASSERT_TRUE(finding);
    EXPECT_LT(evidence(repeats(recording, with_cause(model, *finding))), 0.0 + 1e-9);
}

TEST(Repeats, OfADeadAxisAreNone) {
    Recording recording = *recorded(typical_mpu9250(), 4096, 2);
    auto& counts = std::get<std::vector<std::int16_t>>(recording.columns[0].data);
    std::ranges::fill(counts, std::int16_t{7});
    EXPECT_LE(evidence(repeats(std::make_shared<const Recording>(recording), typical_mpu9250())), 0.0);
}

}  // namespace
}  // namespace gyrolog
