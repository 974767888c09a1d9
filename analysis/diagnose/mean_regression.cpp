#include "analysis/diagnose/mean_regression.hpp"

#include <algorithm>

namespace gyrolog {

namespace {

Eigen::VectorXd head_of(const std::vector<float>& values, Eigen::Index count) {
    return Eigen::Map<const Eigen::VectorXf>(values.data(), count).cast<double>();
}

}  // namespace

MeanRegression::MeanRegression(const Observation& observation, std::size_t axis,
                               std::span<const double> density, std::size_t coefficients)
    : observation_(observation), axis_(axis), coefficients_(static_cast<Eigen::Index>(coefficients)) {
    const Baseline& baseline = observation.baseline();
    const std::vector<UncertainResponse>& uncertain = baseline.uncertain(axis);
    // The uncertain responses reach as far as the motion does, whatever the effect's response.
    const auto count = uncertain.empty() ? coefficients_ : static_cast<Eigen::Index>(baseline.length());
    Eigen::ArrayXd weight = Eigen::ArrayXd::Zero(count);
    for (std::size_t i = 0; i < baseline.bins().size(); ++i) {
        const SpectralBin& bin = baseline.bins()[i];
        for (std::size_t k = bin.first; k < std::min(bin.end, static_cast<std::size_t>(count)); ++k) {
            weight[static_cast<Eigen::Index>(k)] = 1.0 / (density[i] * baseline.rate_hz());
        }
    }
    const Eigen::VectorXd cosines = head_of(observation.axis(axis).cosines, count);
    const auto directions = static_cast<Eigen::Index>(uncertain.size());
    uncertain_.resize(count, directions);
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(directions, directions);
    for (Eigen::Index u = 0; u < directions; ++u) {
        const UncertainResponse& direction = uncertain[static_cast<std::size_t>(u)];
        uncertain_.col(u) = (head_of(direction.cosines, count).array() * weight).matrix();
        for (Eigen::Index v = 0; v <= u; ++v) {
            information(u, v) = information(v, u) =
                uncertain_.col(u).dot(head_of(uncertain[static_cast<std::size_t>(v)].cosines, count));
        }
        information(u, u) += 1.0 / (direction.sd * direction.sd);
    }
    information_.compute(information);
    pull_ = uncertain_.transpose() * cosines;
    for (Eigen::Index u = 0; u < directions; ++u) {
        const double sd = uncertain[static_cast<std::size_t>(u)].sd;
        pull_[u] -= observation.axis(axis).uncertain_fit[static_cast<std::size_t>(u)] / (sd * sd);
    }
    uncertain_.conservativeResize(coefficients_, Eigen::NoChange);
    weight_ = weight.head(coefficients_);
    weighted_ = (cosines.head(coefficients_).array() * weight_).matrix();
}

NormalEquations MeanRegression::equations(std::span<const std::vector<float>> responses) const {
    const auto count = static_cast<Eigen::Index>(responses.size());
    NormalEquations equations{Eigen::MatrixXd(count, count), Eigen::VectorXd(count), {}};
    Eigen::MatrixXd G(weight_.size(), count);
    for (Eigen::Index j = 0; j < count; ++j) {
        G.col(j) = head_of(responses[static_cast<std::size_t>(j)], weight_.size());
    }
    const Eigen::MatrixXd weighted = G.array().colwise() * weight_;
    equations.A = weighted.transpose() * G;
    equations.b = G.transpose() * weighted_;
    if (uncertain_.cols() > 0) {
        const Eigen::MatrixXd cross = uncertain_.transpose() * G;
        equations.shift = -information_.solve(cross);
        equations.A += cross.transpose() * equations.shift;
        equations.b += equations.shift.transpose() * pull_;
    }
    return equations;
}

MeanRegression::Rest MeanRegression::rest(std::span<const std::vector<float>> responses,
                                          const NormalEquations& equations, const Eigen::VectorXd& c) const {
    const Baseline& baseline = observation_.baseline();
    const AxisObservation& seen = observation_.axis(axis_);
    const std::vector<UncertainResponse>& uncertain = baseline.uncertain(axis_);
    Eigen::VectorXd left = head_of(
        seen.cosines, uncertain.empty() ? coefficients_ : static_cast<Eigen::Index>(baseline.length()));
    for (Eigen::Index j = 0; j < c.size(); ++j) {
        left.head(coefficients_) -= c[j] * head_of(responses[static_cast<std::size_t>(j)], coefficients_);
    }
    Rest rest;
    if (!uncertain.empty()) {
        const Eigen::VectorXd shift = equations.shift * c + information_.solve(pull_);
        for (Eigen::Index u = 0; u < shift.size(); ++u) {
            const UncertainResponse& direction = uncertain[static_cast<std::size_t>(u)];
            left -= shift[u] * head_of(direction.cosines, left.size());
            const double before = seen.uncertain_fit[static_cast<std::size_t>(u)];
            const double after = before + shift[u];
            rest.charge_nats += 0.5 * (after * after - before * before) / (direction.sd * direction.sd);
        }
    }
    rest.power = seen.power;
    for (std::size_t i = 0; i < baseline.bins().size(); ++i) {
        const SpectralBin& bin = baseline.bins()[i];
        const auto first = static_cast<Eigen::Index>(bin.first);
        const auto width = static_cast<Eigen::Index>(bin.end - bin.first);
        // Beyond, there is nothing of the responses.
        if (first + width > left.size()) { break; }
        rest.power[i] = left.segment(first, width).squaredNorm() / (bin.count() * baseline.rate_hz());
    }
    return rest;
}

}  // namespace gyrolog
