// A comparison for people, in the order in which one asks: what differs on each axis, and by how much; the
// numbers of both sides; what to do next; what was compared; then every place outside, where that is wanted.
#pragma once

#include <string>
#include <vector>

#include "analysis/compare/comparison.hpp"
#include "host/formats/wording.hpp"

namespace gyrolog {

std::string comparison_text(const Comparison& comparison, Wording wording = Wording::whole);

// "x: the simulation is too quiet by 4.7 dB at 13 ms (Allan deviation 0.02, simulated 0.012 dps)"
std::string outcome_sentence(const Comparison& comparison, const AxisComparison& axis);

// For the head of a figure: rate, length, samples. Of two recordings each has its own length: what differs at
// long averaging times may be that.
std::vector<std::string> comparison_facts(const Comparison& comparison);

}  // namespace gyrolog
