// The line is a steady sinusoid, on all axes at one frequency with an amplitude and a phase of each axis'
// own. The effect's parameters are f_hz, amplitude_dps and phase_rad.
//
// The search finds coefficients next to each other whose squares, against the expected density, are too large
// together. Where they are, the sinusoid is fitted with its frequency (steady_line.hpp). The floor that it
// stands on is the expected density or, where the coefficients around it show more once the line is taken
// off, theirs: a broad excess is no line, and of one that wanders only what a steady one explains counts.
//
// The evidence pays Laplace's factor of the frequency, uniform from 0 to half the rate. With the standard
// deviation of a line of gain z that is ln(1.02 n/2 sqrt(z)), n the samples: what noise alone exceeds by
// chance somewhere in a spectrum (R. V. Baluev, MNRAS 385 (2008) 1279). It pays for each axis' amplitude and
// phase, too.
//
// The frequency is that of the samples, below half the rate: the true one may be folded.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_line_estimator(const EffectDefinition& effect,
                                  std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
