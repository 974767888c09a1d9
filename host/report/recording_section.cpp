#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/formats/stops_text.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {
namespace {

// Of more dropouts the first ones are listed.
constexpr std::size_t dropouts_most = 12;

std::string rate_text(const AnalysisReport& analysis) {
    std::string text = (analysis.rate_sd_hz ? with_uncertainty(analysis.rate_hz, *analysis.rate_sd_hz)
                                            : fmt::format("{:.6g}", analysis.rate_hz)) +
                       " Hz";
    if (analysis.nominal_rate_hz) {
        text += fmt::format(" (nominal {:g} Hz, {:+.0f} ppm)", *analysis.nominal_rate_hz,
                            (analysis.rate_hz / *analysis.nominal_rate_hz - 1.0) * 1e6);
    }
    if (analysis.stamps == StampKind::none) { text += ", as given"; }
    if (analysis.stamps == StampKind::arrival) { text += ", by stamps of arrival: the mean only"; }
    return text;
}

std::string missing_text(const AnalysisReport& analysis) {
    if (analysis.stamps == StampKind::none) { return "not known: the recording has no time stamps"; }
    if (analysis.stamps == StampKind::arrival) {
        return "not known: the time stamps say when the data arrived, not when they were sampled";
    }
    if (analysis.dropouts == 0) { return "none"; }
    return fmt::format("{} in {}; {}",
                       counted(static_cast<std::uint64_t>(analysis.samples_missing), "sample"),
                       counted(analysis.dropouts, "dropout"), counted(analysis.segments, "unbroken segment"));
}

std::string temperature_text(const ReportPage& page) {
    if (!page.temperature) { return "not recorded"; }
    return fmt::format("{:.2f} °C to {:.2f} °C", page.temperature->lowest_degC,
                       page.temperature->highest_degC);
}

std::string axes_text(const std::vector<AxisReport>& axes) {
    std::string text;
    for (const AxisReport& axis : axes) { text += (text.empty() ? "" : ", ") + axis.axis; }
    return text;
}

Html facts_of(const ReportPage& page) {
    const AnalysisReport& analysis = page.analysis;
    HtmlTable facts{{}, {}, "facts"};
    facts.rows.push_back(cells_of({"length", duration_text(analysis.duration_s)}));
    facts.rows.push_back(cells_of({"samples", format_count(analysis.samples)}));
    if (!analysis.axes.empty()) { facts.rows.push_back(cells_of({"gyro axes", axes_text(analysis.axes)})); }
    if (analysis.accelerometer) {
        facts.rows.push_back(cells_of({"accelerometer axes", axes_text(analysis.accelerometer->axes)}));
    }
    facts.rows.push_back(cells_of({"rate", rate_text(analysis)}));
    facts.rows.push_back(cells_of({"missing", missing_text(analysis)}));
    if (analysis.stops > 0) {
        facts.rows.push_back(cells_of({"pauses", stops_text(analysis.stops, analysis.stopped_s)}));
    }
    facts.rows.push_back(cells_of({"temperature", temperature_text(page)}));
    return table(facts);
}

Html about_capture(const ReportPage& page) {
    if (page.about.empty()) { return {}; }
    HtmlTable lines{{}, {}, "facts"};
    for (const LabelledLine& line : page.about) { lines.rows.push_back(cells_of({line.label, line.text})); }
    return element("h3", Html::text("What the capture says of itself")) + table(lines);
}

Html dropouts_of(const ReportPage& page) {
    if (page.dropouts.empty()) { return {}; }
    HtmlTable list{cells_of({"dropout at", "samples", "cause"}), {}};
    const std::size_t shown = std::min(page.dropouts.size(), dropouts_most);
    for (std::size_t i = 0; i < shown; ++i) {
        const Dropout& dropout = page.dropouts[i];
        list.rows.push_back(
            cells_of({fmt::format("{:.3f} s", dropout.at_s),
                      format_count(static_cast<std::uint64_t>(dropout.samples)), dropout.cause}));
    }
    Html section = element("h3", Html::text("Dropouts")) + table(list);
    if (page.dropouts.size() > shown) {
        section +=
            paragraph(fmt::format("and {}", counted(page.dropouts.size() - shown, "more dropout")), "muted");
    }
    return section;
}

Html warnings_of(const AnalysisReport& analysis) {
    if (analysis.warnings.empty()) { return paragraph("The analysis has no warnings."); }
    return element("div",
                   element("b", Html::text(counted(analysis.warnings.size(), "warning"))) +
                       bullet_list(analysis.warnings),
                   "warning");
}

}  // namespace

Html recording_section(const ReportPage& page) {
    return element("h2", Html::text("What was recorded")) + facts_of(page) + warnings_of(page.analysis) +
           dropouts_of(page) + about_capture(page);
}

}  // namespace gyrolog
