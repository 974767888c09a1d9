#include "analysis/diagnose/likelihood/bin_sums.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace gyrolog {

namespace {

double sum_of_half(const SpectralBin& bin, std::span<const float> a, std::span<const float> b,
                   std::size_t size) {
    double sum = 0.0;
    for (std::size_t k = bin.first; k < std::min(bin.end, size); ++k) {
        if (bin.has(k)) { sum += static_cast<double>(a[k]) * static_cast<double>(b[k]); }
    }
    return sum;
}

Eigen::Map<const Eigen::ArrayXd> array_of(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

BinSums bin_sums(const SpectralBins& bins, std::span<const float> a, std::span<const float> b) {
    using Coefficients = Eigen::Map<const Eigen::ArrayXf>;
    const std::size_t size = std::min(a.size(), b.size());
    BinSums sums(bins.size(), 0.0);
    for (std::size_t i = 0; i < bins.size() && bins[i].first < size; ++i) {
        const std::size_t first = bins[i].first;
        const auto count = static_cast<Eigen::Index>(std::min(bins[i].end, size) - first);
        if (bins[i].half != Half::both) {
            sums[i] = sum_of_half(bins[i], a, b, size);
            continue;
        }
        sums[i] = (Coefficients(a.data() + first, count).cast<double>() *
                   Coefficients(b.data() + first, count).cast<double>())
                      .sum();
    }
    return sums;
}

BinSums bin_weights(std::span<const double> density, double rate_hz) {
    BinSums weights(density.size());
    std::ranges::transform(density, weights.begin(), [rate_hz](double S) { return 1.0 / (S * rate_hz); });
    return weights;
}

double weighted_sum(const BinSums& sums, const BinSums& weights) {
    return (array_of(sums) * array_of(weights)).sum();
}

void add_multiple(BinSums& sums, double factor, const BinSums& products) {
    for (std::size_t i = 0; i < sums.size(); ++i) { sums[i] += factor * products[i]; }
}

}  // namespace gyrolog
