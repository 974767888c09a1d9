// Generalised least squares of responses in the cosine coefficients of one axis, with the model's uncertain
// responses (Baseline::uncertain) projected out within their prior.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "analysis/diagnose/observation.hpp"

namespace gyrolog {

// Of c in Y = sum c_j G_j + noise: gain 1/2 b' A^-1 b at c = A^-1 b.
struct NormalEquations {
    Eigen::MatrixXd A;
    Eigen::VectorXd b;
    Eigen::MatrixXd shift;  // of the uncertain responses' parameters for one unit of each c
};

class MeanRegression {
public:
    // For responses of up to `coefficients` cosine coefficients, under `density` by bin.
    MeanRegression(const Observation& observation, std::size_t axis, std::span<const double> density,
                   std::size_t coefficients);

    NormalEquations equations(std::span<const std::vector<float>> responses) const;

    // What fitting c leaves: power by bin, and what the prior of the uncertain responses charges for giving
    // way.
    struct Rest {
        std::vector<double> power;
        double charge_nats = 0.0;
    };
    Rest rest(std::span<const std::vector<float>> responses, const NormalEquations& equations,
              const Eigen::VectorXd& c) const;

private:
    const Observation& observation_;
    std::size_t axis_;
    Eigen::Index coefficients_;
    Eigen::ArrayXd weight_;                     // 1 / (S_k rate) by coefficient, 0 for k = 0
    Eigen::VectorXd weighted_;                  // Y_k times it
    Eigen::MatrixXd uncertain_;                 // responses by column, weighted
    Eigen::VectorXd pull_;                      // what is left to gain from the uncertain responses alone
    Eigen::LDLT<Eigen::MatrixXd> information_;  // of the uncertain responses, with their prior
};

}  // namespace gyrolog
