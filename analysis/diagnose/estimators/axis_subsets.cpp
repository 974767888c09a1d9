#include "analysis/diagnose/estimators/axis_subsets.hpp"

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

double axis_choice_nats(std::size_t axes) { return std::log(std::exp2(static_cast<double>(axes)) - 1.0); }

double axis_membership_nats(std::size_t axes) { return axes > 1 ? std::log(2.0) : 0.0; }

}  // namespace gyrolog
