#include "host/formats/analysis_text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "host/formats/noise_unit.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t axes_per_table = 4;

// "0.01314 ± 0.00002", or "(1.579 ± 0.010)e-04" for very small and large values: the uncertainty to two
// digits, the value to its last decimal.
std::string with_uncertainty(double value, double uncertainty) {
    if (!(uncertainty > 0.0)) { return fmt::format("{:.6g}", value); }
    const auto decade_of = [](double x) { return static_cast<int>(std::floor(std::log10(x))); };
    const double larger = std::max(std::abs(value), uncertainty);
    const int exponent = larger < 1e-3 || larger >= 1e6 ? decade_of(larger) : 0;
    const double unit = std::pow(10.0, exponent);
    const int decimals = std::clamp(1 - decade_of(uncertainty / unit), 0, 9);
    const std::string text =
        fmt::format("{:.{}f} ± {:.{}f}", value / unit, decimals, uncertainty / unit, decimals);
    return exponent == 0 ? text : fmt::format("({})e{:+03d}", text, exponent);
}

std::string duration_text(double seconds) {
    if (seconds < 120.0) { return fmt::format("{:.1f} s", seconds); }
    if (seconds < 7200.0) { return fmt::format("{:.1f} min", seconds / 60.0); }
    return fmt::format("{:.2f} h", seconds / 3600.0);
}

// A row of the table: a label with its unit, and what to write for an axis.
struct Row {
    std::string label;
    std::string unit;
    std::function<std::string(const AxisReport&)> cell;
};

std::string coefficient_text(const FittedCoefficient& fitted, double scale) {
    if (fitted.state == FittedCoefficient::State::not_identifiable) {
        return fmt::format("< {:.2g}", fitted.upper * scale);
    }
    return with_uncertainty(fitted.value * scale, fitted.sd * scale);
}

Row coefficient_row(const std::string& label, const std::string& unit, NoiseTerm term, double scale) {
    return {label, unit, [=](const AxisReport& axis) { return coefficient_text(axis.fit[term], scale); }};
}

std::string slope_text(const std::optional<SlopeReading::Value>& value, double scale) {
    if (!value) { return "-"; }
    return fmt::format("{:.3g} at {:.3g} s", value->coefficient * scale, value->tau_s);
}

std::vector<Row> rows_of(const AnalysisReport& report) {
    const RateUnit& unit = report.unit;
    const double scale = unit.per_column_unit;
    const bool angular = unit.name != "lsb";
    const double degrees = unit.name == "rad/s" ? deg_per_rad : scale;  // deg/s per column unit
    std::vector<Row> rows = {
        {"bias (k = 2)", unit.name,
         [=](const AxisReport& axis) {
             return with_uncertainty(axis.bias.value * scale, axis.bias.expanded_uncertainty * scale);
         }},
        coefficient_row("N  angle random walk", noise_unit(NoiseTerm::N, unit), NoiseTerm::N, scale)};
    if (angular) { rows.push_back(coefficient_row("", "deg/sqrt(h)", NoiseTerm::N, degrees * 60.0)); }
    rows.push_back(coefficient_row("B  bias instability", unit.name, NoiseTerm::B, scale));
    if (angular) { rows.push_back(coefficient_row("", "deg/h", NoiseTerm::B, degrees * 3600.0)); }
    rows.push_back(
        coefficient_row("K  rate random walk", noise_unit(NoiseTerm::K, unit), NoiseTerm::K, scale));
    rows.push_back(coefficient_row("Q  quantisation", noise_unit(NoiseTerm::Q, unit), NoiseTerm::Q, scale));
    rows.push_back(coefficient_row("R  rate ramp", noise_unit(NoiseTerm::R, unit), NoiseTerm::R, scale));
    rows.push_back({"by slope: N", noise_unit(NoiseTerm::N, unit),
                    [=](const AxisReport& axis) { return slope_text(axis.slopes.N, scale); }});
    rows.push_back(
        {"          B", unit.name, [=](const AxisReport& axis) { return slope_text(axis.slopes.B, scale); }});
    rows.push_back({"          K", noise_unit(NoiseTerm::K, unit),
                    [=](const AxisReport& axis) { return slope_text(axis.slopes.K, scale); }});
    rows.push_back({"lowest deviation", unit.name, [=](const AxisReport& axis) -> std::string {
                        const auto& points = axis.curve.points;
                        const auto lowest = std::ranges::min_element(points, {}, &AllanPoint::deviation);
                        if (lowest == points.end()) { return "-"; }
                        return fmt::format("{:.3g} at {:.3g} s", lowest->deviation * scale, lowest->tau_s);
                    }});
    return rows;
}

// Columns on a terminal: every byte but the continuation bytes of UTF-8.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
    const std::size_t used = width_of(text);
    return fmt::format("{}{:{}}", text, "", width > used ? width - used : 0);
}

std::string table_of(const std::vector<Row>& rows, std::span<const AxisReport> axes) {
    std::vector<std::vector<std::string>> cells = {{"", ""}};
    for (const AxisReport& axis : axes) { cells.front().push_back(axis.axis); }
    for (const Row& row : rows) {
        cells.push_back({row.label, row.unit});
        for (const AxisReport& axis : axes) { cells.back().push_back(row.cell(axis)); }
    }
    std::vector<std::size_t> widths(axes.size() + 2);
    for (const auto& line : cells) {
        for (std::size_t c = 0; c < line.size(); ++c) { widths[c] = std::max(widths[c], width_of(line[c])); }
    }
    std::string text;
    for (const auto& line : cells) {
        std::string one;
        for (std::size_t c = 0; c < line.size(); ++c) { one += padded(line[c], widths[c] + 2); }
        one.resize(one.find_last_not_of(' ') + 1);
        text += fmt::format("  {}\n", one);
    }
    return text;
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
        text += fmt::format("{} dropout{}, {} samples missing; {} unbroken segments\n", report.dropouts,
                            report.dropouts == 1 ? "" : "s", report.samples_missing, report.segments);
    } else if (report.stamps == StampKind::sampling) {
        text += "no dropouts\n";
    }
    for (const std::string& warning : report.warnings) { text += fmt::format("warning: {}\n", warning); }
    return text;
}

}  // namespace

std::string analysis_text(const AnalysisReport& report) {
    std::string text = head_of(report);
    const std::vector<Row> rows = rows_of(report);
    const std::span axes(report.axes);
    for (std::size_t first = 0; first < axes.size(); first += axes_per_table) {
        text += '\n';
        text += table_of(rows, axes.subspan(first, std::min(axes_per_table, axes.size() - first)));
    }
    if (!report.axes.empty()) {
        text += fmt::format(
            "\n  ± one standard deviation (bias: expanded, k = 2); \"<\": not identifiable in this record, "
            "upper limit at "
            "{:.3g} %\n",
            report.confidence * 100.0);
    }
    return text;
}

}  // namespace gyrolog
