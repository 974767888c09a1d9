#include "analysis/calibrate/accelerometer_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/least_squares.hpp"
#include "analysis/numerics/robust_spread.hpp"

namespace gyrolog {
namespace {

struct Place {
    std::size_t row = 0;
    std::size_t column = 0;
};

// Of M's parameters, then the biases. The first three are the diagonal.
constexpr std::array<Place, 6> places = {{{0, 0}, {1, 1}, {2, 2}, {1, 0}, {2, 0}, {2, 1}}};
constexpr std::size_t scales = 3;
constexpr std::size_t biases = 3;

std::string cross_name(std::size_t p) {
    return std::string("misalignment of ") + axis_names[places[p].row] + " from " +
           axis_names[places[p].column];
}

struct Sensor {
    Matrix3 M = identity_matrix;
    Vector3 bias{};
};

class RestFit {
public:
    RestFit(std::span<const Rest> rests, const MeanScatter& scatter, const AccelerometerFitOptions& options,
            bool with_misalignment)
        : scatter_(&scatter), options_(&options), of_M_(with_misalignment ? places.size() : scales) {
        for (const Rest& rest : rests) {
            forces_.push_back(rest.force_m_s2);
            durations_s_.push_back(rest.duration_s);
        }
    }

    std::size_t parameters() const { return of_M_ + biases; }
    std::size_t rests() const { return forces_.size(); }

    std::vector<double> start() const {
        std::vector<double> at(parameters(), 0.0);
        std::fill_n(at.begin(), scales, 1.0);
        return at;
    }

    Sensor sensor(std::span<const double> at) const {
        Sensor sensor;
        for (std::size_t p = 0; p < of_M_; ++p) { sensor.M[places[p].row][places[p].column] = at[p]; }
        std::copy_n(at.begin() + static_cast<std::ptrdiff_t>(of_M_), biases, sensor.bias.begin());
        return sensor;
    }

    std::vector<double> prior_sd() const {
        std::vector<double> sd(parameters(), options_->tolerance.bias_m_s2);
        std::fill_n(sd.begin(), of_M_, options_->tolerance.cross_axis);
        std::fill_n(sd.begin(), scales, options_->tolerance.scale);
        return sd;
    }

    std::string name(std::size_t p) const {
        if (p >= of_M_) { return "bias " + std::string(axis_names[p - of_M_]); }
        return p < scales ? "scale " + std::string(axis_names[p]) : cross_name(p);
    }

    std::string symbol(std::size_t p) const {
        if (p >= of_M_) { return std::string("bias_") + axis_names[p - of_M_]; }
        return std::string("M_") + axis_names[places[p].row] + axis_names[places[p].column];
    }

    double residual_m_s2(const Sensor& sensor, std::size_t rest) const {
        const auto inverse = gyrolog::inverse(sensor.M);
        if (!inverse) { return options_->gravity_m_s2; }
        return norm(product(*inverse, difference(forces_[rest], sensor.bias))) - options_->gravity_m_s2;
    }

    void residuals(std::span<const double> at, std::span<double> values) const {
        const Sensor s = sensor(at);
        for (std::size_t i = 0; i < rests(); ++i) {
            values[i] = residual_m_s2(s, i) / sd_m_s2(s, forces_[i], durations_s_[i]);
        }
    }

    // With a = M^-1 (y - b) and n = M^-T a / |a|: d|a| = -n' db - n' dM a.
    std::vector<double> row(const Sensor& s, const Vector3& force, double duration_s) const {
        std::vector<double> row(parameters());
        const Matrix3 inverse = *gyrolog::inverse(s.M);
        const Vector3 a = product(inverse, difference(force, s.bias));
        const Vector3 n = scaled(product(transposed(inverse), a), 1.0 / norm(a));
        const double weight = 1.0 / sd_m_s2(s, force, duration_s);
        for (std::size_t p = 0; p < of_M_; ++p) { row[p] = -n[places[p].row] * a[places[p].column] * weight; }
        for (std::size_t axis = 0; axis < biases; ++axis) { row[of_M_ + axis] = -n[axis] * weight; }
        return row;
    }

    void differentiate(std::span<const double> at, Matrix& derivatives) const {
        const Sensor s = sensor(at);
        for (std::size_t i = 0; i < rests(); ++i) {
            const std::vector<double> one = row(s, forces_[i], durations_s_[i]);
            for (std::size_t p = 0; p < one.size(); ++p) { derivatives(i, p) = one[p]; }
        }
    }

    Matrix derivatives(std::span<const double> at) const {
        Matrix derivatives(rests(), parameters());
        differentiate(at, derivatives);
        return derivatives;
    }

    std::vector<PoseAdvice> advice(const Sensor& s, const Matrix& information) const {
        const double duration_s = median_of(durations_s_);  // as long as the rests that there are
        std::vector<PoseAdvice> advice = advise_poses(
            information, prior_sd(), options_->tolerance.share_most,
            [&](const Vector3& up) {
                Vector3 force = product(s.M, scaled(up, options_->gravity_m_s2));
                for (std::size_t axis = 0; axis < 3; ++axis) { force[axis] += s.bias[axis]; }
                return row(s, force, duration_s);
            },
            options_->poses_advised, options_->poses_most);
        for (PoseAdvice& pose : advice) { pose.symbol = symbol(pose.parameter); }
        return advice;
    }

private:
    // Of the mean's size: its axes' deviations along the force.
    double sd_m_s2(const Sensor& s, const Vector3& force, double duration_s) const {
        const Vector3 along = difference(force, s.bias);
        const Vector3 sd = scatter_->force_sd_m_s2(duration_s);
        double variance = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double share = along[axis] / norm(along);
            variance += share * share * sd[axis] * sd[axis];
        }
        return std::sqrt(variance);
    }

