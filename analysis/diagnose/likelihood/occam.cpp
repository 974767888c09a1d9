#include "analysis/diagnose/likelihood/occam.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gyrolog {

double parameter_cost_nats(double range, double sd) {
    if (!(sd > 0.0) || !(range > 0.0)) { return 0.5; }
    return std::max(0.5, std::log(range / (sd * std::sqrt(2.0 * std::numbers::pi))));
}

}  // namespace gyrolog
