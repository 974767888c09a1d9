#include "analysis/calibrate/gyro_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/least_squares.hpp"
#include "analysis/numerics/robust_spread.hpp"

namespace gyrolog {
namespace {

// All parameters: an axis' bias, its three of K, its three of M, axis by axis.
constexpr std::size_t of_an_axis = 7;
constexpr std::size_t all_parameters = 3 * of_an_axis;
constexpr std::size_t K_at = 1;
constexpr std::size_t M_at = 4;

constexpr std::size_t bias_of(std::size_t axis) { return axis * of_an_axis; }
constexpr std::size_t M_of(std::size_t axis, std::size_t from) { return axis * of_an_axis + M_at + from; }

std::string symbol(std::size_t parameter) {
    const std::size_t axis = parameter / of_an_axis;
    const std::size_t within = parameter % of_an_axis;
    if (within == 0) { return std::string("bias_") + axis_names[axis]; }
    const bool is_M = within >= M_at;
    return std::string(is_M ? "M_" : "K_") + axis_names[axis] + axis_names[within - (is_M ? M_at : K_at)];
}

struct Gyro {
    Vector3 bias{};
    Matrix3 K{};
    Matrix3 M = identity_matrix;
};

// O. Rodrigues' formula: the vector turned by the length of `turn_rad` about its direction.
Vector3 turned(const Vector3& vector, const Vector3& turn_rad) {
    const double angle = norm(turn_rad);
    if (angle == 0.0) { return vector; }
    const Vector3 axis = scaled(turn_rad, 1.0 / angle);
    const double along = dot(axis, vector) * (1.0 - std::cos(angle));
    return sum_of(sum_of(scaled(vector, std::cos(angle)), scaled(cross(axis, vector), std::sin(angle))),
                  scaled(axis, along));
}

// Where the gyro sees gravity's direction end.
Vector3 carried(const Gyro& gyro, const Matrix3& correction, const GravityMove& move) {
    const auto rate = [&](std::size_t row) {
        const Vector3 zero = sum_of(gyro.bias, product(gyro.K, move.force_m_s2[row]));
        return product(correction, difference(move.measured_rad_s[row], zero));
    };
    Vector3 up = move.up_before;
    Vector3 last = rate(0);
    for (std::size_t row = 1; row < move.measured_rad_s.size(); ++row) {
        const Vector3 now = rate(row);
        up = turned(up, scaled(sum_of(last, now), -0.5 * move.row_s));
        last = now;
    }
    return up;
}

// Two directions across, for the two components that a difference of directions has.
std::array<Vector3, 2> across(const Vector3& up) {
    std::size_t least = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
        if (std::abs(up[axis]) < std::abs(up[least])) { least = axis; }
    }
    Vector3 other{};
    other[least] = 1.0;
    const Vector3 first = cross(up, other);
    const Vector3 one = scaled(first, 1.0 / norm(first));
    return {one, cross(up, one)};
}

class Equations {
public:
    Equations(const GyroObservations& observations, const GyroFitOptions& options)
        : of_(observations), options_(options) {
        active_.resize(all_parameters);
        std::iota(active_.begin(), active_.end(), 0U);
        sd_factor_.fill(1.0);
    }

    std::size_t size() const { return 3 * of_.means.size() + 2 * of_.moves.size(); }
    const std::vector<std::size_t>& active() const { return active_; }
    void keep(const std::vector<std::size_t>& parameters) { active_ = parameters; }

    ObservationKind kind(std::size_t equation) const {
        const std::size_t of_means = 3 * of_.means.size();
        return equation < of_means ? of_.means[equation / 3].kind : ObservationKind::gravity;
    }
    double sd(std::size_t equation) const {
        const std::size_t of_means = 3 * of_.means.size();
        const double stated = equation < of_means ? of_.means[equation / 3].sd_rad_s[equation % 3]
                                                  : of_.moves[(equation - of_means) / 2].sd_rad;
        return stated * factor(kind(equation));
    }
    double factor(ObservationKind kind) const { return sd_factor_[static_cast<std::size_t>(kind)]; }
    void raise(ObservationKind kind, double by) { sd_factor_[static_cast<std::size_t>(kind)] *= by; }

