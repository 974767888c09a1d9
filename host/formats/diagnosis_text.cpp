#include "host/formats/diagnosis_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/chain.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/text_table.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

// Four digits: lines are narrow.
std::string frequency_text(double f_hz) {
    if (f_hz < 0.1) { return fmt::format("{:.4g} mHz", f_hz * 1e3); }
    return f_hz < 1000.0 ? fmt::format("{:.4g} Hz", f_hz) : fmt::format("{:.4g} kHz", f_hz / 1e3);
}

// "60 s to 15 min" behind `range`; where both ends read alike, one of them behind `point`.
template <typename Text>
std::string span_text(const Span& span, Text text, const char* range, const char* point) {
    const std::string from = text(span.from);
    const std::string to = text(span.to);
    return from == to ? point + from : fmt::format("{}{} to {}", range, from, to);
}

// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& items) {
    std::string text;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i > 0) { text += i + 1 == items.size() ? " and " : ", "; }
        text += items[i];
    }
    return text;
}

std::string cause_name(const Cause& cause) {
    const std::string axes = axes_text(cause.finding.where.axes);
    return axes.empty() ? cause.finding.effect : cause.finding.effect + " on " + axes;
}

// "temp_lag on x and tone on y", "temp_lag and tone on x".
std::string causes_text(const Diagnosis& diagnosis) {
    std::vector<std::string> names;
    std::vector<std::string> effects;
    names.reserve(diagnosis.causes.size());
    effects.reserve(diagnosis.causes.size());
    bool alike = true;
    for (const Cause& cause : diagnosis.causes) {
        names.push_back(cause_name(cause));
        effects.push_back(cause.finding.effect);
        alike = alike && cause.finding.where.axes == diagnosis.causes.front().finding.where.axes;
    }
    if (names.size() < 2 || !alike || names.front() == effects.front()) { return listed(names); }
    return listed(effects) + " on " + axes_text(diagnosis.causes.front().finding.where.axes);
}

// How often a recording of the very model differs as much.
std::string odds_text(double p) {
    if (p < 1e-6) { return "less than 1 in a million"; }
    if (p >= 0.1) { return fmt::format("{:.0f} of 100", 100.0 * p); }
    const double one_of = 1.0 / p;
    const double step = std::pow(10.0, std::floor(std::log10(one_of)) - 1.0);
    return fmt::format("1 of {:.0f}", std::round(one_of / step) * step);
}

std::string probability_text(double p) { return p < 1e-6 ? "p < 1e-6" : fmt::format("p = {:.2g}", p); }

