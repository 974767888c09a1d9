// Evidence that an effect seems to have although nothing is behind it: under a model that the likelihoods do
// not describe well, as one with a coarse converter, simulations of that very model show it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "analysis/diagnose/selection/forward_selection.hpp"

namespace gyrolog {

// In nats, by effect: four standard deviations above the mean of 16 simulations of the hypotheses' model; 0
// where that is less. No value when ended early.
std::optional<std::map<std::string, double>> null_bias_nats(const Hypotheses& hypotheses, std::uint64_t seed,
                                                            unsigned threads,
                                                            const std::function<bool()>& told);

}  // namespace gyrolog
