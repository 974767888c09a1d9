// The step of the converter that made a column's numbers.
#pragma once

#include "analysis/recording/recording.hpp"

namespace gyrolog {

// Of a step: where the samples scatter by less, the error of rounding is neither white nor of variance step^2
// / 12 (Widrow and Kollar, Quantization Noise, 2008).
inline constexpr double least_sd_in_steps = 0.4;

// Of counts: their scale. Of real numbers: the step of the grid on which they all lie, to the rounding of a
// printed number; 0 where there is none, and where the samples scatter by less than `least_sd_in_steps` of
// it.
double converter_step(const Column& column);

}  // namespace gyrolog