    std::vector<double> start() const {
        std::vector<double> all(all_parameters, 0.0);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            all[M_of(axis, axis)] = 1.0;
            all[bias_of(axis)] = median_at_rest(axis);
        }
        std::vector<double> at;
        for (const std::size_t parameter : active_) { at.push_back(all[parameter]); }
        return at;
    }

    Gyro gyro(std::span<const double> at) const {
        Gyro gyro;
        for (std::size_t i = 0; i < at.size(); ++i) {
            const std::size_t axis = active_[i] / of_an_axis;
            const std::size_t within = active_[i] % of_an_axis;
            if (within == 0) {
                gyro.bias[axis] = at[i];
            } else if (within < M_at) {
                gyro.K[axis][within - K_at] = at[i];
            } else {
                gyro.M[axis][within - M_at] = at[i];
            }
        }
        return gyro;
    }

    std::vector<double> prior_sd() const {
        const SensorTolerance& tolerance = options_.tolerance;
        std::vector<double> sd;
        for (const std::size_t parameter : active_) {
            const std::size_t axis = parameter / of_an_axis;
            const std::size_t within = parameter % of_an_axis;
            if (within == 0) {
                sd.push_back(tolerance.bias_rad_s);
            } else if (within < M_at) {
                sd.push_back(tolerance.g_sensitivity_s_per_m);
            } else {
                sd.push_back(within - M_at == axis ? tolerance.scale : tolerance.cross_axis);
            }
        }
        return sd;
    }

    // Over their sigmas.
    void residuals(std::span<const double> at, std::span<double> values) const {
        const Gyro g = gyro(at);
        const Matrix3 correction = inverse(g.M).value_or(identity_matrix);
        std::size_t n = 0;
        for (const MeanRate& mean : of_.means) {
            const Vector3 expected =
                sum_of(g.bias, sum_of(product(g.K, mean.force_m_s2), product(g.M, mean.rate_rad_s)));
            const Vector3 error = difference(mean.measured_rad_s, expected);
            for (const double component : error) { write(values, n, component); }
        }
        for (const GravityMove& move : of_.moves) {
            const Vector3 error = difference(carried(g, correction, move), move.up_after);
            for (const Vector3& direction : across(move.up_after)) {
                write(values, n, dot(error, direction));
            }
        }
    }

    void differentiate(std::span<const double> at, Matrix& J) const {
        std::ranges::fill(J.values(), 0.0);
        for (std::size_t i = 0; i < active_.size(); ++i) {
            const std::size_t axis = active_[i] / of_an_axis;
            const std::size_t within = active_[i] % of_an_axis;
            for (std::size_t m = 0; m < of_.means.size(); ++m) {
                const MeanRate& mean = of_.means[m];
                double by = 1.0;
                if (within >= M_at) {
                    by = mean.rate_rad_s[within - M_at];
                } else if (within >= K_at) {
                    by = mean.force_m_s2[within - K_at];
                }
                J(3 * m + axis, i) = -by / sd(3 * m + axis);
            }
        }
        if (!of_.moves.empty()) { differentiate_moves(at, J); }
    }

private:
    void write(std::span<double> values, std::size_t& n, double error) const {
        values[n] = error / sd(n);
        ++n;
    }

    void differentiate_moves(std::span<const double> at, Matrix& J) const {
        const std::vector<double> prior = prior_sd();
        std::vector<double> moved(at.begin(), at.end());
        for (std::size_t i = 0; i < active_.size(); ++i) {
            const double step = options_.step_of_prior * prior[i];
            moved[i] = at[i] + step;
            const std::vector<double> above = ends(moved);
            moved[i] = at[i] - step;
            const std::vector<double> below = ends(moved);
            moved[i] = at[i];
            for (std::size_t n = 0; n < above.size(); ++n) {
                const std::size_t row = 3 * of_.means.size() + n;
                J(row, i) = (above[n] - below[n]) / (2.0 * step) / sd(row);
            }
        }
    }

    // Components across, of all moves.
    std::vector<double> ends(std::span<const double> at) const {
        const Gyro g = gyro(at);
        const Matrix3 correction = inverse(g.M).value_or(identity_matrix);
        std::vector<double> ends;
        for (const GravityMove& move : of_.moves) {
            const Vector3 up = carried(g, correction, move);
            for (const Vector3& direction : across(move.up_after)) { ends.push_back(dot(up, direction)); }
        }
        return ends;
    }

