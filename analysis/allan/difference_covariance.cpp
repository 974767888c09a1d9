#include "analysis/allan/difference_covariance.hpp"

#include <array>
#include <cmath>

namespace gyrolog {
namespace {

double t2_log_t(double t) { return t == 0.0 ? 0.0 : t * t * std::log(std::abs(t)); }

// -log|t| has no value at 0: second difference of t^2 log|t| over one sample, changed in sign.
double averaged_log(double lag) {
    const double t = std::abs(lag);
    if (t > 1000.0) { return -2.0 * std::log(t) - 3.0 + 1.0 / (6.0 * t * t); }
    return 2.0 * t2_log_t(t) - t2_log_t(t - 1.0) - t2_log_t(t + 1.0);
}

// s(t) of white noise summed so many times: the discrete solution of delta^{2 sums} s = delta(t), scaled.
double summed_white(int sums, double lag) {
    const double t = std::abs(lag);
    switch (sums) {
        case 0:
            return t == 0.0 ? 2.0 : 0.0;
        case 1:
            return -t;
        case 2:
            return t * (t * t - 1.0) / 6.0;
        default:
            return -t * (t * t - 1.0) * (t * t - 4.0) / 120.0;
    }
}

// Of flicker angle noise summed so many times.
double summed_flicker(int sums, double lag) {
    switch (sums) {
        case 0:
            return averaged_log(lag);
        case 1:
            return t2_log_t(lag);
        default:
            return -lag * lag * t2_log_t(lag) / 12.0;
    }
}

double generalised_covariance(PowerLaw law, int more_sums, double lag) {
    switch (law) {
        case PowerLaw::white_angle:
            return summed_white(more_sums, lag);
        case PowerLaw::flicker_angle:
            return summed_flicker(more_sums, lag);
        case PowerLaw::white_rate:
            return summed_white(1 + more_sums, lag);
        case PowerLaw::flicker_rate:
            return summed_flicker(1 + more_sums, lag);
        case PowerLaw::rate_walk:
            return summed_white(2 + more_sums, lag);
    }
    return 0.0;
}

// theta*_{i-m} - 2 theta*_i + theta*_{i+m}, written with points that exist.
struct ReflectedTerm {
    ReflectedTerm(double i, double m, double last) : at{i - m, i, i + m, 0.0} {
        if (i < m) {
            at = {m - i, i, i + m, 0.0};
            weight = {-1.0, -2.0, 1.0, 2.0};
        } else if (i + m > last) {
            at = {i - m, i, 2.0 * last - i - m, last};
            weight = {1.0, -2.0, -1.0, 2.0};
        }
    }
    std::array<double, 4> at;
    std::array<double, 4> weight{1.0, -2.0, 1.0, 0.0};
};

}  // namespace

DifferenceCovariance::DifferenceCovariance(PowerLaw law, const DeviationRule& rule, std::int64_t m)
    : law_(law),
      summed_(rule.window_mean),
      order_(rule.order + (rule.window_mean ? 1 : 0)),
      m_(static_cast<double>(m)),
      norm_(rule.norm(m)),
      variance_(at(0.0)) {}

double DifferenceCovariance::generalised(double lag) const {
    return generalised_covariance(law_, summed_ ? 1 : 0, lag);
}

double DifferenceCovariance::reflected(double i, double j, double points) const {
    const ReflectedTerm a(i, m_, points - 1.0);
    const ReflectedTerm b(j, m_, points - 1.0);
    double sum = 0.0;
    for (std::size_t p = 0; p < a.at.size(); ++p) {
        for (std::size_t q = 0; q < b.at.size(); ++q) {
            const double weight = a.weight[p] * b.weight[q];
            if (weight != 0.0) { sum += weight * generalised(a.at[p] - b.at[q]); }
        }
    }
    return sum;
}

double DifferenceCovariance::at(double lag) const {
    const auto s = [&](double t) { return generalised(t); };
    const auto pair = [&](double steps) { return s(lag - steps * m_) + s(lag + steps * m_); };
    if (order_ == 2) { return 6.0 * s(lag) - 4.0 * pair(1.0) + pair(2.0); }
    return 20.0 * s(lag) - 15.0 * pair(1.0) + 6.0 * pair(2.0) - pair(3.0);
}

}  // namespace gyrolog
