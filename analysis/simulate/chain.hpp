// The signal chain of the simulated sensor: its own stages and all effects, in the order of their action.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/simulate/effect.hpp"
#include "analysis/simulate/stage.hpp"

namespace gyrolog {

// One of the three is set.
struct ChainLink {
    StageMaker own = nullptr;  // a part of every sensor
    const EffectDefinition* effect = nullptr;
    const EffectDefinition* timing_of = nullptr;  // the effect's part before the world is asked
};

std::span<const ChainLink> signal_chain();

// Null for an unknown name.
const EffectDefinition* find_effect(std::string_view name);

// The rate at which a sensor really samples that is set to `nominal_hz`.
double true_rate_hz(const SensorModel& model, double nominal_hz);

// What the numbers of an axis are multiples of: the model's lsb, or the coarser step of an effect that is no
// multiple of it; 0 of a model without an lsb.
double converter_step_rad_s(const SensorModel& model, std::size_t axis);
std::array<double, 3> converter_steps_rad_s(const SensorModel& model);

struct Chain {
    std::vector<std::unique_ptr<Stage>> stages;
    std::size_t clock_stages = 0;  // the first ones, which ask nothing of the world
};

// The stages that the context's model needs; it has no simulation_refusal(). They run at the true rate:
// sample k of all of them is that of the time k / rate.
Chain make_chain(const StageContext& nominal);

}  // namespace gyrolog
