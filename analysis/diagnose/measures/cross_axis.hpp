// The correlation of two axes by frequency: of their cosine coefficients in each third of an octave, in its
// standard deviations. x is in Hz.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure cross_axis;
}

// The function adds a curve for each axis beyond `axis`.
void add_cross_axis_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
