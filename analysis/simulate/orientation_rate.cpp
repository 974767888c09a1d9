#include "analysis/simulate/orientation_rate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace gyrolog {

namespace {

constexpr double fit_half_s = 0.05;

struct KnownRow {
    std::size_t row;
    std::array<double, 3> turned_rad;  // since the run's first
};

Quaternion conjugate_times(const Quaternion& a, const Quaternion& b) {
    return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3],
            a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
            a[0] * b[2] + a[1] * b[3] - a[2] * b[0] - a[3] * b[1],
            a[0] * b[3] - a[1] * b[2] + a[2] * b[1] - a[3] * b[0]};
}

// atan(t) for 0 <= t <= 1, in portable arithmetic: halving the angle twice leaves a short series.
double arctangent(double t) {
    const double half = t / (1.0 + std::sqrt(1.0 + t * t));
    const double quarter = half / (1.0 + std::sqrt(1.0 + half * half));
    const double square = quarter * quarter;  // at most 0.04
    double series = 0.0;
    for (int n = 23; n >= 1; n -= 2) { series = 1.0 / n - square * series; }
    return 4.0 * quarter * series;
}

// A cubic bends with the motion; at the end of its rows it would bend with the noise.
constexpr std::size_t rows_of_cubic = 6;
constexpr double off_middle_most = 0.25;  // of the rows' span

// Slope by row at `row` of the polynomial of least squares through the rows, in polynomials that are
// orthogonal on them (G. E. Forsythe, J. SIAM 5 (1957) 74, equations 7 to 10).
std::array<double, 3> slope_at(std::size_t row, std::span<const KnownRow> rows) {
    const auto offset = [&](const KnownRow& known) {
        return static_cast<double>(known.row) - static_cast<double>(row);
    };
    const double from = offset(rows.front());
    const double to = offset(rows.back());
    const bool in_middle = std::fabs(0.5 * (from + to)) <= off_middle_most * (to - from);
    const int degree = rows.size() >= rows_of_cubic && in_middle ? 3 : 1;
    const std::array<double, 3>& start_rad = rows.front().turned_rad;
    std::vector<double> before(rows.size(), 0.0);
    std::vector<double> now(rows.size(), 1.0);
    double norm_before = 1.0;
    double value_before = 0.0;  // and slope, of the polynomial before, at the row
    double slope_before = 0.0;
    double value = 1.0;
    double slope = 0.0;
    std::array<double, 3> sum{};
    for (int order = 0;; ++order) {
        double norm = 0.0;
        double moment = 0.0;
        std::array<double, 3> product{};
        for (std::size_t i = 0; i < rows.size(); ++i) {
            norm += now[i] * now[i];
            moment += offset(rows[i]) * now[i] * now[i];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                product[axis] += now[i] * (rows[i].turned_rad[axis] - start_rad[axis]);
            }
        }
        for (std::size_t axis = 0; axis < 3; ++axis) { sum[axis] += product[axis] / norm * slope; }
        if (order == degree) { return sum; }
        const double alpha = moment / norm;
        const double beta = order == 0 ? 0.0 : norm / norm_before;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double next = (offset(rows[i]) - alpha) * now[i] - beta * before[i];
            before[i] = now[i];
            now[i] = next;
        }
        const double next_slope = value - alpha * slope - beta * slope_before;
        const double next_value = -alpha * value - beta * value_before;
        value_before = value, value = next_value;
        slope_before = slope, slope = next_slope;
        norm_before = norm;
    }
}

// Rates of all rows from the run's first to its last; no two known rows are more than half_rows apart.
void fit_run(std::span<const KnownRow> run, std::size_t half_rows, double rate_hz,
             std::span<std::array<double, 3>> rates) {
    if (run.size() < 2) { return; }
    std::size_t begin = 0;
    std::size_t end = 0;
    for (std::size_t row = run.front().row; row <= run.back().row; ++row) {
        while (run[begin].row + half_rows < row) { ++begin; }
        while (end < run.size() && run[end].row <= row + half_rows) { ++end; }
        const auto slope = slope_at(row, run.subspan(begin, end - begin));
        for (std::size_t axis = 0; axis < 3; ++axis) { rates[row][axis] = slope[axis] * rate_hz; }
    }
}

