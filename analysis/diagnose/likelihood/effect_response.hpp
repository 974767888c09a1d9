// An effect's response is its part in the noise-free answer to the world, in cosine coefficients, rad/s.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"

namespace gyrolog {

namespace resolution {

// A slow response keeps this many of the lowest coefficients.
inline constexpr std::size_t slow_coefficients = 8192;

}  // namespace resolution

// The function returns the change that one entry of a model makes, by axis of the prediction and coefficient,
// for the effect acting on all axes. A slow response does not depend on the rest of the model and is
// remembered for all predictions of one world.
std::array<std::vector<float>, 3> effect_response(const Prediction& prediction, const EffectModel& effect,
                                                  bool slow);

}  // namespace gyrolog
