// What comes back: the autocorrelation of the whitened samples, summed over the multiples of a period; of
// every octave of periods the best, as the normal deviate that chance exceeds as rarely. x is the octave's
// middle in s.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure period;
}

void add_period_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
