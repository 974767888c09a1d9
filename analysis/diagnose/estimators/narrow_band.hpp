// Narrowband noise about a frequency that the axes share, with a height of each axis' own.
//
// Windows of the cosine coefficients of every width from a few on that stand out against both neighbours say
// where to look. There the spectral bins, a thirty-second of their frequency wide, are cut into so small ones
// that a line has several across its width; frequency, width and heights are then those of the largest
// Whittle likelihood, with N, B and K fitted again, and so is the shape: a resonance's Lorentzian, or the
// Gaussian of a line whose frequency wanders (simulate/effects/narrowband.cpp). What is narrower than some
// coefficients is a steady line, and not looked for: steady_line.hpp.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

// Whether noise about a frequency is a band that a record of this length and rate can show: between the
// slowest line and half the rate, wider than a steady line, and narrower than its own frequency by the least
// quality.
bool is_band(double f_hz, double width_hz, const Prediction& prediction);
// The number of the prediction's bins within a band's width.
double bins_within(double f_hz, double width_hz, const Prediction& prediction);

MadeEstimator make_narrow_band_estimator(const EffectDefinition& effect,
                                         std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
