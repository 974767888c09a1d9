#include "analysis/noise/noise_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "analysis/allan/degrees_of_freedom.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/eigen_view.hpp"
#include "analysis/numerics/pseudo_inverse.hpp"

namespace gyrolog {
namespace {

constexpr double edf_of_print = 50.0;
constexpr double identified_sd = 2.0;
// In the sparse model a term stays sooner: a drift left out makes a mean look known that is not.
constexpr double kept_sd = 1.0;
constexpr unsigned all_terms = (1U << noise_terms) - 1;

using Squares = Eigen::Matrix<double, static_cast<int>(noise_terms), 1>;

NoiseCoefficients coefficients_of(const Squares& squares) {
    const auto root = [&](NoiseTerm term) {
        return std::sqrt(std::max(0.0, squares[static_cast<int>(term)]));
    };
    return {root(NoiseTerm::Q), root(NoiseTerm::N), root(NoiseTerm::B), root(NoiseTerm::K),
            root(NoiseTerm::R)};
}

Eigen::MatrixXd design_of(const std::vector<AllanPoint>& points) {
    Eigen::MatrixXd design(static_cast<Eigen::Index>(points.size()), static_cast<Eigen::Index>(noise_terms));
    for (Eigen::Index i = 0; i < design.rows(); ++i) {
        for (Eigen::Index j = 0; j < design.cols(); ++j) {
            Squares one = Squares::Zero();
            one[j] = 1.0;
            design(i, j) = coefficients_of(one).allan_variance(points[static_cast<std::size_t>(i)].tau_s);
        }
    }
    return design;
}

// Columns of terms with an active bit, in the order of the terms.
std::vector<Eigen::Index> active_columns(unsigned active) {
    std::vector<Eigen::Index> columns;
    for (unsigned j = 0; j < noise_terms; ++j) {
        if ((active >> j & 1U) != 0) { columns.push_back(static_cast<Eigen::Index>(j)); }
    }
    return columns;
}

struct Solution {
    unsigned active = 0;
    Squares squares = Squares::Zero();
    double cost = 0.0;
};

// Least squares on the active terms. Rows are scaled by the weights' roots; columns to length one, because
// the squares of the coefficients differ by many orders of magnitude.
Solution solve_active(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right, unsigned active) {
    const auto columns = active_columns(active);
    Eigen::MatrixXd part = rows(Eigen::all, columns);
    const Eigen::VectorXd lengths = part.colwise().norm();
    for (Eigen::Index c = 0; c < part.cols(); ++c) { part.col(c) /= lengths[c]; }
    const std::vector<double> solved = solve_least_squares(matrix_of(part), values_of(right));
    const auto x = view_of(std::span<const double>(solved));
    Solution solution;
    solution.active = active;
    solution.cost = (part * x - right).squaredNorm();
    for (Eigen::Index c = 0; c < part.cols(); ++c) {
        solution.squares[columns[static_cast<std::size_t>(c)]] = x[c] / lengths[c];
    }
    return solution;
}

// Non-negative least squares by trying every set of terms: there are 31. N comes first, so that a tie is
// white noise.
Solution solve_non_negative(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right, unsigned allowed) {
    constexpr unsigned white = 1U << static_cast<unsigned>(NoiseTerm::N);
    Solution best = solve_active(rows, right, white);
    for (unsigned active = 1; active <= all_terms; ++active) {
        if ((active & ~allowed) != 0) { continue; }
        const auto columns = active_columns(active);
        if (static_cast<Eigen::Index>(columns.size()) > rows.rows()) { continue; }
        const Solution solution = solve_active(rows, right, active);
        if (solution.squares.minCoeff() < 0.0) { continue; }
        if (solution.cost < best.cost - 1e-12 * right.squaredNorm()) { best = solution; }
    }
    return best;
}

// What decides the scatter of one point of the curve.
class PointScatter {
public:
    PointScatter(const AllanPoint& point, DeviationKind kind) : tau_s_(point.tau_s) {
        if (point.terms <= 0 || point.m <= 0) { return; }
        constexpr std::array laws = {PowerLaw::white_angle, PowerLaw::white_rate, PowerLaw::flicker_rate,
                                     PowerLaw::rate_walk};
        degrees_.emplace(laws, rule_of(kind), point.m, std::array{point.terms});
    }

