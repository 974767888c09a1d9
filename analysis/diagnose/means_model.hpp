// What is left of a sensor in means of its samples.
#pragma once

#include <cstddef>

#include "analysis/simulate/effect_signature.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// Not so what single samples show, their codes and their stamps, nor what folds: a mean is no sample.
bool shows_in_means(const EffectSignature& signature);

// As white as they were are what is white and what the converter adds; what does not show is left out. Holds
// for what changes little within `samples`.
SensorModel model_of_means(SensorModel model, std::size_t samples);

}  // namespace gyrolog
