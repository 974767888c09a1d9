// Numbers that white noise of the right level and shape has by itself, and that samples which are made in
// another way have not, whatever that way is.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/measures/gap_curves.hpp"

namespace gyrolog {

// By lag in seconds: samples that equal the one before or the one before that, beyond what the lags after
// these show, in standard deviations of a count. Colour makes codes equal at all of these lags, nearly.
GapCurve repeats_curve(const Observation& observation, std::size_t axis);

// By period in seconds, octaves: the most that the autocorrelation has, summed over all multiples of a whole
// number of samples, as the normal deviate that is as rare among as many periods. What comes back every P
// samples has no line that stands out when it is short, but all of its multiples agree.
GapCurve period_curve(const Observation& observation, std::size_t axis);

// By frequency: the largest sum of whitened power over neighbouring coefficients, in windows of several
// widths within a band, over the band's own level where that is above the model's; as the normal deviate that
// is as rare among as many windows. A line that wanders is too weak for its band and too broad for a steady
// line. `edges`: first bin of every band, and the end; bands too low to hold the broadest window are one. x
// is where the window lies.
GapCurve narrow_curve(const Observation& observation, std::size_t axis,
                      const std::vector<std::size_t>& edges);

// The converter's histogram (IEEE Std 1241, code density): 1, the code, or the two neighbours, most at odds
// with the normal density through the codes around, as the normal deviate that is as rare among as many
// codes; 2, even codes against odd ones, in standard deviations of a count. 0 where the model has no step or
// the sensor moves.
GapCurve codes_curve(const Observation& observation, std::size_t axis);

}  // namespace gyrolog
