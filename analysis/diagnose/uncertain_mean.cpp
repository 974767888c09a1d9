#include "analysis/diagnose/uncertain_mean.hpp"

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

Eigen::LDLT<Eigen::MatrixXd> UncertainMean::information(const BinSums& weights) const {
    const auto count = static_cast<Eigen::Index>(size());
    Eigen::MatrixXd information(count, count);
    for (std::size_t u = 0; u < size(); ++u) {
        const auto row = static_cast<Eigen::Index>(u);
        for (std::size_t v = 0; v <= u; ++v) {
            const auto column = static_cast<Eigen::Index>(v);
            information(row, column) = information(column, row) = (products(u, v) * weights).sum();
        }
        information(row, row) += 1.0 / (responses_[u].sd * responses_[u].sd);
    }
    return information.ldlt();
}

Eigen::VectorXd UncertainMean::pull(const BinSums& weights, std::span<const BinSums> products,
                                    std::span<const double> at) const {
    Eigen::VectorXd pull(static_cast<Eigen::Index>(size()));
    for (std::size_t u = 0; u < size(); ++u) {
        const double sd = responses_[u].sd;
        pull[static_cast<Eigen::Index>(u)] = (products[u] * weights).sum() - at[u] / (sd * sd);
    }
    return pull;
}

}  // namespace gyrolog
