// Where the level of a record's spectrum changes: at the edges of a line or a narrow band.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"

namespace gyrolog {

// The function returns, ascending, the coefficients within `bins` from which on the mean square is another.
//
// `cosines`: of the whole record (numerics/cosine_transform.hpp). A bin is cut about the window that tells
// the most of two levels instead of one, and the three parts are cut likewise. A cut has to pay its
// description (Rissanen, Automatica 14 (1978) 465): ln of the number of windows, and ln(n) / 2 of a bin's n
// coefficients for either level more.
std::vector<std::size_t> level_changes(std::span<const float> cosines, const SpectralBins& bins);

}  // namespace gyrolog
