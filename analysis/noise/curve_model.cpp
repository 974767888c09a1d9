#include "analysis/noise/curve_model.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "analysis/noise/curve_scatter.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/eigen_view.hpp"
#include "analysis/numerics/least_squares.hpp"
#include "analysis/numerics/matrix_products.hpp"
#include "analysis/numerics/pseudo_inverse.hpp"

namespace gyrolog {
namespace {

using Kind = CurveTerm::Kind;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double term_margin_to_enter = 6.0;
constexpr double term_margin_to_stay = 2.0;
constexpr std::size_t steps_max = 30;
constexpr std::size_t terms_max = 9;
constexpr std::array linear_kinds = {Kind::Q, Kind::N, Kind::B, Kind::K, Kind::R};

// Where the Allan deviation is highest: tau / T = 1.89 of Gauss-Markov noise (IEEE Std 952-1997 C.1.5), f tau
// = 0.371 of a sinusoid (C.1.6).
constexpr double gauss_markov_peak = 1.89;
constexpr double sinusoid_peak = 0.371;

std::size_t parameters_of(Kind kind) { return has_shape(kind) ? 2 : 1; }

std::size_t parameters_of(const std::vector<CurveTerm>& terms) {
    std::size_t count = 0;
    for (const CurveTerm& term : terms) { count += parameters_of(term.kind); }
    return count;
}

// The curve as it is fitted.
struct FittedCurve {
    std::vector<double> tau_s;
    VectorXd log_variance;  // natural logarithm of the Allan variance

