// A gain band is where in the spectrum most of a gain arises.
#pragma once

#include <limits>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The function returns the gain of one bin whose density goes from `before` to `after`, in nats.
double bin_gain_nats(const SpectralBin& bin, double power, double before, double after);

// The function returns the averaging times at which the Allan deviation looks at a band, none beyond the
// longest.
Span averaging_times_of(const Span& band_hz, double longest_s = std::numeric_limits<double>::infinity());

// The function puts into `where` the band outside of which a twentieth of the gains lies on either side, and
// the averaging times at which the Allan deviation looks at it. Losses count as nothing.
void put_gain_band(const SpectralBins& bins, std::vector<double> gains_nats, Place& where);

}  // namespace gyrolog
