// An effect that a person describes: whether the data call for it.
#pragma once

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The function takes the entry times an amount into the model of `beside` and of `alone`, two models of one
// recording, and compares log_likelihood_nats(). The amount multiplies a table's values; of a table that
// multiplies (EffectTable::positive) it is the exponent. It is the most likely one between -3 and 3; its
// standard deviation is from the curvature there. An effect without a table is taken as it is described.
// The data call for it where one place that is looked at would by chance seldom gain as much
// (DecisionOptions::seen_sigma); for what is taken as described, where its Bayes factor is strong
// (DecisionOptions::strong_nats).
// Whatever shows in the samples' distribution, codes or stamps alone gains nothing here.
Asked asked(const DescribedEffect& described, const Observation& beside, const Observation& alone);

}  // namespace gyrolog