    Index points() const { return log_variance.size(); }
};

FittedCurve target_of(const AllanCurve& curve) {
    FittedCurve target;
    std::vector<double> logs;
    for (const AllanPoint& point : curve.points) {
        if (!(point.deviation > 0.0 && point.tau_s > 0.0)) { continue; }
        target.tau_s.push_back(point.tau_s);
        logs.push_back(2.0 * std::log(point.deviation));
    }
    target.log_variance = Eigen::Map<const VectorXd>(logs.data(), static_cast<Index>(logs.size()));
    return target;
}

// Terms as a vector of logarithms: of the squares of all sizes, then of all shapes. Positive sizes need no
// bounds then, and a step means the same for a quantisation of 1e-9 as for a white noise of 1e-3.
std::vector<double> logarithms_of(const std::vector<CurveTerm>& terms) {
    std::vector<double> logs;
    logs.reserve(terms.size());
    for (const CurveTerm& term : terms) { logs.push_back(2.0 * std::log(term.size)); }
    for (const CurveTerm& term : terms) {
        if (has_shape(term.kind)) { logs.push_back(std::log(term.shape)); }
    }
    return logs;
}

std::vector<CurveTerm> terms_of(const std::vector<CurveTerm>& like, std::span<const double> logs) {
    std::vector<CurveTerm> terms = like;
    std::size_t at = 0;
    for (CurveTerm& term : terms) { term.size = std::exp(std::clamp(logs[at++], -200.0, 200.0) / 2.0); }
    for (CurveTerm& term : terms) {
        if (has_shape(term.kind)) { term.shape = std::exp(std::clamp(logs[at++], -60.0, 60.0)); }
    }
    return terms;
}

// Allan variance by point and term.
MatrixXd variances_of(const std::vector<CurveTerm>& terms, const std::vector<double>& tau_s) {
    MatrixXd variances(static_cast<Index>(tau_s.size()), static_cast<Index>(terms.size()));
    for (Index j = 0; j < variances.cols(); ++j) {
        const CurveTerm& term = terms[static_cast<std::size_t>(j)];
        for (Index i = 0; i < variances.rows(); ++i) {
            variances(i, j) = term.allan_variance(tau_s[static_cast<std::size_t>(i)]);
        }
    }
    return variances;
}

// Curve over model, dB.
VectorXd residuals_db(const FittedCurve& target, const std::vector<CurveTerm>& terms) {
    const VectorXd model = variances_of(terms, target.tau_s).rowwise().sum().cwiseMax(1e-300);
    return variance_db_per_neper * (target.log_variance - model.array().log().matrix());
}

// Derivatives of the model in dB by the logarithms of its parameters: for a size it is the share that the
// term has of the variance.
MatrixXd sensitivities_db(const FittedCurve& target, const std::vector<CurveTerm>& terms) {
    const MatrixXd variances = variances_of(terms, target.tau_s);
    const VectorXd total = variances.rowwise().sum().cwiseMax(1e-300);
    MatrixXd slopes(target.points(), static_cast<Index>(parameters_of(terms)));
    slopes.leftCols(variances.cols()) = variances;
    Index column = variances.cols();
    constexpr double step = 1e-4;
    for (const CurveTerm& term : terms) {
        if (!has_shape(term.kind)) { continue; }
        const CurveTerm above{term.kind, term.size, term.shape * std::exp(step)};
        const CurveTerm below{term.kind, term.size, term.shape * std::exp(-step)};
        slopes.col(column++) =
            (variances_of({above}, target.tau_s) - variances_of({below}, target.tau_s)) / (2.0 * step);
    }
    return variance_db_per_neper * total.cwiseInverse().asDiagonal() * slopes;
}

struct Candidate {
    std::vector<CurveTerm> terms;
    VectorXd residuals;  // dB
    double sum = std::numeric_limits<double>::infinity();
};

// Least squares from where `start` is. `tolerance`: relative, of the sum of squares.
Candidate fitted_from(const FittedCurve& target, const std::vector<CurveTerm>& start, double tolerance) {
    LeastSquaresProblem problem;
    problem.residuals = static_cast<std::size_t>(target.points());
    problem.evaluate = [&](std::span<const double> logs, std::span<double> residuals) {
        view_of(residuals) = residuals_db(target, terms_of(start, logs));
    };
    problem.differentiate = [&](std::span<const double> logs, Matrix& derivatives) {
        view_of(derivatives) = -sensitivities_db(target, terms_of(start, logs));
    };
    const std::vector<double> logs = least_squares(problem, logarithms_of(start), {tolerance, 400});
    Candidate candidate;
    candidate.terms = terms_of(start, logs);
    candidate.residuals = residuals_db(target, candidate.terms);
    candidate.sum = candidate.residuals.squaredNorm();
    return candidate;
}

struct JudgedCandidate {
    Candidate candidate;
    double criterion = std::numeric_limits<double>::infinity();
    double smooth_sd_db = 0.0;
};

JudgedCandidate judged(const CurveScatter& scatter, Candidate candidate) {
    if (candidate.terms.empty()) { return {}; }
    const auto fit = scatter.fit(values_of(candidate.residuals));
    const double penalty = static_cast<double>(parameters_of(candidate.terms)) *
                           std::log(static_cast<double>(candidate.residuals.size()));
    return {std::move(candidate), fit.minus_two_log_likelihood + penalty, fit.smooth_sd_db};
}

// A size at which the term stays below the curve everywhere.
CurveTerm below_curve(const FittedCurve& target, Kind kind, double shape) {
    CurveTerm unit{kind, 1.0, shape};
    double least = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < target.points(); ++i) {
        const double variance = unit.allan_variance(target.tau_s[static_cast<std::size_t>(i)]);
        if (variance > 0.0) { least = std::min(least, target.log_variance[i] - std::log(variance)); }
    }
    constexpr double part_of_variance = 0.3;
    unit.size = std::sqrt(part_of_variance * std::exp(least));
    return unit;
}

// Correlation times or frequencies of which the curve has the hump, evenly on a logarithmic axis.
std::vector<double> shapes_to_try(const FittedCurve& target, Kind kind) {
    if (!has_shape(kind)) { return {0.0}; }
    const auto [first, last] = std::minmax_element(target.tau_s.begin(), target.tau_s.end());
    const double per_octave = kind == Kind::sinusoid ? 4.0 : 1.5;
    const int steps = std::max(2, static_cast<int>(std::ceil(std::log2(*last / *first) * per_octave)));
    std::vector<double> shapes;
    for (int i = 0; i < steps; ++i) {
        const double tau_s = *first * std::pow(*last / *first, (i + 0.5) / steps);
        shapes.push_back(kind == Kind::sinusoid ? sinusoid_peak / tau_s : tau_s / gauss_markov_peak);
    }
    return shapes;
}

// Its hump lies on the curve: elsewhere it is another name for N, K or R.
bool within_curve(const FittedCurve& target, const CurveTerm& term) {
    if (!has_shape(term.kind)) { return true; }
    const auto [first, last] = std::minmax_element(target.tau_s.begin(), target.tau_s.end());
    return term.hump_tau_s() >= *first && term.hump_tau_s() <= *last;
}

// The best fit with one more term; without terms where there is none.
Candidate with_term(const FittedCurve& target, const Candidate& before, Kind kind) {
    constexpr double coarse = 1e-3;
    constexpr double fine = 1e-10;
    Candidate best;
    for (const double shape : shapes_to_try(target, kind)) {
        std::vector<CurveTerm> start = before.terms;
        start.push_back(below_curve(target, kind, shape));
        Candidate candidate = fitted_from(target, start, coarse);
        const bool inside =
            std::ranges::all_of(candidate.terms, [&](const auto& t) { return within_curve(target, t); });
        if (inside && candidate.sum < best.sum) { best = std::move(candidate); }
    }
    if (best.terms.empty()) { return best; }
    Candidate refined = fitted_from(target, best.terms, fine);
    const bool inside =
        std::ranges::all_of(refined.terms, [&](const auto& t) { return within_curve(target, t); });
    return inside && refined.sum <= best.sum ? refined : best;
}

Candidate without_term(const FittedCurve& target, const Candidate& before, std::size_t term) {
    std::vector<CurveTerm> start = before.terms;
    start.erase(start.begin() + static_cast<std::ptrdiff_t>(term));
    return fitted_from(target, start, 1e-10);
}

CurveResidual residual_of(const FittedCurve& target, const VectorXd& residuals) {
    CurveResidual residual;
    residual.rms_db = std::sqrt(residuals.squaredNorm() / static_cast<double>(residuals.size()));
    Index worst = 0;
    residuals.cwiseAbs().maxCoeff(&worst);
    residual.worst_db = residuals[worst];
    residual.worst_tau_s = target.tau_s[static_cast<std::size_t>(worst)];
    return residual;
}

// Stepwise search for the terms that the curve calls for.
class TermSearch {
public:
    TermSearch(const FittedCurve& target, double reading_sd_db)
        : target_(target), scatter_(target.tau_s, reading_sd_db) {}

