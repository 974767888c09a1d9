#include "analysis/noise/likelihood_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/allan/confidence.hpp"
#include "analysis/noise/likelihood_maximum.hpp"

namespace gyrolog {
namespace {

using Index = Eigen::Index;

// A coefficient is identified when twice its gain of the log likelihood exceeds this: 2.6 standard
// deviations, 0.5 % by chance.
constexpr double identified_ratio = 6.6;
// An optional term must gain more, since the others lose precision by it.
constexpr double optional_ratio = 10.8;
// Terms with less are left out of the sparse model: two standard deviations.
constexpr double kept_ratio = 4.0;
// A Gauss-Markov term has two parameters, and its correlation time was searched for.
constexpr double gauss_markov_gain = 8.0;
// White noise behind a low pass has the spectrum of Gauss-Markov noise. A gyro's own filter is wider than 5
// Hz (32 ms), and its drift slower than this.
constexpr double fastest_drift_s = 0.1;
constexpr double clear_error = 0.05;  // a departure beyond which the model is amended

// What the likelihood is made of, in the order of its components: N, B, K, then the optional ones.
struct Model {
    bool ramp = false;
    bool angle_noise = false;
    std::vector<double> correlations_s;  // of Gauss-Markov terms
    std::vector<FittedSinusoid> lines;
    double upper_hz = std::numeric_limits<double>::infinity();
    double error = 0.0;

    Index angle_noise_at() const { return 3; }
    Index gauss_markov_at(std::size_t i) const { return 3 + (angle_noise ? 1 : 0) + static_cast<Index>(i); }
    Index components() const {
        return gauss_markov_at(correlations_s.size()) + static_cast<Index>(lines.size());
    }
};

NoiseLikelihood likelihood_of(const ContrastPyramid& pyramid, const Model& model) {
    NoiseLikelihood likelihood(pyramid, model.ramp);
    for (const NoiseTerm term : {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K}) {
        likelihood.add(average_covariance(term));
    }
    if (model.angle_noise) { likelihood.add(average_covariance(NoiseTerm::Q)); }
    for (const double correlation_s : model.correlations_s) {
        likelihood.add(gauss_markov_covariance(correlation_s));
    }
    for (const FittedSinusoid& line : model.lines) {
        likelihood.add(sinusoid_covariance(line.value.frequency_hz, pyramid.rate_hz));
    }
    likelihood.limit_frequency(model.upper_hz);
    likelihood.tolerate(model.error);
    return likelihood;
}

double square(double x) { return x * x; }

// Fitted components of one model.
struct Fitted {
    Model model;
    LikelihoodMaximum maximum;

