// Spectral bins gather the cosine coefficients of a record by frequency.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/half.hpp"

namespace gyrolog {

// A bin holds the coefficients first ... end - 1, those of them that the half has. At low frequencies it
// holds one, then a share of an octave; a bin within which the record's level changes is cut there.
struct SpectralBin {
    std::size_t first = 1;
    std::size_t end = 2;
    double f_hz = 0.0;  // geometric middle
    Half half = Half::both;
    double number = 1.0;
    std::size_t uncut_first = 1;  // of the bin that this one is a part of

    bool has(std::size_t k) const { return has_coefficient(half, k); }
    double count() const { return number; }
};
using SpectralBins = std::vector<SpectralBin>;

// The function returns the bins of a record of `length` samples, cut before the coefficients `cuts`
// (ascending). None is empty.
SpectralBins spectral_bins(std::size_t length, double rate_hz, Half half = Half::both,
                           std::span<const std::size_t> cuts = {});

// The mean over the bins' coefficients of a density by bin.
double mean_density(const SpectralBins& bins, std::span<const double> density);

}  // namespace gyrolog
