// A comparison for people, in the order in which one asks: what differs on each axis, and by how much; the
// numbers of both sides; what to do next; what was compared; then every place outside, where that is wanted.
#pragma once

#include <string>

#include "analysis/compare/comparison.hpp"
#include "host/formats/wording.hpp"

namespace gyrolog {

std::string comparison_text(const Comparison& comparison, Wording wording = Wording::whole);

// "x: the simulation is too quiet by 4.7 dB at 13 ms (Allan deviation 0.02, simulated 0.012 dps)"
std::string outcome_sentence(const Comparison& comparison, const AxisComparison& axis);

}  // namespace gyrolog
