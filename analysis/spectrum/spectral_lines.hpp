// Lines that stand out of a spectrum: mains, vibration, a clock folded into the band.
//
// Search: the mean density of 1, 4, 16 or 64 neighbouring bins against that of the bins on both sides, at
// every place of every averaged periodogram. The probability that noise with a locally even spectrum exceeds
// that ratio is worked out with the correlation of the bins (saddle point; Lugannani and Rice 1980), and
// multiplied by the number of places looked at (Bonferroni), so that the false alarm probability holds for
// the whole spectrum.
//
// Estimate: least squares of A sin(2 pi f t + phase) beside a local straight line, at the samples' true
// times. Where one frequency and phase do not hold for the whole record (by chi-square of what is left), the
// line is not steady: then its frequency and power are the first moments of what stands above the floor.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/spectrum/averaged_periodogram.hpp"

namespace gyrolog {

struct SpectralLine {
    double f_hz = 0.0;  // as sampled: a line above rate / 2 appears folded
    double f_sd_hz = 0.0;
    double amplitude = 0.0;  // peak, of A sin(2 pi f t + phase), in the column's unit; of a line that is not
                             // steady the root of twice its mean square
    double amplitude_sd = 0.0;
    double false_alarm = 0.0;  // probability that noise alone has such a line anywhere in this spectrum
    bool steady = true;        // one frequency and phase hold for the whole record
    double width_hz = 0.0;     // root mean square about f_hz; 0: steady
};

// The strongest lines with a false alarm probability below `false_alarm`, at most `most`, strongest first.
//
// Standard deviations of a steady line: the Cramer-Rao bound in noise as dense as the floor (Rife and
// Boorstyn 1974; Kay 1993, eq. 3.41, written for a record with holes).
std::vector<SpectralLine> find_lines(const Column& column, std::span<const Segment> segments, double rate_hz,
                                     double false_alarm = 1e-4, std::size_t most = 8);
std::vector<SpectralLine> find_lines(std::span<const AveragedPeriodogram> periodograms, const Column& column,
                                     std::span<const Segment> segments, double rate_hz,
                                     double false_alarm = 1e-4, std::size_t most = 8);

}  // namespace gyrolog
