// The figures of the page that `report` writes: those of the other commands, with letters of a size for
// paper.
#pragma once

#include "analysis/diagnose/report.hpp"
#include "analysis/noise/analyze.hpp"
#include "analysis/recording/recording.hpp"
#include "host/base/result.hpp"
#include "host/fleet/unit_population.hpp"
#include "host/report/report_page.hpp"

namespace gyrolog {

// Errors: `failed` with the reason and the mend, such as a missing font.
Status draw_figures(ReportPage& page, const Recording& recording);

// Of the page on many recordings. Empty without two units to lie apart.
Result<Png> draw_spread(const UnitPopulation& population);

}  // namespace gyrolog
