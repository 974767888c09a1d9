#include "host/report/report_page.hpp"

#include <fmt/format.h>

#include "host/base/program_name.hpp"
#include "host/formats/diagnosis_text.hpp"
#include "host/report/html.hpp"
#include "host/report/page_style.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {
namespace {

Html head_of(const ReportPage& page) {
    return element(
        "head", Html::markup("<meta charset=\"utf-8\">\n"
                             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n") +
                    element("title", Html::text(page.analysis.name + " - gyrolog report")) +
                    element("style", Html::markup(page_style)));
}

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
            fmt::format("Against {}: {}", page.diagnosis->model_name, verdict_sentence(*page.diagnosis)));
    }
    body += recording_section(page);
    for (const SensorPart& part : parts_of(page)) {
        body += figures_section(part);
        body += coefficients_section(part);
        body += bias_section(part);
    }
    body += diagnosis_section(page);
    body += next_section(page);
    return body + element("footer", Html::text("Written by " + program_name() + "."));
}

}  // namespace

std::string report_html(const ReportPage& page) {
    const Html content = head_of(page) + element("body", body_of(page));
    return "<!DOCTYPE html>\n<html lang=\"en\">\n" + content.str() + "</html>\n";
}

}  // namespace gyrolog
