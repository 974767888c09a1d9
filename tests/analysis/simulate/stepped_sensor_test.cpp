#include "analysis/simulate/stepped_sensor.hpp"

#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "tests/analysis/simulate/simulated.hpp"
#include "tests/support/heap_account.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

EffectModel plausible(const EffectDefinition& definition) {
    EffectModel entry = effect_entry(std::string(definition.name), {});
    for (const EffectParam& param : definition.params) {
        if (param.from_model) { continue; }
        entry.params[std::string(param.name)] =
            param.whole_up_to != 0.0 || param.range == EffectParam::Range::yes_no
                ? param.plausible_to
                : 0.5 * (param.plausible_from + param.plausible_to);
    }
    if (definition.table) {
        entry.table[std::string(definition.table->at)] = {-10.0, 20.0, 30.0};
        entry.table[std::string(definition.table->value)] = {1.0, 2.0, 0.5};
    }
    return entry;
}

WorldInstant at_rest(double t_s) {
    WorldInstant now;
    now.t_s = t_s;
    now.specific_force_m_s2 = {0.0, 0.0, standard_gravity_m_s2};
    return now;
}

std::vector<SteppedSample> taken(SteppedSensor& sensor) {
    std::vector<SteppedSample> samples;
    SteppedSample sample;
    while (sensor.take(sample) == SteppedSensor::Take::sample) { samples.push_back(sample); }
    return samples;
}

void expect_same_in_parts(const SensorModel& model, const std::shared_ptr<const World>& world,
                          const std::string& what) {
    SensorSimulator whole(model, rate_hz, 3, world);
    SensorSimulator parts(model, rate_hz, 3, world);
    for (int b = 0; b < 3; ++b) {
        const SampleBlock& block = whole.next_block();
        // The second block comes as singles and a rest.
        const std::size_t singles = b == 1 ? 700 : block_samples;
        for (std::size_t i = 0; i < block_samples; ++i) {
            const SampleBlock& part = i < singles ? parts.next_sample() : parts.next_block();
            const std::size_t end = i == singles ? block_samples : i + 1;
            for (std::size_t k = i; k < end; ++k) {
                ASSERT_TRUE(same_bits(part.stamp_s[k], block.stamp_s[k])) << what << ' ' << b << ' ' << k;
                ASSERT_TRUE(same_bits(part.temperature_C[k], block.temperature_C[k])) << what << ' ' << k;
                ASSERT_EQ(part.lost[k], block.lost[k]) << what << ' ' << k;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    ASSERT_TRUE(same_bits(part.rate_rad_s[axis][k], block.rate_rad_s[axis][k]))
                        << what << ' ' << b << ' ' << k;
                    ASSERT_EQ(part.counts[axis][k], block.counts[axis][k]) << what << ' ' << b << ' ' << k;
                }
            }
            if (i == singles) { break; }
        }
    }
}

TEST(SampleBySample, EachEffectIsTheSameBits) {
    int effects = 0;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr) { continue; }
        SensorModel model = typical_mpu9250();
        model.effects = {plausible(*link.effect)};
        ASSERT_EQ(simulation_refusal(model), std::nullopt);
        expect_same_in_parts(model, tumbling_world(1.0), std::string(link.effect->name));
        ++effects;
    }
    EXPECT_GT(effects, 30);
}

TEST(SampleBySample, ASensorWithAllItsNoiseTermsAtRestIsTheSameBits) {
    SensorModel model = typical_mpu9250();
    model.lsb_rad_s = 0.0;
    model.timestamp_jitter_s = 1e-5;
    model.temperature = TemperatureModel{25.0, {1e-4, 2e-4, 3e-4}, {1e-3, 0.0, 2e-3}};
    for (AxisModel& axis : model.axes) {
        axis.noise.Q_rad = 1e-5;
        axis.noise.R_rad_per_s2 = 1e-6;
    }
    expect_same_in_parts(model, nullptr, "at rest");
}

TEST(SteppedSensor, AtRestGivesTheBitsOfASimulatedRecording) {
    const SensorModel model = typical_mpu9250();
    const Recording recording = simulate_recording(model, {.samples = 3000, .seed = 7});
    SteppedSensor sensor(model, model.rate_hz, 7);
    std::vector<SteppedSample> samples;
    // Ten steps a period, summed up with their rounding.
    double t_s = 0.0;
    while (samples.size() < 3000) {
        ASSERT_EQ(sensor.step(at_rest(t_s)), SteppedSensor::Step::taken);
        for (const SteppedSample& sample : taken(sensor)) { samples.push_back(sample); }
        t_s += 0.1 / model.rate_hz;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Column& column = *recording.find(std::string("g") + axis_names[axis]);
        for (std::size_t i = 0; i < 3000; ++i) {
            ASSERT_EQ(samples[i].counts[axis], std::get<std::vector<std::int16_t>>(column.data)[i]) << i;
            ASSERT_TRUE(same_bits(samples[i].temperature_C, recording.find("temp")->value(i))) << i;
        }
    }
}

