// The details of a diagnosis for people: every cause's parameters and evidence, how far each comparison is
// off before and after, and what could not be tested.
#pragma once

#include <string>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

std::string diagnosis_details(const Diagnosis& diagnosis);

}  // namespace gyrolog
