// A sensor that moves against an orientation with errors of its own.
#include "analysis/diagnose/multiscale/motion_diagnosis.hpp"

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/diagnose/calibration/reference_error.hpp"
#include "analysis/diagnose/calibration/replicates.hpp"
#include "analysis/simulate/orientation_rate.hpp"

namespace gyrolog {
namespace {

using testing::UnorderedElementsAre;

constexpr double rate_hz = 100.0;
constexpr std::size_t samples = 24'000;  // 4 min
constexpr double noise_rad_per_sqrt_s = 0.005 * rad_per_deg;

struct Fault {
    double scale = 0.0;     // of x, and half of it of y, the other way
    double z_from_y = 0.0;  // misalignment
    double latency_s = 0.0;
};

struct OrientationError {
    double at_rest_rad = 0.5e-3;
    double moving_rad = 0.5e-3;
};

Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion turned_by(const Quaternion& q, const std::array<double, 3>& turn_rad) {
    const double angle_rad = std::hypot(turn_rad[0], turn_rad[1], turn_rad[2]);
    const double share = angle_rad > 0.0 ? std::sin(0.5 * angle_rad) / angle_rad : 0.5;
    return product(
        q, {std::cos(0.5 * angle_rad), share * turn_rad[0], share * turn_rad[1], share * turn_rad[2]});
}

// Swings about all axes, less than 2 Hz, with a rest at the beginning and one in the middle.
class Motion {
public:
    explicit Motion(std::uint64_t seed) : random_(seed) {
        std::uniform_real_distribution<double> f_hz(0.05, 2.0);
        std::uniform_real_distribution<double> size_rad_s(0.2, 1.0);
        std::uniform_real_distribution<double> phase_rad(0.0, 2.0 * pi);
        for (auto& axis : swings_) {
            for (Swing& swing : axis) { swing = {f_hz(random_), size_rad_s(random_), phase_rad(random_)}; }
        }
    }

    double envelope(double t_s) const {
        const auto begun = [&](double at_s) { return 0.5 + 0.5 * std::tanh(3.0 * (t_s - at_s)); };
        return begun(30.0) - begun(120.0) + begun(130.0);
    }

    std::array<double, 3> rate_rad_s(double t_s) const {
        std::array<double, 3> rate_rad_s{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const Swing& swing : swings_.at(axis)) {
                rate_rad_s.at(axis) += envelope(t_s) * swing.size_rad_s *
                                       std::sin(2.0 * pi * swing.f_hz * t_s + swing.phase_rad);
            }
        }
        return rate_rad_s;
    }

private:
    struct Swing {
        double f_hz, size_rad_s, phase_rad;
    };
    std::mt19937_64 random_;
    std::array<std::array<Swing, 4>, 3> swings_{};
};

std::array<double, 3> shown(const std::array<double, 3>& rate_rad_s, const Fault& fault) {
    return {(1.0 + fault.scale) * rate_rad_s[0], (1.0 - 0.5 * fault.scale) * rate_rad_s[1],
            rate_rad_s[2] + fault.z_from_y * rate_rad_s[1]};
}

std::shared_ptr<const Recording> recorded(std::uint64_t seed, const Fault& fault,
                                          const OrientationError& error = {}) {
    const Motion motion(seed);
    std::mt19937_64 random(seed + 1000);
    std::normal_distribution<double> normal;
    std::array<std::vector<double>, 7> values;
    constexpr int steps = 4;
    Quaternion orientation = {1.0, 0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < samples; ++i) {
        const double t_s = static_cast<double>(i) / rate_hz;
        const std::array<double, 3> rate_rad_s = shown(motion.rate_rad_s(t_s - fault.latency_s), fault);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            values.at(axis).push_back(rate_rad_s.at(axis) +
                                      noise_rad_per_sqrt_s * std::sqrt(rate_hz) * normal(random));
        }
        const double envelope = motion.envelope(t_s);
        const double sd_rad = error.at_rest_rad + envelope * (error.moving_rad - error.at_rest_rad);
        const Quaternion seen = turned_by(
            orientation, {sd_rad * normal(random), sd_rad * normal(random), sd_rad * normal(random)});
        for (std::size_t part = 0; part < 4; ++part) { values.at(3 + part).push_back(seen.at(part)); }
        for (int step = 0; step < steps; ++step) {
            const double dt_s = 1.0 / rate_hz / steps;
            std::array<double, 3> turn_rad = motion.rate_rad_s(t_s + (step + 0.5) * dt_s);
            for (double& each : turn_rad) { each *= dt_s; }
            orientation = turned_by(orientation, turn_rad);
        }
    }
    auto recording = std::make_shared<Recording>();
    recording->name = "swings";
    recording->rate_hz = rate_hz;
    const std::array<const char*, 7> names = {"gx", "gy", "gz", "ref_qw", "ref_qx", "ref_qy", "ref_qz"};
    for (std::size_t column = 0; column < names.size(); ++column) {
        recording->columns.push_back(
            {names.at(column), column < 3 ? "rad/s" : "", std::move(values.at(column)), 1.0, 0.0, "", {}});
    }
    recording->segments = {{0, samples, 0}};
    return recording;
}

