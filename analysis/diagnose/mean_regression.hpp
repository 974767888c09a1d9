// Generalised least squares of responses in the cosine coefficients of one axis, with the model's uncertain
// responses (Baseline::uncertain) projected out within their prior.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "analysis/diagnose/bin_sums.hpp"
#include "analysis/diagnose/observation.hpp"

namespace gyrolog {

// Of c in Y = sum c_j G_j + noise: gain 1/2 b' A^-1 b at c = A^-1 b. The uncertain responses' parameters move
// by give + shift c.
struct NormalEquations {
    Eigen::MatrixXd A;
    Eigen::VectorXd b;
    Eigen::MatrixXd shift;
    Eigen::VectorXd give;
};

// Responses on one axis, and what every regression on them needs.
class MeanResponses {
public:
    MeanResponses() = default;
    // Cosine coefficients by response. Beyond the last that weighs anything under the model they are cut off.
    MeanResponses(const Baseline& baseline, std::size_t axis, std::vector<std::vector<float>> cosines);

    std::size_t size() const { return cosines_.size(); }
    const std::vector<float>& cosines(std::size_t j) const { return cosines_[j]; }
    const BinSums& products(std::size_t i, std::size_t j) const { return products_[i * size() + j]; }
    const BinSums& uncertain_products(std::size_t u, std::size_t j) const {
        return uncertain_products_[u * size() + j];
    }

private:
    std::vector<std::vector<float>> cosines_;
    std::vector<BinSums> products_;
    std::vector<BinSums> uncertain_products_;
};

class MeanRegression {
public:
    // The arguments outlive it.
    MeanRegression(const Observation& observation, std::size_t axis, const MeanResponses& responses);

    // Under `density` by bin.
    NormalEquations equations(std::span<const double> density) const;

    // What fitting c leaves: power by bin, and what the prior of the uncertain responses charges for giving
    // way.
    struct Rest {
        std::vector<double> power;
        double charge_nats = 0.0;
    };
    Rest rest(const NormalEquations& equations, const Eigen::VectorXd& c) const;

private:
    const Baseline& baseline_;
    const AxisObservation& seen_;
    const UncertainMean& uncertain_;
    const MeanResponses& responses_;
    std::vector<BinSums> products_;  // of the observed coefficients, by response
};

}  // namespace gyrolog
