#include "host/formats/diagnosis_details.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/chain.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/place_text.hpp"
#include "host/formats/text_table.hpp"
#include "host/formats/text_width.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

// Empty where the model's noise stays as it is.
std::string noise_refit_sentence(const Diagnosis& diagnosis) {
    if (diagnosis.noise_refits.empty()) { return {}; }
    std::vector<std::string> changes;
    const double per_unit = diagnosis.unit.per_column_unit;
    for (const NoiseRefit& one : diagnosis.noise_refits) {
        changes.push_back(fmt::format("{} of {} {:.3g} ± {:.1g} instead of {:.3g}", one.coefficient,
                                      axis_names.at(one.axis), one.fitted * per_unit,
                                      one.fitted_sd * per_unit, one.stated * per_unit));
    }
    return fmt::format(
        "The model's noise held part of the causes, as that of a model does which was fitted to a recording "
        "with the same effects; with the causes in the model it is {0} (N in {1}/√Hz, B in {1}, K in "
        "{1}·√Hz).",
        fmt::join(changes, ", "), diagnosis.unit.sensor == SensorKind::gyro ? "deg/s" : diagnosis.unit.name);
}

// Parameters that were not fitted stand with those that were: the entry needs both.
std::string entry_text(const Finding& finding, std::size_t entry) {
    std::string text;
    for (const auto& [name, value] : finding.entries[entry].params) {
        double sd = 0.0;
        if (entry < finding.sd.size() && finding.sd[entry].contains(name)) {
            sd = finding.sd[entry].at(name);
        }
        text += (text.empty() ? "" : ", ") + param_text(name, value, sd);
    }
    if (finding.entries.size() > 1) {
        text = fmt::format("{}: {}", fmt::join(finding.entries[entry].axes, ", "), text);
    }
    return text;
}

std::string rivals_text(const Cause& cause) {
    std::vector<std::string> rivals;
    for (const Rival& rival : cause.tie_group) {
        if (rival.effect == cause.finding.effect) { continue; }
        rivals.push_back(
            fmt::format("`{}` has {:.1f} nats less", rival.effect, rival.evidence_below_best_nats));
    }
    return fmt::format("{}", fmt::join(rivals, ", "));
}

std::string cause_details(const Cause& cause, std::size_t rank) {
    const Finding& finding = cause.finding;
    std::vector<std::string> lines{fmt::format("evidence {:.0f} nats", finding.evidence_nats)};
    const std::string rivals = rivals_text(cause);
    if (!rivals.empty()) { lines.back() += "; " + rivals; }
    const std::string place = place_text(finding.where);
    if (!place.empty()) { lines.push_back(place); }
    for (std::size_t entry = 0; entry < finding.entries.size(); ++entry) {
        const std::string values = entry_text(finding, entry);
        if (!values.empty()) { lines.push_back(values); }
    }
    std::string text = wrapped_text(fmt::format("  {}. ", rank), finding.effect + ": " + lines.front());
    for (std::size_t line = 1; line < lines.size(); ++line) { text += wrapped_text("     ", lines[line]); }
    return text;
}

std::string causes_details(const Diagnosis& diagnosis) {
    if (diagnosis.causes.empty()) { return {}; }
    std::string text = "\nparameters of the causes\n";
    for (std::size_t i = 0; i < diagnosis.causes.size(); ++i) {
        text += cause_details(diagnosis.causes[i], i + 1);
    }
    const std::string noise_refits = noise_refit_sentence(diagnosis);
    return noise_refits.empty() ? text : text + wrapped_text("  ", noise_refits);
}

std::string outside_text(const std::vector<bool>& outside, std::size_t points) {
    return fmt::format("{} of {}", std::ranges::count(outside, true), points);
}

// Of many places only those with something to see are listed.
constexpr std::size_t listed_whole_most = 6;

bool is_listed(const Diagnosis& diagnosis, const GapDomain& domain) {
    return diagnosis.domains.size() <= listed_whole_most || domain.stands_out;
}

std::string domains_text(const Diagnosis& diagnosis) {
    if (diagnosis.domains.empty()) { return {}; }
    const bool corrected = std::ranges::any_of(
        diagnosis.domains, [](const GapDomain& domain) { return !domain.after_lo.empty(); });
    std::vector<std::string> heads{"gap", "points outside"};
    if (corrected) { heads = {"gap before", "after", "points outside before", "after"}; }
    std::vector<TextRow> rows;
    std::size_t quiet = 0;
    for (const GapDomain& domain : diagnosis.domains) {
        if (!is_listed(diagnosis, domain)) {
            ++quiet;
            continue;
        }
        TextRow row{fmt::format("{} {}", domain.axis_text(), domain.name), "", {}};
        const std::string before = outside_text(domain.outside_before, domain.x.size());
        row.cells = {fmt::format("{:.2g}", domain.gap_before), before};
        if (corrected && domain.after_lo.empty()) {
            row.cells = {row.cells[0], "-", before, "-"};
        } else if (corrected) {
            row.cells = {row.cells[0], fmt::format("{:.2g}", domain.gap_after), before,
                         outside_text(domain.outside_after, domain.x.size())};
        }
        rows.push_back(std::move(row));
    }
    if (rows.empty()) { return fmt::format("\nwhere: nothing stands out in any of {} comparisons\n", quiet); }
    std::string text =
        "\n" +
        wrapped_text(
            "", fmt::format("where (1 is the floor: what two simulations differ by; {:.3g} % of simulated "
                            "points are inside)",
                            100.0 * diagnosis.band_probability));
    text += text_table(heads, rows, terminal_width);
    if (quiet > 0) { text += fmt::format("  nothing stands out in {} other comparisons\n", quiet); }
    return text;
}

std::string untestable_text(const Diagnosis& diagnosis) {
    std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
    for (const Untestable& one : diagnosis.untestable) {
        auto reason = std::ranges::find_if(reasons, [&](const auto& r) { return r.first == one.why; });
        if (reason == reasons.end()) { reason = reasons.insert(reasons.end(), {one.why, {}}); }
        reason->second.push_back(one.effect);
    }
    std::string text = reasons.empty() ? "" : "\nnot tested\n";
    for (const auto& [why, effects] : reasons) {
        text += wrapped_text("  - ", fmt::format("{}: {}", why, fmt::join(effects, ", ")));
    }
    return text;
}

}  // namespace

std::string diagnosis_details(const Diagnosis& diagnosis) {
    return causes_details(diagnosis) + domains_text(diagnosis) + untestable_text(diagnosis);
}

}  // namespace gyrolog
