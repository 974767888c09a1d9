// Logarithm, exponential and normal quantile with the same bits on every machine: only + - * / sqrt and exact
// integer steps, never the C library's own functions, whose last digit differs from one to the next.
#pragma once

namespace gyrolog {

// Natural logarithm of a positive, normal x. Error below 1e-15 relative, or absolute near x = 1.
double portable_log(double x);

// e^x for |x| <= 700. Relative error below 1e-15.
double portable_exp(double x);

// z with P(standard normal > z) = p, for 1e-300 < p <= 0.5. Relative error about 1e-15.
// Source: M. J. Wichura, Algorithm AS 241 (PPND16), Applied Statistics 37 (1988) 477-484.
double upper_normal_quantile(double p);

// sin(2 pi turns), turns below 2^50. Error below 1e-15.
double portable_sine_of_turns(double turns);

}  // namespace gyrolog