TEST(SteppedSensor, MotionAndTemperatureBetweenStepsAreStraightLines) {
    SensorModel model = with_effect(ideal_model(), "temp_linear", {{"c1_dps_per_C", 0.5}});
    model.latency_s = 0.013;
    const auto world = world_turning([](double t_s) { return Vector3{t_s, -2.0 * t_s, 0.5}; });
    world->temperature_C = [](double t_s) { return 20.0 + t_s; };
    const Simulated expected = simulate(model, rate_hz, 1, 1, world);
    SteppedSensor sensor(model, rate_hz, 1);
    std::size_t k = 0;
    constexpr double start_s = 1000.0;
    for (int i = 0; i < 300; ++i) {  // slower than the sensor
        const double t_s = 0.032 * i;
        WorldInstant now = at_rest(start_s + t_s);
        now.rate_rad_s = world->rate_rad_s(t_s);
        now.temperature_C = world->temperature_C(t_s);
        ASSERT_EQ(sensor.step(now), SteppedSensor::Step::taken);
        for (const SteppedSample& sample : taken(sensor)) {
            ASSERT_EQ(sample.index, k);
            EXPECT_NEAR(sample.stamp_s, start_s + expected.stamp_s[k], 1e-9);
            for (std::size_t axis = 0; axis < 3 && expected.world_s[k] >= 0.0; ++axis) {
                EXPECT_NEAR(sample.rate_rad_s[axis], expected.rate_rad_s[axis][k], 1e-9) << k;
            }
            ++k;
        }
        EXPECT_NEAR(static_cast<double>(k), std::floor(t_s * rate_hz + 1e-3) + 1.0, 0.0);
    }
}

TEST(SteppedSensor, ASampleThatShowsLaterThanNowWaits) {
    // The world runs away from samples that are too few for their stamps.
    const SensorModel model =
        with_effect(ideal_model(), "dropped", {{"per_hour", 36000.0}, {"longest", 5.0}, {"in_stamps", 0.0}});
    const auto world = world_turning([](double t_s) { return Vector3{t_s, 0.0, 0.0}; });
    const Simulated expected = simulate(model, rate_hz, 5, 1, world);
    SteppedSensor sensor(model, rate_hz, 5);
    std::size_t k = 0;
    for (int i = 0; i < 1000; ++i) {
        WorldInstant now = at_rest(i / rate_hz);
        now.rate_rad_s = {now.t_s, 0.0, 0.0};
        ASSERT_EQ(sensor.step(now), SteppedSensor::Step::taken);
        for (const SteppedSample& sample : taken(sensor)) {
            EXPECT_NEAR(sample.rate_rad_s[0], expected.rate_rad_s[0][k++], 1e-9);
        }
    }
    EXPECT_GT(expected.world_s[k - 1], static_cast<double>(k) / rate_hz + 0.1);
}

TEST(SteppedSensor, BadStepsChangeNothing) {
    const SensorModel model = typical_mpu9250();
    SteppedSensor sensor(model, rate_hz, 1);
    SteppedSensor undisturbed(model, rate_hz, 1);
    SteppedSample sample;
    EXPECT_EQ(sensor.take(sample), SteppedSensor::Take::none);
    for (int i = 0; i < 50; ++i) {
        const WorldInstant now = at_rest(i / rate_hz);
        ASSERT_EQ(sensor.step(now), SteppedSensor::Step::taken);
        ASSERT_EQ(undisturbed.step(now), SteppedSensor::Step::taken);
        EXPECT_EQ(sensor.step(now), SteppedSensor::Step::not_later);
        WorldInstant bad = at_rest(now.t_s + 1.0);
        bad.rate_rad_s[1] = std::numeric_limits<double>::infinity();
        EXPECT_EQ(sensor.step(bad), SteppedSensor::Step::not_finite);
        bad = at_rest(now.t_s + 1.0);
        bad.temperature_C = 20.0;
        EXPECT_EQ(sensor.step(bad), SteppedSensor::Step::temperature_changed);
        const auto samples = taken(sensor);
        const auto expected = taken(undisturbed);
        ASSERT_EQ(samples.size(), expected.size());
        for (std::size_t k = 0; k < samples.size(); ++k) { EXPECT_EQ(samples[k].counts, expected[k].counts); }
    }
}

TEST(SteppedSensor, ADelayBeyondTheRememberedStepsIsToldAndNothingIsMadeUp) {
    SensorModel model = ideal_model();
    model.latency_s = 1.0;
    SteppedSensor sensor(model, rate_hz, 1);
    SteppedSample sample;
    auto last = SteppedSensor::Take::none;
    for (int i = 0; last != SteppedSensor::Take::forgotten && i < 1'000'000; ++i) {
        ASSERT_EQ(sensor.step(at_rest(1e-5 * i)), SteppedSensor::Step::taken);
        do { last = sensor.take(sample); } while (last == SteppedSensor::Take::sample);
    }
    EXPECT_EQ(last, SteppedSensor::Take::forgotten);
}

TEST(SteppedSensor, NoStepAllocates) {
    SensorModel model = typical_mpu9250();
    for (const ChainLink& link : signal_chain()) {
        if (link.effect != nullptr) { model.effects.push_back(plausible(*link.effect)); }
    }
    SteppedSensor sensor(model, 1000.0, 1);
    const std::size_t before = allocations;
    SteppedSample sample;
    std::size_t samples = 0;
    for (int i = 0; i < 20'000; ++i) {
        ASSERT_EQ(sensor.step(at_rest(1e-3 * i)), SteppedSensor::Step::taken);
        while (sensor.take(sample) == SteppedSensor::Take::sample) { ++samples; }
    }
    EXPECT_GT(samples, 10'000U);
    EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace gyrolog