    // Standard deviation of the Allan variance estimate under a model. A ramp is no noise, but where it
    // dominates the point says little about the others: it is given the longest memory there is.
    double sd(const NoiseCoefficients& model) const {
        VarianceShares shares{};
        const auto add = [&](PowerLaw law, const NoiseCoefficients& only) {
            shares[static_cast<std::size_t>(law)] += only.allan_variance(tau_s_);
        };
        add(PowerLaw::white_angle, {model.Q_rad, 0.0, 0.0, 0.0, 0.0});
        add(PowerLaw::white_rate, {0.0, model.N_rad_per_sqrt_s, 0.0, 0.0, 0.0});
        add(PowerLaw::flicker_rate, {0.0, 0.0, model.B_rad_per_s, 0.0, 0.0});
        add(PowerLaw::rate_walk, {0.0, 0.0, 0.0, model.K_rad_per_s_sqrt_s, model.R_rad_per_s2});
        const double variance = model.allan_variance(tau_s_);
        const double edf = degrees_ && variance > 0.0 ? degrees_->of(shares) : edf_of_print;
        return std::max(variance, 1e-300) * std::sqrt(2.0 / edf);
    }

private:
    double tau_s_;
    std::optional<DegreesOfFreedom> degrees_;
};

// Correlation of Allan variance estimates:
//   cov(s_i, s_j) ~ (2 / T) integral of S(f)^2 |H_i(f)|^2 |H_j(f)|^2 df,  |H_m|^2 = 2 sin^4(pi f m tau0) /
//   (m sin(pi f tau0))^2
// for differences that are stationary, averaged over T. Only its shape is used here: T differs from point to
// point, and the degrees of freedom say the diagonal better. 1 / f is taken as that of samples, pi tau0 /
// sin(pi f tau0).
class DifferenceSpectra {
public:
    explicit DifferenceSpectra(const std::vector<AllanPoint>& points) {
        const AllanPoint& first = points.front();
        // A curve from print does not say how its samples were taken; its first point stands well above them.
        const double tau0_s = first.m > 0 ? first.tau_s / static_cast<double>(first.m) : first.tau_s / 4.0;
        constexpr int per_octave = 61;
        const double low_hz = 1.0 / (64.0 * points.back().tau_s);
        const double octaves = std::log2(0.5 / tau0_s / low_hz);
        const auto steps = static_cast<Eigen::Index>(std::ceil(octaves * per_octave));
        const double ratio = std::exp2(octaves / static_cast<double>(steps));
        gains_.resize(steps, static_cast<Eigen::Index>(points.size()));
        for (Eigen::Index q = 0; q < steps; ++q) {
            const double f_hz = low_hz * std::pow(ratio, static_cast<double>(q) + 0.5);
            const double sine = std::sin(pi * f_hz * tau0_s);
            f_of_samples_hz_.push_back(sine / (pi * tau0_s));
            root_width_.push_back(std::sqrt(f_hz * (std::sqrt(ratio) - 1.0 / std::sqrt(ratio))));
            for (Eigen::Index i = 0; i < gains_.cols(); ++i) {
                const double tau_s = points[static_cast<std::size_t>(i)].tau_s;
                const double swing = std::sin(pi * f_hz * tau_s) * std::sin(pi * f_hz * tau_s);
                gains_(q, i) = 2.0 * std::pow(swing * tau0_s / (tau_s * sine), 2);
            }
        }
    }

