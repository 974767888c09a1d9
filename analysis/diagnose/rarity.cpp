#include "analysis/diagnose/rarity.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace gyrolog {

double surprise_of_largest(double value, double degrees, double tries) {
    const double chance = boost::math::gamma_q(0.5 * degrees, 0.5 * value);
    return -std::log(-std::expm1(tries * std::log1p(-std::max(chance, 1e-280))));
}

double deviate_of(double surprise_nats) {
    const double chance = std::clamp(std::exp(-surprise_nats), 1e-280, 0.99);
    return boost::math::quantile(boost::math::complement(boost::math::normal(), chance));
}

}  // namespace gyrolog
