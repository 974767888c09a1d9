// How well a record can tell the rate random walk K and the bias instability B, and how long it must be to
// tell them as well as wanted.
//
// The bound of Cramer and Rao with N^2, B^2 and K^2 all unknown, by Whittle's approximation of the
// information in a stationary record of length T (P. Whittle, Ark. Mat. 2, 1953; the spectra are those of
// noise_model.hpp):
//
//   I_ij = T * integral of S_i S_j / S^2 df,  f from 1 / 2T to half the rate;   sd(K) / K = sd(K^2) / (2 K^2)
//
// With N known and no B it is sqrt(2 N / (K T)). The likelihood fit comes within some 15 % of it
// (METHODS.md), so that what is said here of a length is what `analyze` states at that length.
#pragma once

#include <optional>

#include "analysis/allan/power_law_levels.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

// sd(K) / K at best; no value where K is 0 or the record shorter than ten samples. Q and R are left aside.
std::optional<double> walk_relative_sd(const NoiseCoefficients& noise, double rate_hz, double length_s);

// The shortest record that tells K to so much of itself. No value where K is 0, or ten thousand years do not
// suffice.
std::optional<double> length_to_know_walk_s(const NoiseCoefficients& noise, double rate_hz,
                                            double relative_sd);

// The same of B, beside a walk that is not known, or not there: sd(B) / B.
std::optional<double> flicker_relative_sd(const NoiseCoefficients& noise, double rate_hz, double length_s);
std::optional<double> length_to_know_flicker_s(const NoiseCoefficients& noise, double rate_hz,
                                               double relative_sd);

// The walk that a record of this length would have shown, but for one in twenty: K told to 22 % (simulated:
// walk_knowledge_test.cpp), beside N and B as they are. What goes unseen by the power laws is most likely
// below it.
std::optional<double> walk_seen_from(const NoiseCoefficients& noise, double rate_hz, double length_s);

// N, B and K of power laws fitted to an Allan curve.
NoiseCoefficients coefficients_of(const PowerLawLevels& laws, double rate_hz);

}  // namespace gyrolog
