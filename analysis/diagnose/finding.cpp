#include "analysis/diagnose/finding.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

SensorModel with_cause(SensorModel model, const Finding& finding) {
    model.effects.insert(model.effects.end(), finding.entries.begin(), finding.entries.end());
    return model;
}

double parameter_cost_nats(double range, double sd) {
    if (!(sd > 0.0) || !(range > 0.0)) { return 0.5; }
    return std::max(0.5, std::log(range / (sd * std::sqrt(2.0 * pi))));
}

}  // namespace gyrolog