    void run() {
        start();
        do { remove_idle_terms(); } while (steps.size() < steps_max && add_term());
    }

    const JudgedCandidate& result() const { return now_; }
    const CurveScatter& scatter() const { return scatter_; }
    std::vector<CurveFitStep> steps;
    std::vector<RejectedTerm> rejected;

private:
    void start() {
        Candidate candidate;
        for (const Kind kind : {Kind::N, Kind::B, Kind::K}) {
            candidate.terms.push_back(below_curve(target_, kind, 0.0));
        }
        now_ = judged(scatter_, fitted_from(target_, candidate.terms, 1e-10));
        note(CurveFitStep::Change::start, Kind::N);
    }

    bool has(Kind kind) const {
        return std::ranges::any_of(now_.candidate.terms,
                                   [&](const CurveTerm& term) { return term.kind == kind; });
    }

    // A term more must leave points over to judge it by.
    bool room_for(Kind kind) const {
        const std::size_t parameters = parameters_of(now_.candidate.terms) + parameters_of(kind);
        return now_.candidate.terms.size() < terms_max &&
               parameters + 2 <= static_cast<std::size_t>(target_.points());
    }

    bool add_term() {
        JudgedCandidate best;
        Kind added = Kind::N;
        rejected.clear();
        for (const Kind kind :
             {Kind::Q, Kind::N, Kind::B, Kind::K, Kind::R, Kind::gauss_markov, Kind::sinusoid}) {
            if ((!has_shape(kind) && has(kind)) || !room_for(kind)) { continue; }
            JudgedCandidate with = judged(scatter_, with_term(target_, now_.candidate, kind));
            if (with.candidate.terms.empty()) { continue; }
            rejected.push_back({with.candidate.terms.back(), now_.criterion - with.criterion,
                                residual_of(target_, with.candidate.residuals).rms_db});
            if (with.criterion < best.criterion) {
                best = std::move(with);
                added = kind;
            }
        }
        if (!(best.criterion < now_.criterion - term_margin_to_enter)) { return false; }
        now_ = std::move(best);
        note(CurveFitStep::Change::added, added);
        return true;
    }

