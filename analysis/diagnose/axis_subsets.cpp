#include "analysis/diagnose/axis_subsets.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {

std::vector<std::vector<std::size_t>> axis_subsets(std::span<const std::size_t> axes) {
    std::vector<std::vector<std::size_t>> subsets;
    for (std::size_t bits = 1; bits < std::size_t{1} << axes.size(); ++bits) {
        std::vector<std::size_t> subset;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            if ((bits >> i & 1U) != 0) { subset.push_back(axes[i]); }
        }
        subsets.push_back(std::move(subset));
    }
    std::ranges::stable_sort(subsets, {}, [](const auto& subset) { return subset.size(); });
    return subsets;
}

double log_sum_exp(std::span<const double> terms) {
    const double most = *std::ranges::max_element(terms);
    double sum = 0.0;
    for (const double term : terms) { sum += std::exp(term - most); }
    return most + std::log(sum);
}

}  // namespace gyrolog
