// The uncertain mean is the directions in which a model's noise-free answer is uncertain by its own
// statement: the gains of M, the latency, the clock.
#pragma once

#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/bin_sums.hpp"
#include "analysis/numerics/matrix.hpp"

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

    // The sums over each bin of the products of two responses.
    const BinSums& products(std::size_t u, std::size_t v) const;
    // The same of each response with other coefficients.
    std::vector<BinSums> products_with(const SpectralBins& bins, std::span<const float> cosines) const;

    // The information matrix of the parameters, with their prior, where each bin's coefficients weigh so
    // much.
    Matrix information(const BinSums& weights) const;
    // The gradient of the log posterior at the parameters `at`, where what is left of the coefficients has
    // these products with the responses.
    std::vector<double> pull(const BinSums& weights, std::span<const BinSums> products,
                             std::span<const double> at) const;
    // The Newton step information^-1 pull: how far the parameters move to their most likely values.
    std::vector<double> step(const BinSums& weights, std::span<const BinSums> products,
                             std::span<const double> at) const;

private:
    std::vector<UncertainResponse> responses_;
    std::vector<BinSums> products_;  // by pair, the lower triangle row by row
};

}  // namespace gyrolog
