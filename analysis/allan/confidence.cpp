#include "analysis/allan/confidence.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

Interval chi_square_interval(double deviation, double edf, double confidence) {
    const double tail = (1.0 - confidence) / 2.0;
    return {deviation * std::sqrt(edf / chi_squared_upper_quantile(edf, tail)),
            deviation * std::sqrt(edf / chi_squared_quantile(edf, tail))};
}

Interval textbook_interval(double deviation, double averages, double confidence) {
    const double relative = normal_quantile((1.0 + confidence) / 2.0) / std::sqrt(2.0 * (averages - 1.0));
    return {deviation * std::max(0.0, 1.0 - relative), deviation * (1.0 + relative)};
}

}  // namespace gyrolog
