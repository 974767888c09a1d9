// An effect's part in the noise-free answer to the world, in cosine coefficients.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"

namespace gyrolog {

// Of a slow response, only so many of the lowest coefficients are kept.
inline constexpr std::size_t slow_coefficients = 8192;

// The change that one entry of a model makes, by axis of the prediction and coefficient, for the effect
// acting on all axes. A slow response does not depend on the rest of the model and is remembered for all
// predictions of one world.
std::array<std::vector<float>, 3> effect_response(const Prediction& prediction, const EffectModel& effect,
                                                  bool slow);

}  // namespace gyrolog
