// The variance fit tells how the white noise's level goes with something, by the likelihood of block
// variances.
//
// A block's variance v of normal samples, with n degrees of freedom, has the log-likelihood
//   -n/2 (ln s + v / s),    s = s0 h,   h = 1 - share + share g^2
// with g the factor on the white noise's standard deviation and s0 free: the level itself is no evidence.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/whitened_blocks.hpp"

namespace gyrolog {

// The function joins neighbouring blocks to no more than `at_most`.
WhitenedBlocks joined(const WhitenedBlocks& blocks, std::size_t at_most);

// By how much the variances `level`, up to a common factor, fit better than a constant.
double course_gain_nats(const WhitenedBlocks& blocks, std::span<const double> level);

// The standard deviation of the whole that a course with these levels has at level 1.
double unit_level(const WhitenedBlocks& blocks, std::span<const double> level);

// How many times more the blocks, or sums of neighbouring ones, scatter about the course than chance would
// have it, where that is certain; else 1. A gain is worth so many times less. A level that wanders slowly, as
// that of a line whose frequency wanders, follows any slow course by chance.
double overdispersion(const WhitenedBlocks& blocks, std::span<const double> level);

// The degrees of freedom of Student's t that the samples have when each is divided by the level of the blocks
// around it; infinity where they are as good as normal. What the model says stays.
double tails_beside(const WhitenedBlocks& blocks, const Observation& observation, std::size_t axis,
                    double model_nu);

}  // namespace gyrolog
