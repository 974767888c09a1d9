// A comparison for people.
#pragma once

#include <string>

#include "analysis/compare/comparison.hpp"

namespace gyrolog {

std::string comparison_text(const Comparison& comparison);

// "x: the simulation is too quiet by 4.7 dB at 13 ms; the samples' excess kurtosis is 61, of simulations ..."
std::string outcome_sentence(const Comparison& comparison, const AxisComparison& axis);

}  // namespace gyrolog
