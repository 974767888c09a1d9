#include "analysis/noise/noise_projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/numerics/golden_section.hpp"

namespace gyrolog {
namespace {

constexpr double octave_parts = 16.0;
constexpr double infinite = std::numeric_limits<double>::infinity();

double dB(double variance_ratio) { return 10.0 * std::log10(variance_ratio); }

class ProjectionTarget {
public:
    ProjectionTarget(std::span<const NoiseModel> models, double rate_hz, double horizon_s) {
        const double shortest_s = 1.0 / rate_hz;
        const auto steps = static_cast<int>(std::ceil(octave_parts * std::log2(horizon_s / shortest_s)));
        for (int i = 0; i <= steps; ++i) {
            const double tau_s = std::min(shortest_s * std::exp2(i / octave_parts), horizon_s);
            for (const NoiseModel& model : models) {
                tau_s_.push_back(tau_s);
                variance_.push_back(model.allan_variance(tau_s));
            }
        }
    }

    // Of a shape, the ratio to the model at each averaging time.
    template <typename Shape>
    std::vector<double> ratios(const Shape& shape) const {
        std::vector<double> all;
        for (std::size_t i = 0; i < tau_s_.size(); ++i) { all.push_back(shape(tau_s_[i]) / variance_[i]); }
        return all;
    }