    double median_at_rest(std::size_t axis) const {
        std::vector<double> rates;
        for (const MeanRate& mean : of_.means) {
            if (mean.kind == ObservationKind::rest) { rates.push_back(mean.measured_rad_s[axis]); }
        }
        return rates.empty() ? 0.0 : median_of(rates);
    }

    const GyroObservations& of_;
    const GyroFitOptions& options_;
    std::vector<std::size_t> active_;
    std::array<double, observation_kinds.size()> sd_factor_{};
};

Matrix derivatives(const Equations& equations, std::span<const double> at) {
    Matrix J(equations.size(), at.size());
    equations.differentiate(at, J);
    return J;
}

bool is_K(std::size_t parameter) { return parameter % of_an_axis >= K_at && parameter % of_an_axis < M_at; }
bool is_M(std::size_t parameter) { return parameter % of_an_axis >= M_at; }
std::size_t column_of(std::size_t of_M) { return of_M % of_an_axis - M_at; }
bool is_scale(std::size_t of_M) { return of_M / of_an_axis == column_of(of_M); }

// By what it is of: a turn's axis.
void name_open(const std::vector<std::size_t>& dropped, GyroResult& result) {
    for (std::size_t column = 0; column < 3; ++column) {
        bool scale = false;
        bool others = false;
        for (const std::size_t parameter : dropped) {
            if (!is_M(parameter) || column_of(parameter) != column) { continue; }
            (is_scale(parameter) ? scale : others) = true;
        }
        if (!scale && !others) { continue; }
        const std::string what = std::string(scale ? "scale" : "") + (scale && others ? " and " : "") +
                                 (others ? "misalignment" : "");
        result.undetermined.push_back(what + " of turns about " + axis_names[column]);
    }
}

// Takes out what the data leave open, K as a whole and M's by themselves, until all is determined.
void keep_determined(Equations& equations, const GyroFitOptions& options, GyroResult& result) {
    std::vector<std::size_t> dropped;
    for (;;) {
        const std::vector<double> at = equations.start();
        const Matrix information = information_of(derivatives(equations, at));
        std::vector<std::size_t> open;
        for (const std::size_t i :
             undetermined(information, equations.prior_sd(), options.tolerance.share_most)) {
            open.push_back(equations.active()[i]);
        }
        // A bias that is open alone is what it is: K, and then M, are dropped before it.
        const bool drop_K = std::ranges::any_of(open, is_K);
        if (!drop_K && std::ranges::none_of(open, is_M)) { break; }
        if (drop_K) { result.undetermined.emplace_back("g-sensitivity"); }
        std::vector<std::size_t> kept;
        for (const std::size_t parameter : equations.active()) {
            const bool is_open = std::ranges::find(open, parameter) != open.end();
            const bool drop = drop_K ? is_K(parameter) : is_M(parameter) && is_open;
            (drop ? dropped : kept).push_back(parameter);
        }
        equations.keep(kept);
    }
    name_open(dropped, result);
}

std::vector<double> solve(const Equations& equations, std::span<const double> start) {
    LeastSquaresProblem problem;
    problem.residuals = equations.size();
    problem.evaluate = [&](std::span<const double> at, std::span<double> values) {
        equations.residuals(at, values);
    };
    problem.differentiate = [&](std::span<const double> at, Matrix& J) { equations.differentiate(at, J); };
    LeastSquaresLimits limits;
    limits.tolerance = 1e-10;
    return least_squares(problem, start, limits);
}

// J_k C J_k' along its diagonal: the share of the parameters that an equation determines.
std::vector<double> shares_of(const Matrix& J, const Matrix& covariance) {
    std::vector<double> shares(J.rows(), 0.0);
    for (std::size_t row = 0; row < J.rows(); ++row) {
        for (std::size_t i = 0; i < J.columns(); ++i) {
            for (std::size_t j = 0; j < J.columns(); ++j) {
                shares[row] += J(row, i) * covariance(i, j) * J(row, j);
            }
        }
    }
    return shares;
}

