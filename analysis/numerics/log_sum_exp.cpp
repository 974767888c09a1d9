#include "analysis/numerics/log_sum_exp.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {

double log_sum_exp(std::span<const double> terms) {
    const double most = *std::ranges::max_element(terms);
    double sum = 0.0;
    for (const double term : terms) { sum += std::exp(term - most); }
    return most + std::log(sum);
}

}  // namespace gyrolog