    const std::vector<double>& tau_s() const { return tau_s_; }
    const std::vector<double>& variance() const { return variance_; }

private:
    std::vector<double> tau_s_;
    std::vector<double> variance_;
};

// Two shapes, added: a c_1 + b c_2. What matters of the two coefficients is their proportion; the best common
// factor puts the largest and the smallest ratio as far from 1, in dB.
struct Mixture {
    double first = 0.0;
    double second = 0.0;
    double worst_dB = infinite;
};

Mixture best_mixture(const std::vector<double>& first, const std::vector<double>& second,
                     const ProjectionOptions& options) {
    const double first_scale = 1.0 / *std::ranges::max_element(first);
    const double second_scale = 1.0 / *std::ranges::max_element(second);
    const auto mixed = [&](double log_odds) {
        const double share = 1.0 / (1.0 + std::exp(-log_odds));
        return Mixture{(1.0 - share) * first_scale, share * second_scale, 0.0};
    };
    const auto judged = [&](Mixture mixture) {
        double most = 0.0;
        double least = infinite;
        for (std::size_t i = 0; i < first.size(); ++i) {
            const double ratio = mixture.first * first[i] + mixture.second * second[i];
            most = std::max(most, ratio);
            least = std::min(least, ratio);
        }
        const double factor = 1.0 / std::sqrt(most * least);
        return Mixture{mixture.first * factor, mixture.second * factor, dB(std::sqrt(most / least))};
    };
    // Sets where largest / smallest <= a number are cones: along the mixing share there is one valley.
    constexpr double far = 40.0;
    const double at = place_of_top([&](double log_odds) { return -judged(mixed(log_odds)).worst_dB; }, -far,
                                   far, options.log_odds_tolerance_rel);
    const Mixture both = judged(mixed(at));
    const Mixture alone = judged({first_scale, 0.0, 0.0});
    return alone.worst_dB <= both.worst_dB ? alone : both;
}

NoiseProjection with_gauss_markov(const ProjectionTarget& target, const ProjectionOptions& options) {
    const auto white = target.ratios([](double tau_s) { return 1.0 / tau_s; });
    const auto shape_of = [](double correlation_s) {
        return [=](double tau_s) { return GaussMarkov{1.0, correlation_s}.allan_variance(tau_s); };
    };
    const auto mixture_at = [&](double log_correlation) {
        return best_mixture(white, target.ratios(shape_of(std::exp(log_correlation))), options);
    };
    // From less than a sample to where the process is a walk over the whole horizon. The error may have
    // several valleys: the lowest of a net of places is looked at closely.
    const double from = std::log(0.1 * target.tau_s().front());
    const double to = std::log(1000.0 * target.tau_s().back());
    constexpr int net = 48;
    const double step = (to - from) / net;
    double best = from;
    for (int i = 1; i <= net; ++i) {
        if (mixture_at(from + step * i).worst_dB < mixture_at(best).worst_dB) { best = from + step * i; }
    }
    best = place_of_top([&](double log_correlation) { return -mixture_at(log_correlation).worst_dB; },
                        best - step, best + step, options.log_correlation_tolerance_rel);
    const Mixture found = mixture_at(best);
    NoiseProjection projection;
    projection.N_rad_per_sqrt_s = std::sqrt(found.first);
    projection.gauss_markov = {std::sqrt(found.second), std::exp(best)};
    return projection;
}

NoiseProjection with_walk(const ProjectionTarget& target, const ProjectionOptions& options) {
    const Mixture found = best_mixture(target.ratios([](double tau_s) { return 1.0 / tau_s; }),
                                       target.ratios([](double tau_s) { return tau_s / 3.0; }), options);
    NoiseProjection projection;
    projection.N_rad_per_sqrt_s = std::sqrt(found.first);
    projection.K_rad_per_s_sqrt_s = std::sqrt(found.second);
    return projection;
}

NoiseProjection with_white_alone(const ProjectionTarget& target) {
    const auto white = target.ratios([](double tau_s) { return 1.0 / tau_s; });
    const auto [least, most] = std::ranges::minmax_element(white);
    NoiseProjection projection;
    projection.N_rad_per_sqrt_s = 1.0 / std::pow(*least * *most, 0.25);
    return projection;
}

void judge(NoiseProjection& projection, const ProjectionTarget& target) {
    for (std::size_t i = 0; i < target.tau_s().size(); ++i) {
        const double tau_s = target.tau_s()[i];
        const double error_dB = std::fabs(dB(projection.allan_variance(tau_s) / target.variance()[i]));
        if (error_dB < projection.worst_dB) { continue; }
        projection.worst_dB = error_dB;
        projection.worst_tau_s = tau_s;
    }
}

// Squared, the converter's error in it.
double white_density(const NoiseModel& model) {
    const double N = model.coefficients.N_rad_per_sqrt_s;
    return N * N + model.converter.density();
}

bool same_noise(const NoiseModel& a, const NoiseModel& b) {
    const auto processes = [](const NoiseModel& of) {
        return of.gauss_markov.empty() ? GaussMarkov{} : of.gauss_markov.front();
    };
    return white_density(a) == white_density(b) &&
           a.coefficients.K_rad_per_s_sqrt_s == b.coefficients.K_rad_per_s_sqrt_s &&
           processes(a).sigma_rad_per_s == processes(b).sigma_rad_per_s &&
           processes(a).correlation_s == processes(b).correlation_s;
}

// Of noise that is nothing but the terms.
std::optional<NoiseProjection> as_it_is(std::span<const NoiseModel> models, ProjectedTerms terms) {
    for (const NoiseModel& model : models) {
        const NoiseCoefficients& of = model.coefficients;
        const bool walks = of.K_rad_per_s_sqrt_s != 0.0;
        const bool has_more = of.Q_rad != 0.0 || of.B_rad_per_s != 0.0 || of.R_rad_per_s2 != 0.0 ||
                              !model.sinusoids.empty() || model.gauss_markov.size() > 1;
        if (has_more || (walks && terms != ProjectedTerms::white_walk) ||
            !same_noise(model, models.front())) {
            return std::nullopt;
        }
        if (!model.gauss_markov.empty() && terms != ProjectedTerms::white_gauss_markov) {
            return std::nullopt;
        }
    }
    const NoiseModel& one = models.front();
    NoiseProjection projection;
    projection.N_rad_per_sqrt_s = one.converter.step_rad_per_s == 0.0 ? one.coefficients.N_rad_per_sqrt_s
                                                                      : std::sqrt(white_density(one));
    projection.K_rad_per_s_sqrt_s = one.coefficients.K_rad_per_s_sqrt_s;
    if (!one.gauss_markov.empty()) { projection.gauss_markov = one.gauss_markov.front(); }
    return projection;
}

}  // namespace

double NoiseProjection::drive_rad_per_s_sqrt_s() const {
    if (gauss_markov.sigma_rad_per_s == 0.0) { return 0.0; }
    return gauss_markov.sigma_rad_per_s * std::sqrt(2.0 / gauss_markov.correlation_s);
}

double NoiseProjection::allan_variance(double tau_s) const {
    const double slow = gauss_markov.sigma_rad_per_s == 0.0 ? 0.0 : gauss_markov.allan_variance(tau_s);
    return NoiseCoefficients{.N_rad_per_sqrt_s = N_rad_per_sqrt_s, .K_rad_per_s_sqrt_s = K_rad_per_s_sqrt_s}
               .allan_variance(tau_s) +
           slow;
}

NoiseProjection project_noise(std::span<const NoiseModel> models, ProjectedTerms terms, double rate_hz,
                              double horizon_s, const ProjectionOptions& options) {
    const ProjectionTarget target(models, rate_hz, horizon_s);
    // Without noise there is nothing to be near to. A line alone has none at some averaging times.
    if (std::ranges::any_of(target.variance(), [](double variance) { return variance <= 0.0; })) {
        NoiseProjection nothing;
        const bool silent =
            std::ranges::all_of(target.variance(), [](double variance) { return variance == 0.0; });
        nothing.worst_dB = silent ? 0.0 : infinite;
        nothing.worst_tau_s = target.tau_s().front();
        return nothing;
    }
    if (auto projection = as_it_is(models, terms)) {
        judge(*projection, target);
        return *projection;
    }
    NoiseProjection projection = terms == ProjectedTerms::white        ? with_white_alone(target)
                                 : terms == ProjectedTerms::white_walk ? with_walk(target, options)
                                                                       : with_gauss_markov(target, options);
    judge(projection, target);
    return projection;
}

}  // namespace gyrolog
