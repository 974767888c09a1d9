#include "tests/benchmark/obvious_curve.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "analysis/allan/averaging_factors.hpp"

namespace gyrolog {
namespace {

double obvious_deviation(const std::vector<double>& theta, std::size_t m, double tau_s) {
    double sum = 0.0;
    const std::size_t terms = theta.size() - 2 * m;
    for (std::size_t k = 0; k < terms; ++k) {
        const double d = theta[k + 2 * m] - 2.0 * theta[k + m] + theta[k];
        sum += d * d;
    }
    return std::sqrt(sum / (2.0 * tau_s * tau_s * static_cast<double>(terms)));
}

}  // namespace

std::vector<double> obvious_curve(const std::vector<double>& rate, double rate_hz) {
    const double mean = std::accumulate(rate.begin(), rate.end(), 0.0) / static_cast<double>(rate.size());
    std::vector<double> theta(rate.size() + 1);
    for (std::size_t i = 0; i < rate.size(); ++i) { theta[i + 1] = theta[i] + (rate[i] - mean) / rate_hz; }
    std::vector<double> deviations;
    for (const std::int64_t m : averaging_factors(static_cast<std::int64_t>(rate.size()))) {
        deviations.push_back(
            obvious_deviation(theta, static_cast<std::size_t>(m), static_cast<double>(m) / rate_hz));
    }
    return deviations;
}

}  // namespace gyrolog
