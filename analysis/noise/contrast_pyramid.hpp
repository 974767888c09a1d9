// A record reduced to what the likelihood of its noise needs.
//
// The samples are taken in blocks of some neighbours. Each block gives its average, and contrasts: its DCT-II
// coefficients k = 1, 2, ..., which do not hold the average. Of the contrasts only the mean square over all
// blocks is kept, one number for each k; the averages are the samples of the next level, until few enough are
// left to be looked at exactly. Every step is an orthogonal transform, so nothing is lost or counted twice.
//
// Why cosines: the contrasts of one block are uncorrelated both for white noise and for a random walk, whose
// inverse covariance is the Laplacian of a path with exactly these eigenvectors (Strang, "The discrete cosine
// transform", SIAM Review 41 (1999)), and nearly so for all that lies between. A Fourier transform's leakage
// would let the slow noise flood the fast one's coefficients.
//
// Holes: contrasts are taken of complete blocks only; an average stands for its block when half of the
// samples are there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct ContrastLevel {
    std::int64_t span = 0;    // samples in each of the averages that a block is made of
    int length = 0;           // averages in a block
    std::int64_t blocks = 0;  // that gave contrasts
    // Mean square of coefficient k + 1 of the orthonormal DCT-II, k = 0 ... length - 2; unit of the column,
    // squared.
    std::vector<double> power;
};

struct TopAverage {
    std::int64_t index = 0;    // on the grid, in units of top_span
    std::int64_t samples = 0;  // that are there
    double value = 0.0;        // about the column's mean
};

struct ContrastPyramid {
    double rate_hz = 0.0;
    std::vector<ContrastLevel> levels;  // from the samples up
    std::int64_t top_span = 1;          // samples in each of the top's averages
    std::vector<TopAverage> top;

    // What the top's averages stand for together, in samples and in time.
    double length() const { return static_cast<double>(top_span) * static_cast<double>(top.size()); }
    double length_s() const { return length() / rate_hz; }
};

inline constexpr std::size_t most_top_averages = 128;

// A record of up to `most_top` samples has no levels: its samples are the top.
ContrastPyramid contrast_pyramid(const Column& column, std::span<const Segment> segments, double rate_hz,
                                 std::size_t most_top = most_top_averages);

// The orthonormal DCT-II of `length` points: row k, column i is sqrt(2 / length) cos(pi k (i + 1/2) /
// length), for k = 1 ... length - 1; row 0, the average, is left out.
std::vector<std::vector<double>> cosine_contrasts(int length);

}  // namespace gyrolog
