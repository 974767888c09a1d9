// Nonparametric alternatives are shapes that no effect of the catalogue has. Noise of the right size
// resembles much that is no such noise: where one of these tells a recording far better than the causes that
// were found, they are not its causes.
#pragma once

#include <optional>
#include <string>

#include "analysis/diagnose/likelihood/observation.hpp"

namespace gyrolog {

struct NonparametricFit {
    std::string words;           // "A course that repeats every 412 s"
    double evidence_nats = 0.0;  // log Bayes factor against `without`'s model; comparable to a Finding's
};

// The function returns the best alternative for a recording under a model without the causes in question, its
// noise coefficients as free as with them. `with`: the same recording with the causes.
std::optional<NonparametricFit> best_nonparametric(const Observation& without, const Observation& with);

}  // namespace gyrolog
