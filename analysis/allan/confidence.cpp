#include "analysis/allan/confidence.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>

namespace gyrolog {

Interval chi_square_interval(double deviation, double edf, double confidence) {
    const boost::math::chi_squared distribution(edf);
    const double tail = (1.0 - confidence) / 2.0;
    return {deviation * std::sqrt(edf / quantile(complement(distribution, tail))),
            deviation * std::sqrt(edf / quantile(distribution, tail))};
}

Interval textbook_interval(double deviation, double averages, double confidence) {
    const double relative = normal_quantile((1.0 + confidence) / 2.0) / std::sqrt(2.0 * (averages - 1.0));
    return {deviation * std::max(0.0, 1.0 - relative), deviation * (1.0 + relative)};
}

double normal_quantile(double p) { return quantile(boost::math::normal(), p); }

}  // namespace gyrolog
