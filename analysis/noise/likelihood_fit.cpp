#include "analysis/noise/likelihood_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/noise/noise_search.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/matrix_products.hpp"
#include "analysis/numerics/pseudo_inverse.hpp"
#include "analysis/numerics/square.hpp"

namespace gyrolog {
namespace {

Matrix inverse_information(const Matrix& information) {
    std::vector<double> scale;
    for (std::size_t i = 0; i < information.rows(); ++i) {
        scale.push_back(1.0 / std::sqrt(std::max(information(i, i), 1e-300)));
    }
    return scaled_on_both_sides(pseudo_inverse(scaled_on_both_sides(information, scale)), scale);
}

// Standard deviations of the squares that no estimator without bias can beat, from the spectra of the model.
std::vector<double> cramer_rao(const Fitted& fitted, double rate_hz, double length_s) {
    const SpectrumModel& model = fitted.model;
    const std::size_t count = model.components() - model.lines.size();
    const std::span<const double> squares = std::span(fitted.maximum.squares).first(count);
    Matrix information(count, count);
    constexpr double step = 1.01;
    const int steps = static_cast<int>(std::log(rate_hz * length_s) / std::log(step));
    for (int i = 0; i < steps; ++i) {
        const double f_hz = 0.5 / length_s * std::pow(step, i);
        const double sampled_hz = rate_hz / pi * std::sin(pi * f_hz / rate_hz);
        std::vector<double> spectra(count);
        spectra[0] = 1.0;
        spectra[1] = 1.0 / (2.0 * pi * sampled_hz);
        spectra[2] = 1.0 / square(2.0 * pi * sampled_hz);
        if (model.angle_noise) { spectra[3] = square(2.0 * pi * sampled_hz); }
        for (std::size_t k = 0; k < model.correlations_s.size(); ++k) {
            spectra[model.gauss_markov_at(k)] = GaussMarkov{1.0, model.correlations_s[k]}.psd(sampled_hz);
        }
        const double total = dot(spectra, squares);
        for (double& spectrum : spectra) { spectrum /= total; }
        add_square(information, length_s * f_hz * (step - 1.0), spectra);
    }
    const Matrix covariance = inverse_information(information);
    std::vector<double> sd;
    for (std::size_t j = 0; j < count; ++j) { sd.push_back(std::sqrt(std::max(covariance(j, j), 0.0))); }
    return sd;
}

// One squared coefficient as it is reported. `known`: a part of the square that is not the coefficient's.
FittedCoefficient judged(const NoiseLikelihood& likelihood, const LikelihoodMaximum& maximum,
                         std::size_t component, double sd, double confidence, double known) {
    constexpr double well_known_sd = 15.0;  // so many standard deviations from 0 the interval is symmetric
    const double sigmas = normal_quantile(0.5 + confidence / 2.0);
    const double value = maximum.squares[component];
    SquareInterval interval{value - sigmas * sd, value + sigmas * sd};
    double ratio = square(value / sd);
    if (!(value > well_known_sd * sd)) {
        interval = profile_interval(likelihood, maximum, component, sigmas, sd);
        ratio = likelihood_ratio(likelihood, maximum, component);
    }
    FittedCoefficient fitted;
    const auto root = [&](double x) { return std::sqrt(std::max(0.0, x - known)); };
    fitted.upper = root(interval.hi);
    set_estimate(fitted, value - known, sd);
    if (ratio > identified_ratio && value > known) {
        fitted.state = FittedCoefficient::State::identified;
        fitted.value = root(value);
        fitted.sd = sd / (2.0 * fitted.value);
        fitted.lo = root(interval.lo);
        fitted.hi = root(interval.hi);
    }
    return fitted;
}

FittedCoefficient judged_ramp(const RampFit& fit, double confidence) {
    const RampEstimate& ramp = fit.ramp;
    const double sigmas = normal_quantile(0.5 + confidence / 2.0);
    const double size = std::abs(ramp.slope_per_s);
    FittedCoefficient fitted;
    fitted.upper = size + sigmas * ramp.sd_per_s;
    fitted.estimate = size;
    fitted.estimate_sd = fitted.bound = ramp.sd_per_s;
    if (is_significant(fit)) {
        fitted.state = FittedCoefficient::State::identified;
        fitted.value = size;
        fitted.sd = ramp.sd_per_s;
        fitted.lo = std::max(0.0, size - sigmas * ramp.sd_per_s);
        fitted.hi = fitted.upper;
    }
    return fitted;
}

FittedGaussMarkov judged_gauss_markov(const ContrastPyramid& pyramid, const Fitted& fitted, std::size_t i,
                                      double square_sd) {
    const std::size_t at = fitted.model.gauss_markov_at(i);
    const double sigma = std::sqrt(fitted.maximum.squares[at]);
    const double correlation_s = fitted.model.correlations_s[i];
    // Curvature of the profile over the logarithm of the correlation time.
    constexpr double ratio = 1.1;
    const auto moved = [&](double t_s) {
        SpectrumModel model = fitted.model;
        model.correlations_s[i] = t_s;
        return maximise(likelihood_of(pyramid, model), fitted.maximum.squares);
    };
    const LikelihoodMaximum shorter = moved(correlation_s / ratio);
    const LikelihoodMaximum longer = moved(correlation_s * ratio);
    const double curvature = (2.0 * fitted.value() - shorter.value - longer.value) / square(std::log(ratio));
    const double log_sd = curvature > 0.0 ? 1.0 / std::sqrt(curvature) : 1.0;
    const double slope = (longer.squares[at] - shorter.squares[at]) / (2.0 * std::log(ratio));
    const double total_sd = std::hypot(square_sd, slope * log_sd);
    return {{sigma, correlation_s}, total_sd / (2.0 * sigma), correlation_s * log_sd};
}

// Puts the fitted parts into the form of a report.
class Report {
public:
    Report(const ContrastPyramid& pyramid, const Fitted& fitted, const LikelihoodFitOptions& options)
        : pyramid_(pyramid),
          fitted_(fitted),
          options_(options),
          likelihood_(likelihood_of(pyramid, fitted.model)),
          covariance_(inverse_information(likelihood_.expected_information(fitted.maximum.squares))) {}

