// What repeats itself, whatever its shape, in series of unit white noise.
//
// Under one period, a series' Fourier coefficients at the period's harmonics are the noise's plus the
// pattern's. With the pattern's own drawn from N(0, V h^-q) in units of the noise, a coefficient of power P
// (noise: 1) is worth P v / (1 + v) - ln(1 + v) nats, v = V h^-q.
#pragma once

#include <vector>

namespace gyrolog {

struct Repetition {
    double period_s = 0.0;
    // For the strength and steepness that fit best: of all series that have the pattern, less what looking at
    // as many periods earns by chance.
    double evidence_nats = 0.0;
};

// The best of every octave of periods, the longest first: from a fourth of the length to eight steps.
// `series` are as long as each other; their values are step_s apart.
std::vector<Repetition> repetitions(const std::vector<std::vector<float>>& series, double step_s);

}  // namespace gyrolog
