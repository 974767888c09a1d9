// Power spectral density of a uniformly sampled signal with holes.
//
// Two-sided, so that white noise N has the density N^2 (noise_model.hpp), and the sum of the density over
// -rate/2 ... rate/2 is the variance. Unit: the column's, squared, per Hz.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct SpectrumPoint {
    double f_hz = 0.0;
    double density = 0.0;
    double lo = 0.0;  // confidence interval by chi-square
    double hi = 0.0;
    double dof = 0.0;  // degrees of freedom: twice the number of independent periodogram ordinates averaged
};

struct PowerSpectrum {
    double confidence = 0.683;
    std::vector<SpectrumPoint> points;  // by rising frequency, evenly on a logarithmic axis
};

// A steady line that stands out of the noise around it.
struct SpectralLine {
    double f_hz = 0.0;  // as sampled: a line above rate / 2 appears folded
    double f_sd_hz = 0.0;
    double amplitude = 0.0;  // peak, of A sin(2 pi f t + phase), in the column's unit
    double amplitude_sd = 0.0;
    double false_alarm = 0.0;  // probability that noise alone has such a line anywhere in this spectrum
};

struct SpectrumOptions {
    double confidence = 0.683;
    int points_per_decade = 20;
};

// Empty for fewer than 16 samples in the longest segment.
PowerSpectrum power_spectrum(const Column& column, std::span<const Segment> segments, double rate_hz,
                             const SpectrumOptions& options = {});

// The strongest lines with a false alarm probability below `false_alarm`, at most `most`, strongest first.
std::vector<SpectralLine> find_lines(const Column& column, std::span<const Segment> segments, double rate_hz,
                                     double false_alarm = 1e-4, std::size_t most = 8);

}  // namespace gyrolog
