// What a model leaves open within its stated uncertainty, fitted to the recording: where that takes up a gap,
// no residual shows it, but the values lie outside what the model states.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure noise_coefficients, motion_parameters;
}

void add_model_parameter_curves(const Observation& observation, std::size_t axis,
                                std::vector<GapCurve>& curves);

}  // namespace gyrolog
