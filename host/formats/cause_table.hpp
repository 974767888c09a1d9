// The causes of a gap as a table for a terminal of 80 columns.
#pragma once

#include <string>
#include <vector>

#include "host/formats/diagnosis_text.hpp"

namespace gyrolog {

// A row for each cause, under a head; axes that have more or less of a cause have lines of their own.
std::string cause_table(const std::vector<DiagnosisSentences::OfCause>& causes);

}  // namespace gyrolog
