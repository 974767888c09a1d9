#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/cause_table.hpp"
#include "host/formats/curve_diagnosis_report.hpp"
#include "host/formats/curve_effect.hpp"
#include "host/formats/diagnosis_text.hpp"
#include "host/formats/noise_text.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

std::string residual_text(const CurveDiagnosis& diagnosis, const CurveResidual& residual) {
    return fmt::format("{:.2f} dB RMS, {:+.2f} dB at worst, at {}; {:.2g} times what the best fit leaves",
                       residual.rms_db, residual.worst_db, duration_text(residual.worst_tau_s),
                       diagnosis.in_floors(residual));
}

// Positive where the curve lies above the model. The decibels that an octave adds say how a gap grows.
std::string stretch_text(const CurveGapStretch& stretch) {
    const bool quiet = stretch.worst_db > 0.0;
    const std::string range =
        stretch.from_tau_s == stretch.to_tau_s
            ? "at " + duration_text(stretch.from_tau_s)
            : fmt::format("{} to {}", duration_text(stretch.from_tau_s), duration_text(stretch.to_tau_s));
    return fmt::format("{}: the model is too {} by up to {:.1f} dB, at {}", range, quiet ? "quiet" : "noisy",
                       std::abs(stretch.worst_db), duration_text(stretch.worst_tau_s));
}

std::string cause_words(const CurveCause& cause, const RateUnit& unit) {
    if (!cause.in_model) { return fmt::format("The model lacks {}", term_text(cause.term, unit)); }
    if (cause.term.size == 0.0) {
        return fmt::format("No {} seen, where the model has {}", name_of(cause.term.kind),
                           term_text(*cause.in_model, unit));
    }
    return fmt::format("The sensor's {} is {} times the model's ({})", name_of(cause.term.kind),
                       with_uncertainty(cause.factor(), cause.factor() * cause.size_sd_rel),
                       term_text(*cause.in_model, unit));
}

std::string cause_text(const CurveCause& cause, const RateUnit& unit) {
    std::string text = wrapped_text(
        "    - ", fmt::format("{}: {:.0f} % of the gap, probability {:.0f} %. {}; most of it from {} to {}.",
                              effect_of(cause).effect, 100.0 * cause.share, 100.0 * cause.probability,
                              cause_words(cause, unit), duration_text(cause.from_tau_s),
                              duration_text(cause.to_tau_s)));
    for (const CurveRival& rival : cause.rivals) {
        text += wrapped_text("      ",
                             fmt::format("`{}` ({}) fits nearly as well: it is {:.2g} times less likely.",
                                         effect_name(rival.term.kind), term_text(rival.term, unit),
                                         std::exp(0.5 * rival.criterion_behind)));
    }
    return text;
}

std::string left_text(const CurveLeft& left) {
    const std::string from = duration_text(left.from_tau_s);
    const std::string to = duration_text(left.to_tau_s);
    return fmt::format("left: {}, {:.2g} times what the best fit leaves",
                       left.from_tau_s == left.to_tau_s ? "at " + from : from + " to " + to, left.floors);
}

std::string curve_text(const DiagnosedCurve& curve, const RateUnit& unit) {
    const CurveDiagnosis& diagnosis = curve.diagnosis;
    const auto& points = curve.curve.points;
    std::string text = fmt::format("\n{} against the model's {} axis: {} points from {} to {}\n",
                                   printable(curve.name), axis_names.at(curve.axis), diagnosis.points,
                                   duration_text(points.front().tau_s), duration_text(points.back().tau_s));
    text += wrapped_text("  before: ", residual_text(diagnosis, diagnosis.before));
    for (const CurveGapStretch& stretch : diagnosis.stretches) {
        text += wrapped_text("    ", stretch_text(stretch));
    }
    for (const CurveCause& cause : diagnosis.causes) { text += cause_text(cause, unit); }
    if (!diagnosis.causes.empty()) {
        text += wrapped_text(
            "  after:  ", fmt::format("{}; {:.0f} % of the gap explained",
                                      residual_text(diagnosis, diagnosis.after), 100.0 * diagnosis.shrink));
    }
    for (const CurveLeft& left : diagnosis.left) { text += wrapped_text("    ", left_text(left)); }
    return text;
}

}  // namespace

std::string curve_diagnosis_text(const CurveDiagnosisReport& report) {
    const Diagnosis diagnosis = as_diagnosis(report);
    std::string text = wrapped_text("", verdict_line(diagnosis, "curve")) + "\n";
    const DiagnosisSentences sentences = diagnosis_sentences(diagnosis);
    if (!sentences.causes.empty()) { text += cause_table(sentences.causes) + "\n"; }
    text += wrapped_text(
        "",
        fmt::format("{} against {}; reading error taken as {:.3g} %. The best fit is that of the complete "
                    "noise model to the curve itself. Causes were fitted to the curve on "
                    "which the gap is measured: a recording would give data that the fit did not see.",
                    report.curve_name, report.model_name, 100.0 * report.options.reading_error));
    text += "\nwhat to do next\n";
    for (const std::string& sentence : next_sentences(diagnosis, "curve")) {
        text += wrapped_text("  - ", sentence);
    }
    for (const DiagnosedCurve& curve : report.curves) { text += curve_text(curve, report.unit); }
    if (!report.warnings.empty()) { text += "\nwarnings\n"; }
    for (const std::string& warning : report.warnings) { text += wrapped_text("  - ", warning); }
    return text;
}

}  // namespace gyrolog
