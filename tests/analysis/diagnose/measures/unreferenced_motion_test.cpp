// What tells a gyro that was turned from one at rest, whatever ails it.
#include "analysis/diagnose/measures/unreferenced_motion.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/recording/disturbances.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t seeds = 3;
constexpr std::uint64_t samples = 30'000;  // 5 min

Recording simulated(const SensorModel& model, std::uint64_t seed) {
    SimulationRequest request;
    request.samples = samples;
    request.seed = seed;
    return simulate_recording(model, request);
}

// Each parameter at the end of its plausible range that is farther from zero, or at the nearer one: short
// dwell times and low frequencies are at the nearer ends.
EffectModel extreme(const EffectDefinition& effect, unsigned ends) {
    EffectModel entry;
    entry.effect = std::string(effect.name);
    unsigned bit = 0;
    for (const EffectParam& param : effect.params) {
        if (!(param.plausible_to > param.plausible_from)) { continue; }
        const bool is_far = ((ends >> bit++) & 1U) == 0U;
        entry.params[std::string(param.name)] =
            is_far == (std::abs(param.plausible_to) >= std::abs(param.plausible_from)) ? param.plausible_to
                                                                                       : param.plausible_from;
    }
    return entry;
}

// Bumps of 100 deg/s, every ten seconds, that ring for 2 s at 2 Hz, which a second hardly averages: there
// something swings. (Shares of 0.10 to 0.16.)
bool swings_always(const EffectModel& entry) {
    return entry.effect == "disturbance" && entry.params.at("per_hour") == 360.0 &&
           entry.params.at("size_dps") == 100.0 && entry.params.at("f_hz") == 2.0 &&
           entry.params.at("decay_s") == 2.0;
}

TEST(UnreferencedMotion, IsNotThereWhateverAilsASensorAtRest) {
    double largest = 0.0;
    std::size_t cases = 0;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->table) { continue; }
        const auto ranges = std::ranges::count_if(link.effect->params, [](const EffectParam& param) {
            return param.plausible_to > param.plausible_from;
        });
        for (unsigned ends = 0; ends < (1U << static_cast<unsigned>(ranges)); ++ends) {
            SensorModel sensor = typical_mpu9250();
            sensor.effects = {extreme(*link.effect, ends)};
            if (simulation_refusal(sensor) || swings_always(sensor.effects.front())) { continue; }
            ++cases;
            for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
                const double share = share_turned(simulated(sensor, seed), typical_mpu9250());
                EXPECT_LE(share, DisturbanceOptions().together_share)
                    << link.effect->name << ", ends " << ends << ", seed " << seed;
                largest = std::max(largest, share);
            }
        }
    }
    std::cout << cases << " cases of " << seeds << " seeds, largest share " << largest << '\n';
    EXPECT_GT(cases, 100U);
}

// A model that knows next to none of the noise: what is loud is no motion.
TEST(UnreferencedMotion, IsNotThereUnderAModelThatIsTooQuiet) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SensorModel loud = typical_mpu9250();
        for (AxisModel& axis : loud.axes) {
            axis.noise.N_rad_per_sqrt_s *= 100.0;
            axis.noise.K_rad_per_s_sqrt_s *= 100.0;
        }
        EXPECT_EQ(share_turned(simulated(loud, seed), typical_mpu9250()), 0.0) << "seed " << seed;
    }
}

TEST(UnreferencedMotion, IsThereWhereASensorIsTurnedByHandFromPoseToPose) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Recording turned = simulated(typical_mpu9250(), seed);
        // A quarter turn of 2 s about one axis after the other, then 4 s of rest.
        for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
            Column& column = turned.columns.at(axis);
            std::vector<double> values = column.values();
            for (std::size_t row = 3000; row < values.size(); ++row) {
                const std::size_t in_pose = row % 600;
                if (in_pose >= 200 || (row / 600) % 3 != axis) { continue; }
                const double swing = std::sin(pi * static_cast<double>(in_pose) / 200.0);
                values[row] += 0.25 * pi * pi / 2.0 * swing;
            }
            column = {column.name, "rad/s", std::move(values)};
        }
        const double share = share_turned(turned, typical_mpu9250());
        EXPECT_GT(share, 0.3) << "seed " << seed;
        turned.columns.push_back({"ref_x", "rad/s", std::vector<double>(turned.rows(), 0.0)});
        EXPECT_EQ(share_turned(turned, typical_mpu9250()), 0.0) << "a reference tells it";
    }
}

}  // namespace
}  // namespace gyrolog