    void fill(NoiseFit& fit, const RampFit& ramp) {
        const std::vector<double> bounds = cramer_rao(fitted_, pyramid_.rate_hz, pyramid_.length_s());
        const RateQuantisation converter{options_.step, pyramid_.rate_hz};
        fit.best.converter = fit.sparse.converter = converter;
        add(fit, NoiseTerm::N, 0, bounds, converter.density());
        add(fit, NoiseTerm::B, 1, bounds, 0.0);
        add(fit, NoiseTerm::K, 2, bounds, 0.0);
        if (fitted_.model.angle_noise) {
            add(fit, NoiseTerm::Q, fitted_.model.angle_noise_at(), bounds, 0.0);
        } else {
            term(fit, NoiseTerm::Q) = absent_angle_noise();
        }
        term(fit, NoiseTerm::R) = judged_ramp(ramp, options_.confidence);
        fit.best.coefficients = coefficients_of(fitted_.maximum.squares, converter, fit);
        const LikelihoodMaximum needed = with_needed_terms(pyramid_, fitted_);
        fit.sparse.coefficients = coefficients_of(needed.squares, converter, fit);
        for (std::size_t i = 0; i < fitted_.model.correlations_s.size(); ++i) {
            const std::size_t at = fitted_.model.gauss_markov_at(i);
            fit.gauss_markov.push_back(judged_gauss_markov(pyramid_, fitted_, i, sd_of(at)));
            fit.best.gauss_markov.push_back(fit.gauss_markov.back().value);
            fit.sparse.gauss_markov.push_back(
                {std::sqrt(needed.squares[at]), fitted_.model.correlations_s[i]});
        }
        fit.sinusoids = fitted_.model.lines;
        for (const FittedSinusoid& line : fit.sinusoids) { fit.best.sinusoids.push_back(line.value); }
        fit.sparse.sinusoids = fit.best.sinusoids;
        correlate(fit);
        fit.mean_dof = mean_dof(needed);
        find_worst(fit);
    }

private:
    NoiseCoefficients coefficients_of(const std::vector<double>& squares, const RateQuantisation& converter,
                                      const NoiseFit& fit) const {
        NoiseCoefficients coefficients;
        coefficients.N_rad_per_sqrt_s = std::sqrt(std::max(0.0, squares[0] - converter.density()));
        coefficients.B_rad_per_s = std::sqrt(squares[1]);
        coefficients.K_rad_per_s_sqrt_s = std::sqrt(squares[2]);
        if (fitted_.model.angle_noise) {
            coefficients.Q_rad = std::sqrt(squares[fitted_.model.angle_noise_at()]);
        }
        if (fitted_.model.ramp) { coefficients.R_rad_per_s2 = fit[NoiseTerm::R].value; }
        return coefficients;
    }

    static FittedCoefficient& term(NoiseFit& fit, NoiseTerm which) {
        return fit.terms[static_cast<std::size_t>(which)];
    }

    double sd_of(std::size_t component) const {
        return std::sqrt(std::max(covariance_(component, component), 0.0));
    }

    void add(NoiseFit& fit, NoiseTerm which, std::size_t component, const std::vector<double>& bounds,
             double known) {
        FittedCoefficient& coefficient = term(fit, which) =
            judged(likelihood_, fitted_.maximum, component, sd_of(component), options_.confidence, known);
        if (coefficient.value > 0.0) { coefficient.bound = bounds[component] / (2.0 * coefficient.value); }
        components_.emplace_back(which, component);
    }

