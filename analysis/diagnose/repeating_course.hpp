// An unspecific rival: a mean that repeats itself, whatever its shape.
//
// Under one period, the whitened samples' Fourier coefficients at its harmonics are the noise's plus the
// waveform's. With the waveform's own drawn from N(0, V h^-q) in units of the noise, a coefficient of power P
// (noise: 1) is worth P v / (1 + v) - ln(1 + v) nats, v = V h^-q.
#pragma once

#include "analysis/diagnose/unspecific_rivals.hpp"

namespace gyrolog {

std::optional<UnspecificFinding> find_repeating_course(const Observation& without, const Observation& with);

}  // namespace gyrolog
