// The mean regression is generalised least squares of responses in the cosine coefficients of one axis. The
// model's uncertain responses (Prediction::uncertain) are projected out within their prior.
#pragma once

#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/bin_sums.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

// The normal equations are those of c in Y = sum_j c_j G_j + noise. The log likelihood gains b'c - 1/2 c'A c,
// in nats, and gains most at A c = b. The parameters of the uncertain responses move by give + shift c.
struct NormalEquations {
    Matrix A;
    std::vector<double> b;
    Matrix shift;              // a row for each uncertain parameter; empty where the model is certain
    std::vector<double> give;  // by uncertain parameter

    // The function adds other data on the same c; shift and give stay.
    void add(const NormalEquations& other);
    // The most likely c. A direction of which the data know nothing stays at zero.
    std::vector<double> solution() const;
    // The standard deviations of c; 0 in a direction of which the data know nothing.
    std::vector<double> sd() const;
    double gain_nats(std::span<const double> c) const;
    // How far the uncertain parameters move, one by one.
    std::vector<double> moved(std::span<const double> c) const;
};

// Mean responses are the responses on one axis, and what every regression on them needs.
class MeanResponses {
public:
    MeanResponses() = default;
    // `cosines`: coefficients by response. Beyond the last that weighs anything under the model they are cut
    // off.
    MeanResponses(const Prediction& prediction, std::size_t axis, std::vector<std::vector<float>> cosines);

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

    // The equations where the noise has `density`, by bin, two-sided, (rad/s)^2/Hz.
    NormalEquations equations(std::span<const double> density) const;

    // The rest is what fitting c leaves: power by bin, and what the prior of the uncertain responses charges
    // for giving way.
    struct Rest {
        std::vector<double> power;
        double charge_nats = 0.0;
    };
    Rest rest(const NormalEquations& equations, std::span<const double> c) const;

private:
    const Prediction& prediction_;
    const AxisObservation& seen_;
    const UncertainMean& uncertain_;
    const MeanResponses& responses_;
    std::vector<BinSums> products_;  // of the observed coefficients, by response
};

}  // namespace gyrolog
