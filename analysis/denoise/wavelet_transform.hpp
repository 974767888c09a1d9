// One level of the discrete wavelet transform with Daubechies' wavelet of four vanishing moments (db4), of a
// signal continued beyond its ends by its mirror image (half a sample beyond the last one).
//
// Filter: I. Daubechies, "Ten Lectures on Wavelets" (1992), table 6.1, N = 4. Alignment and length as in
// MATLAB's and PyWavelets' mode "symmetric": n samples give floor((n + 7) / 2) approximations and as many
// details, from which the n samples come back exactly.
#pragma once

#include <cstddef>
#include <span>

namespace gyrolog {

inline constexpr std::size_t wavelet_taps = 8;

inline constexpr std::size_t coefficients_of(std::size_t samples) { return (samples + wavelet_taps - 1) / 2; }

// Levels of which the coarsest still has a coefficient that no end has touched: floor(log2(n / 7)).
int levels_of(std::size_t samples);

// `approximation` and `detail` take coefficients_of(signal.size()) each; one sample at least.
void analyse_level(std::span<const double> signal, std::span<double> approximation, std::span<double> detail);

// The samples first, first + 1, ... of the signal that has these coefficients.
void restore_level(std::span<const double> approximation, std::span<const double> detail, std::size_t first,
                   std::span<double> samples);

}  // namespace gyrolog
