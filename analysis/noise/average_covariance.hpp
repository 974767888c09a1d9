// What each kind of noise does to the averages of neighbouring samples.
//
// For a noise whose coefficient is 1, the covariance of two averages of `span_s` seconds each, `lag` averages
// apart. Random walk and flicker have no finite variance: theirs is known up to a constant, which contrasts
// (weights that sum to zero) cancel. With the generalised covariance G(t) of the angle,
//   c(lag) = (2 G(t) - G(t - span) - G(t + span)) / span^2,  t = lag span
//   angle noise     Q   G = 1 at t = 0, else 0
//   white           N   G = -|t| / 2
//   flicker         B   G = t^2 ln|t| / (2 pi)
//   random walk     K   G = |t|^3 / 12
// whose Allan variance c(0) - c(1) is that of noise_model.hpp. Samples count as averages over their interval.
#pragma once

#include <cstdint>
#include <functional>

#include "analysis/noise/noise_fit.hpp"

namespace gyrolog {

struct AverageCovariance {
    std::function<double(std::int64_t lag, double span_s)> of_unit_square;
    bool per_sample = false;  // an average with a share of its samples missing has so much more of it
};

// Of Q, N, B or K; R is no noise.
AverageCovariance average_covariance(NoiseTerm term);

// Of Gauss-Markov noise of variance 1.
AverageCovariance gauss_markov_covariance(double correlation_s);

// Of white noise that came through a Butterworth low-pass filter of the second order (effects/lowpass.cpp)
// and was then sampled: its covariance is Re(C z^k), k samples apart, with
//   q = 2 pi bandwidth / (sqrt 2 rate),  C proportional to 1 - i,  z = exp(-q + i q)
// and those of averages of m samples are geometric series of it. The coefficient, 1, is the square root of
// the samples' density at low frequencies.
AverageCovariance filtered_white_covariance(double bandwidth_hz, double rate_hz);

// Of a sinusoid of amplitude 1 and unknown phase, sampled without averaging within a sample.
AverageCovariance sinusoid_covariance(double frequency_hz, double rate_hz);

}  // namespace gyrolog
