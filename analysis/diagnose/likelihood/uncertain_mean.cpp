#include "analysis/diagnose/likelihood/uncertain_mean.hpp"

#include <utility>

#include "analysis/numerics/cholesky.hpp"

namespace gyrolog {

UncertainMean::UncertainMean(std::vector<UncertainResponse> responses, const SpectralBins& bins)
    : responses_(std::move(responses)) {
    for (std::size_t u = 0; u < responses_.size(); ++u) {
        for (std::size_t v = 0; v <= u; ++v) {
            products_.push_back(bin_sums(bins, responses_[u].cosines, responses_[v].cosines));
        }
    }
}

const BinSums& UncertainMean::products(std::size_t u, std::size_t v) const {
    if (u < v) { std::swap(u, v); }
    return products_[u * (u + 1) / 2 + v];
}

std::vector<BinSums> UncertainMean::products_with(const SpectralBins& bins,
                                                  std::span<const float> cosines) const {
    std::vector<BinSums> products;
    products.reserve(responses_.size());
    for (const UncertainResponse& response : responses_) {
        products.push_back(bin_sums(bins, response.cosines, cosines));
    }
    return products;
}

Matrix UncertainMean::information(const BinSums& weights) const {
    Matrix information(size(), size());
    for (std::size_t u = 0; u < size(); ++u) {
        for (std::size_t v = 0; v <= u; ++v) {
            information(u, v) = information(v, u) = weighted_sum(products(u, v), weights);
        }
        information(u, u) += 1.0 / (responses_[u].sd * responses_[u].sd);
    }
    return information;
}

std::vector<double> UncertainMean::pull(const BinSums& weights, std::span<const BinSums> products,
                                        std::span<const double> at) const {
    std::vector<double> pull(size());
    for (std::size_t u = 0; u < size(); ++u) {
        const double sd = responses_[u].sd;
        pull[u] = weighted_sum(products[u], weights) - at[u] / (sd * sd);
    }
    return pull;
}

std::vector<double> UncertainMean::step(const BinSums& weights, std::span<const BinSums> products,
                                        std::span<const double> at) const {
    return solve_symmetric(information(weights), pull(weights, products, at));
}

}  // namespace gyrolog
