#include "analysis/simulate/recording_simulator.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {
namespace {

EffectModel effect_of(std::string name, std::map<std::string, double> params) {
    return {.effect = std::move(name), .axes = {}, .params = std::move(params), .carried_json = {}};
}

const std::vector<std::int16_t>& counts_of(const Recording& recording, const char* name) {
    return std::get<std::vector<std::int16_t>>(recording.find(name)->data);
}

SensorModel silent_model() {
    SensorModel model;
    model.full_scale_rad_s = model.saturation_rad_s = 1e9;
    return model;
}

// Turns about z and is shaken along x.
class Swing final : public World {
public:
    bool moves() const override { return true; }
    bool is_measured() const override { return false; }
    void motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rate_rad_s,
                const std::array<std::span<double>, 3>& specific_force_m_s2) const override {
        for (std::size_t i = 0; i < world_s.size(); ++i) {
            rate_rad_s[0][i] = rate_rad_s[1][i] = 0.0;
            rate_rad_s[2][i] = rate_at(world_s[i]);
            specific_force_m_s2[0][i] = std::cos(world_s[i]);
            specific_force_m_s2[1][i] = 0.0;
            specific_force_m_s2[2][i] = 9.80665;
        }
    }
    bool has_temperature() const override { return false; }
    void temperature(std::span<const double> /*world_s*/,
                     std::span<double> /*temperature_C*/) const override {}

    static double rate_at(double world_s) { return 2.0 * std::sin(3.0 * world_s); }
};

TEST(RecordingSimulator, HoldsTheSimulatorsCountsSampleForSample) {
    const SensorModel model = typical_mpu9250();
    const Recording recording = simulate_recording(model, {.samples = 3000, .seed = 9});
    SensorSimulator simulator(model, model.rate_hz, 9);
    for (std::size_t row = 0; row < 3000;) {
        const SampleBlock& block = simulator.next_block();
        for (std::size_t i = 0; i < block_samples && row < 3000; ++i, ++row) {
            ASSERT_EQ(counts_of(recording, "gx")[row], block.counts[0][i]);
            ASSERT_EQ(counts_of(recording, "gz")[row], block.counts[2][i]);
            ASSERT_EQ(recording.find("temp")->value(row), block.temperature_C[i]);
            ASSERT_NEAR(recording.t_s[row], block.stamp_s[i], 0.5e-9);
        }
    }
    EXPECT_EQ(recording.find("gx")->scale, model.lsb_rad_s);
    EXPECT_EQ(recording.segments.size(), 1U);
    EXPECT_NEAR(recording.rate_hz, 100.0, 1e-4);
    EXPECT_EQ(recording.find("ref_x"), nullptr);
}

