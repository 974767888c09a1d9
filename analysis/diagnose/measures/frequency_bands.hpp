// Bands of the spectrum, a third of an octave each.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"

namespace gyrolog {

// The function returns the first bin of every band, and the end. Bins that are broader than a band are one
// each.
std::vector<std::size_t> band_edges(const SpectralBins& bins);

// The geometric middle of the bins from `first` to the one before `end`.
double middle_hz(const SpectralBins& bins, std::size_t first, std::size_t end);

}  // namespace gyrolog
