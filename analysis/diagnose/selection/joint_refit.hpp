// The joint refit fits effects of the mean answer in motion together. One after the other, each with the
// others as they are, two that lag alike would take many rounds, and noise is found in what they leave
// meanwhile.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

struct JointRefit {
    std::vector<Finding> findings;     // with new parameters and nothing else
    double log_likelihood_nats = 0.0;  // of the recording with all of them
    bool moved = false;
};

// The function takes Gauss-Newton steps (Nocedal, Wright, Numerical Optimization, 10.3) in all fitted
// parameters of `findings`, whose number does not change, from where they are. Steps that lower the
// likelihood are shortened. `without` has none of the findings.
JointRefit refit_jointly(const Prediction& without, const std::shared_ptr<const Recording>& recording,
                         std::vector<Finding> findings, std::uint64_t seed);

}  // namespace gyrolog
