// The alternative noise is what a nonparametric alternative is judged under.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"

namespace gyrolog {

struct AlternativeNoise {
    std::vector<double> density;  // by bin
    double lost_nats = 0.0;       // against the noise that fits best without a rival
};

// The noise is that of a model without the causes, with the coefficients that were fitted beside them: what
// would explain the alternative's shape is not in it.
AlternativeNoise alternative_noise(const Observation& without, const Observation& with, std::size_t axis);

}  // namespace gyrolog
