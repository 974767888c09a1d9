// Power spectral density of a uniformly sampled signal with holes.
//
// Two-sided, so that white noise N has the density N^2 (noise_model.hpp), and the sum of the density over
// -rate/2 ... rate/2 is the variance. Unit: the column's, squared, per Hz.
#pragma once

#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/spectrum/averaged_periodogram.hpp"

namespace gyrolog {

struct SpectrumPoint {
    double f_hz = 0.0;  // of the band it averages, the geometric middle
    double density = 0.0;
    double lo = 0.0;  // confidence interval by chi-square
    double hi = 0.0;
    double dof = 0.0;       // degrees of freedom: 2 density^2 / its variance
    double width_hz = 0.0;  // of the band; bands do not overlap, and join where every one has a bin
};

struct PowerSpectrum {
    double confidence = 0.683;
    std::vector<SpectrumPoint> points;  // by rising frequency, evenly on a logarithmic axis
};

struct SpectrumOptions {
    double confidence = 0.683;
    int points_per_decade = 40;
    double least_dof = 6.0;  // bands are made wider until they have as many; the lowest may have fewer
};

// From two periods in the longest segment up to half the rate. Empty for fewer than 16 samples in the longest
// segment. The lowest point of a spectrum that rises towards 0 as steeply as 1/f^2 comes out high, by some 40
// %: the taper smears each bin over four.
PowerSpectrum power_spectrum(const Column& column, std::span<const Segment> segments, double rate_hz,
                             const SpectrumOptions& options = {});
PowerSpectrum power_spectrum(std::span<const AveragedPeriodogram> periodograms,
                             const SpectrumOptions& options = {});

}  // namespace gyrolog