std::vector<ObservationFit> fits_of(const Equations& equations, const std::vector<double>& at,
                                    const Matrix& J, const Matrix& covariance,
                                    std::vector<double>& chi_squared) {
    std::vector<double> residuals(equations.size());
    equations.residuals(at, residuals);
    const std::vector<double> shares = shares_of(J, covariance);
    std::vector<ObservationFit> fits;
    chi_squared.clear();
    for (const ObservationKind kind : observation_kinds) {
        ObservationFit fit{kind, 0, 0.0, equations.factor(kind), 0.0};
        double chi = 0.0;
        for (std::size_t n = 0; n < residuals.size(); ++n) {
            if (equations.kind(n) != kind) { continue; }
            ++fit.count;
            fit.redundancy += 1.0 - shares[n];
            chi += residuals[n] * residuals[n];
            fit.rms += residuals[n] * equations.sd(n) * residuals[n] * equations.sd(n);
        }
        if (fit.count == 0) { continue; }
        fit.rms = std::sqrt(fit.rms / static_cast<double>(fit.count));
        fits.push_back(fit);
        chi_squared.push_back(chi);
    }
    return fits;
}

// Raises the sigmas of the kind that is off most: others may be off because of it. Whether it raised any.
bool weight_again(Equations& equations, const std::vector<ObservationFit>& fits,
                  const std::vector<double>& chi_squared, const GyroFitOptions& options) {
    std::size_t most = fits.size();
    double by_most = 0.0;
    for (std::size_t k = 0; k < fits.size(); ++k) {
        // Less than one equation that is spare tells no size.
        if (!(fits[k].redundancy >= 1.0)) { continue; }
        const bool is_raised = fits[k].sd_factor > 1.0;
        const bool is_unlikely =
            chi_squared[k] > chi_squared_upper_quantile(fits[k].redundancy, options.chance_least);
        if (!is_raised && !is_unlikely) { continue; }
        // What was raised may fall again, to what was stated.
        const double by =
            std::log(std::max(1.0 / fits[k].sd_factor, std::sqrt(chi_squared[k] / fits[k].redundancy)));
        if (std::abs(by) > std::max(std::abs(by_most), options.factor_settled)) {
            by_most = by;
            most = k;
        }
    }
    if (most == fits.size()) { return false; }
    equations.raise(fits[most].kind, std::exp(by_most));
    return true;
}

void fill(GyroCalibration& result, const Equations& equations, const std::vector<double>& at,
          const Matrix& covariance) {
    const Gyro gyro = equations.gyro(at);
    result.bias_rad_s = gyro.bias;
    result.M = gyro.M;
    result.K_s_per_m = gyro.K;
    result.covariance = covariance;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const std::size_t parameter = equations.active()[i];
        result.names.push_back(symbol(parameter));
        const std::size_t axis = parameter / of_an_axis;
        const std::size_t within = parameter % of_an_axis;
        const double sd = std::sqrt(covariance(i, i));
        if (within == 0) {
            result.bias_sd_rad_s[axis] = sd;
        } else if (is_K(parameter)) {
            result.K_sd_s_per_m[axis][within - K_at] = sd;
            result.has_g_sensitivity = true;
        } else {
            result.M_sd[axis][within - M_at] = sd;
            if (within - M_at == axis) { result.has_scale[axis] = true; }
        }
    }
}

}  // namespace

GyroResult fit_gyro(const GyroObservations& observations, const GyroFitOptions& options) {
    GyroResult result;
    Equations equations(observations, options);
    if (observations.means.empty()) { return result; }
    keep_determined(equations, options, result);
    std::vector<double> at = equations.start();
    Matrix covariance;
    GyroCalibration calibration;
    for (int weighting = 0; weighting < options.weightings_most; ++weighting) {
        at = solve(equations, at);
        const Matrix J = derivatives(equations, at);
        const CholeskyFactor factor(information_of(J));
        if (!factor.is_positive_definite()) { return result; }
        covariance = factor.inverse();
        std::vector<double> chi_squared;
        calibration.fits = fits_of(equations, at, J, covariance, chi_squared);
        if (!weight_again(equations, calibration.fits, chi_squared, options)) { break; }
    }
    fill(calibration, equations, at, covariance);
    result.calibration = std::move(calibration);
    return result;
}

}  // namespace gyrolog
