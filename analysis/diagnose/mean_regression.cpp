#include "analysis/diagnose/mean_regression.hpp"

#include <algorithm>

namespace gyrolog {

namespace {

// Of a response's weight, next to nothing even where all but a millionth of it is taken for an uncertain one.
constexpr double weightless = 1e-11;

void cut_tail(const Baseline& baseline, std::size_t axis, std::vector<float>& cosines) {
    const SpectralBins& bins = baseline.bins();
    BinSums weight = bin_sums(bins, cosines, cosines);
    for (std::size_t i = 0; i < bins.size(); ++i) {
        weight[static_cast<Eigen::Index>(i)] /= baseline.parts(axis)[i].sum();
    }
    const double negligible = weightless * weight.sum();
    std::size_t kept = bins.size();
    double beyond = 0.0;
    while (kept > 1 && (beyond += weight[static_cast<Eigen::Index>(kept) - 1]) <= negligible) { --kept; }
    cosines.resize(std::min(cosines.size(), bins[kept - 1].end));
}

}  // namespace

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
    const auto count = static_cast<Eigen::Index>(responses_.size());
    NormalEquations equations{Eigen::MatrixXd(count, count), Eigen::VectorXd(count), {}, {}};
    const auto at = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
    for (Eigen::Index i = 0; i < count; ++i) {
        equations.b[i] = (products_[at(i)] * weights).sum();
        for (Eigen::Index j = 0; j <= i; ++j) {
            equations.A(i, j) = equations.A(j, i) = (responses_.products(at(i), at(j)) * weights).sum();
        }
    }
    if (uncertain_.empty()) { return equations; }
    const auto directions = static_cast<Eigen::Index>(uncertain_.size());
    Eigen::MatrixXd cross(directions, count);
    for (Eigen::Index u = 0; u < directions; ++u) {
        for (Eigen::Index j = 0; j < count; ++j) {
            cross(u, j) = (responses_.uncertain_products(at(u), at(j)) * weights).sum();
        }
    }
    const Eigen::LDLT<Eigen::MatrixXd> information = uncertain_.information(weights);
    const Eigen::VectorXd pull = uncertain_.pull(weights, seen_.uncertain_products, seen_.uncertain_fit);
    equations.shift = -information.solve(cross);
    equations.give = information.solve(pull);
    equations.A += cross.transpose() * equations.shift;
    equations.b += equations.shift.transpose() * pull;
    return equations;
}

MeanRegression::Rest MeanRegression::rest(const NormalEquations& equations, const Eigen::VectorXd& c) const {
    const SpectralBins& bins = baseline_.bins();
    const auto size = static_cast<Eigen::Index>(bins.size());
    // Sums of squares of what is left, from the products alone.
    BinSums change = BinSums::Zero(size);
    const auto at = [&c](std::size_t j) { return c[static_cast<Eigen::Index>(j)]; };
    for (std::size_t i = 0; i < responses_.size(); ++i) {
        change -= 2.0 * at(i) * products_[i];
        for (std::size_t j = 0; j < responses_.size(); ++j) {
            change += at(i) * at(j) * responses_.products(i, j);
        }
    }
    Rest rest;
    if (!uncertain_.empty()) {
        const Eigen::VectorXd moved = equations.shift * c + equations.give;
        for (std::size_t u = 0; u < uncertain_.size(); ++u) {
            const double by = moved[static_cast<Eigen::Index>(u)];
            change -= 2.0 * by * seen_.uncertain_products[u];
            for (std::size_t j = 0; j < responses_.size(); ++j) {
                change += 2.0 * by * at(j) * responses_.uncertain_products(u, j);
            }
            for (std::size_t v = 0; v < uncertain_.size(); ++v) {
                change += by * moved[static_cast<Eigen::Index>(v)] * uncertain_.products(u, v);
            }
            const double before = seen_.uncertain_fit[u];
            const double after = before + by;
            const double sd = uncertain_[u].sd;
            rest.charge_nats += 0.5 * (after * after - before * before) / (sd * sd);
        }
    }
    rest.power.resize(bins.size());
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const double by = change[static_cast<Eigen::Index>(i)] / (bins[i].count() * baseline_.rate_hz());
        rest.power[i] = std::max(0.0, seen_.power[i] + by);
    }
    return rest;
}

}  // namespace gyrolog
