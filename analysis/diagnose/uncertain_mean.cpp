#include "analysis/diagnose/uncertain_mean.hpp"

#include <Eigen/Cholesky>
#include <utility>

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

std::vector<double> UncertainMean::information(const BinSums& weights) const {
    std::vector<double> information(size() * size());
    for (std::size_t u = 0; u < size(); ++u) {
        for (std::size_t v = 0; v <= u; ++v) {
            information[u * size() + v] = information[v * size() + u] = weighted_sum(products(u, v), weights);
        }
        information[u * size() + u] += 1.0 / (responses_[u].sd * responses_[u].sd);
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
    const auto count = static_cast<Eigen::Index>(size());
    const std::vector<double> matrix = information(weights);
    std::vector<double> step = pull(weights, products, at);
    Eigen::Map<Eigen::VectorXd> solved(step.data(), count);
    solved = Eigen::Map<const Eigen::MatrixXd>(matrix.data(), count, count).ldlt().solve(solved).eval();
    return step;
}

}  // namespace gyrolog