// The same motion against an instrument that measures rates.
std::shared_ptr<const Recording> recorded_against_rates(std::uint64_t seed, const Fault& fault,
                                                        double noise_rad_s) {
    const Motion motion(seed);
    std::mt19937_64 random(seed + 2000);
    std::normal_distribution<double> normal;
    auto recording = std::make_shared<Recording>(*recorded(seed, fault));
    std::erase_if(recording->columns, [](const Column& column) { return column.name.starts_with("ref_"); });
    std::array<std::vector<double>, 3> rates;
    for (std::size_t i = 0; i < samples; ++i) {
        const std::array<double, 3> rate_rad_s = motion.rate_rad_s(static_cast<double>(i) / rate_hz);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            rates.at(axis).push_back(rate_rad_s.at(axis) + noise_rad_s * normal(random));
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        recording->columns.push_back(
            {std::string("ref_") + axis_names.at(axis), "rad/s", std::move(rates.at(axis))});
    }
    return recording;
}

SensorModel sensor() {
    SensorModel model;
    model.rate_hz = rate_hz;
    model.full_scale_rad_s = model.saturation_rad_s = 100.0;
    for (AxisModel& axis : model.axes) { axis.noise.N_rad_per_sqrt_s = noise_rad_per_sqrt_s; }
    return model;
}

std::optional<Diagnosis> diagnosed(const std::shared_ptr<const Recording>& recording) {
    DiagnosisOptions options;
    options.simulations = 40;
    return diagnose_in_motion(recording, sensor(), "sensor", options);
}

std::vector<std::string> effects_of(const Diagnosis& diagnosis) {
    std::vector<std::string> effects;
    for (const Cause& cause : diagnosis.causes) { effects.push_back(cause.finding.effect); }
    return effects;
}

TEST(ReferenceError, IsThatOfTheOrientationAndNotOfTheSensor) {
    const auto rows = std::make_shared<const Recording>(means_against_orientation(*recorded(3, {})));
    ASSERT_EQ(rows->samples_per_row, 5U);
    const ReferenceQuality quality = with_reference_error(sensor(), rows, 1).quality;
    // The difference of two angles, over the time of a row; what the fourth order adds is at the ends.
    const double error_rad_s = std::sqrt(2.0) * 0.5e-3 * 20.0;
    for (const Span& seen_rad_s : quality.error_rad_s) {
        EXPECT_LT(seen_rad_s.from, 1.1 * error_rad_s);
        EXPECT_GT(seen_rad_s.to, 0.9 * error_rad_s);
        EXPECT_LT(seen_rad_s.to, 2.0 * seen_rad_s.from) << "it is the same all the time";
    }
    EXPECT_LT(std::fabs(quality.latency_s), 5.0 * quality.latency_sd_s);
    EXPECT_LT(quality.latency_sd_s, 1e-4);
    EXPECT_GT(quality.bandwidth_hz, 1.5);
    EXPECT_LT(quality.bandwidth_hz, 4.0) << "the motion has nothing above 2 Hz";
}

TEST(ReferenceError, ChangesWithTheMotion) {
    const auto rows = std::make_shared<const Recording>(means_against_orientation(
        *recorded(4, {.latency_s = 4e-3}, {.at_rest_rad = 0.2e-3, .moving_rad = 2e-3})));
    const ReferenceQuality quality = with_reference_error(sensor(), rows, 1).quality;
    for (const Span& seen_rad_s : quality.error_rad_s) { EXPECT_GT(seen_rad_s.to, 4.0 * seen_rad_s.from); }
    EXPECT_NEAR(quality.latency_s, 4e-3, 5.0 * quality.latency_sd_s);
    EXPECT_LT(quality.latency_sd_s, 0.5e-3);
}

