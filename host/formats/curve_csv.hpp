// Allan curves as text, as they are printed in papers and data sheets: one header line, then one line per
// averaging time.
//
//   tau_s           averaging time, seconds (needed)
//   NAME_UNIT       a deviation; UNIT is dps, deg_per_s, deg_per_h or rad_s: x_deg_per_h, sensor_x_dps; of an
//                   accelerometer g, mg, ug or m_s2, and then of all columns
//
// Columns may come in any order; unknown ones are ignored, with one warning. An empty field or NaN is a point
// that the curve does not have.
#pragma once

#include <string>
#include <string_view>

#include "analysis/noise/curve_report.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// Points are sorted by tau. Errors: malformed (names line and column, and what to do), and those of reading a
// file. A curve of fewer than curve_fit_points_min points is one.
Result<PrintedCurves> read_curve_csv(const std::string& path);
Result<PrintedCurves> parse_curve_csv(std::string_view text, std::string name);

}  // namespace gyrolog
