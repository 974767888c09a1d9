// The analysis of printed curves as JSON: gyrolog-analysis/1 with "curve" in place of "recording".
#pragma once

#include <string>

#include "analysis/noise/curve_report.hpp"

namespace gyrolog {

std::string curve_json(const CurveReport& report);

}  // namespace gyrolog