// The error holds all noise, of whatever effect the model has it, and the model's other effects stay.
TEST(ReferenceError, TakesThePlaceOfAllNoiseOfTheModelAndOfNothingElse) {
    const auto rows = std::make_shared<const Recording>(means_against_orientation(*recorded(6, {})));
    SensorModel model = sensor();
    model.effects.push_back({"scale_factor", {}, {{"eps", 0.01}}, ""});
    model.effects.push_back({"biquad", {}, {{"b0", 1.0}}, ""});
    model.effects.push_back({"arw_scale", {}, {{"factor", 3.0}}, ""});
    model.effects.push_back({"heavy_tail", {}, {{"nu", 4.0}}, ""});
    const WithReferenceError plain = with_reference_error(sensor(), rows, 1);
    const WithReferenceError other = with_reference_error(model, rows, 1);
    ASSERT_GE(other.model.effects.size(), 2U);
    EXPECT_EQ(other.model.effects[0].effect, "scale_factor");
    EXPECT_EQ(other.model.effects[1].effect, "biquad");
    EXPECT_EQ(other.model.effects.size(), plain.model.effects.size() + 2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Span& expected_rad_s = plain.quality.error_rad_s.at(axis);
        EXPECT_NEAR(other.quality.error_rad_s.at(axis).to / expected_rad_s.to, 1.0, 0.05);
        EXPECT_NEAR(other.model.axes.at(axis).noise.Q_rad / plain.model.axes.at(axis).noise.Q_rad, 1.0, 0.05);
    }
}

// Within its error the reference tells no rate, such as one below a dead zone's edge; and nobody draws the
// error anew that the model's noise holds already.
TEST(ReferenceError, IsAllNoiseAboutTheReference) {
    const auto rows = std::make_shared<const Recording>(means_against_orientation(*recorded(7, {})));
    const auto world = std::make_shared<const RecordedWorld>(rows);
    SensorModel model = sensor();
    model.ref_noise_rad_s = 1e-3;
    const Prediction stated(world, model);
    const Prediction error(world, model, Prediction::NoiseOf::reference_too);
    EXPECT_TRUE(can_be_measured_anew(stated));
    EXPECT_FALSE(can_be_measured_anew(error));
    EXPECT_DOUBLE_EQ(stated.reference_noise_rad_s(1), 1e-3);
    EXPECT_DOUBLE_EQ(stated.rate_sd_rad_s(1), 1e-3);
    EXPECT_EQ(error.reference_noise_rad_s(1), 0.0);
    EXPECT_NEAR(error.rate_sd_rad_s(1), noise_rad_per_sqrt_s * std::sqrt(rows->rate_hz), 1e-9);
}

TEST(MotionDiagnosis, FindsHowTheSensorAnswersAndNoFaultOfItsNoise) {
    const Fault fault{.scale = 0.01, .z_from_y = 0.006, .latency_s = 4e-3};
    for (const OrientationError& error : {OrientationError{}, OrientationError{0.2e-3, 2e-3}}) {
        const auto diagnosis = diagnosed(recorded(5, fault, error));
        ASSERT_TRUE(diagnosis);
        EXPECT_EQ(diagnosis->verdict, Verdict::known);
        EXPECT_THAT(effects_of(*diagnosis), UnorderedElementsAre("scale_factor", "misalignment", "latency"));
        for (const Cause& cause : diagnosis->causes) {
            for (const EffectModel& entry : cause.finding.entries) {
                const auto close = [&](const char* param, double truth, double within) {
                    EXPECT_NEAR(entry.params.at(param), truth, within) << cause.finding.effect;
                };
                const bool is_loud = error.moving_rad > 1e-3;
                if (cause.finding.effect == "latency") { close("delay_s", 4e-3, is_loud ? 0.5e-3 : 0.1e-3); }
                if (cause.finding.effect == "misalignment") { close("from_y", 0.006, is_loud ? 2e-3 : 3e-4); }
                if (entry.axes == std::vector<std::string>{"x"} && entry.params.contains("eps")) {
                    close("eps", 0.01, is_loud ? 2e-3 : 3e-4);
                }
            }
        }
        EXPECT_TRUE(diagnosis->noise_refits.empty());
        // In the model that was given, whose noise the reference's error is no part of.
        EXPECT_EQ(diagnosis->corrected.axes[0].noise.N_rad_per_sqrt_s, noise_rad_per_sqrt_s);
        EXPECT_EQ(diagnosis->corrected.effects.size(), [&] {
            std::size_t entries = 0;
            for (const Cause& cause : diagnosis->causes) { entries += cause.finding.entries.size(); }
            return entries;
        }());
        ASSERT_EQ(diagnosis->passes.size(), 2U);
        EXPECT_TRUE(diagnosis->passes.front().is_at_rest);
        EXPECT_TRUE(diagnosis->reference);
    }
}

