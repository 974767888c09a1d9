// Joined passes are one answer from two passes over a long recording (long_diagnosis.hpp).
#pragma once

#include <cstddef>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The function removes causes of a pass that another pass tells better, by effect, with what is proposed to
// settle their ties and what was said to be better than them.
void remove_causes(Diagnosis& pass, const std::vector<const Cause*>& removed);

// The function joins `beginning`, in single samples, and `means`, of all of them. Each holds the causes that
// it is to stand for, those of the means as samples have them. `model` is what both were held against, of
// samples.
//
// The verdict is that of the pass that explains least. p_none is that of the smaller of both. Each pass's
// share of what is closed weighs as much as its causes gain, or, where something stays unexplained, as its
// gap's excess. On a second recording the pass with the larger gap there is reported.
Diagnosis joined_passes(const SensorModel& model, const Diagnosis& beginning, const Diagnosis& means,
                        std::size_t samples_per_row);

}  // namespace gyrolog
