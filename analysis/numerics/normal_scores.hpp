// Normal scores put what a normal variable of the same rank would be in the place of each number (van der
// Waerden 1952). Powers of scores have the tails that powers of normal noise have, however heavy the
// numbers' own are.
#pragma once

#include <cstddef>
#include <vector>

namespace gyrolog {

// Of magnitudes: a score is the quantile of |z|, z standard normal.
class NormalScores {
public:
    // Of some magnitudes, none or more; their order does not matter.
    explicit NormalScores(std::vector<double> magnitudes);

    // Of the largest of them that is not above it, at the middle of the ranks of those that are equal. 0
    // where there are none.
    double of(double magnitude) const;

private:
    std::size_t part_of(double magnitude) const;

    std::vector<double> magnitudes_;  // that differ
    std::vector<double> scores_;
    // How many of them lie below each of as many equal parts of their range: where the search begins.
    std::vector<std::size_t> below_;
    double parts_per_unit_ = 0.0;
};

}  // namespace gyrolog
