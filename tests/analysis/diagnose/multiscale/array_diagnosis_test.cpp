// One gyro of an array against the others: a fault is named for the gyro that has it, and for no other.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/denoise/array_reference.hpp"
#include "analysis/diagnose/multiscale/motion_diagnosis.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::IsEmpty;

constexpr double rate_hz = 100.0;
constexpr std::size_t rows = 24'000;  // 4 min
constexpr std::size_t still_rows = 6'000;
constexpr std::size_t gyros = 3;

// At rest, then swings about all axes at once.
std::shared_ptr<const RecordedWorld> motion(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> f_hz(0.05, 1.5);
    std::uniform_real_distribution<double> size_rad_s(0.2, 0.7);
    Recording recording;
    recording.rate_hz = rate_hz;
    recording.segments = {{0, rows, 0}};
    for (const char* axis : axis_names) {
        std::vector<double> rate(rows, 0.0);
        for (int swing = 0; swing < 4; ++swing) {
            const double own_hz = f_hz(random);
            const double own_rad_s = size_rad_s(random);
            for (std::size_t row = still_rows; row < rows; ++row) {
                const double t_s = static_cast<double>(row - still_rows) / rate_hz;
                rate[row] += std::min(1.0, t_s) * own_rad_s * std::sin(2.0 * pi * own_hz * t_s);
            }
        }
        recording.columns.insert(recording.columns.begin(),
                                 {std::string("g") + axis, "rad/s", std::vector<double>(rows, 0.0)});
        recording.columns.push_back({std::string("ref_") + axis, "rad/s", std::move(rate)});
    }
    return std::make_shared<const RecordedWorld>(std::make_shared<const Recording>(std::move(recording)));
}

// Of typical sensors, with drift and codes; the second has the fault.
Recording array_with(const EffectModel& fault, std::uint64_t seed) {
    const auto world = motion(seed);
    Recording array;
    for (std::size_t gyro = 1; gyro <= gyros; ++gyro) {
        SensorModel model = typical_mpu9250();
        if (gyro == 2) { model.effects = {fault}; }
        SimulationRequest request;
        request.like = world;
        request.seed = 100 * seed + gyro;
        Recording one = simulate_recording(model, request);
        std::erase_if(one.columns, [](const Column& column) { return !column.name.starts_with('g'); });
        for (Column& column : one.columns) { column.name += std::to_string(gyro); }
        if (array.columns.empty()) {
            array = std::move(one);
            continue;
        }
        std::ranges::move(one.columns, std::back_inserter(array.columns));
    }
    return array;
}

std::optional<Diagnosis> diagnosed(const Recording& array, unsigned long gyro) {
    UnitOfArray judged = unit_against_others(array, gyro);
    EXPECT_EQ(judged.failure, "");
    DiagnosisOptions options;
    options.simulations = 40;
    return diagnose_in_motion(std::make_shared<const Recording>(std::move(judged.recording)),
                              typical_mpu9250(), "typical", options);
}

std::vector<std::string> effects_of(const Diagnosis& diagnosis) {
    std::vector<std::string> effects;
    for (const Cause& cause : diagnosis.causes) { effects.push_back(cause.finding.effect); }
    return effects;
}

void expect_named_for_the_second_alone(const EffectModel& fault, const std::string& param) {
    for (const std::uint64_t seed : {1U, 2U}) {
        const Recording array = array_with(fault, seed);
        for (unsigned long gyro = 1; gyro <= gyros; ++gyro) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", gyro " + std::to_string(gyro));
            const auto diagnosis = diagnosed(array, gyro);
            ASSERT_TRUE(diagnosis && diagnosis->reference);
            EXPECT_EQ(diagnosis->reference->gyros, gyros - 1);
            if (gyro != 2) {
                EXPECT_THAT(effects_of(*diagnosis), IsEmpty());
                EXPECT_EQ(diagnosis->verdict, Verdict::none);
                continue;
            }
            ASSERT_THAT(effects_of(*diagnosis), Contains(fault.effect));
            EXPECT_EQ(diagnosis->causes.size(), 1U);
            const EffectModel& named = diagnosis->causes.front().finding.entries.front();
            EXPECT_EQ(named.axes, fault.axes);
            EXPECT_NEAR(named.params.at(param), fault.params.at(param), 5e-4);
        }
    }
}

TEST(ArrayDiagnosis, NamesAScaleFactorForTheGyroThatHasIt) {
    expect_named_for_the_second_alone({"scale_factor", {"x"}, {{"eps", 0.01}}, ""}, "eps");
}

TEST(ArrayDiagnosis, NamesAMisalignmentForTheGyroThatHasIt) {
    expect_named_for_the_second_alone({"misalignment", {"z"}, {{"from_x", 0.01}}, ""}, "from_x");
}

}  // namespace
}  // namespace gyrolog