    void remove_idle_terms() {
        while (now_.candidate.terms.size() > 1) {
            JudgedCandidate best;
            Kind removed = Kind::N;
            for (std::size_t i = 0; i < now_.candidate.terms.size(); ++i) {
                JudgedCandidate without = judged(scatter_, without_term(target_, now_.candidate, i));
                if (without.criterion < best.criterion) {
                    best = std::move(without);
                    removed = now_.candidate.terms[i].kind;
                }
            }
            if (!(best.criterion < now_.criterion + term_margin_to_stay)) { return; }
            now_ = std::move(best);
            note(CurveFitStep::Change::removed, removed);
        }
    }

    void note(CurveFitStep::Change change, Kind kind) {
        steps.push_back({change, kind, now_.candidate.terms, residual_of(target_, now_.candidate.residuals),
                         now_.criterion});
    }

    const FittedCurve& target_;
    CurveScatter scatter_;
    JudgedCandidate now_;
};

// How the estimates of the parameters' logarithms depend on the curve in dB.
Matrix estimators_of(const MatrixXd& sensitivities) { return pseudo_inverse(matrix_of(sensitivities)); }

NoiseModel model_of(const std::vector<CurveTerm>& terms) {
    NoiseModel model;
    for (const CurveTerm& term : terms) {
        switch (term.kind) {
            case Kind::Q:
                model.coefficients.Q_rad = term.size;
                break;
            case Kind::N:
                model.coefficients.N_rad_per_sqrt_s = term.size;
                break;
            case Kind::B:
                model.coefficients.B_rad_per_s = term.size;
                break;
            case Kind::K:
                model.coefficients.K_rad_per_s_sqrt_s = term.size;
                break;
            case Kind::R:
                model.coefficients.R_rad_per_s2 = term.size;
                break;
            case Kind::gauss_markov:
                model.gauss_markov.push_back({term.size, term.shape});
                break;
            case Kind::sinusoid:
                model.sinusoids.push_back({term.size, term.shape});
                break;
        }
    }
    return model;
}

// What an absent term would be: the best estimate of its square, and the square at which the curve would lie
// as many standard deviations below as the confidence says; its scatter is that of a curve that holds it.
FittedCoefficient absent_term(const FittedCurve& target, const TermSearch& search, Kind kind, double sigmas) {
    const Candidate& fit = search.result().candidate;
    const Matrix covariance = search.scatter().covariance(search.result().smooth_sd_db);
    CurveTerm term = below_curve(target, kind, 0.0);
    const double scale = term.size * term.size;
    double estimate = 0.0;
    double square = 1e-6;  // in units of `scale`
    FittedCoefficient absent;
    for (int pass = 0; pass < 8; ++pass) {
        std::vector<CurveTerm> terms = fit.terms;
        term.size = std::sqrt(square * scale);
        terms.push_back(term);
        const auto column = static_cast<Index>(terms.size()) - 1;
        MatrixXd slopes = sensitivities_db(target, terms);
        slopes.col(column) /= square;  // by the square itself, not its logarithm
        const Matrix estimators = estimators_of(slopes);
        const VectorXd estimator = view_of(estimators).row(column);
        const std::vector<double> pulled = transposed_product(covariance, values_of(estimator));
        const double sd = std::sqrt(dot(pulled, values_of(estimator)));
        if (pass == 0) {
            estimate = std::max(0.0, estimator.dot(fit.residuals));
            set_estimate(absent, estimate * scale, sd * scale);
        }
        square = estimate + sigmas * sd;
    }
    absent.upper = std::sqrt(square * scale);
    return absent;
}

void report_coefficients(const FittedCurve& target, const TermSearch& search, CurveModelFit& fit) {
    const double sigmas = normal_quantile(0.5 + fit.noise.confidence / 2.0);
    const Matrix estimators = estimators_of(sensitivities_db(target, fit.terms));
    const Matrix covariance = product_with_transposed(
        product(estimators, search.scatter().covariance(fit.smooth_sd_db)), estimators);
    const auto sd_of = [&](std::size_t parameter) {
        return std::sqrt(std::max(0.0, covariance(parameter, parameter)));
    };
    std::array<std::optional<std::size_t>, noise_terms> at;
    std::size_t shape_at = fit.terms.size();
    for (std::size_t j = 0; j < fit.terms.size(); ++j) {
        const CurveTerm& term = fit.terms[j];
        const double size_sd = term.size * sd_of(j) / 2.0;
        const double shape_sd = has_shape(term.kind) ? term.shape * sd_of(shape_at++) : 0.0;
        if (term.kind == Kind::gauss_markov) {
            fit.noise.gauss_markov.push_back({{term.size, term.shape}, size_sd, shape_sd});
        } else if (term.kind == Kind::sinusoid) {
            fit.noise.sinusoids.push_back({{term.size, term.shape}, size_sd, shape_sd});
        } else {
            at[static_cast<std::size_t>(term.kind)] = j;
            const double factor = std::exp(sigmas * size_sd / term.size);
            FittedCoefficient& found = fit.noise.terms[static_cast<std::size_t>(term.kind)];
            found.state = FittedCoefficient::State::identified;
            found.value = found.estimate = term.size;
            found.sd = found.estimate_sd = size_sd;
            found.lo = term.size / factor;
            found.hi = found.upper = term.size * factor;
        }
    }
    for (const Kind kind : linear_kinds) {
        const auto row = static_cast<std::size_t>(kind);
        if (!at[row]) {
            fit.noise.terms[row] = absent_term(target, search, kind, sigmas);
            continue;
        }
        for (std::size_t column = 0; column < noise_terms; ++column) {
            if (!at[column]) { continue; }
            const double product = sd_of(*at[row]) * sd_of(*at[column]);
            if (product > 0.0) {
                fit.noise.correlation[row][column] = covariance(*at[row], *at[column]) / product;
            }
        }
    }
}

}  // namespace

