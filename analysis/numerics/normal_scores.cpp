#include "analysis/numerics/normal_scores.hpp"

#include <algorithm>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

NormalScores::NormalScores(std::vector<double> magnitudes) {
    std::ranges::sort(magnitudes);
    const std::size_t count = magnitudes.size();
    for (std::size_t first = 0, end = 0; first < count; first = end) {
        while (end < count && magnitudes[end] == magnitudes[first]) { ++end; }
        const double smaller = 0.5 * static_cast<double>(first + end) / static_cast<double>(count);
        magnitudes_.push_back(magnitudes[first]);
        scores_.push_back(normal_upper_quantile(0.5 * (1.0 - smaller)));
    }
}

double NormalScores::of(double magnitude) const {
    if (scores_.empty()) { return 0.0; }
    const auto above = std::ranges::upper_bound(magnitudes_, magnitude) - magnitudes_.begin();
    return scores_[static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - 1, 0))];
}

}  // namespace gyrolog
