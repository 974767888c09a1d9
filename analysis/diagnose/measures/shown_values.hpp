// Conversions from the numbers of curves to those that people read.
#pragma once

namespace gyrolog {

double as_it_is(double value);
double in_degrees(double angle_rad);

// From ln of a variance ratio to dB: 10 log10 of the ratio.
double variance_dB(double log_variance);

// From the cube root of a variance ratio, less 1, to dB: 10 log10 of the ratio. A band of simulations may
// reach below a ratio of zero; the cube root counts as 0.2 there.
double cube_root_dB(double cube_root_less_1);

}  // namespace gyrolog
