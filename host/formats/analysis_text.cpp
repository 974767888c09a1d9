#include "host/formats/analysis_text.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/formats/noise_text.hpp"
#include "host/formats/stops_text.hpp"
#include "host/formats/uncertain_number.hpp"

namespace gyrolog {
namespace {

// The three strongest lines, where an axis has some and the fit does not name them already; JSON has them
// all.
std::vector<TextRow> line_rows(const AnalysisReport& report) {
    constexpr std::size_t shown = 3;
    std::size_t most = 0;
    for (const AxisReport& axis : report.axes) {
        if (axis.fit.sinusoids.empty()) { most = std::max(most, axis.lines.size()); }
    }
    std::vector<TextRow> rows;
    for (std::size_t i = 0; i < std::min(most, shown); ++i) {
        TextRow row{i == 0 ? "spectral lines" : "", report.unit.name, {}};
        for (const AxisReport& axis : report.axes) {
            row.cells.push_back(axis.fit.sinusoids.empty() && i < axis.lines.size()
                                    ? fmt::format("{:.3g} at {:.5g} Hz",
                                                  axis.lines[i].amplitude * report.unit.per_column_unit,
                                                  axis.lines[i].f_hz)
                                    : "-");
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<TextRow> rows_of(const AnalysisReport& report, std::span<const FitOfColumn> fits) {
    const double scale = report.unit.per_column_unit;
    TextRow bias{"bias", report.unit.name, {}};
    TextRow lowest{"lowest deviation", report.unit.name, {}};
    for (const AxisReport& axis : report.axes) {
        bias.cells.push_back(
            with_uncertainty(axis.bias.value * scale, axis.bias.expanded_uncertainty * scale));
        const auto& points = axis.curve.points;
        const auto least = std::ranges::min_element(points, {}, &AllanPoint::deviation);
        lowest.cells.push_back(least == points.end() ? "-"
                                                     : fmt::format("{:.3g} at {:.3g} s",
                                                                   least->deviation * scale, least->tau_s));
    }
    std::vector<TextRow> rows = {std::move(bias)};
    for (TextRow& row : noise_rows(fits, report.unit)) { rows.push_back(std::move(row)); }
    rows.push_back(std::move(lowest));
    for (TextRow& row : line_rows(report)) { rows.push_back(std::move(row)); }
    return rows;
}

std::string head_of(const AnalysisReport& report) {
    std::string text =
        fmt::format("{}: {} samples, {}", report.name, report.samples, duration_text(report.duration_s));
    text += fmt::format(", {} Hz", report.rate_sd_hz ? with_uncertainty(report.rate_hz, *report.rate_sd_hz)
                                                     : fmt::format("{:.6g}", report.rate_hz));
    if (report.nominal_rate_hz) {
        text += fmt::format(" (nominal {:g} Hz, {:+.0f} ppm)", *report.nominal_rate_hz,
                            (report.rate_hz / *report.nominal_rate_hz - 1.0) * 1e6);
    }
    if (report.stamps == StampKind::none) { text += " as given"; }
    text += "\n";
    if (report.dropouts > 0) {
        text += fmt::format("{}, {} missing; {}\n", counted(report.dropouts, "dropout"),
                            counted(static_cast<std::uint64_t>(report.samples_missing), "sample"),
                            counted(report.segments, "unbroken segment"));
    } else if (report.stamps == StampKind::sampling) {
        text += "no dropouts\n";
    }
    if (report.stops > 0) { text += stops_text(report.stops, report.stopped_s) + "\n"; }
    for (const std::string& warning : report.warnings) { text += fmt::format("warning: {}\n", warning); }
    return text;
}

}  // namespace

std::string analysis_text(const AnalysisReport& report) {
    std::string text = head_of(report);
    if (report.axes.empty()) { return text; }
    std::vector<FitOfColumn> fits;
    std::vector<std::string> heads;
    for (const AxisReport& axis : report.axes) {
        fits.push_back({&axis.fit, &axis.slopes});
        heads.push_back(axis.axis);
    }
    text += '\n' + text_table(heads, rows_of(report, fits));
    text += fmt::format(
        "\n  ± one standard deviation (bias: expanded, 95.45 %); \"<\": not identifiable in this record, "
        "upper "
        "limit\n"
        "  at {:.3g} %; \"± at best\": Cramer-Rao bound, below which no unbiased method gets\n",
        report.confidence * 100.0);
    const std::vector<TextRow> si = si_rows(fits, report.unit);
    if (!si.empty()) { text += '\n' + text_table(heads, si); }
    return text;
}

}  // namespace gyrolog
