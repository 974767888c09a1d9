#include "analysis/noise/likelihood_maximum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/matrix_products.hpp"

namespace gyrolog {
namespace {

// The Newton step of the components that are free to move, in units of their own scale.
std::vector<double> scoring_step(const NoiseLikelihood::Evaluation& at,
                                 const std::vector<std::size_t>& moving) {
    Matrix information = at.information.part(moving, moving);
    std::vector<double> scale;
    std::vector<double> gradient;
    for (std::size_t i = 0; i < moving.size(); ++i) {
        scale.push_back(1.0 / std::sqrt(std::max(information(i, i), 1e-300)));
        gradient.push_back(at.gradient[moving[i]] * scale.back());
    }
    information = scaled_on_both_sides(std::move(information), scale);
    for (std::size_t i = 0; i < moving.size(); ++i) { information(i, i) += 1e-9; }
    const std::vector<double> solved = solve_symmetric(information, gradient);
    std::vector<double> step(at.gradient.size(), 0.0);
    for (std::size_t i = 0; i < moving.size(); ++i) { step[moving[i]] = scale[i] * solved[i]; }
    return step;
}

LikelihoodMaximum with_held(const NoiseLikelihood& likelihood, const LikelihoodMaximum& from,
                            std::size_t component, double square) {
    std::vector<double> start = from.squares;
    start[component] = square;
    return maximise(likelihood, start, std::array{component});
}

// The distance from the maximum, on one side, at which the root of twice the drop is `sigmas`. The root grows
// nearly in proportion to the distance, so a few corrections in proportion find it; a bracket guards them.
double crossing(const NoiseLikelihood& likelihood, LikelihoodMaximum near, double top_value,
                std::size_t component, double centre, double side, double sigmas, double guess,
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

LikelihoodMaximum maximise(const NoiseLikelihood& likelihood, std::span<const double> start,
                           std::span<const std::size_t> held) {
    constexpr int most_steps = 40;
    constexpr double settled = 1e-7;  // gain that a further step promises
    NoiseLikelihood::Evaluation at = likelihood.evaluate(start);
    LikelihoodMaximum best{{start.begin(), start.end()}, at.value};
    if (!std::isfinite(best.value)) { return best; }
    for (int pass = 0; pass < most_steps; ++pass) {
        std::vector<std::size_t> moving;
        for (std::size_t j = 0; j < start.size(); ++j) {
            if (std::ranges::find(held, j) != held.end()) { continue; }
            if (best.squares[j] > 0.0 || at.gradient[j] > 0.0) { moving.push_back(j); }
        }
        if (moving.empty()) { break; }
        const std::vector<double> step = scoring_step(at, moving);
        if (0.5 * dot(at.gradient, step) < settled) { break; }
        const auto stepped = [&](double part) {
            std::vector<double> squares = best.squares;
            for (std::size_t j = 0; j < step.size(); ++j) {
                squares[j] = std::max(squares[j] + part * step[j], 0.0);
            }
            return squares;
        };
        // Most steps are taken whole: then the derivatives are there for the next one.
        LikelihoodMaximum next{stepped(1.0), 0.0};
        at = likelihood.evaluate(next.squares);
        next.value = at.value;
        const bool whole = next.value >= best.value;
        for (int halving = 1; halving < 30 && !(next.value >= best.value); ++halving) {
            next.squares = stepped(std::exp2(-halving));
            next.value = likelihood.value(next.squares);
        }
        if (!(next.value >= best.value)) { break; }
        const double gain = next.value - best.value;
        best = std::move(next);
        if (gain < settled) { break; }
        if (!whole) { at = likelihood.evaluate(best.squares); }
    }
    return best;
}

SquareInterval profile_interval(const NoiseLikelihood& likelihood, const LikelihoodMaximum& maximum,
                                std::size_t component, double sigmas, double sd) {
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
                        std::size_t component) {
    if (maximum.squares[component] == 0.0) { return 0.0; }
    const double without = with_held(likelihood, maximum, component, 0.0).value;
    return std::isfinite(without) ? std::max(0.0, 2.0 * (maximum.value - without))
                                  : std::numeric_limits<double>::infinity();
}

}  // namespace gyrolog