    // Standard deviation of sum_i estimator_i s_i, where s_i has standard deviation 1.
    double deviation_of(const Eigen::RowVectorXd& estimator, const NoiseCoefficients& model) const {
        NoiseCoefficients noise = model;
        noise.R_rad_per_s2 = 0.0;  // a ramp is no noise
        Eigen::VectorXd spectrum(gains_.rows());
        for (Eigen::Index q = 0; q < spectrum.size(); ++q) {
            const auto at = static_cast<std::size_t>(q);
            spectrum[q] = noise.psd(f_of_samples_hz_[at]) * root_width_[at];
        }
        const Eigen::MatrixXd filtered = spectrum.asDiagonal() * gains_;
        const Eigen::RowVectorXd lengths = filtered.colwise().norm().cwiseMax(1e-300);
        return (filtered * estimator.cwiseQuotient(lengths).transpose()).norm();
    }

private:
    Eigen::MatrixXd gains_;  // |H|^2 by frequency and point
    std::vector<double> f_of_samples_hz_;
    std::vector<double> root_width_;
};

// The converged fit: what the measured variances were divided by, and what came out.
struct Weighted {
    const std::vector<AllanPoint>& points;
    std::vector<PointScatter> scatter;
    DifferenceSpectra spectra;
    Eigen::MatrixXd design;
    Eigen::VectorXd measured;  // Allan variances
    Eigen::VectorXd sd;        // of each, under the model fitted last
    Eigen::MatrixXd rows;      // design over sd
    Eigen::VectorXd right;     // measured over sd
    Solution solution;
};

Eigen::VectorXd deviations_under(const Weighted& fit, const NoiseCoefficients& model) {
    Eigen::VectorXd sd(static_cast<Eigen::Index>(fit.scatter.size()));
    for (Eigen::Index i = 0; i < sd.size(); ++i) {
        sd[i] = fit.scatter[static_cast<std::size_t>(i)].sd(model);
    }
    return sd;
}

void weight(Weighted& fit, Eigen::VectorXd sd) {
    fit.sd = std::move(sd);
    fit.rows = fit.sd.cwiseInverse().asDiagonal() * fit.design;
    fit.right = fit.measured.cwiseQuotient(fit.sd);
}

// Weights start from the measured values and then follow the model until it stands still.
void fit_terms(Weighted& fit, unsigned allowed) {
    fit.measured.resize(fit.design.rows());
    Eigen::VectorXd sd(fit.design.rows());
    for (Eigen::Index i = 0; i < sd.size(); ++i) {
        const AllanPoint& p = fit.points[static_cast<std::size_t>(i)];
        fit.measured[i] = p.deviation * p.deviation;
        sd[i] = fit.measured[i] * std::sqrt(2.0 / (p.edf > 0.0 ? p.edf : edf_of_print));
    }
    weight(fit, std::move(sd));
    Eigen::VectorXd model = Eigen::VectorXd::Zero(fit.design.rows());
    for (int pass = 0; pass < 12; ++pass) {
        fit.solution = solve_non_negative(fit.rows, fit.right, allowed);
        const Eigen::VectorXd before = std::exchange(model, fit.design * fit.solution.squares);
        weight(fit, deviations_under(fit, coefficients_of(fit.solution.squares)));
        if ((model - before).cwiseQuotient(model.cwiseMax(1e-300)).cwiseAbs().maxCoeff() < 1e-6) { break; }
    }
}

// How the estimate of one squared coefficient depends on the weighted variances, with the term and the active
// ones free.
Eigen::RowVectorXd estimator_of(const Weighted& fit, Eigen::Index term) {
    const auto columns = active_columns(fit.solution.active | 1U << static_cast<unsigned>(term));
    Eigen::MatrixXd part = fit.rows(Eigen::all, columns);
    const Eigen::VectorXd lengths = part.colwise().norm();
    for (Eigen::Index c = 0; c < part.cols(); ++c) { part.col(c) /= lengths[c]; }
    const Matrix inverse = pseudo_inverse(matrix_of(part));
    const auto at = std::find(columns.begin(), columns.end(), term) - columns.begin();
    return view_of(inverse).row(at) / lengths[at];
}

double estimator_sd(const Weighted& fit, const Eigen::RowVectorXd& estimator,
                    const NoiseCoefficients& model) {
    const Eigen::VectorXd scale = deviations_under(fit, model).cwiseQuotient(fit.sd);
    return fit.spectra.deviation_of(estimator.cwiseProduct(scale.transpose()), model);
}

// The upper end of the two-sided interval: the square u of which an estimate as low as this one is as many
// standard deviations below as the confidence says. The estimate scatters more the larger the true value is,
// so the standard deviation belongs to u and not to the estimate.
double upper_square(const Weighted& fit, Eigen::Index term, const Eigen::RowVectorXd& estimator,
                    double square, double confidence) {
    const double sigmas = normal_quantile(0.5 + confidence / 2.0);
    double upper = square;
    for (int pass = 0; pass < 4; ++pass) {
        Squares squares = fit.solution.squares;
        squares[term] = upper;
        upper = square + sigmas * estimator_sd(fit, estimator, coefficients_of(squares));
    }
    return upper;
}

FittedCoefficient judged(const Weighted& fit, Eigen::Index term, double confidence) {
    const Eigen::RowVectorXd estimator = estimator_of(fit, term);
    const double square = std::max(0.0, estimator.dot(fit.right));
    const double square_sd = estimator_sd(fit, estimator, coefficients_of(fit.solution.squares));
    FittedCoefficient fitted;
    fitted.upper = std::sqrt(upper_square(fit, term, estimator, square, confidence));
    set_estimate(fitted, square, square_sd);
    const bool active = (fit.solution.active >> static_cast<unsigned>(term) & 1U) != 0;
    if (!active || !(square > identified_sd * square_sd)) { return fitted; }
    const double half = normal_quantile(0.5 + confidence / 2.0) * square_sd;
    fitted.state = FittedCoefficient::State::identified;
    fitted.value = std::sqrt(square);
    fitted.sd = square_sd / (2.0 * fitted.value);
    fitted.lo = std::sqrt(std::max(0.0, square - half));
    fitted.hi = std::sqrt(square + half);
    return fitted;
}

// Takes the least significant term out and fits again, until every term left is significant.
void drop_insignificant_terms(Weighted& fit) {
    while (true) {
        const auto columns = active_columns(fit.solution.active);
        if (columns.size() < 2) { return; }
        const NoiseCoefficients model = coefficients_of(fit.solution.squares);
        Eigen::Index weakest = columns.front();
        double least = std::numeric_limits<double>::infinity();
        for (const Eigen::Index term : columns) {
            const Eigen::RowVectorXd estimator = estimator_of(fit, term);
            const double significance = estimator.dot(fit.right) / estimator_sd(fit, estimator, model);
            if (significance < least) {
                least = significance;
                weakest = term;
            }
        }
        if (!(least < kept_sd)) { return; }
        fit_terms(fit, fit.solution.active & ~(1U << static_cast<unsigned>(weakest)));
    }
}

// No more terms than the points can tell apart and leave one over: with two points of white noise, N, B and Q
// together would meet both exactly and mean nothing.
unsigned terms_for(std::size_t points) {
    constexpr std::array by_need{NoiseTerm::N, NoiseTerm::B, NoiseTerm::K, NoiseTerm::Q, NoiseTerm::R};
    const std::size_t count = std::clamp<std::size_t>(points, 2, noise_terms + 1) - 1;
    unsigned terms = 0;
    for (std::size_t i = 0; i < count; ++i) { terms |= 1U << static_cast<unsigned>(by_need[i]); }
    return terms;
}

std::vector<AllanPoint> points_of_fit(const AllanCurve& curve) {
    std::vector<AllanPoint> points;
    std::ranges::copy_if(curve.points, std::back_inserter(points),
                         [](const AllanPoint& p) { return p.deviation > 0.0 && p.tau_s > 0.0; });
    return points;
}

}  // namespace

std::string_view name_of(NoiseTerm term) {
    constexpr std::array<std::string_view, noise_terms> names = {"Q", "N", "B", "K", "R"};
    return names[static_cast<std::size_t>(term)];
}

void set_estimate(FittedCoefficient& fitted, double square, double square_sd) {
    fitted.estimate = std::sqrt(std::max(0.0, square));
    fitted.estimate_sd = std::sqrt(std::max(0.0, square) + square_sd) - fitted.estimate;
}

std::string_view name_of(FitMethod method) { return method == FitMethod::curve ? "curve" : "likelihood"; }

bool NoiseFit::is_of_motion() const {
    // Share of the model (model_error).
    constexpr double hopeless_error = 0.5;
    return method == FitMethod::likelihood && model_error > hopeless_error;
}

NoiseModel NoiseFit::identified() const {
    const auto value = [&](NoiseTerm term) {
        const FittedCoefficient& fitted = (*this)[term];
        return fitted.state == FittedCoefficient::State::identified ? fitted.value : 0.0;
    };
    NoiseModel model;
    model.coefficients = {value(NoiseTerm::Q), value(NoiseTerm::N), value(NoiseTerm::B), value(NoiseTerm::K),
                          value(NoiseTerm::R)};
    for (const FittedGaussMarkov& noise : gauss_markov) { model.gauss_markov.push_back(noise.value); }
    for (const FittedSinusoid& line : sinusoids) { model.sinusoids.push_back(line.value); }
    return model;
}

NoiseFit fit_noise(const AllanCurve& curve, double confidence) {
    NoiseFit fit;
    fit.confidence = confidence;
    const std::vector<AllanPoint> points = points_of_fit(curve);
    fit.points = points.size();
    if (points.empty()) { return fit; }
    std::vector<PointScatter> scatter;
    scatter.reserve(points.size());
    for (const AllanPoint& point : points) { scatter.emplace_back(point, curve.kind); }
    Weighted weighted{
        points, std::move(scatter), DifferenceSpectra(points), design_of(points), {}, {}, {}, {}, {}};
    fit_terms(weighted, terms_for(points.size()));
    fit.best.coefficients = coefficients_of(weighted.solution.squares);
    fit.worst_residual_sd =
        (weighted.rows * weighted.solution.squares - weighted.right).cwiseAbs().maxCoeff();
    for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(noise_terms); ++j) {
        fit.terms[static_cast<std::size_t>(j)] = judged(weighted, j, confidence);
    }
    drop_insignificant_terms(weighted);
    fit.sparse.coefficients = coefficients_of(weighted.solution.squares);
    return fit;
}

}  // namespace gyrolog
