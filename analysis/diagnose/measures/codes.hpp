// The converter's codes, as in a code density test (IEEE Std 1241): at x = 1 the code, or the two neighbours,
// whose count is most at odds with a Poisson regression of a normal density through the codes around, as the
// normal deviate that chance exceeds as rarely; at x = 2 the difference of even and odd codes, in standard
// deviations. A sensor that moves has zeros: it shows each code for as long as the motion has it.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure codes;
}

void add_codes_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
