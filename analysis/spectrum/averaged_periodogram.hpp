// Averaged periodograms of a signal with holes, from the whole record down to its longest unbroken stretch.
//
//   P_k = |sum_t w_t x_t exp(-2 pi i k t / n)|^2 / (rate sum_t w_t^2),   w_t = sin^2(pi t / n)
//
// averaged over pieces of n samples that overlap by half (Welch 1967, "The use of fast Fourier transform for
// the estimation of power spectra"). Two-sided. The taper's side lobes fall by 18 dB an octave, so that
// spectra as steep as 1/f^2 do not leak upwards.
//
// What pieces of a bounded length do not resolve is looked at in the decimated signal, and so on until one
// piece holds the longest stretch: memory and time do not grow with the resolution. Nothing is filled in: a
// piece lies between two holes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct AveragedPeriodogram {
    double rate_hz = 0.0;      // of the decimated signal
    std::size_t length = 0;    // n
    std::size_t pieces = 0;    // averaged
    std::size_t overlaps = 0;  // pairs of pieces that share half of their samples
    // Bins that describe the signal, and among them those that no shorter length of a higher rate covers.
    std::size_t valid_begin = 0, valid_end = 0;
    std::size_t begin = 0, end = 0;
    std::vector<double> density;  // of bins 0 ... valid_end - 1, unit of the column squared, per Hz
    // By the octave of the frequency, bins 2^i ... 2^(i+1) - 1: the share of the record that its power there
    // comes from; 1 for noise that is the same throughout, 1/10 where all is in a tenth of the time.
    std::vector<double> evenness;

    double width_hz() const { return rate_hz / static_cast<double>(length); }
    double f_hz(std::size_t bin) const { return static_cast<double>(bin) * width_hz(); }
    double evenness_at(std::size_t bin) const;  // 1 for bin 0
    // Of the mean of so many neighbouring bins of even noise, under a spectrum that is flat across them: 2
    // mean^2 / variance, with the correlation that taper and overlap bring. Two for a single bin of a single
    // piece.
    double degrees_of_freedom(std::size_t bins) const;
};

// Correlation of the power in neighbouring bins of one piece, by their distance; 0 from 3 on.
inline constexpr double bin_correlation[] = {1.0, 4.0 / 9.0, 1.0 / 36.0};

// 2^2 3^3 5^4. A power of two takes longer (benchmark_spectrum): its transform's parts fall on each other in
// the cache.
inline constexpr std::size_t longest_piece = 67500;
inline constexpr std::size_t shortest_piece = 16;

// Coarse (high rate, short pieces) to fine. Empty where no stretch has `shortest_piece` samples.
std::vector<AveragedPeriodogram> averaged_periodograms(const Column& column,
                                                       std::span<const Segment> segments, double rate_hz);

}  // namespace gyrolog