// At the 1 % level, of eight one by chance is rare enough, and two would be a fault.
TEST(MotionDiagnosis, FindsNothingWhereTheOrientationAloneIsWrong) {
    int called = 0;
    std::string told;
    for (std::uint64_t seed = 11; seed < 19; ++seed) {
        const double moving_rad = seed % 2 == 0 ? 0.5e-3 : 2e-3;
        const auto diagnosis =
            diagnosed(recorded(seed, {}, {.at_rest_rad = 0.5e-3, .moving_rad = moving_rad}));
        ASSERT_TRUE(diagnosis);
        told += "seed " + std::to_string(seed) + ": p " + std::to_string(diagnosis->p_none);
        for (const std::string& effect : effects_of(*diagnosis)) { told += " " + effect; }
        told += "\n";
        for (const GapDomain& domain : diagnosis->domains) {
            if (!domain.stands_out) { continue; }
            told += "  " + domain.name + " of " + domain.axis_text() + ", surprise " +
                    std::to_string(domain.surprise_before_nats) + " nats\n";
        }
        if (diagnosis->verdict != Verdict::none) { ++called; }
    }
    EXPECT_LE(called, 1) << told;
    std::cout << told;
}

constexpr double strong_noise_rad_s = 0.2 * rad_per_deg;  // four times the sensor's
constexpr double weak_noise_rad_s = 0.01 * rad_per_deg;

TEST(ReferenceRates, OfLittleNoiseHaveThatOfTheirSamplesAtRest) {
    const auto recording = recorded_against_rates(5, {.latency_s = 3e-3}, weak_noise_rad_s);
    const auto diagnosis = diagnosed(recording);
    ASSERT_TRUE(diagnosis && diagnosis->reference);
    const ReferenceQuality& quality = *diagnosis->reference;
    EXPECT_TRUE(quality.is_known_at_rest);
    EXPECT_FALSE(quality.is_orientation);
    for (const Span& seen_rad_s : quality.error_rad_s) {
        EXPECT_NEAR(seen_rad_s.from / weak_noise_rad_s, 1.0, 0.05);
        EXPECT_EQ(seen_rad_s.from, seen_rad_s.to);
    }
    EXPECT_NEAR(quality.latency_s, 3e-3, 5.0 * quality.latency_sd_s);
    EXPECT_LT(quality.latency_sd_s, 0.1e-3);
    EXPECT_GT(quality.bandwidth_hz, 1.5);
    EXPECT_TRUE(diagnosis->passes.empty());
    EXPECT_THAT(effects_of(*diagnosis), UnorderedElementsAre("latency"));
}

TEST(ReferenceRates, ThatAreExactOrStatedSayNothing) {
    DiagnosisOptions options;
    options.simulations = 20;
    EXPECT_FALSE(diagnose_in_motion(recorded_against_rates(5, {}, 0.0), sensor(), "", options)->reference);
    SensorModel stating = sensor();
    stating.ref_noise_rad_s = weak_noise_rad_s;
    EXPECT_FALSE(
        diagnose_in_motion(recorded_against_rates(5, {}, weak_noise_rad_s), stating, "", options)->reference);
}

TEST(ReferenceRates, NoisierThanTheSensorMakeNoCause) {
    const auto diagnosis = diagnosed(recorded_against_rates(7, {.scale = 0.01}, strong_noise_rad_s));
    ASSERT_TRUE(diagnosis && diagnosis->reference);
    EXPECT_FALSE(diagnosis->reference->is_known_at_rest);
    EXPECT_NEAR(diagnosis->reference->error_rad_s[0].to / strong_noise_rad_s, 1.0, 0.2);
    ASSERT_EQ(diagnosis->passes.size(), 2U);
    EXPECT_TRUE(diagnosis->passes.front().is_at_rest);
    EXPECT_THAT(effects_of(*diagnosis), UnorderedElementsAre("scale_factor"));
    EXPECT_EQ(diagnosis->verdict, Verdict::known);
}

// Where the sensor moves no one can tell it from the reference's.
TEST(ReferenceRates, NoisierThanTheSensorLeaveItsNoiseToTheRest) {
    SensorModel quieter = sensor();
    for (AxisModel& axis : quieter.axes) { axis.noise.N_rad_per_sqrt_s /= 1.5; }
    DiagnosisOptions options;
    options.simulations = 40;
    const auto diagnosis =
        diagnose_in_motion(recorded_against_rates(8, {}, strong_noise_rad_s), quieter, "quieter", options);
    ASSERT_TRUE(diagnosis);
    EXPECT_THAT(effects_of(*diagnosis), UnorderedElementsAre("arw_scale"));
}

}  // namespace
}  // namespace gyrolog
