// The home of all chance that is not the simulator's own: every use has its name here, and from a seed, a
// name and a number comes a seed of its own. Two uses share no draw, whatever their seeds, since the hash of
// the three tells them apart; nor do they share one with the simulator's chain, whose streams
// (StageContext::stream) are those of the seed itself.
#pragma once

#include <cstdint>

#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

enum class RandomPurpose : std::uint32_t {
    // Numbered are the draws of one simulation, by axis or column.
    noise_coefficients,  // of a model, within their uncertainty
    sensor_parameters,   // the others
    stand_ins,           // for samples that are missing
    replicate_reference_noise,
    replicate_clock,
    reference_measured_anew,
    // Numbered are simulations.
    compared_simulations,
    null_simulations,          // of the model as it is given
    null_bias_simulations,     // of the model with its main cause
    simulations_after,         // of the corrected model
    simulations_in_doubt,      // of the corrected model, once more
    measured_gap_simulations,  // of the corrected model, for the parts of the data that judge
    bootstrap_simulations,
};

std::uint64_t derived_seed(std::uint64_t seed, RandomPurpose purpose, std::uint64_t number = 0);

RandomStream derived_stream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t number = 0);

}  // namespace gyrolog
