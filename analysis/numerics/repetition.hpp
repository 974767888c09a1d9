// A repetition is a pattern of any shape that comes back with one period in series of unit white noise.
//
// At the h-th harmonic of the period a Fourier coefficient of a series is the sum of the noise's and the
// pattern's. The pattern's is drawn from N(0, v), v = V h^-q, in units of the noise. A coefficient of power P
// (the noise has 1) then has the log Bayes factor P v / (1 + v) - ln(1 + v), in nats, against noise alone.
#pragma once

#include <vector>

namespace gyrolog {

struct Repetition {
    double period_s = 0.0;
    // The evidence is summed over the series that have the pattern, at the strength V and the steepness q
    // that fit best. The logarithm of the number of periods that were tried is taken off.
    double evidence_nats = 0.0;
};

// The function returns the best period of every octave, the longest first. Periods run from a fourth of the
// length down to eight steps. All `series` have one length; their values are step_s apart.
std::vector<Repetition> repetitions(const std::vector<std::vector<float>>& series, double step_s);

}  // namespace gyrolog
