// The sections of the page, from top to bottom.
#pragma once

#include "host/report/html.hpp"
#include "host/report/report_page.hpp"

namespace gyrolog {

Html recording_section(const ReportPage& page);
Html figures_section(const ReportPage& page);
Html coefficients_section(const ReportPage& page);
Html bias_section(const ReportPage& page);
// Nothing without a diagnosis.
Html diagnosis_section(const ReportPage& page);
Html next_section(const ReportPage& page);

}  // namespace gyrolog
