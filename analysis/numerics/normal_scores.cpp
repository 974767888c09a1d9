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
    if (magnitudes_.empty() || !(magnitudes_.back() > 0.0)) { return; }
    parts_per_unit_ = static_cast<double>(magnitudes_.size()) / magnitudes_.back();
    // The largest may fall behind the last part, by rounding.
    const std::size_t parts = magnitudes_.size() + 1;
    below_.reserve(parts + 1);
    for (std::size_t part = 0; part <= parts; ++part) {
        std::size_t below = part == 0 ? 0 : below_.back();
        while (below < magnitudes_.size() && part_of(magnitudes_[below]) < part) { ++below; }
        below_.push_back(below);
    }
}

std::size_t NormalScores::part_of(double magnitude) const {
    return static_cast<std::size_t>(magnitude * parts_per_unit_);
}

double NormalScores::of(double magnitude) const {
    if (scores_.empty()) { return 0.0; }
    if (!(magnitude < magnitudes_.back())) { return scores_.back(); }
    const std::size_t part = part_of(magnitude);
    const auto first = magnitudes_.begin() + static_cast<std::ptrdiff_t>(below_[part]);
    const auto end = magnitudes_.begin() + static_cast<std::ptrdiff_t>(below_[part + 1]);
    const auto above = std::upper_bound(first, end, magnitude) - magnitudes_.begin();
    return scores_[static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - 1, 0))];
}

}  // namespace gyrolog