double CurveTerm::allan_variance(double tau_s) const {
    switch (kind) {
        case Kind::gauss_markov:
            return GaussMarkov{size, shape}.allan_variance(tau_s);
        case Kind::sinusoid:
            return Sinusoid{size, shape}.allan_variance(tau_s);
        case Kind::Q:
            return NoiseCoefficients{size, 0.0, 0.0, 0.0, 0.0}.allan_variance(tau_s);
        case Kind::N:
            return NoiseCoefficients{0.0, size, 0.0, 0.0, 0.0}.allan_variance(tau_s);
        case Kind::B:
            return NoiseCoefficients{0.0, 0.0, size, 0.0, 0.0}.allan_variance(tau_s);
        case Kind::K:
            return NoiseCoefficients{0.0, 0.0, 0.0, size, 0.0}.allan_variance(tau_s);
        case Kind::R:
            return NoiseCoefficients{0.0, 0.0, 0.0, 0.0, size}.allan_variance(tau_s);
    }
    return 0.0;
}

double CurveTerm::hump_tau_s() const {
    if (kind == Kind::gauss_markov) { return gauss_markov_peak * shape; }
    return kind == Kind::sinusoid ? sinusoid_peak / shape : 0.0;
}

std::string_view name_of(CurveTerm::Kind kind) {
    constexpr std::array<std::string_view, 7> names = {"Q", "N", "B", "K", "R", "Gauss-Markov", "sinusoid"};
    return names[static_cast<std::size_t>(kind)];
}

CurveModelFit fit_curve_model(const AllanCurve& curve, const CurveFitOptions& options) {
    CurveModelFit fit;
    fit.noise.method = FitMethod::curve;
    fit.noise.confidence = options.confidence;
    const FittedCurve target = target_of(curve);
    fit.noise.points = target.tau_s.size();
    if (target.tau_s.size() < curve_fit_points_min) { return fit; }
    const double reading_sd_db = 2.0 * variance_db_per_neper * options.reading_error;
    TermSearch search(target, reading_sd_db);
    search.run();
    fit.terms = search.result().candidate.terms;
    std::ranges::sort(fit.terms, [](const CurveTerm& a, const CurveTerm& b) {
        return a.kind != b.kind ? a.kind < b.kind : a.shape < b.shape;
    });
    fit.smooth_sd_db = search.result().smooth_sd_db;
    fit.residual = residual_of(target, search.result().candidate.residuals);
    fit.steps = std::move(search.steps);
    fit.rejected = std::move(search.rejected);
    fit.noise.best = model_of(fit.terms);
    fit.noise.sparse = fit.noise.best;
    fit.noise.worst_residual_sd =
        std::abs(fit.residual.worst_db) / std::hypot(reading_sd_db, fit.smooth_sd_db);
    report_coefficients(target, search, fit);
    return fit;
}

}  // namespace gyrolog
