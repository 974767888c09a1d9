#include "host/formats/diagnosis_text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/cause_table.hpp"
#include "host/formats/diagnosis_details.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/place_text.hpp"
#include "host/formats/text_width.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

// The verdict is one line.
constexpr std::size_t causes_in_verdict_most = 3;

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

// Each once, in their order: "2 × tone on y".
std::vector<std::string> each_once(const std::vector<std::string>& names) {
    std::vector<std::string> once;
    for (auto name = names.begin(); name != names.end(); ++name) {
        if (std::find(names.begin(), name, *name) != name) { continue; }
        const auto count = std::count(name, names.end(), *name);
        once.push_back(count == 1 ? *name : fmt::format("{} × {}", count, *name));
    }
    return once;
}

// "temp_lag on x and tone on y", "temp_lag and tone on x", "temp_lag on x, tone on y and 3 more".
std::string causes_text(const Diagnosis& diagnosis) {
    std::vector<std::string> names;
    std::vector<std::string> effects;
    bool alike = true;
    for (const Cause& cause : diagnosis.causes) {
        names.push_back(cause_name(cause));
        effects.push_back(cause.finding.effect);
        alike = alike && cause.finding.where.axes == diagnosis.causes.front().finding.where.axes;
    }
    const bool of_sensor = !names.empty() && names.front() == effects.front();
    names = each_once(names);
    if (names.size() > causes_in_verdict_most) {
        const std::size_t more = names.size() - causes_in_verdict_most + 1;
        names.resize(causes_in_verdict_most - 1);
        names.push_back(fmt::format("{} more", more));
        return listed(names);
    }
    if (names.size() < 2 || !alike || of_sensor) { return listed(names); }
    return listed(each_once(effects)) + " on " + axes_text(diagnosis.causes.front().finding.where.axes);
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

// Nothing has no sign.
std::string percent_text(double share) { return fmt::format("{:.0f} %", std::round(100.0 * share) + 0.0); }

std::string share_text(const Share& share) {
    if (percent_text(share.lo) == percent_text(share.hi)) {
        return percent_text(share.value) + " of the gap";
    }
    return fmt::format("{} of the gap ({} to {})", percent_text(share.value), percent_text(share.lo),
                       percent_text(share.hi));
}

// For a column that is headed by what it is a share of.
std::string short_share_text(const Share& share) {
    if (percent_text(share.lo) == percent_text(share.hi)) { return percent_text(share.value); }
    const auto number = [](double of) { return std::round(100.0 * of) + 0.0; };
    return fmt::format("{} ({:.0f} to {:.0f})", percent_text(share.value), number(share.lo),
                       number(share.hi));
}

std::string times_floor(double value, const Gap& gap) {
    const double times = value / gap.floor;
    return times < 100.0 ? fmt::format("{:.2g}", times) : fmt::format("{:.0f}", times);
}

std::string with_full_stop(std::string sentence) {
    if (!sentence.ends_with('.')) { sentence += '.'; }
    return sentence;
}

// How large the gap is, where, and whether chance makes one.
std::string gap_sentence(const Diagnosis& diagnosis) {
    const Gap& gap = diagnosis.gap_before;
    std::string text;
    // A second recording was measured of a model without a gap, too.
    if (diagnosis.verdict != Verdict::none || !diagnosis.held_out.empty()) {
        text = fmt::format(
            "{} is {} times as far from a simulation as two simulations are from each other ({} to {}). ",
            diagnosis.held_out.empty() ? "The recording" : diagnosis.held_out, times_floor(gap.value, gap),
            times_floor(gap.lo, gap), times_floor(gap.hi, gap));
    }
    if (diagnosis.verdict != Verdict::none) {
        const std::string place = place_text(diagnosis.where);
        if (!place.empty()) { text += fmt::format("It differs most here: {}. ", place); }
    }
    return text + fmt::format("Of recordings that do come from the model, {} would differ as much ({}).",
                              odds_text(diagnosis.p_none), probability_text(diagnosis.p_none));
}

// On which data the shares were measured.
std::string measured_sentence(const Diagnosis& diagnosis) {
    std::string text =
        diagnosis.held_out.empty()
            ? "measured by simulating, on parts of the recording that the fit did not use"
            : fmt::format("measured by simulating, on {}, which had no part in the fit", diagnosis.held_out);
    if (!diagnosis.not_held_out.empty()) {
        text += fmt::format("; not so {}, for which the data of the fit were used",
                            listed(diagnosis.not_held_out));
    }
    return text;
}

std::string tie_clause(const Cause& cause) {
    std::vector<std::string> rivals;
    for (const Rival& rival : cause.tie_group) {
        if (rival.effect != cause.finding.effect) { rivals.push_back("`" + rival.effect + "`"); }
    }
    if (rivals.empty()) { return {}; }
    return fmt::format(" This recording cannot tell it from {}.",
                       fmt::format("{}", fmt::join(rivals, " or ")));
}

DiagnosisSentences::OfCause sentences_of(const Cause& cause) {
    return {cause.finding.effect, cause_sizes(cause), short_share_text(cause.share),
            percent_text(cause.score), with_full_stop(cause_words(cause)) + tie_clause(cause)};
}

std::string explained_sentence(const Diagnosis& diagnosis) {
    if (diagnosis.causes.empty()) { return "nothing, no known effect makes such a gap"; }
    return fmt::format("{}, {}", share_text(diagnosis.shrink), measured_sentence(diagnosis));
}

std::string explained_section(const DiagnosisSentences& sentences) {
    std::string text = wrapped_text("", "explained: " + sentences.explained);
    if (!sentences.causes.empty()) { text += cause_table(sentences.causes); }
    if (sentences.causes.size() > 1) {
        text += wrapped_text("  ",
                             "Each share is what returns when that cause alone is taken out again: shares "
                             "may overlap.");
    }
    return "\n" + text;
}

std::string words_section(const DiagnosisSentences& sentences) {
    std::string text = sentences.causes.empty() ? "" : "\nwhat the causes are\n";
    for (std::size_t i = 0; i < sentences.causes.size(); ++i) {
        text += wrapped_text(fmt::format("  {}. ", i + 1), sentences.causes[i].words);
    }
    return text;
}

std::string better_shape_sentence(const BetterShape& better) {
    return fmt::format("{} fits better than {}, and is no known effect.", better.words,
                       better.than.empty() ? "the model" : listed(better.than));
}

// What was modelled without an effect.
std::string words_of_form(const Unnamed& unnamed) {
    const std::string& form = unnamed.form;
    if (form == "density") { return "a spectrum"; }
    if (form == "drift") { return "a course in time"; }
    if (form == "temperature") { return "a mean that goes with the temperature"; }
    if (form == "rate") {
        return unnamed.where.force_m_s2 ? "a mean that goes with the force"
                                        : "a mean that goes with the rate";
    }
    if (form == "level") { return "a level of the noise over time"; }
    if (form == "masked") { return "stretches that were left out as disturbances"; }
    return form;
}

std::string unnamed_text(const Unnamed& unnamed) {
    const std::string place = place_text(unnamed.where);
    return fmt::format("without a name, {}{}: {} of the gap", words_of_form(unnamed),
                       place.empty() ? "" : " (" + place + ")", percent_text(unnamed.share));
}

std::string left_text(const Left& left) {
    const std::string place = place_text(left.where);
    return fmt::format("{}: {:.2g} times what two simulations differ by", place.empty() ? "somewhere" : place,
                       left.size);
}

// From what the gap falls, to what.
std::string fall_text(const Diagnosis& diagnosis) {
    std::string text =
        fmt::format("the gap is {}", times_floor(diagnosis.gap_before.value, diagnosis.gap_before));
    if (!diagnosis.causes.empty()) {
        text +=
            fmt::format(", {} with the causes", times_floor(diagnosis.gap_named.value, diagnosis.gap_named));
    }
    if (!diagnosis.unnamed.empty()) {
        text += fmt::format(", {} with what has no name as well",
                            times_floor(diagnosis.gap_after.value, diagnosis.gap_after));
    }
    return text + " (1 is what two simulations differ by)";
}

std::string left_sentence(const Diagnosis& diagnosis) {
    std::string text =
        fmt::format("{} of the gap", percent_text(std::max(1.0 - diagnosis.shrink.value, 0.0)));
    if (!diagnosis.unnamed.empty()) {
        text += fmt::format(", {} beside what has no name",
                            percent_text(std::max(1.0 - diagnosis.shrink_modelled, 0.0)));
    }
    text += "; " + fall_text(diagnosis);
    if (!diagnosis.causes.empty()) {
        text += fmt::format("; chance leaves as much in {} ({})", odds_text(diagnosis.p_left),
                            probability_text(diagnosis.p_left));
    }
    return text;
}

std::vector<std::string> left_items(const Diagnosis& diagnosis) {
    std::vector<std::string> items;
    for (const Unnamed& one : diagnosis.unnamed) { items.push_back(unnamed_text(one)); }
    for (const Left& one : diagnosis.left) { items.push_back(left_text(one)); }
    if (diagnosis.better_shape) { items.push_back(better_shape_sentence(*diagnosis.better_shape)); }
    if (items.empty()) { items.emplace_back("no place stands out"); }
    return items;
}

// What others of its kind cannot tell. Empty of another reference.
std::string gyros_sentence(std::size_t gyros) {
    if (gyros == 0) { return {}; }
    if (gyros == 1) {
        return "The reference is the array's one other gyro: which of the two is off nobody can tell, and "
               "what "
               "both share, such as a scale error or a delay, does not show. ";
    }
    return fmt::format(
        "The reference is the mean of the array's {} other gyros, each brought to the median response of "
        "all: "
        "what most of them share, such as a scale error or a delay, does not show. ",
        gyros);
}

// What the sensor is judged by. Empty where a model states it.
std::string reference_sentence(const Diagnosis& diagnosis) {
    if (!diagnosis.reference) { return {}; }
    const ReferenceQuality& reference = *diagnosis.reference;
    std::vector<std::string> errors;
    for (const std::size_t axis : diagnosis.axes) {
        const Span& error_rad_s = reference.error_rad_s.at(axis);
        if (!(error_rad_s.to > 0.0)) { continue; }
        const std::string least =
            reference.is_known_at_rest ? "" : fmt::format("{:.2g} to ", error_rad_s.from * deg_per_rad);
        errors.push_back(
            fmt::format("{}{:.2g} deg/s on {}", least, error_rad_s.to * deg_per_rad, axis_names.at(axis)));
    }
    const std::string row = reference.samples_per_row == 1
                                ? "a sample"
                                : fmt::format("a mean of {} samples", reference.samples_per_row);
    return gyros_sentence(reference.gyros) +
           fmt::format(
               "The {} off by {} (one sigma of {}{}), and follow the sensor up to {:.2g} Hz. The sensor is "
               "{} ms {} "
               "them: which of the two is late nobody can tell.{}",
               reference.is_orientation ? "rates of the orientation are" : "reference rates are",
               listed(errors), row, reference.is_known_at_rest ? ", where the sensor rests" : "",
               reference.bandwidth_hz,
               with_uncertainty(1e3 * std::fabs(reference.latency_s), 1e3 * reference.latency_sd_s),
               reference.latency_s < 0.0 ? "ahead of" : "behind",
               reference.is_known_at_rest ? "" : " What is noise of the sensor shows at rest only.");
}

std::string heading_text(const Diagnosis& diagnosis) {
    std::string text = fmt::format(
        "{}{} against {} simulations of {} (seed {}): {} at {:.6g} Hz, {}", diagnosis.recording_name,
        diagnosis.unit.sensor == SensorKind::gyro ? "" : ", the accelerometer,", diagnosis.simulations,
        diagnosis.model_name, diagnosis.seed, counted(diagnosis.samples, "sample"), diagnosis.rate_hz,
        duration_text(diagnosis.duration_s));
    if (!diagnosis.passes.empty()) { text += "; " + passes_text(diagnosis); }
    return text;
}

std::string sentences_text(const char* title, const std::vector<std::string>& sentences) {
    std::string text = sentences.empty() ? "" : fmt::format("\n{}\n", title);
    for (const std::string& sentence : sentences) { text += wrapped_text("  - ", sentence); }
    return text;
}

// What makes most of what the causes do not; nothing where that has no place.
std::string unnamed_sentence(const Diagnosis& diagnosis) {
    if (diagnosis.unnamed.empty()) { return {}; }
    const Unnamed& most = *std::ranges::max_element(diagnosis.unnamed, {}, &Unnamed::share);
    return wrapped_text(
        "", fmt::format("{} on {} that no known effect has makes {} of the gap", words_of_form(most),
                        axes_text(most.where.axes), percent_text(most.share)));
}

// `causes`: their names.
std::string verdict_on(const std::string& causes, const Diagnosis& diagnosis, std::string_view of) {
    const bool one = diagnosis.causes.size() == 1;
    const char* explain = one ? "explains" : "explain";
    switch (diagnosis.verdict) {
        case Verdict::none:
            return fmt::format("no gap: the {} could have come from the model", of);
        case Verdict::known:
            return fmt::format("known: {} {} the gap", causes, explain);
        case Verdict::partly:
            return fmt::format("partly: {} {} {} of the gap", causes, explain,
                               percent_text(diagnosis.shrink.value));
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
    return fmt::format("unexplained: there is a gap, and {} {} too little of it", causes, explain);
}

// "31.4 Hz, 0.00933 deg/s"; empty where axes differ in it, which the table shows.
std::string size_text(const Cause& cause) {
    const std::vector<CauseSize> sizes = cause_sizes(without_uncertainty(cause));
    return sizes.size() == 1 ? fmt::format("{}", fmt::join(sizes.front().values, ", ")) : "";
}

std::string cause_with_size(const Cause& cause) {
    const std::string size = size_text(cause);
    return cause_name(cause) + (size.empty() ? "" : " (" + size + ")");
}

// What is seen of the terms that `analyze` may give as a limit only.
std::string limit_sentence(const Diagnosis& diagnosis) {
    struct SlowNoise {
        std::string_view effect;
        char term;
    };
    for (const SlowNoise& slow : {SlowNoise{"flicker_missing", 'B'}, SlowNoise{"rrw_missing", 'K'}}) {
        const bool is_cause = std::ranges::any_of(
            diagnosis.causes, [&](const Cause& cause) { return cause.finding.effect == slow.effect; });
        if (!is_cause) { continue; }
        return fmt::format(
            "{0}: where `analyze` gives {1} as an upper limit (\"<\") only, the model that it "
            "writes has {1} = 0. This says that 0 is too little; a size below that limit "
            "contradicts nothing.",
            slow.effect, slow.term);
    }
    return {};
}

// What one can do with the answer as it is, before another recording.
std::string next_step(const Diagnosis& diagnosis, std::string_view of) {
    const bool is_simulated = diagnosis.simulations > 0;
    if (diagnosis.verdict == Verdict::none) {
        return fmt::format(
            "use the model: it makes such {}s. One that is longer, or taken under other "
            "conditions, tests it harder.",
            of);
    }
    if (diagnosis.causes.empty()) {
        return is_simulated
                   ? "`--model-out FILE --unnamed` writes the model with what was found without a name."
                   : "diagnose the recording itself, which tells more than its curve.";
    }
    const bool has_rest = diagnosis.verdict != Verdict::known && is_simulated;
    return fmt::format("`--model-out FILE` writes the model with {} in it, which `gyrolog simulate` takes{}.",
                       diagnosis.causes.size() == 1 ? "the cause" : "the causes",
                       has_rest ? "; `--unnamed` adds what has no name" : "");
}

std::string amount_text(const Asked::Answer& answer) {
    return answer.amount ? fmt::format("{} times what is described, ",
                                       with_uncertainty(answer.amount->value, answer.amount->sd))
                         : "";
}

std::string asked_sentence(const Diagnosis& diagnosis, const Asked& asked) {
    const std::vector<std::string>& axes = asked.described.entry.axes;
    const Asked::Answer& beside = asked.beside;
    const Asked::Answer& alone = asked.alone;
    std::string text =
        fmt::format("{}{}: the data {} for it ({}{})", printable(asked.described.name),
                    axes.empty() ? "" : " on " + listed(axes), beside.is_called_for ? "call" : "do not call",
                    amount_text(beside), probability_text(beside.p));
    if (diagnosis.causes.empty()) { return text; }
    return text + fmt::format("; without the causes that were found they {} ({}{})",
                              alone.is_called_for ? "would" : "would not", amount_text(alone),
                              probability_text(alone.p));
}

std::vector<std::string> asked_sentences(const Diagnosis& diagnosis) {
    std::vector<std::string> sentences;
    for (const Asked& one : diagnosis.asked) { sentences.push_back(asked_sentence(diagnosis, one)); }
    return sentences;
}

}  // namespace

std::string passes_text(const Diagnosis& diagnosis) {
    std::vector<std::string> passes;
    for (const Pass& pass : diagnosis.passes) {
        passes.push_back(pass.is_at_rest
                             ? fmt::format("at {} of rest sample by sample", duration_text(pass.duration_s))
                         : pass.samples_per_row == 1
                             ? fmt::format("at the first {} sample by sample", duration_text(pass.duration_s))
                             : fmt::format("at all of it in means of {} samples", pass.samples_per_row));
    }
    return "looked " + listed(passes);
}

std::string verdict_sentence(const Diagnosis& diagnosis, std::string_view of) {
    return verdict_on(causes_text(diagnosis), diagnosis, of);
}

std::string short_verdict_sentence(const Diagnosis& diagnosis, std::string_view of) {
    const std::size_t causes = diagnosis.causes.size();
    return verdict_on(
        causes == 1 ? diagnosis.causes.front().finding.effect : fmt::format("{} causes", causes), diagnosis,
        of);
}

std::string verdict_line(const Diagnosis& diagnosis, std::string_view of) {
    std::vector<std::string> causes;
    for (const Cause& cause : diagnosis.causes) { causes.push_back(cause_with_size(cause)); }
    std::string line = verdict_on(listed(causes), diagnosis, of);
    return width_of(line) <= terminal_width ? line : verdict_sentence(diagnosis, of);
}

std::vector<std::string> next_sentences(const Diagnosis& diagnosis, std::string_view of) {
    std::vector<std::string> sentences{next_step(diagnosis, of)};
    sentences.insert(sentences.end(), diagnosis.next_recordings.begin(), diagnosis.next_recordings.end());
    return sentences;
}

DiagnosisSentences diagnosis_sentences(const Diagnosis& diagnosis) {
    DiagnosisSentences sentences;
    sentences.heading = heading_text(diagnosis);
    sentences.gap = gap_sentence(diagnosis);
    if (diagnosis.verdict == Verdict::none) { return sentences; }
    sentences.explained = explained_sentence(diagnosis);
    for (const Cause& cause : diagnosis.causes) { sentences.causes.push_back(sentences_of(cause)); }
    sentences.left = left_sentence(diagnosis);
    sentences.left_items = left_items(diagnosis);
    return sentences;
}

std::string diagnosis_text(const Diagnosis& gyro, const Diagnosis& accelerometer,
                           const std::vector<std::string>& shared, Wording wording) {
    std::string text = "gyro\n\n" + diagnosis_text(gyro, wording) + "\naccelerometer\n\n" +
                       diagnosis_text(accelerometer, wording);
    if (shared.empty()) { return text; }
    return text + "\n" +
           wrapped_text("",
                        fmt::format("Both sensors have {} at the same place: what they share makes {}, the "
                                    "board, its clock, or what it stands on.",
                                    listed(shared), shared.size() == 1 ? "it" : "them"));
}

std::string diagnosis_text(const Diagnosis& diagnosis, Wording wording) {
    const DiagnosisSentences sentences = diagnosis_sentences(diagnosis);
    std::string text = wrapped_text("", verdict_line(diagnosis)) + unnamed_sentence(diagnosis);
    if (const std::string reference = reference_sentence(diagnosis); !reference.empty()) {
        text += "\n" + wrapped_text("", "reference: " + reference);
    }
    text += "\n" + wrapped_text("", "gap: " + sentences.gap);
    if (diagnosis.verdict != Verdict::none) {
        text += explained_section(sentences);
        text += "\n" + wrapped_text("", "left: " + sentences.left);
        for (const std::string& item : sentences.left_items) { text += wrapped_text("  - ", item); }
    }
    text += sentences_text("what to do next", next_sentences(diagnosis));
    text += sentences_text("what was asked", asked_sentences(diagnosis));
    text += words_section(sentences);
    if (const std::string limit = limit_sentence(diagnosis); !limit.empty()) {
        text += wrapped_text("  ", limit);
    }
    text += "\n" + wrapped_text("", "compared: " + sentences.heading);
    if (wording == Wording::whole) { text += diagnosis_details(diagnosis); }
    text += sentences_text("warnings", diagnosis.warnings);
    return text;
}

}  // namespace gyrolog
