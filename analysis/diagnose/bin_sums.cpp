#include "analysis/diagnose/bin_sums.hpp"

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

}  // namespace

BinSums bin_sums(const SpectralBins& bins, std::span<const float> a, std::span<const float> b) {
    using Coefficients = Eigen::Map<const Eigen::ArrayXf>;
    const std::size_t size = std::min(a.size(), b.size());
    BinSums sums = BinSums::Zero(static_cast<Eigen::Index>(bins.size()));
    for (std::size_t i = 0; i < bins.size() && bins[i].first < size; ++i) {
        const std::size_t first = bins[i].first;
        const auto count = static_cast<Eigen::Index>(std::min(bins[i].end, size) - first);
        if (bins[i].half != Half::both) {
            sums[static_cast<Eigen::Index>(i)] = sum_of_half(bins[i], a, b, size);
            continue;
        }
        sums[static_cast<Eigen::Index>(i)] = (Coefficients(a.data() + first, count).cast<double>() *
                                              Coefficients(b.data() + first, count).cast<double>())
                                                 .sum();
    }
    return sums;
}

BinSums bin_weights(std::span<const double> density, double rate_hz) {
    return (Eigen::Map<const BinSums>(density.data(), static_cast<Eigen::Index>(density.size())) * rate_hz)
        .inverse();
}

}  // namespace gyrolog
