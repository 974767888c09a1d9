#include "analysis/denoise/motion_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace gyrolog {
namespace {

constexpr std::size_t samples_least = 100;

// Least squares of y on 1, u and v.
class Regression {
public:
    void add(double y, double u, double v) {
        const std::array<double, 3> x{1.0, u, v};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) { normal_.at(i).at(j) += x.at(i) * x.at(j); }
            right_.at(i) += x.at(i) * y;
        }
        squares_ += y * y;
        ++count_;
    }

    // By elimination; a regressor that is nothing but the others gets 0.
    std::array<double, 3> solve() const {
        auto a = normal_;
        auto b = right_;
        std::array<bool, 3> idle{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!(a.at(i).at(i) > 1e-12 * normal_.at(i).at(i))) {
                idle.at(i) = true;
                continue;
            }
            for (std::size_t k = i + 1; k < 3; ++k) {
                const double factor = a.at(k).at(i) / a.at(i).at(i);
                for (std::size_t j = i; j < 3; ++j) { a.at(k).at(j) -= factor * a.at(i).at(j); }
                b.at(k) -= factor * b.at(i);
            }
        }
        std::array<double, 3> x{};
        for (std::size_t i = 3; i-- > 0;) {
            if (idle.at(i)) { continue; }
            double rest = b.at(i);
            for (std::size_t j = i + 1; j < 3; ++j) { rest -= a.at(i).at(j) * x.at(j); }
            x.at(i) = rest / a.at(i).at(i);
        }
        return x;
    }

    double residual_variance() const {
        const std::array<double, 3> x = solve();
        double left = squares_;
        for (std::size_t i = 0; i < 3; ++i) { left -= x.at(i) * right_.at(i); }
        return std::max(0.0, left) / static_cast<double>(count_);
    }

private:
    std::array<std::array<double, 3>, 3> normal_{};
    std::array<double, 3> right_{};
    double squares_ = 0.0;
    std::size_t count_ = 0;
};

struct Variance {
    double sum = 0.0;
    double squares = 0.0;
    double count = 0.0;

    void add(double x) {
        sum += x;
        squares += x * x;
        count += 1.0;
    }
    double value() const { return std::max(0.0, squares / count - sum / count * sum / count); }
};

// Rows with everything that any lag asks for.
std::vector<std::size_t> usable_rows(std::span<const double> rate, std::span<const double> reference,
                                     std::span<const Segment> segments, std::size_t margin) {
    std::vector<std::size_t> rows;
    for (const Segment& segment : segments) {
        std::size_t known = 0;  // in a row, of the reference
        for (std::size_t i = 0; i < segment.count; ++i) {
            known = std::isnan(reference[segment.first + i]) ? 0 : known + 1;
            if (known < 2 * margin + 1) { continue; }
            const std::size_t row = segment.first + i - margin;
            if (!std::isnan(rate[row])) { rows.push_back(row); }
        }
    }
    return rows;
}

double change_at(std::span<const double> reference, std::size_t row) {
    return 0.5 * (reference[row + 1] - reference[row - 1]);
}

// Infinite where the rate would be the reference turned round: half a period of a swing is no lag.
double left_at_lag(std::span<const double> rate, std::span<const double> reference,
                   std::span<const std::size_t> rows, std::ptrdiff_t lag, std::size_t every) {
    Regression regression;
    for (std::size_t i = 0; i < rows.size(); i += every) {
        const auto row = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(rows[i]) - lag);
        regression.add(rate[rows[i]], reference[row], 0.0);
    }
    return regression.solve()[1] > 0.0 ? regression.residual_variance()
                                       : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<MotionError> motion_error(std::span<const double> rate, std::span<const double> reference,
                                        std::span<const Segment> segments, double rate_hz,
                                        double longest_lag_s) {
    const auto longest =
        std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(std::ceil(longest_lag_s * rate_hz)));
    const std::vector<std::size_t> rows =
        usable_rows(rate, reference, segments, static_cast<std::size_t>(longest) + 1);
    if (rows.size() < samples_least) { return std::nullopt; }
    Variance motion;
    for (const std::size_t row : rows) { motion.add(reference[row]); }
    if (!(motion.value() > 0.0)) { return std::nullopt; }
    constexpr std::size_t samples_searched = 20'000;
    const std::size_t every = std::max<std::size_t>(1, rows.size() / samples_searched);
    std::ptrdiff_t lag = 0;
    double least = std::numeric_limits<double>::infinity();
    // From the shortest on: a whole period of a swing is as good but for chance.
    constexpr double better = 0.999;
    for (std::ptrdiff_t size = 0; size <= longest; ++size) {
        for (const std::ptrdiff_t trial : {size, -size}) {
            const double left = left_at_lag(rate, reference, rows, trial, every);
            if (left < better * least) {
                least = left;
                lag = trial;
            }
        }
    }
    const auto lagged = [&](std::size_t row) {
        return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row) - lag);
    };
    Regression regression;
    for (const std::size_t row : rows) {
        regression.add(rate[row], reference[lagged(row)], change_at(reference, lagged(row)));
    }
    const std::array<double, 3> fit = regression.solve();
    MotionError error;
    error.offset = fit[0];
    error.gain = fit[1];
    const double fraction = fit[1] != 0.0 ? -fit[2] / fit[1] : 0.0;
    error.lag_s = (static_cast<double>(lag) + fraction) / rate_hz;
    error.samples = rows.size();
    Variance whole;
    Variance moved;
    Variance noise;
    for (const std::size_t row : rows) {
        const double expected =
            fit[0] + fit[1] * reference[lagged(row)] + fit[2] * change_at(reference, lagged(row));
        whole.add(rate[row] - reference[row]);
        moved.add(expected - reference[row]);
        noise.add(rate[row] - expected);
    }
    error.error_variance = whole.value();
    error.motion_variance = moved.value();
    error.noise_variance = noise.value();
    return error;
}

}  // namespace gyrolog
