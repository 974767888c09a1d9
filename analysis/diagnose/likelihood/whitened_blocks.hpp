// Whitened blocks are the whitened samples of an axis in blocks of equal length: how their variance goes
// along the record. Each block's mean is taken off first, so that a slow misfit of the model is no noise.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"

namespace gyrolog {

struct WhitenedBlocks {
    // The length of a block in a record with so many slots.
    static std::size_t length_for(std::size_t slots);

    std::size_t length = 0;        // slots of a block
    std::vector<double> mean;      // by block
    std::vector<double> variance;  // about the mean, without outliers
    // How many normal samples would know the variance as well; 0: too few samples to judge.
    std::vector<double> weight;
    double level = 0.0;  // standard deviation: from the median of the blocks' variances

    std::size_t size() const { return variance.size(); }
    // A dead axis has none.
    bool has_noise() const;
};

WhitenedBlocks whitened_blocks(const Observation& observation, std::size_t axis);

// The function returns the same blocks with the maximum likelihood estimates of the variance for samples of
// Student's t distribution with `nu` degrees of freedom, which know it with 2 nu / (nu + 3) instead of 2 a
// sample (K. L. Lange, R. J. A. Little, J. M. G. Taylor, JASA 84 (1989) 881, section 3).
WhitenedBlocks with_tails(const WhitenedBlocks& blocks, const Observation& observation, std::size_t axis,
                          double nu);

// A histogram of the whitened samples by size, sign aside: bins, then one by one what lies beyond.
struct WhitenedHistogram {
    std::vector<double> at;
    std::vector<double> count;
    double samples = 0.0;

    double moment(int order) const;
    double excess_kurtosis() const;
};

// The function counts the samples less their blocks' means and divided by `scale` of their block (empty: by
// the level).
WhitenedHistogram whitened_histogram(const WhitenedBlocks& blocks, const Observation& observation,
                                     std::size_t axis, const std::vector<double>& scale = {});

}  // namespace gyrolog