std::string chance_sentence(const Diagnosis& diagnosis) {
    return fmt::format("Of recordings that do come from the model, {} would differ as much ({}).",
                       odds_text(diagnosis.p_none), probability_text(diagnosis.p_none));
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

std::string times_floor(double value, const Gap& gap) {
    const double times = value / gap.floor;
    return times < 100.0 ? fmt::format("{:.2g}", times) : fmt::format("{:.0f}", times);
}

std::string gap_before_sentence(const Diagnosis& diagnosis) {
    const Gap& gap = diagnosis.gap_before;
    const std::string place = place_text(diagnosis.where);
    return fmt::format("{}{}he simulation is {} times the floor away ({} to {}).", place,
                       place.empty() ? "T" : ": t", times_floor(gap.value, gap), times_floor(gap.lo, gap),
                       times_floor(gap.hi, gap));
}

std::string split_half_clause(const SplitHalfResult& halves) {
    if (halves.judged.empty()) {
        return "the fit's own uncertainty says so, no half of the recording could judge the other's fit "
               "(--holdout takes a second recording)";
    }
    const std::string what = listed(halves.judged);
    const char* leave = halves.judged.size() == 1 ? "leaves" : "leave";
    if (halves.excess_nats > 0.0) {
        return fmt::format(
            "{}, fitted to one half of the recording, {} more in the other than chance does "
            "({:.3g} nats), which is counted",
            what, leave, halves.evidence_left_nats);
    }
    return fmt::format("{}, fitted to one half of the recording, {} no more in the other than chance does",
                       what, leave);
}

std::string gap_after_sentence(const Diagnosis& diagnosis) {
    const Gap& gap = diagnosis.gap_after;
    const std::size_t causes = diagnosis.causes.size();
    const char* with = causes == 1 ? "it" : causes == 2 ? "both" : "all of them";
    std::string text = fmt::format("With {} the gap {} {} times the floor: {} ({} to {}) closed", with,
                                   gap.value < diagnosis.gap_before.value ? "falls to" : "is still",
                                   times_floor(gap.value, gap), percent(diagnosis.shrink),
                                   percent(diagnosis.shrink_lo), percent(diagnosis.shrink_hi));
    if (!diagnosis.held_out.empty()) {
        text += fmt::format(" on data that the fit did not see ({})", diagnosis.held_out);
    } else if (diagnosis.verdict == Verdict::known) {
        text += "; " + split_half_clause(diagnosis.split_half);
    }
    return text + ".";
}

std::string with_full_stop(std::string sentence) {
    if (!sentence.ends_with('.')) { sentence += '.'; }
    return sentence;
}

// Empty where the model's noise stays as it is.
std::string noise_refit_sentence(const Diagnosis& diagnosis) {
    if (diagnosis.noise_refits.empty()) { return {}; }
    std::vector<std::string> changes;
    for (const NoiseRefit& one : diagnosis.noise_refits) {
        changes.push_back(fmt::format("{} of {} {:.3g} ± {:.1g} instead of {:.3g}", one.coefficient,
                                      axis_names.at(one.axis), one.fitted * deg_per_rad,
                                      one.fitted_sd * deg_per_rad, one.stated * deg_per_rad));
    }
    return fmt::format(
        "The model's noise held part of this, as that of a model does which was fitted to a recording with "
        "the same effect; with the effect in the model it is {} (N in deg/s/√Hz, B in deg/s, K in "
        "deg/s·√Hz).",
        fmt::join(changes, ", "));
}

std::string better_shape_sentence(const BetterShape& better) {
    return fmt::format("{} fits better than {}, by {:.0f} nats, and is no known effect.", better.words,
                       better.than.empty() ? "the model" : listed(better.than), better.evidence_nats);
}

// How likely the gap is by chance, where it lies, what makes it and how far it closes.
std::string summary_text(const Diagnosis& diagnosis) {
    std::vector<std::string> sentences{chance_sentence(diagnosis)};
    if (diagnosis.verdict == Verdict::none) { return wrapped_text("", sentences.front()); }
    sentences.push_back(gap_before_sentence(diagnosis));
    for (const Cause& cause : diagnosis.causes) {
        const std::string axes = axes_text(cause.finding.where.axes);
        const std::string words = with_full_stop(effect_words(cause.finding));
        const bool says_axes = diagnosis.causes.size() > 1 && !axes.empty();
        sentences.push_back(says_axes ? fmt::format("On {}: {}", axes, words) : words);
    }
    const std::string noise_refits = noise_refit_sentence(diagnosis);
    if (!noise_refits.empty()) { sentences.push_back(noise_refits); }
    if (!diagnosis.causes.empty()) { sentences.push_back(gap_after_sentence(diagnosis)); }
    if (diagnosis.better_shape) { sentences.push_back(better_shape_sentence(*diagnosis.better_shape)); }
    if (diagnosis.verdict == Verdict::unexplained && !diagnosis.causes.empty() && !diagnosis.better_shape) {
        const std::string place = place_text(diagnosis.left);
        sentences.push_back(fmt::format("What is left is not by chance either ({}){}.",
                                        probability_text(diagnosis.p_left),
                                        place.empty() ? "" : ": " + place));
    }
    return wrapped_text("", fmt::format("{}", fmt::join(sentences, " ")));
}

std::string heading_text(const Diagnosis& diagnosis) {
    std::string text =
        fmt::format("{} against {} simulations of {} (seed {}): {} samples at {:.6g} Hz, {}",
                    diagnosis.recording_name, diagnosis.simulations, diagnosis.model_name, diagnosis.seed,
                    diagnosis.samples, diagnosis.rate_hz, duration_text(diagnosis.duration_s));
    if (!diagnosis.passes.empty()) { text += "; " + passes_text(diagnosis); }
    return wrapped_text("", text);
}

// Parameters that were not fitted stand with those that were: the entry needs both.
std::string entry_text(const Finding& finding, std::size_t entry) {
    const EffectDefinition* effect = find_effect(finding.effect);
    std::string text;
    for (const auto& [name, value] : finding.entries[entry].params) {
        const EffectParam* param = nullptr;
        if (effect != nullptr) {
            const auto found = std::ranges::find(effect->params, name, &EffectParam::name);
            if (found != effect->params.end()) { param = &*found; }
        }
        double sd = 0.0;
        if (entry < finding.sd.size() && finding.sd[entry].contains(name)) {
            sd = finding.sd[entry].at(name);
        }
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, quantity_text(name, value, sd, param));
    }
    if (finding.entries.size() > 1) {
        text = fmt::format("{}: {}", fmt::join(finding.entries[entry].axes, ", "), text);
    }
    return text;
}

std::string tie_sentence(const Cause& cause) {
    std::vector<std::string> rivals;
    for (const Rival& rival : cause.tie_group) {
        if (rival.effect == cause.finding.effect) { continue; }
        rivals.push_back(
            fmt::format("`{}` ({:.1f} nats less)", rival.effect, rival.evidence_below_best_nats));
    }
    if (rivals.empty()) { return {}; }
    std::string text =
        fmt::format("{} {} nearly as well", listed(rivals), rivals.size() == 1 ? "fits" : "fit");
    if (!cause.decided_by.empty()) { text += fmt::format("; {} would decide", cause.decided_by); }
    return text + ".";
}

