#include "analysis/compare/compared_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/compare/compared_curve.hpp"
#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

double distance_from(std::span<const double> simulated, double value) {
    const auto n = static_cast<double>(simulated.size());
    double mean = 0.0;
    double square = 0.0;
    for (const double x : simulated) { mean += x / n; }
    for (const double x : simulated) { square += (x - mean) * (x - mean); }
    const double d = std::fabs(value - mean);
    if (d == 0.0) { return 0.0; }
    return square > 0.0 ? d / std::sqrt(square / (n - 1.0) * (1.0 + 1.0 / n))
                        : std::numeric_limits<double>::infinity();
}

double distance_by_chance(std::size_t simulations, double probability) {
    return students_t_upper_quantile(static_cast<double>(simulations) - 1.0, 0.5 * probability);
}

ComparedNumber compare_number(double recording, std::vector<double> simulated,
                              double (*evenly_scattered)(double), double false_alarms) {
    std::ranges::sort(simulated);
    const std::size_t count = simulated.size();
    const std::size_t rank = band_rank(count);
    ComparedNumber number;
    number.recording = recording;
    number.other = 0.5 * (simulated[(count - 1) / 2] + simulated[count / 2]);
    number.lo = simulated[rank - 1];
    number.hi = simulated[count - rank];
    std::ranges::transform(simulated, simulated.begin(), evenly_scattered);
    const double own = evenly_scattered(recording);
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (is_finite(own) && std::ranges::all_of(simulated, is_finite)) {
        number.distance = distance_from(simulated, own);
        number.stands_out = number.distance > distance_by_chance(count, false_alarms);
    }
    return number;
}

}  // namespace gyrolog
