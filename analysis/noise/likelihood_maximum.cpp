#include "analysis/noise/likelihood_maximum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyrolog {
namespace {

// The Newton step of the components that are free to move, in units of their own scale.
Eigen::VectorXd scoring_step(const NoiseLikelihood::Evaluation& at, const std::vector<Eigen::Index>& moving) {
    const auto count = static_cast<Eigen::Index>(moving.size());
    Eigen::MatrixXd information = at.information(moving, moving);
    const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    information = scale.asDiagonal() * information * scale.asDiagonal();
    information += 1e-9 * Eigen::MatrixXd::Identity(count, count);
    const Eigen::VectorXd gradient = at.gradient(moving).cwiseProduct(scale);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(at.gradient.size());
    step(moving) = scale.cwiseProduct(information.ldlt().solve(gradient));
    return step;
}

LikelihoodMaximum with_held(const NoiseLikelihood& likelihood, const LikelihoodMaximum& from,
                            Eigen::Index component, double square) {
    Eigen::VectorXd start = from.squares;
    start[component] = square;
    return maximise(likelihood, start, {component});
}

// The distance from the maximum, on one side, at which the root of twice the drop is `sigmas`. The root grows
// nearly in proportion to the distance, so a few corrections in proportion find it; a bracket guards them.
double crossing(const NoiseLikelihood& likelihood, LikelihoodMaximum near, double top_value,
                Eigen::Index component, double centre, double side, double sigmas, double guess,
                double farthest) {
    double inside = 0.0;
    double outside = farthest;
    double distance = std::min(guess, farthest);
    for (int pass = 0; pass < 12; ++pass) {
        near = with_held(likelihood, near, component, std::max(centre + side * distance, 0.0));
        const double root = std::sqrt(std::max(0.0, 2.0 * (top_value - near.value)));
        if (std::abs(root - sigmas) < 0.01 * sigmas) { break; }
        (root < sigmas ? inside : outside) = distance;
        if (root < sigmas && distance >= farthest) { break; }
        double next = std::isfinite(root) && root > 0.0 ? distance * sigmas / root : 10.0 * distance;
        next = std::clamp(next, distance / 10.0, distance * 10.0);
        if (!(next > inside && next < outside)) {
            next = std::isfinite(outside) ? 0.5 * (inside + outside) : 2.0 * distance;
        }
        distance = next;
    }
    return distance;
}

}  // namespace

LikelihoodMaximum maximise(const NoiseLikelihood& likelihood, const Eigen::VectorXd& start,
                           const std::vector<Eigen::Index>& held) {
    constexpr int most_steps = 40;
    constexpr double settled = 1e-7;  // gain that a further step promises
    LikelihoodMaximum best{start, likelihood.value(start)};
    if (!std::isfinite(best.value)) { return best; }
    for (int pass = 0; pass < most_steps; ++pass) {
        const NoiseLikelihood::Evaluation at = likelihood.evaluate(best.squares);
        std::vector<Eigen::Index> moving;
        for (Eigen::Index j = 0; j < start.size(); ++j) {
            if (std::ranges::find(held, j) != held.end()) { continue; }
            if (best.squares[j] > 0.0 || at.gradient[j] > 0.0) { moving.push_back(j); }
        }
        if (moving.empty()) { break; }
        const Eigen::VectorXd step = scoring_step(at, moving);
        LikelihoodMaximum next;
        for (int halving = 0; halving < 30; ++halving) {
            next.squares = (best.squares + std::exp2(-halving) * step).cwiseMax(0.0);
            next.value = likelihood.value(next.squares);
            if (next.value >= best.value) { break; }
        }
        if (!(next.value >= best.value)) { break; }
        const double gain = next.value - best.value;
        best = std::move(next);
        if (gain < settled) { break; }
    }
    return best;
}

SquareInterval profile_interval(const NoiseLikelihood& likelihood, const LikelihoodMaximum& maximum,
                                Eigen::Index component, double sigmas, double sd) {
    const double centre = maximum.squares[component];
    const double guess = std::max(sigmas * sd, 1e-3 * centre);
    const auto at = [&](double side, double farthest) {
        return crossing(likelihood, maximum, maximum.value, component, centre, side, sigmas, guess, farthest);
    };
    SquareInterval interval;
    interval.hi = centre + at(1.0, std::numeric_limits<double>::infinity());
    if (centre > 0.0) { interval.lo = std::max(0.0, centre - at(-1.0, centre)); }
    return interval;
}

double likelihood_ratio(const NoiseLikelihood& likelihood, const LikelihoodMaximum& maximum,
                        Eigen::Index component) {
    if (maximum.squares[component] == 0.0) { return 0.0; }
    const double without = with_held(likelihood, maximum, component, 0.0).value;
    return std::isfinite(without) ? std::max(0.0, 2.0 * (maximum.value - without))
                                  : std::numeric_limits<double>::infinity();
}

}  // namespace gyrolog
