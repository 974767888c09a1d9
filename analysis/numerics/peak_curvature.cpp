#include "analysis/numerics/peak_curvature.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog::resolution {

constexpr int doublings_most = 10;
// Of a log-likelihood, on both sides together: well above rounding, and still a parabola.
constexpr double fall_enough = 0.5;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

class Differences {
public:
    Differences(const std::function<double(const std::vector<double>&)>& function,
                const std::vector<double>& at, double value)
        : function_(function), at_(at), value_(value) {}

    // The negative second derivative along one parameter, and the step over which it was taken.
    struct Second {
        double curvature = 0.0;
        double step = 0.0;
    };

    Second along(std::size_t i, double step_least) const {
        Second found{0.0, step_least};
        for (int doubling = 0; doubling < resolution::doublings_most; ++doubling) {
            const double step = std::ldexp(step_least, doubling);
            const double up = value_ - moved(i, step, i, 0.0);
            const double down = value_ - moved(i, -step, i, 0.0);
            const double fall = std::isfinite(up + down) ? up + down : 2.0 * std::min(up, down);
            if (!std::isfinite(fall)) { break; }
            found = {fall / (step * step), step};
            if (fall > resolution::fall_enough) { break; }
        }
        return found;
    }

    double mixed(std::size_t i, double step_i, std::size_t j, double step_j) const {
        const double second = moved(i, step_i, j, step_j) - moved(i, step_i, j, -step_j) -
                              moved(i, -step_i, j, step_j) + moved(i, -step_i, j, -step_j);
        return std::isfinite(second) ? -second / (4.0 * step_i * step_j) : 0.0;
    }

private:
    double moved(std::size_t i, double by_i, std::size_t j, double by_j) const {
        std::vector<double> place = at_;
        place[i] += by_i;
        place[j] += by_j;
        return function_(place);
    }

    const std::function<double(const std::vector<double>&)>& function_;
    const std::vector<double>& at_;
    double value_;
};

// Raises the information in the directions that are known worse than `sd_most`.
PeakCurvature with_least_information(const Matrix& information, double sd_most) {
    const std::size_t count = information.rows();
    const SymmetricEigen eigen = symmetric_eigen(information);
    PeakCurvature curvature{Matrix(count, count), std::vector<double>(count, 0.0)};
    for (std::size_t k = 0; k < count; ++k) {
        const double value = std::max(eigen.values[k], 1.0 / (sd_most * sd_most));
        for (std::size_t i = 0; i < count; ++i) {
            const double component = eigen.vectors(i, k);
            curvature.sd[i] += component * component / value;
            for (std::size_t j = 0; j < count; ++j) {
                curvature.information(i, j) += value * component * eigen.vectors(j, k);
            }
        }
    }
    for (double& sd : curvature.sd) { sd = std::sqrt(sd); }
    return curvature;
}

}  // namespace

PeakCurvature peak_curvature(const std::function<double(const std::vector<double>&)>& log_likelihood,
                             const std::vector<double>& at, double value, double step_least, double sd_most) {
    const std::size_t count = at.size();
    const Differences differences(log_likelihood, at, value);
    Matrix information(count, count);
    std::vector<double> steps(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Differences::Second second = differences.along(i, step_least);
        information(i, i) = second.curvature;
        steps[i] = second.step;
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            information(i, j) = information(j, i) = differences.mixed(i, steps[i], j, steps[j]);
        }
    }
    return with_least_information(information, sd_most);
}

}  // namespace gyrolog
