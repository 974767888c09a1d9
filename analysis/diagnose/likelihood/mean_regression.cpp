#include "analysis/diagnose/likelihood/mean_regression.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/matrix_products.hpp"
#include "analysis/numerics/pseudo_inverse.hpp"

namespace gyrolog::resolution {

// Of a response's weight, next to nothing even where all but a millionth of it is taken for an uncertain one.
constexpr double weightless = 1e-11;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

void cut_tail(const Prediction& prediction, std::size_t axis, std::vector<float>& cosines) {
    const SpectralBins& bins = prediction.bins();
    BinSums weight = bin_sums(bins, cosines, cosines);
    for (std::size_t i = 0; i < bins.size(); ++i) { weight[i] /= prediction.parts(axis)[i].sum(); }
    const double negligible = resolution::weightless * std::accumulate(weight.begin(), weight.end(), 0.0);
    std::size_t kept = bins.size();
    double beyond = 0.0;
    while (kept > 1 && (beyond += weight[kept - 1]) <= negligible) { --kept; }
    cosines.resize(std::min(cosines.size(), bins[kept - 1].end));
}

void add(Matrix& sum, const Matrix& more) {
    std::ranges::transform(sum.values(), more.values(), sum.values().begin(), std::plus());
}

void add(std::vector<double>& sum, std::span<const double> more) {
    std::ranges::transform(sum, more, sum.begin(), std::plus());
}

// Takes the uncertain responses out of the equations.
void project_out(const UncertainMean& uncertain, const AxisObservation& seen, const BinSums& weights,
                 const MeanResponses& responses, NormalEquations& equations) {
    Matrix cross(uncertain.size(), responses.size());
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        for (std::size_t j = 0; j < responses.size(); ++j) {
            cross(u, j) = weighted_sum(responses.uncertain_products(u, j), weights);
        }
    }
    const Matrix information = uncertain.information(weights);
    const std::vector<double> pull = uncertain.pull(weights, seen.uncertain_products, seen.uncertain_fit);
    equations.shift = solve_symmetric(information, cross);
    for (double& value : equations.shift.values()) { value = -value; }
    equations.give = solve_symmetric(information, pull);
    add(equations.A, transposed_product(cross, equations.shift));
    add(equations.b, transposed_product(equations.shift, pull));
}

}  // namespace

void NormalEquations::add(const NormalEquations& other) {
    gyrolog::add(A, other.A);
    gyrolog::add(b, other.b);
}

std::vector<double> NormalEquations::solution() const { return product(pseudo_inverse(A), b); }

std::vector<double> NormalEquations::sd() const {
    const Matrix covariance = pseudo_inverse(A);
    std::vector<double> sd(b.size());
    for (std::size_t j = 0; j < sd.size(); ++j) { sd[j] = std::sqrt(std::max(0.0, covariance(j, j))); }
    return sd;
}

double NormalEquations::gain_nats(std::span<const double> c) const {
    return dot(c, b) - 0.5 * dot(c, product(A, c));
}

std::vector<double> NormalEquations::moved(std::span<const double> c) const {
    if (give.empty()) { return {}; }
    std::vector<double> moved = product(shift, c);
    gyrolog::add(moved, give);
    return moved;
}

MeanResponses::MeanResponses(const Prediction& prediction, std::size_t axis,
                             std::vector<std::vector<float>> cosines)
    : cosines_(std::move(cosines)) {
    for (std::vector<float>& response : cosines_) { cut_tail(prediction, axis, response); }
    for (const std::vector<float>& a : cosines_) {
        for (const std::vector<float>& b : cosines_) {
            products_.push_back(bin_sums(prediction.bins(), a, b));
        }
    }
    const UncertainMean& uncertain = prediction.uncertain(axis);
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        for (const std::vector<float>& response : cosines_) {
            uncertain_products_.push_back(bin_sums(prediction.bins(), uncertain[u].cosines, response));
        }
    }
}

MeanRegression::MeanRegression(const Observation& observation, std::size_t axis,
                               const MeanResponses& responses)
    : prediction_(observation.prediction()),
      seen_(observation.axis(axis)),
      uncertain_(prediction_.uncertain(axis)),
      responses_(responses) {
    for (std::size_t j = 0; j < responses_.size(); ++j) {
        products_.push_back(bin_sums(prediction_.bins(), seen_.cosines, responses_.cosines(j)));
    }
}

NormalEquations MeanRegression::equations(std::span<const double> density) const {
    const BinSums weights = bin_weights(density, prediction_.rate_hz());
    const std::size_t count = responses_.size();
    NormalEquations equations{Matrix(count, count), std::vector<double>(count), {}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        equations.b[i] = weighted_sum(products_[i], weights);
        for (std::size_t j = 0; j <= i; ++j) {
            equations.A(i, j) = equations.A(j, i) = weighted_sum(responses_.products(i, j), weights);
        }
    }
    if (!uncertain_.empty()) { project_out(uncertain_, seen_, weights, responses_, equations); }
    return equations;
}

MeanRegression::Rest MeanRegression::rest(const NormalEquations& equations, std::span<const double> c) const {
    const SpectralBins& bins = prediction_.bins();
    // Sums of squares of what is left, from the products alone.
    BinSums change(bins.size(), 0.0);
    for (std::size_t i = 0; i < responses_.size(); ++i) {
        add_multiple(change, -2.0 * c[i], products_[i]);
        for (std::size_t j = 0; j < responses_.size(); ++j) {
            add_multiple(change, c[i] * c[j], responses_.products(i, j));
        }
    }
    Rest rest;
    const std::vector<double> moved = equations.moved(c);
    for (std::size_t u = 0; u < moved.size(); ++u) {
        const double by = moved[u];
        add_multiple(change, -2.0 * by, seen_.uncertain_products[u]);
        for (std::size_t j = 0; j < responses_.size(); ++j) {
            add_multiple(change, 2.0 * by * c[j], responses_.uncertain_products(u, j));
        }
        for (std::size_t v = 0; v < moved.size(); ++v) {
            add_multiple(change, by * moved[v], uncertain_.products(u, v));
        }
        const double before = seen_.uncertain_fit[u];
        const double after = before + by;
        const double sd = uncertain_[u].sd;
        rest.charge_nats += 0.5 * (after * after - before * before) / (sd * sd);
    }
    rest.power.resize(bins.size());
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const double by = change[i] / (bins[i].count() * prediction_.rate_hz());
        rest.power[i] = std::max(0.0, seen_.power[i] + by);
    }
    return rest;
}

}  // namespace gyrolog
