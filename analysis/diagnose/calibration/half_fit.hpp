// A half fit has the causes of a whole recording as one half of it alone shows them (likelihood/half.hpp), so
// that the other half can judge them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// Whether half a recording tells the effect: not where it lies in few coefficients, which may all be in one
// half, or in counts.
bool can_be_halved(const std::string& effect, const Prediction& prediction);

// The function fits each cause to the half that `half` keeps to, the others in the model, in two rounds.
// Causes that cannot be halved stay as they are; what the half has no trace of has no value.
std::vector<std::optional<Finding>> fitted_to_half(const std::shared_ptr<const Prediction>& half,
                                                   const std::shared_ptr<const Recording>& recording,
                                                   const std::vector<Finding>& causes, std::uint64_t seed);

}  // namespace gyrolog
