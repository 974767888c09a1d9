#include "analysis/diagnose/mean_regression.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <numeric>

namespace gyrolog {

namespace {

// Of a response's weight, next to nothing even where all but a millionth of it is taken for an uncertain one.
constexpr double weightless = 1e-11;

void cut_tail(const Baseline& baseline, std::size_t axis, std::vector<float>& cosines) {
    const SpectralBins& bins = baseline.bins();
    BinSums weight = bin_sums(bins, cosines, cosines);
    for (std::size_t i = 0; i < bins.size(); ++i) { weight[i] /= baseline.parts(axis)[i].sum(); }
    const double negligible = weightless * std::accumulate(weight.begin(), weight.end(), 0.0);
    std::size_t kept = bins.size();
    double beyond = 0.0;
    while (kept > 1 && (beyond += weight[kept - 1]) <= negligible) { --kept; }
    cosines.resize(std::min(cosines.size(), bins[kept - 1].end));
}

using Vector = Eigen::Map<const Eigen::VectorXd>;
using Matrix = Eigen::Map<const Eigen::MatrixXd>;

Vector vector_of(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

// Column by column.
Matrix matrix_of(std::span<const double> values, std::size_t rows) {
    const auto row_count = static_cast<Eigen::Index>(rows);
    return {values.data(), row_count, static_cast<Eigen::Index>(values.size()) / row_count};
}

template <typename Values>
std::vector<double> values_of(const Values& values) {
    return {values.data(), values.data() + values.size()};
}

// Takes the uncertain responses out of the equations: cross' shift and shift' pull.
void project_out(const UncertainMean& uncertain, const AxisObservation& seen, const BinSums& weights,
                 const MeanResponses& responses, NormalEquations& equations) {
    const std::size_t directions = uncertain.size();
    std::vector<double> crossed;  // by response
    for (std::size_t j = 0; j < responses.size(); ++j) {
        for (std::size_t u = 0; u < directions; ++u) {
            crossed.push_back(weighted_sum(responses.uncertain_products(u, j), weights));
        }
    }
    const Matrix cross = matrix_of(crossed, directions);
    const std::vector<double> information = uncertain.information(weights);
    const Eigen::LDLT<Eigen::MatrixXd> factors(matrix_of(information, directions));
    const std::vector<double> pulled = uncertain.pull(weights, seen.uncertain_products, seen.uncertain_fit);
    const Eigen::MatrixXd shift = -factors.solve(cross);
    const Eigen::VectorXd give = factors.solve(vector_of(pulled));
    const Eigen::MatrixXd A = matrix_of(equations.A, responses.size()) + cross.transpose() * shift;
    const Eigen::VectorXd b = vector_of(equations.b) + shift.transpose() * vector_of(pulled);
    equations = {values_of(A), values_of(b), values_of(shift), values_of(give)};
}

}  // namespace

void NormalEquations::add(const NormalEquations& other) {
    std::ranges::transform(A, other.A, A.begin(), std::plus());
    std::ranges::transform(b, other.b, b.begin(), std::plus());
}

std::vector<double> NormalEquations::solution() const {
    const Eigen::VectorXd c = matrix_of(A, b.size()).completeOrthogonalDecomposition().solve(vector_of(b));
    return values_of(c);
}

std::vector<double> NormalEquations::sd() const {
    const Eigen::MatrixXd covariance =
        matrix_of(A, b.size()).completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::VectorXd sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    return values_of(sd);
}

double NormalEquations::gain_nats(std::span<const double> c) const {
    const Vector at = vector_of(c);
    return at.dot(vector_of(b)) - 0.5 * at.dot(matrix_of(A, b.size()) * at);
}

std::vector<double> NormalEquations::moved(std::span<const double> c) const {
    if (give.empty()) { return {}; }
    const Eigen::VectorXd moved = matrix_of(shift, give.size()) * vector_of(c) + vector_of(give);
    return values_of(moved);
}

MeanResponses::MeanResponses(const Baseline& baseline, std::size_t axis,
                             std::vector<std::vector<float>> cosines)
    : cosines_(std::move(cosines)) {
    for (std::vector<float>& response : cosines_) { cut_tail(baseline, axis, response); }
    for (const std::vector<float>& a : cosines_) {
        for (const std::vector<float>& b : cosines_) { products_.push_back(bin_sums(baseline.bins(), a, b)); }
    }
    const UncertainMean& uncertain = baseline.uncertain(axis);
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        for (const std::vector<float>& response : cosines_) {
            uncertain_products_.push_back(bin_sums(baseline.bins(), uncertain[u].cosines, response));
        }
    }
}

MeanRegression::MeanRegression(const Observation& observation, std::size_t axis,
                               const MeanResponses& responses)
    : baseline_(observation.baseline()),
      seen_(observation.axis(axis)),
      uncertain_(baseline_.uncertain(axis)),
      responses_(responses) {
    for (std::size_t j = 0; j < responses_.size(); ++j) {
        products_.push_back(bin_sums(baseline_.bins(), seen_.cosines, responses_.cosines(j)));
    }
}

NormalEquations MeanRegression::equations(std::span<const double> density) const {
    const BinSums weights = bin_weights(density, baseline_.rate_hz());
    const std::size_t count = responses_.size();
    NormalEquations equations{std::vector<double>(count * count), std::vector<double>(count), {}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        equations.b[i] = weighted_sum(products_[i], weights);
        for (std::size_t j = 0; j <= i; ++j) {
            equations.A[i * count + j] = equations.A[j * count + i] =
                weighted_sum(responses_.products(i, j), weights);
        }
    }
    if (!uncertain_.empty()) { project_out(uncertain_, seen_, weights, responses_, equations); }
    return equations;
}

MeanRegression::Rest MeanRegression::rest(const NormalEquations& equations, std::span<const double> c) const {
    const SpectralBins& bins = baseline_.bins();
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
        const double by = change[i] / (bins[i].count() * baseline_.rate_hz());
        rest.power[i] = std::max(0.0, seen_.power[i] + by);
    }
    return rest;
}

}  // namespace gyrolog
