// Split-half validation tells whether causes that were fitted to one half of a recording are right for the
// other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

class Prediction;
struct Recording;

// The function fits `causes` anew to either half, from nothing, with each other in the model. With what came
// of it in the model, it asks the other half how much more of the same effect it calls for. `prediction` has
// none of the causes.
SplitHalfResult validate_by_halves(const std::shared_ptr<const Prediction>& prediction,
                                   const std::shared_ptr<const Recording>& recording,
                                   const std::vector<Finding>& causes, std::uint64_t seed, unsigned threads);

}  // namespace gyrolog