TEST(RecordingSimulator, PiecesAreTheWhole) {
    SensorModel model = typical_mpu9250();
    model.effects = {effect_of("dropped", {{"per_hour", 2000.0}})};
    const SimulationRequest request = {.samples = 10'000, .seed = 3};
    const Recording whole = simulate_recording(model, request);
    RecordingSimulator simulator(model, request);
    Recording piece;
    std::size_t row = 0;
    std::int64_t after = -1;
    while (simulator.next(piece)) {
        for (const Segment& segment : piece.segments) {
            EXPECT_GT(segment.first_index, after);
            after = segment.first_index + static_cast<std::int64_t>(segment.count) - 1;
        }
        for (std::size_t i = 0; i < piece.rows(); ++i, ++row) {
            ASSERT_EQ(counts_of(piece, "gy")[i], counts_of(whole, "gy")[row]);
            ASSERT_EQ(piece.t_s[i], whole.t_s[row]);
        }
    }
    EXPECT_EQ(row, whole.rows());
    EXPECT_LT(row, 10'000U);
    EXPECT_EQ(simulator.samples_done(), 10'000U);
}

TEST(RecordingSimulator, ASlotThatIsLostHasNoRowAndItsHoleIsSeen) {
    SensorModel model = typical_mpu9250();
    model.timestamp_jitter_s = 0.0;
    model.effects = {effect_of("dropped", {{"per_hour", 1000.0}})};
    const SimulationRequest request = {.samples = 60'000, .seed = 5};
    const Recording whole = simulate_recording(model, request);
    RecordingSimulator simulator(model, request);
    Recording piece;
    std::vector<std::int64_t> indices;
    while (simulator.next(piece)) {
        for (const Segment& segment : piece.segments) {
            for (std::size_t i = 0; i < segment.count; ++i) {
                indices.push_back(segment.first_index + static_cast<std::int64_t>(i));
            }
        }
    }
    ASSERT_EQ(indices.size(), whole.rows());
    EXPECT_GT(whole.dropouts.size(), 50U);
    std::size_t row = 0;
    for (const Segment& segment : whole.segments) {
        for (std::size_t i = 0; i < segment.count; ++i, ++row) {
            ASSERT_EQ(segment.first_index + static_cast<std::int64_t>(i) + indices.front(), indices[row]);
        }
    }
}

TEST(RecordingSimulator, AMovingWorldIsReadByReferenceAndAccelerometerAtTheStampsInstant) {
    SensorModel model = silent_model();
    model.latency_s = 0.05;
    model.ref_noise_rad_s = 0.01;
    model.acc_noise_m_s2 = 0.1;
    const Recording recording =
        simulate_recording(model, {.samples = 5000, .seed = 1, .world = std::make_shared<Swing>()});
    double reference = 0.0;
    double force = 0.0;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
        const double t_s = recording.t_s[row];
        ASSERT_NEAR(recording.find("gz")->value(row), Swing::rate_at(t_s - 0.05), 1e-9);
        reference += std::pow(recording.find("ref_z")->value(row) - Swing::rate_at(t_s), 2.0);
        force += std::pow(recording.find("ax")->value(row) - std::cos(t_s), 2.0);
    }
    const double allowed = 4.0 * std::sqrt(2.0 / 5000.0);
    EXPECT_NEAR(reference / 5000.0 / (0.01 * 0.01), 1.0, allowed);
    EXPECT_NEAR(force / 5000.0 / (0.1 * 0.1), 1.0, allowed);
}

SensorModel with_accelerometer() {
    SensorModel model = typical_mpu9250();
    AccelerometerModel& accelerometer = model.accelerometer.emplace();
    for (AxisModel& axis : accelerometer.axes) { axis.noise.N_rad_per_sqrt_s = 0.003; }
    accelerometer.axes[0].bias_rad_s = 0.2;
    accelerometer.M[1][2] = 0.01;
    accelerometer.effects.push_back({"tone", {"x"}, {{"f_hz", 12.5}, {"amplitude_g", 0.01}}, {}});
    return model;
}

TEST(RecordingSimulator, AnAccelerometerAtRestHasGravityAndItsOwnNoise) {
    const SensorModel model = with_accelerometer();
    const Recording recording = simulate_recording(model, {.samples = 20'000, .seed = 3});
    const std::vector<double> x = recording.find("ax")->values();
    const std::vector<double> y = recording.find("ay")->values();
    const std::vector<double> z = recording.find("az")->values();
    const auto mean = [](const std::vector<double>& values) {
        double sum = 0.0;
        for (const double value : values) { sum += value; }
        return sum / static_cast<double>(values.size());
    };
    const double allowed_m_s2 = 4.0 * 0.03 / std::sqrt(20'000.0);
    EXPECT_NEAR(mean(x), 0.2, allowed_m_s2);
    EXPECT_NEAR(mean(y), 0.01 * standard_gravity_m_s2, allowed_m_s2);
    EXPECT_NEAR(mean(z), standard_gravity_m_s2, allowed_m_s2);
    const auto variance_about = [](const std::vector<double>& values, double about) {
        double sum = 0.0;
        for (const double value : values) { sum += (value - about) * (value - about); }
        return sum / static_cast<double>(values.size());
    };
    const double allowed = 4.0 * std::sqrt(2.0 / 20'000.0);
    EXPECT_NEAR(variance_about(z, standard_gravity_m_s2) / 9e-4, 1.0, allowed);
    const double amplitude_m_s2 = 0.01 * standard_gravity_m_s2;
    EXPECT_NEAR(variance_about(x, 0.2) / (9e-4 + 0.5 * amplitude_m_s2 * amplitude_m_s2), 1.0, allowed);
}

TEST(RecordingSimulator, AnAccelerometerLeavesTheGyroAsItWas) {
    SensorModel model = with_accelerometer();
    model.accelerometer->lsb_m_s2 = 0.001;
    const SimulationRequest request{.samples = 3000, .seed = 3};
    const Recording with = simulate_recording(model, request);
    model.accelerometer.reset();
    const Recording without = simulate_recording(model, request);
    EXPECT_EQ(without.find("ax"), nullptr);
    EXPECT_TRUE(with.find("az")->is_counts());
    for (const char* name : {"gx", "gy", "gz"}) {
        EXPECT_EQ(with.find(name)->data, without.find(name)->data);
    }
    EXPECT_EQ(with.t_s, without.t_s);
    // The two sensors' noise is not the same.
    const std::vector<double> g = with.find("gz")->values();
    const std::vector<double> a = with.find("az")->values();
    double product = 0.0;
    double g_square = 0.0;
    double a_square = 0.0;
    for (std::size_t i = 1; i < g.size(); ++i) {
        product += (g[i] - g[i - 1]) * (a[i] - a[i - 1]);
        g_square += std::pow(g[i] - g[i - 1], 2.0);
        a_square += std::pow(a[i] - a[i - 1], 2.0);
    }
    EXPECT_NEAR(product / std::sqrt(g_square * a_square), 0.0, 4.0 * std::sqrt(1.5 / 3000.0));
}

TEST(RecordingSimulator, AnEffectThatAnAccelerometerCannotHaveIsNamed) {
    SensorModel model = with_accelerometer();
    model.accelerometer->effects[0].params = {{"f_hz", 12.5}, {"amplitude_dps", -1.0}, {"width", 2.0}};
    model.accelerometer->effects[0].effect = "no such effect";
    const auto refusal = simulation_refusal(model);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->find("accelerometer: "), 0U);
}

// 2000 rows with a hole of 300 after the first 500, stamps that are not on a grid, a temperature and a turn.
std::shared_ptr<const Recording> real_recording() {
    auto recording = std::make_shared<Recording>();
    recording->rate_hz = 100.0;
    recording->stamps = StampKind::sampling;
    recording->segments = {{0, 500, 17}, {500, 1500, 817}};
    recording->dropouts = {{5.0, 300, "link"}};
    std::vector<std::int16_t> temperature;
    std::array<std::vector<double>, 3> turn;
    for (int row = 0; row < 2000; ++row) {
        const double slot = row < 500 ? row : row + 300;
        recording->t_s.push_back(1000.0 + slot / 100.0 + 1e-4 * std::sin(row));
        temperature.push_back(static_cast<std::int16_t>(1000 + row % 7));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            turn[axis].push_back(Swing::rate_at(slot / 100.0) * static_cast<double>(axis));
        }
    }
    recording->columns.push_back({"gx", "rad/s", std::vector<double>(2000, 0.0), 1.0, 0.0, {}});
    recording->columns.push_back({"temp", "degC", temperature, 0.003, 21.0, {}});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        recording->columns.push_back(
            {std::string("ref_") + axis_names[axis], "rad/s", turn[axis], 1.0, 0.0, "rad_s"});
    }
    return recording;
}

TEST(RecordingLike, KeepsEveryStampAndEveryOtherColumnOfTheRecording) {
    const auto real = real_recording();
    const auto world = std::make_shared<const RecordedWorld>(real);
    const Recording simulated = simulate_recording(silent_model(), {.seed = 4, .like = world});
    EXPECT_EQ(simulated.t_s, real->t_s);
    EXPECT_EQ(simulated.find("temp")->data, real->find("temp")->data);
    EXPECT_EQ(simulated.find("temp")->scale, 0.003);
    EXPECT_EQ(simulated.find("ref_y")->data, real->find("ref_y")->data);
    ASSERT_EQ(simulated.segments.size(), 2U);
    EXPECT_EQ(simulated.segments[1].first_index, 817);
    ASSERT_EQ(simulated.dropouts.size(), 1U);
    EXPECT_EQ(simulated.dropouts[0].cause, "link");
    EXPECT_EQ(simulated.dropouts[0].samples, 300);
    EXPECT_EQ(simulated.rate_hz, 100.0);
    // The sensor turns as the reference did, at the slot of each row.
    for (std::size_t row = 0; row < 2000; ++row) {
        ASSERT_NEAR(simulated.find("gz")->value(row), real->find("ref_z")->value(row), 1e-12);
        ASSERT_NEAR(simulated.find("gx")->value(row), 0.0, 1e-12);
    }
}

TEST(RecordingLike, WhatIsDroppedTakesItsRowWithIt) {
    const auto real = real_recording();
    SensorModel model = silent_model();
    model.effects = {effect_of("dropped", {{"per_hour", 5000.0}})};
    const Recording simulated =
        simulate_recording(model, {.seed = 4, .like = std::make_shared<const RecordedWorld>(real)});
    EXPECT_LT(simulated.rows(), real->rows());
    EXPECT_GT(simulated.dropouts.size(), 3U);
    std::size_t row = 0;
    for (const double t_s : simulated.t_s) {
        while (row < real->rows() && real->t_s[row] != t_s) { ++row; }
        ASSERT_LT(row, real->rows());
    }
    std::int64_t missing = 0;
    for (const Dropout& dropout : simulated.dropouts) { missing += dropout.samples; }
    EXPECT_EQ(missing, simulated.missing_samples());
}

TEST(RecordingLike, ItsNoiseIsThatOfTheSlotsNotOfTheRows) {
    // The same seed without a hole: a sample is the same wherever holes are.
    const auto real = real_recording();
    SensorModel model = typical_mpu9250();
    Recording at_rest = *real;
    at_rest.columns.resize(2);
    const Recording with_hole = simulate_recording(
        model,
        {.seed = 4, .like = std::make_shared<const RecordedWorld>(std::make_shared<Recording>(at_rest))});
    const Recording without = simulate_recording(model, {.samples = 2300, .seed = 4});
    for (std::size_t row = 0; row < 2000; ++row) {
        const std::size_t slot = row < 500 ? row : row + 300;
        ASSERT_EQ(counts_of(with_hole, "gx")[row], counts_of(without, "gx")[slot]);
    }
}

TEST(RecordingLike, OnlyTheFirstPartIsMadeWhenThatIsAskedFor) {
    const auto world = std::make_shared<const RecordedWorld>(real_recording());
    const Recording simulated =
        simulate_recording(silent_model(), {.samples = 810, .seed = 4, .like = world});
    EXPECT_EQ(simulated.rows(), 510U);
    const Recording all =
        simulate_recording(silent_model(), {.samples = 1'000'000, .seed = 4, .like = world});
    EXPECT_EQ(all.rows(), 2000U);
}

TEST(RecordingLike, TermsThatActOnStampsAreNamed) {
    SensorModel model = silent_model();
    EXPECT_TRUE(terms_of_stamps(model).empty());
    model.timestamp_jitter_s = 1e-5;
    model.effects = {effect_of("clock_rate", {{"rel", 1e-3}}),
                     effect_of("clock_jitter", {{"sd_s", 1e-3}, {"in_stamps", 0.0}}),
                     effect_of("dropped", {{"per_hour", 1.0}}), effect_of("tone", {})};
    EXPECT_EQ(terms_of_stamps(model), (std::vector<std::string>{"timestamp_jitter_s", "clock_rate"}));
}

// The stamps and the temperature of the recording have it already.
TEST(RecordingLike, WhatIsRecordedDoesNotActTwice) {
    const auto world = std::make_shared<const RecordedWorld>(real_recording());
    SensorModel model = typical_mpu9250();
    model.effects = {effect_of("temp_linear", {{"c1_dps_per_C", 0.3}})};
    const Recording plain = simulate_recording(model, {.seed = 4, .like = world});
    model.effects.push_back(effect_of("clock_rate", {{"rel", 0.01}}));
    model.effects.push_back(effect_of("self_heating", {{"rise_C", 10.0}, {"tau_s", 5.0}}));
    EXPECT_EQ(terms_of_temperature(model), (std::vector<std::string>{"self_heating"}));
    const Recording again = simulate_recording(model, {.seed = 4, .like = world});
    EXPECT_EQ(counts_of(again, "gx"), counts_of(plain, "gx"));
}

}  // namespace
}  // namespace gyrolog
