// The analysis of printed curves for people.
#pragma once

#include <string>

#include "analysis/noise/curve_report.hpp"

namespace gyrolog {

std::string curve_text(const CurveReport& report);

}  // namespace gyrolog