std::string cause_text(const Diagnosis& diagnosis, const Cause& cause, std::size_t rank) {
    const Finding& finding = cause.finding;
    std::string text = wrapped_text(
        fmt::format("  {}. ", rank),
        fmt::format("{}: probability {}, evidence {:.0f} nats, closes {} of the gap alone", cause_name(cause),
                    percent(cause.score), finding.evidence_nats, percent(cause.shrink_alone)));
    const std::string place = place_text(finding.where);
    if (!place.empty() && place != place_text(diagnosis.where)) { text += wrapped_text("     ", place); }
    for (std::size_t entry = 0; entry < finding.entries.size(); ++entry) {
        const std::string values = entry_text(finding, entry);
        if (!values.empty()) { text += wrapped_text("     ", values); }
    }
    const std::string tie = tie_sentence(cause);
    return tie.empty() ? text : text + wrapped_text("     ", tie);
}

std::string outside_text(const std::vector<bool>& outside, std::size_t points) {
    return fmt::format("{} of {}", std::ranges::count(outside, true), points);
}

// Of many places only those with something to see are listed.
constexpr std::size_t listed_whole_most = 6;

bool is_listed(const Diagnosis& diagnosis, const GapDomain& domain) {
    return diagnosis.domains.size() <= listed_whole_most ||
           std::max(domain.surprise_before_nats, domain.surprise_after_nats) >= stands_out_nats;
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
    std::string text = fmt::format(
        "\nwhere (1 is the floor: what two simulations differ by; {:.3g} % of simulated points are inside)\n",
        100.0 * diagnosis.band_probability);
    text += text_table(heads, rows);
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

std::string sentences_text(const char* title, const std::vector<std::string>& sentences) {
    std::string text = sentences.empty() ? "" : fmt::format("\n{}\n", title);
    for (const std::string& sentence : sentences) { text += wrapped_text("  - ", sentence); }
    return text;
}

}  // namespace

std::string place_text(const Place& place) {
    std::vector<std::string> parts;
    if (!place.axes.empty()) {
        parts.push_back(axes_text(place.axes) + (place.axes.size() == 1 ? " axis" : " axes"));
    }
    if (place.tau_s) {
        parts.push_back(span_text(*place.tau_s, duration_text, "averaging times ", "averaging time "));
    }
    if (place.freq_hz) { parts.push_back(span_text(*place.freq_hz, frequency_text, "", "at ")); }
    if (place.time_s) {
        parts.push_back(span_text(*place.time_s, duration_text, "from ", "at ") + " after the first sample");
    }
    if (place.temperature) { parts.emplace_back("with the temperature"); }
    if (place.acceleration) { parts.emplace_back("with the specific force"); }
    if (place.rate_rad_s) {
        parts.push_back(fmt::format("rates of {:.3g} to {:.3g} deg/s", place.rate_rad_s->from * deg_per_rad,
                                    place.rate_rad_s->to * deg_per_rad));
    }
    if (place.amplitude_sigma) {
        parts.push_back(fmt::format("samples {:.2g} to {:.2g} standard deviations off",
                                    place.amplitude_sigma->from, place.amplitude_sigma->to));
    }
    if (!place.structure.empty()) {
        std::string structure = place.structure;
        std::ranges::replace(structure, '_', ' ');
        parts.push_back(structure);
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string passes_text(const Diagnosis& diagnosis) {
    std::vector<std::string> passes;
    for (const Pass& pass : diagnosis.passes) {
        passes.push_back(pass.samples_per_row == 1
                             ? fmt::format("at the first {} sample by sample", duration_text(pass.duration_s))
                             : fmt::format("at all of it in means of {} samples", pass.samples_per_row));
    }
    return "looked " + listed(passes);
}

std::string verdict_sentence(const Diagnosis& diagnosis, std::string_view of) {
    const std::string causes = causes_text(diagnosis);
    const bool one = diagnosis.causes.size() == 1;
    switch (diagnosis.verdict) {
        case Verdict::none:
            return fmt::format("no gap: the {} could have come from the model", of);
        case Verdict::known:
            return fmt::format("known: {} {} the gap", causes, one ? "explains" : "explain");
        case Verdict::unexplained:
            break;
    }
    if (diagnosis.causes.empty()) { return "unexplained: there is a gap, and no known effect makes it"; }
    if (diagnosis.better_shape) {
        const bool than_all = diagnosis.better_shape->than.size() == diagnosis.causes.size();
        return fmt::format("unexplained: {} {} the gap, but something else fits better{}", causes,
                           one ? "resembles" : "resemble",
                           than_all ? "" : " than " + listed(diagnosis.better_shape->than));
    }
    return fmt::format("unexplained: {} {} part of the gap, what makes the rest is not known", causes,
                       one ? "is" : "are");
}

std::string diagnosis_text(const Diagnosis& diagnosis) {
    std::string text = verdict_sentence(diagnosis) + "\n\n" + heading_text(diagnosis);
    text += summary_text(diagnosis);
    if (!diagnosis.causes.empty()) { text += "\ncauses\n"; }
    for (std::size_t i = 0; i < diagnosis.causes.size(); ++i) {
        text += cause_text(diagnosis, diagnosis.causes[i], i + 1);
    }
    text += domains_text(diagnosis);
    text += untestable_text(diagnosis);
    text += sentences_text("recordings that would tell more", diagnosis.next_recordings);
    text += sentences_text("warnings", diagnosis.warnings);
    return text;
}

}  // namespace gyrolog
