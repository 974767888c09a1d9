#include "host/formats/curve_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/noise_text.hpp"
#include "host/formats/text_table.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

std::string residual_text(const CurveResidual& residual) {
    return fmt::format("{:.2f} dB RMS, {:+.2f} dB at worst, at {}", residual.rms_db, residual.worst_db,
                       duration_text(residual.worst_tau_s));
}

std::string step_text(const CurveFitStep& step, const SensorUnit& unit) {
    if (step.change == CurveFitStep::Change::removed) { return fmt::format("- {}", name_of(step.term)); }
    if (step.change == CurveFitStep::Change::added) { return "+ " + term_text(step.terms.back(), unit); }
    std::string text;
    for (const CurveTerm& term : step.terms) {
        text += fmt::format("{}{}", text.empty() ? "" : " ", name_of(term.kind));
    }
    return text;
}

std::string ladder_text(const PrintedCurveReport& curve, const SensorUnit& unit) {
    const auto& points = curve.curve.points;
    std::string text =
        "\n" + wrapped_text(
                   "", fmt::format("{}: {} points from {} to {}", printable(curve.name), points.size(),
                                   duration_text(points.front().tau_s), duration_text(points.back().tau_s)));
    const std::array<std::string, 3> heads{"dB RMS", "at worst", "at"};
    std::vector<TextRow> rows;
    for (const CurveFitStep& step : curve.fit.steps) {
        const CurveResidual& residual = step.residual;
        rows.push_back({step_text(step, unit),
                        "",
                        {fmt::format("{:.2f}", residual.rms_db), fmt::format("{:+.2f}", residual.worst_db),
                         duration_text(residual.worst_tau_s)}});
    }
    text += text_table(heads, rows);
    if (curve.fit.rejected.empty()) { return text; }
    std::string rejected;
    for (const RejectedTerm& term : curve.fit.rejected) {
        rejected += fmt::format("{}{} {:+.1f}", rejected.empty() ? "" : ", ", name_of(term.term.kind),
                                term.criterion_gain);
    }
    return text + "  not called for (fall of BIC, of 6 needed):\n" + wrapped_text("    ", rejected);
}

std::string verdict_text(const CurveGapTerm& term, const SensorUnit& unit) {
    using Verdict = CurveGapTerm::Verdict;
    switch (term.verdict) {
        case Verdict::lacking:
            return fmt::format("lacks {}", term_text(*term.sensor, unit));
        case Verdict::extra:
            return fmt::format("has {}, the sensor does not", term_text(*term.simulation, unit));
        case Verdict::too_weak:
        case Verdict::too_strong:
            return fmt::format("{} {}: {}, the sensor {:.3g} ({:+.1f} dB)", name_of(term.kind),
                               term.verdict == Verdict::too_weak ? "too weak" : "too strong",
                               term_text(*term.simulation, unit), term.sensor->size * unit.per_column_unit,
                               20.0 * std::log10(term.sensor->size / term.simulation->size));
        case Verdict::agrees:
            return fmt::format("{} agrees", name_of(term.kind));
    }
    return {};
}

std::string gap_text(const NamedCurveGap& named, const SensorUnit& unit) {
    const CurveGap& gap = named.gap;
    std::string text = "\n" + wrapped_text("", fmt::format("{} over {}: {}", named.sensor, named.simulation,
                                                           residual_text(gap.residual)));
    for (const CurveGapStretch& stretch : gap.stretches) {
        std::string line = fmt::format(
            "{} to {}: the sensor is up to {:.1f} dB {} (at {})", duration_text(stretch.from_tau_s),
            duration_text(stretch.to_tau_s), std::abs(stretch.worst_db),
            stretch.worst_db > 0.0 ? "noisier" : "quieter", duration_text(stretch.worst_tau_s));
        if (stretch.term) {
            line += fmt::format(", {:.0f} % of it by {}", 100.0 * stretch.share, name_of(*stretch.term));
        }
        text += wrapped_text("  ", line);
    }
    text += "  the simulation:\n";
    for (const CurveGapTerm& term : gap.terms) { text += wrapped_text("    ", verdict_text(term, unit)); }
    return text;
}

}  // namespace

std::string curve_text(const CurveReport& report) {
    const bool is_gyro = report.unit.sensor == SensorKind::gyro;
    const SensorUnit unit = is_gyro ? report.unit : SensorUnit::micro_g();
    std::string text = wrapped_text(
        "", fmt::format("{}: {} Allan curve{} without samples; reading error taken as {:.3g} %",
                        printable(report.name), report.curves.size(), report.curves.size() == 1 ? "" : "s",
                        report.options.reading_error * 100.0));
    for (const std::string& warning : report.warnings) { text += wrapped_text("warning: ", warning); }
    std::vector<FitOfColumn> fits;
    std::vector<std::string> heads;
    for (const PrintedCurveReport& curve : report.curves) {
        text += ladder_text(curve, unit);
        fits.push_back({&curve.fit.noise, &curve.slopes});
        heads.push_back(printable(curve.name));
    }
    text += '\n' + text_table(heads, noise_rows(fits, unit));
    text += fmt::format(
        "\n  In brackets: one standard deviation in the last two digits, of reading the\n"
        "  curve and of what the model leaves over. The scatter of the record behind the\n"
        "  curve, which print does not tell, is not in it. \"<\": not called for by the\n"
        "  curve, upper limit at {:.3g} %.\n",
        report.options.confidence * 100.0);
    const std::vector<TextRow> si = si_rows(fits, unit);
    if (!si.empty()) { text += '\n' + text_table(heads, si); }
    for (const NamedCurveGap& gap : report.gaps) { text += gap_text(gap, unit); }
    return text;
}

}  // namespace gyrolog
