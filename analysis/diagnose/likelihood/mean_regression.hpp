// Generalised least squares of responses in the cosine coefficients of one axis, with the model's uncertain
// responses (Prediction::uncertain) projected out within their prior.
#pragma once

#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/bin_sums.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

// Of c in Y = sum c_j G_j + noise: the log likelihood gains b'c - 1/2 c'A c, most at A c = b. The parameters
// of the uncertain responses move by give + shift c.
struct NormalEquations {
    Matrix A;
    std::vector<double> b;
    Matrix shift;              // a row for each uncertain parameter; empty where the model is certain
    std::vector<double> give;  // by uncertain parameter

    // Of other data on the same c; shift and give stay.
    void add(const NormalEquations& other);
    // Most likely c. A direction of which the data know nothing stays at zero.
    std::vector<double> solution() const;
    // Standard deviations of c; 0 in a direction of which the data know nothing.
    std::vector<double> sd() const;
    double gain_nats(std::span<const double> c) const;
    // By uncertain parameter.
    std::vector<double> moved(std::span<const double> c) const;
};

// Responses on one axis, and what every regression on them needs.
class MeanResponses {
public:
    MeanResponses() = default;
    // Cosine coefficients by response. Beyond the last that weighs anything under the model they are cut off.
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

    // Under `density` by bin.
    NormalEquations equations(std::span<const double> density) const;

    // What fitting c leaves: power by bin, and what the prior of the uncertain responses charges for giving
    // way.
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
