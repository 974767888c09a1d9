#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/formats/diagnosis_text.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {
namespace {

std::string gap_text(const Gap& gap) {
    return fmt::format("{:.3g} ({:.3g} to {:.3g})", gap.value, gap.lo, gap.hi);
}

Html gaps_of(const Diagnosis& diagnosis) {
    HtmlTable gaps{cells_of({"", "gap (95 % interval)"}), {}, "numbers"};
    gaps.rows.push_back(cells_of({"the model as it is", gap_text(diagnosis.gap_before)}));
    if (!diagnosis.causes.empty()) {
        gaps.rows.push_back(cells_of({"with the causes in it", gap_text(diagnosis.gap_named)}));
    }
    if (!diagnosis.unnamed.empty()) {
        gaps.rows.push_back(cells_of({"and what has no name", gap_text(diagnosis.gap_after)}));
    }
    gaps.rows.push_back(
        cells_of({"two simulations of one model", fmt::format("{:.3g}", diagnosis.gap_before.floor)}));
    return table(gaps);
}

Html causes_of(const DiagnosisSentences& sentences) {
    Html section = element("h3", Html::text("Causes")) + paragraph("Explained: " + sentences.explained + ".");
    if (sentences.causes.empty()) { return section; }
    HtmlTable causes{
        cells_of({"cause", "axes", "size", "share of the gap", "probability", "what it is"}), {}, "causes"};
    for (const DiagnosisSentences::OfCause& cause : sentences.causes) {
        for (const CauseSize& size : cause.sizes) {
            const std::string sizes = fmt::format("{}", fmt::join(size.values, "; "));
            if (&size == &cause.sizes.front()) {
                causes.rows.push_back(
                    cells_of({cause.effect, size.axes, sizes, cause.share, cause.probability, cause.words}));
            } else {
                causes.rows.push_back(cells_of({"", size.axes, sizes, "", "", ""}));
            }
        }
    }
    section += table(causes);
    if (sentences.causes.size() > 1) {
        section += paragraph(
            "Each share is what returns when that cause alone is taken out again: shares "
            "may overlap.",
            "muted");
    }
    return section;
}

Html left_of(const DiagnosisSentences& sentences) {
    return element("h3", Html::text("What is left")) + paragraph(sentences.left + ".") +
           bullet_list(sentences.left_items);
}

Html warnings_of(const Diagnosis& diagnosis) {
    if (diagnosis.warnings.empty()) { return {}; }
    return element("div",
                   element("b", Html::text("Warnings of the diagnosis")) + bullet_list(diagnosis.warnings),
                   "warning");
}

}  // namespace

Html diagnosis_section(const ReportPage& page) {
    if (page.diagnosis == nullptr) { return {}; }
    const Diagnosis& diagnosis = *page.diagnosis;
    const DiagnosisSentences sentences = diagnosis_sentences(diagnosis);
    Html section = element("h2", Html::text("Against the model " + diagnosis.model_name));
    section += paragraph(verdict_line(diagnosis), "verdict");
    section += paragraph(sentences.gap) + gaps_of(diagnosis);
    if (diagnosis.verdict != Verdict::none) { section += causes_of(sentences) + left_of(sentences); }
    section += figure(page.diagnosis_png,
                      "Shares of the causes, and the recording over the band of simulations before and after",
                      sentences.heading + ".");
    return section + warnings_of(diagnosis);
}

}  // namespace gyrolog