    double value() const { return maximum.value; }
};

// Squares to begin with, from the curve's fit; white noise from the fastest contrasts, so that it is never 0.
Eigen::VectorXd first_guess(const ContrastPyramid& pyramid, const Model& model, const NoiseFit& start) {
    const NoiseCoefficients& curve = start.best.coefficients;
    double white = 0.0;
    if (!pyramid.levels.empty()) {
        white = pyramid.levels.front().power.back() / pyramid.rate_hz;
    } else {
        for (const TopAverage& sample : pyramid.top) { white += square(sample.value) / pyramid.rate_hz; }
        white /= static_cast<double>(pyramid.top.size());
    }
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(model.components());
    squares[0] = std::max(square(curve.N_rad_per_sqrt_s), 0.01 * white);
    squares[1] = square(curve.B_rad_per_s);
    squares[2] = square(curve.K_rad_per_s_sqrt_s);
    if (model.angle_noise) { squares[model.angle_noise_at()] = square(curve.Q_rad); }
    for (std::size_t i = 0; i < model.lines.size(); ++i) {
        squares[model.gauss_markov_at(model.correlations_s.size() + i)] =
            square(model.lines[i].value.amplitude_rad_per_s);
    }
    return squares;
}

// The relative departure of the spectrum from the model that makes the contrasts' misfits as large as chance
// and it together lead one to expect (Paule and Mandel, J. Res. NBS 87 (1982) 377-385).
// Only contrasts known to some percent can tell; without enough of them: nothing.
std::optional<double> departure(const std::vector<ContrastMisfit>& misfits, double upper_hz) {
    std::vector<ContrastMisfit> counted;
    std::ranges::copy_if(misfits, std::back_inserter(counted), [&](const ContrastMisfit& misfit) {
        return misfit.f_hz <= upper_hz && misfit.dof >= 500.0;
    });
    if (counted.size() < 6) { return std::nullopt; }
    const auto excess = [&](double error) {
        double sum = 0.0;
        for (const ContrastMisfit& misfit : counted) {
            sum += square(misfit.ratio - 1.0) / (2.0 / misfit.dof + error * error);
        }
        return sum / static_cast<double>(counted.size()) - 1.0;
    };
    // Chance alone is within this, ninety-nine times in a hundred.
    if (excess(0.0) < 2.5 * std::sqrt(2.0 / static_cast<double>(counted.size()))) { return 0.0; }
    double low = 0.0;
    double high = 10.0;
    for (int pass = 0; pass < 40; ++pass) {
        const double middle = 0.5 * (low + high);
        (excess(middle) > 0.0 ? low : high) = middle;
    }
    return high;
}

// Fits a model, and again with the departure that the first fit shows, until it stands still.
Fitted fit(const ContrastPyramid& pyramid, Model model, Eigen::VectorXd start) {
    Fitted fitted{model, {}};
    for (int pass = 0; pass < 6; ++pass) {
        const NoiseLikelihood likelihood = likelihood_of(pyramid, fitted.model);
        fitted.maximum = maximise(likelihood, start);
        if (!std::isfinite(fitted.maximum.value)) { break; }
        const double error =
            departure(likelihood.misfits(fitted.maximum.squares), fitted.model.upper_hz).value_or(0.0);
        const double before = std::exchange(fitted.model.error, error);
        if (std::abs(error - before) <= 0.05 * error) {
            fitted.model.error = before;
            break;
        }
        start = fitted.maximum.squares;
    }
    return fitted;
}

// Leaves out the upper end of the band, octave by octave, until what is left agrees with the model.
Fitted without_upper_end(const ContrastPyramid& pyramid, const Fitted& whole) {
    Fitted best = whole;
    const double lowest_hz =
        32.0 * pyramid.rate_hz /
        (static_cast<double>(pyramid.top_span) * static_cast<double>(pyramid.top.size()));
    for (double upper_hz = pyramid.rate_hz / 4.0; upper_hz > lowest_hz; upper_hz /= 2.0) {
        Model model = whole.model;
        model.upper_hz = upper_hz;
        Fitted next = fit(pyramid, model, best.maximum.squares);
        const auto misfits = likelihood_of(pyramid, next.model).misfits(next.maximum.squares);
        if (!std::isfinite(next.value()) || !departure(misfits, upper_hz)) { break; }
        if (next.model.error < 0.7 * best.model.error) { best = std::move(next); }
        if (best.model.error < clear_error) { break; }
    }
    return best;
}

Eigen::VectorXd with_component(const Eigen::VectorXd& squares, Index at, double value) {
    Eigen::VectorXd more(squares.size() + 1);
    more << squares.head(at), value, squares.tail(squares.size() - at);
    return more;
}

Fitted with_gauss_markov(const ContrastPyramid& pyramid, const Fitted& base, double correlation_s) {
    Fitted next = base;
    const Index at = base.model.gauss_markov_at(base.model.correlations_s.size());
    next.model.correlations_s.push_back(correlation_s);
    const NoiseLikelihood likelihood = likelihood_of(pyramid, next.model);
    const double rate = 1.0 / correlation_s;
    const double level = base.maximum.squares[0] * rate;
    next.maximum = maximise(likelihood, with_component(base.maximum.squares, at, 0.3 * level));
    return next;
}

// The best Gauss-Markov term beside what is there, correlation times searched over the whole record.
Fitted search_gauss_markov(const ContrastPyramid& pyramid, const Fitted& base) {
    const double length_s =
        static_cast<double>(pyramid.top_span) * static_cast<double>(pyramid.top.size()) / pyramid.rate_hz;
    Fitted best = base;
    const double step = std::sqrt(10.0);
    const double shortest_s = std::max(3.0 / pyramid.rate_hz, fastest_drift_s);
    for (double t_s = shortest_s; t_s < length_s / 8.0; t_s *= step) {
        Fitted next = with_gauss_markov(pyramid, base, t_s);
        if (next.value() > best.value()) { best = std::move(next); }
    }
    if (best.model.correlations_s.size() == base.model.correlations_s.size()) { return base; }
    for (double ratio = std::sqrt(step); ratio > 1.02; ratio = std::sqrt(ratio)) {
        const double centre_s = best.model.correlations_s.back();
        for (const double t_s : {centre_s / ratio, centre_s * ratio}) {
            if (t_s < shortest_s) { continue; }
            Fitted next = with_gauss_markov(pyramid, base, t_s);
            if (next.value() > best.value()) { best = std::move(next); }
        }
    }
    // What is best at the very end of the search is something faster.
    return best.model.correlations_s.back() > 1.5 * shortest_s ? best : base;
}

// Whether the squares of some contrasts or averages are further from the model than chance, 99 times in a
// hundred, puts them.
bool departs(const std::vector<ContrastMisfit>& misfits) {
    constexpr double enough_dof = 8.0;
    double sum = 0.0;
    double count = 0.0;
    for (const ContrastMisfit& misfit : misfits) {
        if (misfit.dof < enough_dof) { continue; }
        sum += square(misfit.ratio - 1.0) * misfit.dof / 2.0 - 1.0;
        count += 1.0;
    }
    return sum > 2.5 * std::sqrt(2.0 * count);
}

bool white_noise_stays(const ContrastPyramid& pyramid, const Fitted& fitted) {
    const NoiseLikelihood likelihood = likelihood_of(pyramid, fitted.model);
    return likelihood_ratio(likelihood, fitted.maximum, 0) > identified_ratio;
}

// Amends a model that the record departs from: Gauss-Markov noise if it mends that and leaves the white noise
// in place (a filter on white noise looks like it, too), else a narrower band.
Fitted amended(const ContrastPyramid& pyramid, Fitted fitted) {
    for (int terms = 0; terms < 2; ++terms) {
        const auto misfits = likelihood_of(pyramid, fitted.model).misfits(fitted.maximum.squares);
        if (!departs(misfits)) { break; }
        const Fitted tried = search_gauss_markov(pyramid, fitted);
        const bool any = tried.model.correlations_s.size() > fitted.model.correlations_s.size();
        if (!any || tried.value() - fitted.value() < gauss_markov_gain) { break; }
        Fitted next = fit(pyramid, tried.model, tried.maximum.squares);
        if (next.model.error > 0.7 * fitted.model.error || !white_noise_stays(pyramid, next)) { break; }
        fitted = std::move(next);
    }
    return fitted.model.error > clear_error ? without_upper_end(pyramid, fitted) : fitted;
}

Fitted with_angle_noise(const ContrastPyramid& pyramid, const Fitted& base) {
    Model model = base.model;
    model.angle_noise = true;
    const double start = 1e-3 * base.maximum.squares[0] / square(pyramid.rate_hz);
    Fitted more = fit(pyramid, model, with_component(base.maximum.squares, 3, start));
    if (!std::isfinite(more.value())) { return base; }
    const NoiseLikelihood likelihood = likelihood_of(pyramid, more.model);
    return likelihood_ratio(likelihood, more.maximum, 3) > optional_ratio ? more : base;
}

struct RampFit {
    Fitted fitted;
    RampEstimate ramp;
    double ratio = 0.0;  // twice the gain of the log likelihood
};

RampFit with_ramp(const ContrastPyramid& pyramid, const Fitted& base) {
    Fitted with = base;
    with.model.ramp = true;
    const NoiseLikelihood likelihood = likelihood_of(pyramid, with.model);
    with.maximum = maximise(likelihood, base.maximum.squares);
    if (!std::isfinite(with.value())) { return {base, {}, 0.0}; }
    // Likelihoods restricted in different ways do not compare: the ramp's term is taken back.
    const RampEstimate ramp = likelihood.ramp(with.maximum.squares);
    return {with, ramp, 2.0 * (with.value() - std::log(ramp.sd_per_s) - base.value())};
}

Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& information) {
    const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd unit = scale.asDiagonal() * information * scale.asDiagonal();
    const Eigen::MatrixXd inverse = unit.completeOrthogonalDecomposition().pseudoInverse();
    return scale.asDiagonal() * inverse * scale.asDiagonal();
}

// Standard deviations of the squares that no estimator without bias can beat, from the spectra of the model.
Eigen::VectorXd cramer_rao(const Fitted& fitted, double rate_hz, double length_s) {
    const Model& model = fitted.model;
    const Index count = model.components() - static_cast<Index>(model.lines.size());
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
    constexpr double step = 1.01;
    for (double f_hz = 0.5 / length_s; f_hz < rate_hz / 2.0; f_hz *= step) {
        const double sampled_hz = rate_hz / pi * std::sin(pi * f_hz / rate_hz);
        Eigen::VectorXd spectra(count);
        spectra[0] = 1.0;
        spectra[1] = 1.0 / (2.0 * pi * sampled_hz);
        spectra[2] = 1.0 / square(2.0 * pi * sampled_hz);
        if (model.angle_noise) { spectra[3] = square(2.0 * pi * sampled_hz); }
        for (std::size_t i = 0; i < model.correlations_s.size(); ++i) {
            spectra[model.gauss_markov_at(i)] = GaussMarkov{1.0, model.correlations_s[i]}.psd(sampled_hz);
        }
        const Eigen::VectorXd relative = spectra / spectra.dot(fitted.maximum.squares.head(count));
        information += length_s * f_hz * (step - 1.0) * relative * relative.transpose();
    }
    return inverse_information(information).diagonal().cwiseMax(0.0).cwiseSqrt();
}

// One squared coefficient as it is reported. `known`: a part of the square that is not the coefficient's.
struct JudgedSquare {
    double ratio = 0.0;
    FittedCoefficient coefficient;
};

JudgedSquare judged(const NoiseLikelihood& likelihood, const LikelihoodMaximum& maximum, Index component,
                    double sd, double confidence, double known) {
    constexpr double well_known_sd = 15.0;  // so many standard deviations from 0 the interval is symmetric
    const double sigmas = normal_quantile(0.5 + confidence / 2.0);
    const double value = maximum.squares[component];
    JudgedSquare result;
    SquareInterval interval{value - sigmas * sd, value + sigmas * sd};
    result.ratio = square(value / sd);
    if (!(value > well_known_sd * sd)) {
        interval = profile_interval(likelihood, maximum, component, sigmas, sd);
        result.ratio = likelihood_ratio(likelihood, maximum, component);
    }
    FittedCoefficient& fitted = result.coefficient;
    const auto root = [&](double x) { return std::sqrt(std::max(0.0, x - known)); };
    fitted.upper = root(interval.hi);
    if (result.ratio > identified_ratio && value > known) {
        fitted.state = FittedCoefficient::State::identified;
        fitted.value = root(value);
        fitted.sd = sd / (2.0 * fitted.value);
        fitted.lo = root(interval.lo);
        fitted.hi = root(interval.hi);
    }
    return result;
}

FittedCoefficient judged_ramp(const RampFit& fit, double confidence) {
    const RampEstimate& ramp = fit.ramp;
    const double sigmas = normal_quantile(0.5 + confidence / 2.0);
    const double size = std::abs(ramp.slope_per_s);
    FittedCoefficient fitted;
    fitted.upper = size + sigmas * ramp.sd_per_s;
    fitted.bound = ramp.sd_per_s;
    if (std::min(fit.ratio, square(size / ramp.sd_per_s)) > optional_ratio) {
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
    const Index at = fitted.model.gauss_markov_at(i);
    const double sigma = std::sqrt(fitted.maximum.squares[at]);
    const double correlation_s = fitted.model.correlations_s[i];
    // Curvature of the profile over the logarithm of the correlation time.
    constexpr double ratio = 1.1;
    const auto moved = [&](double t_s) {
        Model model = fitted.model;
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
        const double length_s = static_cast<double>(pyramid_.top_span) *
                                static_cast<double>(pyramid_.top.size()) / pyramid_.rate_hz;
        const Eigen::VectorXd bounds = cramer_rao(fitted_, pyramid_.rate_hz, length_s);
        const RateQuantisation converter{options_.step, pyramid_.rate_hz};
        fit.best.converter = fit.sparse.converter = converter;
        const Squares of_best{fit.best.coefficients, fit.sparse.coefficients};
        add(fit, NoiseTerm::N, 0, bounds, converter.density(), of_best.N());
        add(fit, NoiseTerm::B, 1, bounds, 0.0, of_best.B());
        add(fit, NoiseTerm::K, 2, bounds, 0.0, of_best.K());
        if (fitted_.model.angle_noise) {
            add(fit, NoiseTerm::Q, fitted_.model.angle_noise_at(), bounds, 0.0, of_best.Q());
        } else {
            term(fit, NoiseTerm::Q) = absent_angle_noise();
        }
        term(fit, NoiseTerm::R) = judged_ramp(ramp, options_.confidence);
        if (fitted_.model.ramp) {
            fit.best.coefficients.R_rad_per_s2 = fit.sparse.coefficients.R_rad_per_s2 =
                fit[NoiseTerm::R].value;
        }
        for (std::size_t i = 0; i < fitted_.model.correlations_s.size(); ++i) {
            fit.gauss_markov.push_back(
                judged_gauss_markov(pyramid_, fitted_, i, sd_of(fitted_.model.gauss_markov_at(i))));
            fit.best.gauss_markov.push_back(fit.gauss_markov.back().value);
        }
        fit.sinusoids = fitted_.model.lines;
        for (const FittedSinusoid& line : fit.sinusoids) { fit.best.sinusoids.push_back(line.value); }
        fit.sparse.gauss_markov = fit.best.gauss_markov;
        fit.sparse.sinusoids = fit.best.sinusoids;
        correlate(fit);
        fit.mean_dof = mean_dof(fit, length_s);
        find_worst(fit);
    }

private:
    // Where one coefficient stands in the best and in the sparse model.
    struct Places {
        double& best;
        double& sparse;
    };
    struct Squares {
        NoiseCoefficients& best;
        NoiseCoefficients& sparse;
        Places N() const { return {best.N_rad_per_sqrt_s, sparse.N_rad_per_sqrt_s}; }
        Places B() const { return {best.B_rad_per_s, sparse.B_rad_per_s}; }
        Places K() const { return {best.K_rad_per_s_sqrt_s, sparse.K_rad_per_s_sqrt_s}; }
        Places Q() const { return {best.Q_rad, sparse.Q_rad}; }
    };

    static FittedCoefficient& term(NoiseFit& fit, NoiseTerm which) {
        return fit.terms[static_cast<std::size_t>(which)];
    }

    double sd_of(Index component) const {
        return std::sqrt(std::max(covariance_(component, component), 0.0));
    }

    void add(NoiseFit& fit, NoiseTerm which, Index component, const Eigen::VectorXd& bounds, double known,
             Places places) {
        const JudgedSquare judged_square =
            judged(likelihood_, fitted_.maximum, component, sd_of(component), options_.confidence, known);
        FittedCoefficient& coefficient = term(fit, which) = judged_square.coefficient;
        places.best = std::sqrt(std::max(0.0, fitted_.maximum.squares[component] - known));
        places.sparse = judged_square.ratio > kept_ratio ? places.best : 0.0;
        if (coefficient.value > 0.0) { coefficient.bound = bounds[component] / (2.0 * coefficient.value); }
        components_.emplace_back(which, component);
    }

    FittedCoefficient absent_angle_noise() const {
        Model model = fitted_.model;
        model.angle_noise = true;
        const NoiseLikelihood likelihood = likelihood_of(pyramid_, model);
        const Index at = model.angle_noise_at();
        const LikelihoodMaximum maximum = maximise(
            likelihood, with_component(fitted_.maximum.squares, at,
                                       1e-3 * fitted_.maximum.squares[0] / square(pyramid_.rate_hz)));
        const Eigen::MatrixXd covariance =
            inverse_information(likelihood.expected_information(maximum.squares));
        const SquareInterval interval =
            profile_interval(likelihood, maximum, at, normal_quantile(0.5 + options_.confidence / 2.0),
                             std::sqrt(std::max(covariance(at, at), 0.0)));
        FittedCoefficient coefficient;
        coefficient.upper = std::sqrt(interval.hi);
        return coefficient;
    }

    // Of the sparse model's Allan variance at an averaging time of the whole record (JCGM 100:2008, G.4).
    double mean_dof(const NoiseFit& fit, double length_s) const {
        Eigen::VectorXd shares = Eigen::VectorXd::Zero(fitted_.model.components());
        const NoiseCoefficients& sparse = fit.sparse.coefficients;
        if (sparse.N_rad_per_sqrt_s > 0.0) { shares[0] = 1.0 / length_s; }
        if (sparse.B_rad_per_s > 0.0) {
            shares[1] = NoiseCoefficients{0.0, 0.0, 1.0, 0.0, 0.0}.allan_variance(length_s);
        }
        if (sparse.K_rad_per_s_sqrt_s > 0.0) { shares[2] = length_s / 3.0; }
        for (std::size_t i = 0; i < fitted_.model.correlations_s.size(); ++i) {
            shares[fitted_.model.gauss_markov_at(i)] =
                GaussMarkov{1.0, fitted_.model.correlations_s[i]}.allan_variance(length_s);
        }
        const double variance = shares.dot(fitted_.maximum.squares);
        const double scatter = shares.dot(covariance_ * shares);
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
    Eigen::MatrixXd covariance_;
    std::vector<std::pair<NoiseTerm, Index>> components_;
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
    if (pyramid.top.size() < 16 || !varies(pyramid)) { return std::nullopt; }
    Model model;
    model.lines = options.lines;
    Fitted fitted = fit(pyramid, model, first_guess(pyramid, model, start));
    if (!std::isfinite(fitted.value())) { return std::nullopt; }
    fitted = with_angle_noise(pyramid, fitted);
    fitted = amended(pyramid, std::move(fitted));
    const RampFit ramp = with_ramp(pyramid, fitted);
    if (judged_ramp(ramp, options.confidence).state == FittedCoefficient::State::identified) {
        fitted = ramp.fitted;
    }
    NoiseFit result;
    result.method = FitMethod::likelihood;
    result.confidence = options.confidence;
    result.points = start.points;
    result.worst_residual_sd = start.worst_residual_sd;
    result.model_error = fitted.model.error;
    if (std::isfinite(fitted.model.upper_hz)) { result.upper_frequency_hz = fitted.model.upper_hz; }
    Report(pyramid, fitted, options).fill(result, ramp);
    return result;
}

}  // namespace gyrolog
