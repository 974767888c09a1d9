#include "analysis/recording/neighbour_scatter.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace gyrolog {
namespace {

// Pascal's triangle, with signs in turn.
std::vector<double> difference_coefficients(std::size_t order) {
    std::vector<double> coefficients{1.0};
    for (std::size_t k = 0; k < order; ++k) {
        coefficients.push_back(0.0);
        for (std::size_t i = coefficients.size() - 1; i > 0; --i) { coefficients[i] -= coefficients[i - 1]; }
    }
    return coefficients;
}

}  // namespace

double neighbour_scatter(const Column& column, std::span<const Segment> segments, std::size_t order) {
    const std::vector<double> coefficients = difference_coefficients(order);
    double sum = 0.0;
    std::size_t count = 0;
    for (const Segment& segment : segments) {
        for (std::size_t i = segment.first + order; i < segment.first + segment.count; ++i) {
            double difference = 0.0;
            for (std::size_t k = 0; k <= order; ++k) { difference += coefficients[k] * column.value(i - k); }
            if (!std::isfinite(difference)) { continue; }
            sum += difference * difference;
            ++count;
        }
    }
    if (count == 0) { return 0.0; }
    const double gain =
        std::inner_product(coefficients.begin(), coefficients.end(), coefficients.begin(), 0.0);
    return std::sqrt(sum / (gain * static_cast<double>(count)));
}

}  // namespace gyrolog
