// Directions in which a model's noise-free answer is uncertain by its own statement: gains of M, the latency,
// the clock.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "analysis/diagnose/bin_sums.hpp"

namespace gyrolog {

struct UncertainResponse {
    std::vector<float> cosines;  // of the change for one unit of the parameter
    double sd = 0.0;             // of the parameter
};

class UncertainMean {
public:
    UncertainMean() = default;
    UncertainMean(std::vector<UncertainResponse> responses, const SpectralBins& bins);

    bool empty() const { return responses_.empty(); }
    std::size_t size() const { return responses_.size(); }
    const UncertainResponse& operator[](std::size_t u) const { return responses_[u]; }

    // sum over a bin of the products of two responses.
    const BinSums& products(std::size_t u, std::size_t v) const;
    // Of each response with other coefficients.
    std::vector<BinSums> products_with(const SpectralBins& bins, std::span<const float> cosines) const;

    // Of the parameters, with their prior, where each bin's coefficients weigh so much.
    Eigen::LDLT<Eigen::MatrixXd> information(const BinSums& weights) const;
    // Towards which the parameters are pulled from where they are, `at`: what is left of the coefficients has
    // these products with the responses.
    Eigen::VectorXd pull(const BinSums& weights, std::span<const BinSums> products,
                         std::span<const double> at) const;

private:
    std::vector<UncertainResponse> responses_;
    std::vector<BinSums> products_;  // by pair, the lower triangle row by row
};

}  // namespace gyrolog
