#include "analysis/numerics/tail_probability.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

double surprise_of_largest(double value, double degrees, double tries) {
    const double chance = gamma_upper_tail(0.5 * degrees, 0.5 * value);
    return -std::log(-std::expm1(tries * std::log1p(-std::max(chance, 1e-280))));
}

double deviate_of(double surprise_nats) {
    const double chance = std::clamp(std::exp(-surprise_nats), 1e-280, 0.99);
    return normal_upper_quantile(chance);
}

}  // namespace gyrolog
