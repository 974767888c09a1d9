// Unnamed forms model what the causes leave: smooth, and without a formula of an effect.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The function fits every form that has evidence, each beside those before it, to what the prediction's model
// leaves of the recording. A finding's effect is that which simulates the form (EffectDefinition::form).
std::vector<Finding> unnamed_forms(std::shared_ptr<const Prediction> prediction,
                                   const std::shared_ptr<const Recording>& recording, std::uint64_t seed);

// The finding as the report has it.
Unnamed unnamed_of(const Finding& finding, const Share& share);

}  // namespace gyrolog
