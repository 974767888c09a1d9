#include "host/report/report_page.hpp"

#include <fmt/format.h>

#include "host/formats/diagnosis_text.hpp"
#include "host/report/html.hpp"
#include "host/report/page_frame.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {
namespace {

std::vector<SensorPart> parts_of(const ReportPage& page) {
    const AnalysisReport& analysis = page.analysis;
    std::vector<SensorPart> parts;
    if (!analysis.axes.empty()) {
        const char* of = analysis.accelerometer ? " of the gyro" : "";
        parts.push_back({page, page.gyro, analysis.axes, analysis.unit, of});
    }
    if (analysis.accelerometer) {
        parts.push_back({page, page.accelerometer, analysis.accelerometer->axes, analysis.accelerometer->unit,
                         " of the accelerometer"});
    }
    return parts;
}

Html body_of(const ReportPage& page) {
    Html body = element("h1", Html::text(page.analysis.name));
    if (page.diagnosis != nullptr) {
        body += paragraph(
            fmt::format("Against {}: {}", page.diagnosis->model_name, verdict_line(*page.diagnosis)));
    }
    body += recording_section(page);
    for (const SensorPart& part : parts_of(page)) {
        body += figures_section(part);
        body += coefficients_section(part);
        body += bias_section(part);
    }
    body += diagnosis_section(page);
    return body + next_section(page);
}

}  // namespace

std::string report_html(const ReportPage& page) { return whole_page(page.analysis.name, body_of(page)); }

}  // namespace gyrolog
