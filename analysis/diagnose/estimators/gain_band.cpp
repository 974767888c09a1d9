#include "analysis/diagnose/estimators/gain_band.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {

namespace definition {

// Outside of the band, on either side: a band is where nine tenths lie.
constexpr double outside_share = 0.05;
// The Allan deviation's filter peaks at this frequency times the averaging time.
constexpr double allan_peak_turns = 0.37;

}  // namespace definition

double bin_gain_nats(const SpectralBin& bin, double power, double before, double after) {
    return 0.5 * bin.count() * (std::log(before / after) + power / before - power / after);
}

Span averaging_times_of(const Span& band_hz, double longest_s) {
    return {std::min(definition::allan_peak_turns / band_hz.to, longest_s),
            std::min(definition::allan_peak_turns / band_hz.from, longest_s)};
}

void put_gain_band(const SpectralBins& bins, std::vector<double> gains_nats, Place& where) {
    double sum = 0.0;
    for (double& gain : gains_nats) { sum += gain = std::max(gain, 0.0); }
    double below = 0.0;
    Span band{bins.front().f_hz, bins.back().f_hz};
    for (std::size_t i = 0; i < bins.size(); ++i) {
        if (below < definition::outside_share * sum) { band.from = bins[i].f_hz; }
        if (below < (1.0 - definition::outside_share) * sum) { band.to = bins[i].f_hz; }
        below += gains_nats[i];
    }
    where.freq_hz = band;
    where.tau_s = averaging_times_of(band);
}

}  // namespace gyrolog