    FittedCoefficient absent_angle_noise() const {
        const Fitted with = with_angle_noise_added(pyramid_, fitted_);
        if (!std::isfinite(with.value())) { return {}; }
        const NoiseLikelihood likelihood = likelihood_of(pyramid_, with.model);
        const std::vector<double>& squares = with.maximum.squares;
        const std::size_t at = with.model.angle_noise_at();
        const double sd =
            std::sqrt(std::max(inverse_information(likelihood.expected_information(squares))(at, at), 0.0));
        FittedCoefficient coefficient;
        set_estimate(coefficient, squares[at], sd);
        coefficient.upper = std::sqrt(profile_interval(likelihood, with.maximum, at,
                                                       normal_quantile(0.5 + options_.confidence / 2.0), sd)
                                          .hi);
        return coefficient;
    }

    // Of the sparse model's Allan variance at an averaging time of the whole record (JCGM 100:2008, G.4).
    double mean_dof(const LikelihoodMaximum& needed) const {
        const double length_s = pyramid_.length_s();
        std::vector<std::size_t> there;
        std::vector<double> shares(fitted_.model.components(), 0.0);
        shares[0] = 1.0 / length_s;
        shares[1] = NoiseCoefficients{0.0, 0.0, 1.0, 0.0, 0.0}.allan_variance(length_s);
        shares[2] = length_s / 3.0;
        for (std::size_t i = 0; i < fitted_.model.correlations_s.size(); ++i) {
            shares[fitted_.model.gauss_markov_at(i)] =
                GaussMarkov{1.0, fitted_.model.correlations_s[i]}.allan_variance(length_s);
        }
        for (std::size_t j = 0; j < shares.size(); ++j) {
            if (needed.squares[j] > 0.0) { there.push_back(j); }
        }
        std::vector<double> shares_there;
        shares_there.reserve(there.size());
        for (const std::size_t j : there) { shares_there.push_back(shares[j]); }
        const Matrix information = likelihood_.expected_information(needed.squares);
        const Matrix covariance = inverse_information(information.part(there, there));
        const double variance = dot(shares, needed.squares);
        const std::vector<double> pulled = product(covariance, shares_there);
        const double scatter =
            std::inner_product(shares_there.begin(), shares_there.end(), pulled.begin(), 0.0);
        return scatter > 0.0 ? 2.0 * variance * variance / scatter : 0.0;
    }

    void find_worst(NoiseFit& fit) const {
        double worst = 0.0;
        for (const ContrastMisfit& misfit : likelihood_.misfits(fitted_.maximum.squares)) {
            const double sds = std::abs(misfit.ratio - 1.0) * std::sqrt(misfit.dof / 2.0);
            if (sds <= worst) { continue; }
            worst = sds;
            fit.worst_frequency_hz = misfit.f_hz;
            fit.worst_ratio = misfit.ratio;
        }
    }

    void correlate(NoiseFit& fit) const {
        for (const auto& [a, i] : components_) {
            for (const auto& [b, j] : components_) {
                const bool both = fit[a].state == FittedCoefficient::State::identified &&
                                  fit[b].state == FittedCoefficient::State::identified;
                const double scale = sd_of(i) * sd_of(j);
                if (!both || !(scale > 0.0)) { continue; }
                fit.correlation[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] =
                    covariance_(i, j) / scale;
            }
        }
    }

    const ContrastPyramid& pyramid_;
    const Fitted& fitted_;
    const LikelihoodFitOptions& options_;
    NoiseLikelihood likelihood_;
    Matrix covariance_;
    std::vector<std::pair<NoiseTerm, std::size_t>> components_;
};

bool varies(const ContrastPyramid& pyramid) {
    return std::ranges::any_of(pyramid.top, [](const TopAverage& a) { return a.value != 0.0; }) ||
           std::ranges::any_of(pyramid.levels, [](const ContrastLevel& level) {
               return std::ranges::any_of(level.power, [](double p) { return p > 0.0; });
           });
}

}  // namespace

std::optional<NoiseFit> fit_likelihood(const Column& column, std::span<const Segment> segments,
                                       double rate_hz, const NoiseFit& start,
                                       const LikelihoodFitOptions& options) {
    const ContrastPyramid pyramid = contrast_pyramid(column, segments, rate_hz);
    if (pyramid.top.size() < 32 || !varies(pyramid)) { return std::nullopt; }
    const SearchResult found = search_terms(pyramid, start, options);
    const Fitted& fitted = found.fitted;
    if (!std::isfinite(fitted.value())) { return std::nullopt; }
    NoiseFit result;
    result.method = FitMethod::likelihood;
    result.confidence = options.confidence;
    result.points = start.points;
    result.worst_residual_sd = start.worst_residual_sd;
    result.model_error = fitted.model.error;
    if (std::isfinite(fitted.model.upper_hz)) { result.upper_frequency_hz = fitted.model.upper_hz; }
    result.bandwidth_hz = fitted.model.bandwidth_hz;
    Report(pyramid, fitted, options).fill(result, found.ramp);
    return result;
}

}  // namespace gyrolog
