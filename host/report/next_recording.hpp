// What another recording of the same sensor has to be to tell what this one does not.
#pragma once

#include <string>
#include <vector>

#include "analysis/noise/analyze.hpp"

namespace gyrolog {

// In sentences. Lengths are those at which the bound of Cramer and Rao (walk_knowledge.hpp) reaches what
// identifies a term, were it half of the upper limit stated, or what is wanted of one that is identified: the
// longest of the axes. Those of one sensor begin with its name where the recording has an accelerometer.
std::vector<std::string> next_recordings(const AnalysisReport& analysis, bool has_temperature);

}  // namespace gyrolog