// Rates of the turns from each row to the next, even between known rows; NaN before and after those.
std::vector<std::array<double, 3>> turns_to_next(std::span<const Quaternion> orientation, double rate_hz) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::array<double, 3>> turns(orientation.size(), {unknown, unknown, unknown});
    std::optional<std::size_t> before;
    for (std::size_t row = 0; row < orientation.size(); ++row) {
        if (std::isnan(rotation_vector(orientation[row])[0])) { continue; }
        if (before) {
            std::array<double, 3> turn =
                rotation_vector(conjugate_times(orientation[*before], orientation[row]));
            for (double& each : turn) { each *= rate_hz / static_cast<double>(row - *before); }
            std::fill(turns.begin() + static_cast<std::ptrdiff_t>(*before),
                      turns.begin() + static_cast<std::ptrdiff_t>(row), turn);
        }
        before = row;
    }
    return turns;
}

}  // namespace

std::array<double, 3> rotation_vector(const Quaternion& q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double sine = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double cosine = std::fabs(q[0]);
    if (!(norm > 0.0)) {
        const double unknown = std::numeric_limits<double>::quiet_NaN();
        return {unknown, unknown, unknown};
    }
    if (sine == 0.0) { return {0.0, 0.0, 0.0}; }
    constexpr double quarter_turn_rad = 1.57079632679489661923;
    const double half_angle_rad =
        sine <= cosine ? arctangent(sine / cosine) : quarter_turn_rad - arctangent(cosine / sine);
    const double scale = std::copysign(2.0 * half_angle_rad / sine, q[0]);
    return {q[1] * scale, q[2] * scale, q[3] * scale};
}

std::vector<std::array<double, 3>> orientation_rate(std::span<const Quaternion> orientation, double rate_hz) {
    const auto half_rows = static_cast<std::size_t>(std::max(1.0, std::floor(fit_half_s * rate_hz + 0.5)));
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::array<double, 3>> rates(orientation.size(), {unknown, unknown, unknown});
    std::vector<KnownRow> run;
    for (std::size_t row = 0; row < orientation.size(); ++row) {
        if (std::isnan(rotation_vector(orientation[row])[0])) { continue; }
        if (!run.empty() && row - run.back().row > half_rows) {
            fit_run(run, half_rows, rate_hz, rates);
            run.clear();
        }
        KnownRow next = {row, {}};
        if (!run.empty()) {
            const KnownRow& last = run.back();
            const auto turn_rad = rotation_vector(conjugate_times(orientation[last.row], orientation[row]));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                next.turned_rad[axis] = last.turned_rad[axis] + turn_rad[axis];
            }
        }
        run.push_back(next);
    }
    fit_run(run, half_rows, rate_hz, rates);
    return rates;
}

std::vector<std::array<double, 3>> turn_rate(std::span<const Quaternion> orientation, double rate_hz) {
    const std::vector<std::array<double, 3>> turns = turns_to_next(orientation, rate_hz);
    std::vector<std::array<double, 3>> centred(orientation.size());
    for (std::size_t row = 0; row < centred.size(); ++row) {
        const std::array<double, 3>& to = turns[row];
        const std::array<double, 3>& from = row > 0 && !std::isnan(turns[row - 1][0]) ? turns[row - 1] : to;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            centred[row][axis] = std::isnan(to[axis]) ? from[axis] : 0.5 * (from[axis] + to[axis]);
        }
    }
    std::vector<std::array<double, 3>> rates = centred;
    for (std::size_t row = 1; row + 1 < rates.size(); ++row) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double bend = centred[row - 1][axis] - 2.0 * centred[row][axis] + centred[row + 1][axis];
            if (!std::isnan(bend)) { rates[row][axis] -= bend / 6.0; }
        }
    }
    return rates;
}

}  // namespace gyrolog