    const MeanScatter* scatter_;
    const AccelerometerFitOptions* options_;
    std::size_t of_M_;
    std::vector<Vector3> forces_;
    std::vector<double> durations_s_;
};

std::vector<std::string> open_parameters(const RestFit& fit, const Matrix& information, double share_most) {
    std::vector<std::string> names;
    for (const std::size_t p : undetermined(information, fit.prior_sd(), share_most)) {
        names.push_back(fit.name(p));
    }
    return names;
}

std::vector<double> solve(const RestFit& fit, const std::vector<double>& start) {
    LeastSquaresProblem problem;
    problem.residuals = fit.rests();
    problem.evaluate = [&](std::span<const double> at, std::span<double> values) {
        fit.residuals(at, values);
    };
    problem.differentiate = [&](std::span<const double> at, Matrix& derivatives) {
        fit.differentiate(at, derivatives);
    };
    LeastSquaresLimits limits;
    limits.tolerance = 1e-12;  // of numbers that are known to 1e-5 at best: the sum of squares is flat there
    return least_squares(problem, start, limits);
}

AccelerometerCalibration calibration_of(const RestFit& fit, const std::vector<double>& at,
                                        const AccelerometerFitOptions& options) {
    AccelerometerCalibration result;
    const Sensor sensor = fit.sensor(at);
    result.M = sensor.M;
    result.bias_m_s2 = sensor.bias;
    result.has_misalignment = fit.parameters() > scales + biases;
    std::vector<double> residuals(fit.rests());
    fit.residuals(at, residuals);
    for (std::size_t i = 0; i < fit.rests(); ++i) {
        result.residual_m_s2.push_back(fit.residual_m_s2(sensor, i));
        result.rms_m_s2 +=
            result.residual_m_s2[i] * result.residual_m_s2[i] / static_cast<double>(fit.rests());
        result.chi_squared += residuals[i] * residuals[i];
    }
    result.rms_m_s2 = std::sqrt(result.rms_m_s2);
    result.degrees = static_cast<double>(fit.rests()) - static_cast<double>(fit.parameters());
    if (result.degrees > 0.0 &&
        result.chi_squared > chi_squared_upper_quantile(result.degrees, options.chance_least)) {
        result.sd_factor = std::sqrt(result.chi_squared / result.degrees);
    }
    result.covariance = CholeskyFactor(information_of(fit.derivatives(at))).inverse();
    for (double& value : result.covariance.values()) { value *= result.sd_factor * result.sd_factor; }
    const std::size_t of_M = fit.parameters() - biases;
    for (std::size_t p = 0; p < fit.parameters(); ++p) {
        result.names.push_back(fit.symbol(p));
        const double sd = std::sqrt(result.covariance(p, p));
        (p < of_M ? result.M_sd[places[p].row][places[p].column] : result.bias_sd_m_s2[p - of_M]) = sd;
    }
    return result;
}

// The six parameters as nine.
std::vector<double> with_no_misalignment(std::vector<double> at) {
    at.insert(at.begin() + std::ptrdiff_t{scales}, places.size() - scales, 0.0);
    return at;
}

std::vector<std::string> all_cross_names() {
    std::vector<std::string> names;
    for (std::size_t p = scales; p < places.size(); ++p) { names.push_back(cross_name(p)); }
    return names;
}

}  // namespace

// Scale and bias first: what the poses tell of the misalignment is seen only where the bias is known, which
// else looks like a tilt.
AccelerometerResult fit_accelerometer(std::span<const Rest> rests, const MeanScatter& scatter,
                                      const AccelerometerFitOptions& options) {
    AccelerometerResult result;
    if (rests.empty()) { return result; }
    const double share_most = options.tolerance.share_most;
    const RestFit six(rests, scatter, options, false);
    const RestFit nine(rests, scatter, options, true);
    result.undetermined = open_parameters(six, information_of(six.derivatives(six.start())), share_most);
    if (!result.undetermined.empty() || six.rests() < six.parameters()) {
        if (result.undetermined.empty()) {
            result.undetermined.emplace_back("all of scale and bias at once");
        }
        result.advice =
            nine.advice(nine.sensor(nine.start()), information_of(nine.derivatives(nine.start())));
        return result;
    }
    const std::vector<double> at_six = solve(six, six.start());
    std::vector<double> at = with_no_misalignment(at_six);
    const auto is_open = [&] {
        return !open_parameters(nine, information_of(nine.derivatives(at)), share_most).empty();
    };
    bool has_misalignment = nine.rests() >= nine.parameters() && !is_open();
    if (has_misalignment) {
        at = solve(nine, at);
        has_misalignment = !is_open();
    }
    if (!has_misalignment) { at = with_no_misalignment(at_six); }
    result.calibration =
        has_misalignment ? calibration_of(nine, at, options) : calibration_of(six, at_six, options);
    if (!has_misalignment) { result.undetermined = all_cross_names(); }
    result.advice = nine.advice(nine.sensor(at), information_of(nine.derivatives(at)));
    return result;
}

}  // namespace gyrolog
