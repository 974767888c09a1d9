#include "host/formats/effect_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/simulate/accelerometer_effect.hpp"
#include "analysis/simulate/chain.hpp"
#include "host/formats/uncertain_number.hpp"

namespace gyrolog {
namespace {

// One way to write a kind of quantity: `per` of the parameter's own units make one of these.
struct WrittenUnit {
    double from;  // for sizes from this on, in the parameter's unit
    double per;
    std::string_view name;
};

struct QuantityKind {
    std::string_view ending;
    std::string_view own_unit;           // the one that the ending names
    std::span<const WrittenUnit> units;  // by falling `from`; the last one takes all
};

constexpr double per_hour = 1.0 / 3600.0;

constexpr std::array times = {
    WrittenUnit{7200.0, 3600.0, " h"}, WrittenUnit{120.0, 60.0, " min"}, WrittenUnit{1.0, 1.0, " s"},
    WrittenUnit{1e-3, 1e-3, " ms"},    WrittenUnit{0.0, 1e-6, " µs"},
};
constexpr std::array frequencies = {
    WrittenUnit{1000.0, 1000.0, " kHz"},
    WrittenUnit{0.1, 1.0, " Hz"},
    WrittenUnit{0.0, 1e-3, " mHz"},
};
constexpr std::array rates = {
    WrittenUnit{1e-3, 1.0, " deg/s"},
    WrittenUnit{0.0, per_hour, " deg/h"},
};
constexpr std::array rates_per_C = {
    WrittenUnit{1e-3, 1.0, " deg/s per degC"},
    WrittenUnit{0.0, per_hour, " deg/h per degC"},
};
constexpr std::array rates_per_C2 = {
    WrittenUnit{1e-3, 1.0, " deg/s per degC^2"},
    WrittenUnit{0.0, per_hour, " deg/h per degC^2"},
};
constexpr std::array rates_per_C3 = {
    WrittenUnit{1e-3, 1.0, " deg/s per degC^3"},
    WrittenUnit{0.0, per_hour, " deg/h per degC^3"},
};
constexpr std::array rates_per_g = {
    WrittenUnit{1e-3, 1.0, " deg/s per g"},
    WrittenUnit{0.0, per_hour, " deg/h per g"},
};
constexpr std::array rates_per_g2 = {
    WrittenUnit{1e-3, 1.0, " deg/s per g^2"},
    WrittenUnit{0.0, per_hour, " deg/h per g^2"},
};
constexpr std::array ramps = {
    WrittenUnit{1e-3 * per_hour, per_hour, " deg/s per h"},
    WrittenUnit{0.0, per_hour* per_hour, " deg/h per h"},
};
constexpr std::array forces = {
    WrittenUnit{0.1, 1.0, " g"},
    WrittenUnit{1e-4, 1e-3, " mg"},
    WrittenUnit{0.0, 1e-6, " µg"},
};
constexpr std::array forces_per_C = {
    WrittenUnit{1e-4, 1e-3, " mg per degC"},
    WrittenUnit{0.0, 1e-6, " µg per degC"},
};
constexpr std::array forces_per_C2 = {WrittenUnit{0.0, 1e-6, " µg per degC^2"}};
constexpr std::array forces_per_C3 = {WrittenUnit{0.0, 1e-6, " µg per degC^3"}};
constexpr std::array force_ramps = {
    WrittenUnit{1e-4 * per_hour, 1e-3 * per_hour, " mg per h"},
    WrittenUnit{0.0, 1e-6 * per_hour, " µg per h"},
};
constexpr std::array speeds = {WrittenUnit{0.0, 1e-6, " µg s"}};
constexpr std::array velocity_walks = {WrittenUnit{0.0, 1e-6, " µg/sqrt(Hz)"}};
constexpr std::array force_walks = {WrittenUnit{0.0, 1e-6, " µg*sqrt(Hz)"}};
constexpr std::array angles = {WrittenUnit{0.0, 1.0, " deg"}};
constexpr std::array angle_walks = {WrittenUnit{0.0, 1.0, " deg/s/sqrt(Hz)"}};
constexpr std::array rate_walks = {WrittenUnit{0.0, 1.0, " deg/s*sqrt(Hz)"}};
constexpr std::array temperatures = {WrittenUnit{0.0, 1.0, " degC"}};
constexpr std::array shares_per_C = {WrittenUnit{0.0, 0.01, " % per degC"}};
constexpr std::array phases = {WrittenUnit{0.0, rad_per_deg, " deg"}};
constexpr std::array counts_per_hour = {WrittenUnit{0.0, 1.0, " per hour"}};
constexpr std::array relative = {
    WrittenUnit{1e-3, 0.01, " %"},
    WrittenUnit{0.0, 1e-6, " ppm"},
};
constexpr std::array shares = {WrittenUnit{0.0, 0.01, " %"}};
constexpr std::array plain = {WrittenUnit{0.0, 1.0, ""}};

// The first ending that fits: longer ones stand before those that they end in.
constexpr QuantityKind kinds[] = {
    {"_dps_per_sqrt_hz", "deg/s/sqrt(Hz)", angle_walks},
    {"_dps_sqrt_hz", "deg/s*sqrt(Hz)", rate_walks},
    {"_dps_per_C3", "deg/s per degC^3", rates_per_C3},
    {"_dps_per_C2", "deg/s per degC^2", rates_per_C2},
    {"_dps_per_C", "deg/s per degC", rates_per_C},
    {"_dps_per_g2", "deg/s per g^2", rates_per_g2},
    {"_dps_per_g", "deg/s per g", rates_per_g},
    {"_dps_per_s", "deg/s per s", ramps},
    {"_dps_s", "deg", angles},
    {"_dps", "deg/s", rates},
    {"_g_per_sqrt_hz", "g/sqrt(Hz)", velocity_walks},
    {"_g_sqrt_hz", "g*sqrt(Hz)", force_walks},
    {"_g_per_C3", "g per degC^3", forces_per_C3},
    {"_g_per_C2", "g per degC^2", forces_per_C2},
    {"_g_per_C", "g per degC", forces_per_C},
    {"_g_per_s", "g per s", force_ramps},
    {"_g_s", "g*s", speeds},
    {"_g", "g", forces},
    {"per_C", "per degC", shares_per_C},
    {"per_hour", "per hour", counts_per_hour},
    {"_rad", "rad", phases},
    {"_hz", "Hz", frequencies},
    {"_C", "degC", temperatures},
    {"_s", "s", times},
};

constexpr double relative_error_most = 0.05;

bool is_relative_error(const EffectParam& param) {
    const double most = std::max(std::abs(param.plausible_from), std::abs(param.plausible_to));
    return param.range == EffectParam::Range::any && most > 0.0 && most <= relative_error_most;
}

const QuantityKind* kind_of(std::string_view name) {
    const auto* kind =
        std::ranges::find_if(kinds, [&](const QuantityKind& one) { return name.ends_with(one.ending); });
    return kind == std::end(kinds) ? nullptr : kind;
}

std::span<const WrittenUnit> units_of(std::string_view name, const EffectParam* param) {
    if (const QuantityKind* kind = kind_of(name); kind != nullptr) { return kind->units; }
    if (param != nullptr && param->range == EffectParam::Range::share) { return shares; }
    if (param != nullptr && is_relative_error(*param)) { return relative; }
    return plain;
}

const EffectParam* find_param(const Finding& finding, std::string_view name) {
    const EffectDefinition* effect = find_effect(finding.effect);
    if (effect == nullptr) { return nullptr; }
    const auto found = std::ranges::find(effect->params, name, &EffectParam::name);
    return found == effect->params.end() ? nullptr : &*found;
}

struct ValueOfEntry {
    double value = 0.0;
    double sd = 0.0;
};

// The name under which an entry has the parameter: that of an accelerometer is in g.
std::string name_in(const EffectModel& entry, std::string_view name) {
    std::string own(name);
    std::string of_accelerometer = accelerometer_param_name(own);
    return entry.params.contains(of_accelerometer) ? of_accelerometer : own;
}

// No value where neither the entry nor the effect has one.
std::optional<ValueOfEntry> value_in(const Finding& finding, std::size_t entry, std::string_view name) {
    const auto& params = finding.entries[entry].params;
    const std::string own_name = name_in(finding.entries[entry], name);
    const auto given = params.find(own_name);
    if (given == params.end()) {
        const EffectParam* param = find_param(finding, name);
        if (param == nullptr || !param->otherwise) { return std::nullopt; }
        return ValueOfEntry{*param->otherwise, 0.0};
    }
    ValueOfEntry found{given->second, 0.0};
    if (entry < finding.sd.size()) {
        const auto sd = finding.sd[entry].find(own_name);
        if (sd != finding.sd[entry].end()) { found.sd = sd->second; }
    }
    return found;
}

std::string axes_of(const EffectModel& entry) { return fmt::format("{}", fmt::join(entry.axes, ", ")); }

// "6.8 ± 1.0 min", or "2.0 ± 0.1 deg/s (x), 1.3 ± 0.1 deg/s (y)".
std::string value_text(const Finding& finding, std::string_view name) {
    const EffectParam* param = find_param(finding, name);
    std::vector<std::string> texts;
    std::string by_axis;
    for (std::size_t entry = 0; entry < finding.entries.size(); ++entry) {
        const auto value = value_in(finding, entry, name);
        if (!value) { continue; }
        texts.push_back(quantity_text(name_in(finding.entries[entry], name), value->value, value->sd, param));
        by_axis += fmt::format("{}{} ({})", by_axis.empty() ? "" : ", ", texts.back(),
                               axes_of(finding.entries[entry]));
    }
    if (texts.empty()) { return std::string(name); }
    return std::ranges::adjacent_find(texts, std::ranges::not_equal_to()) == texts.end() ? texts.front()
                                                                                         : by_axis;
}

const EffectSignature* signature_of(std::string_view effect) {
    const EffectDefinition* found = find_effect(effect);
    return found == nullptr ? nullptr : found->signature;
}

// A cause of the model that no effect could add has a name of its own: "rrw_excess", "line_absent". The
// effects that such names are about, by what stands before the last '_'.
struct Stem {
    std::string_view stem;
    std::string_view effect;
};
constexpr std::array stems = {Stem{"arw", "arw_scale"}, Stem{"flicker", "flicker_missing"},
                              Stem{"line", "tone"}, Stem{"rrw", "rrw_missing"}};

bool speaks_of_forces(const Finding& finding) { return finding.sensor == SensorKind::accelerometer; }

std::string_view words_of(const EffectSignature* signature, const Finding& finding) {
    if (signature == nullptr) { return {}; }
    return speaks_of_forces(finding) && !signature->force_words.empty() ? signature->force_words
                                                                        : signature->words;
}

std::string_view noun_of(const EffectSignature* signature, const Finding& finding) {
    if (signature == nullptr) { return {}; }
    return speaks_of_forces(finding) && !signature->force_noun.empty() ? signature->force_noun
                                                                       : signature->noun;
}

// With places for values; the effect's name where nothing else is known.
std::string noun_of(const Finding& finding) {
    const std::string_view name = finding.effect;
    const std::string_view stem = name.substr(0, name.rfind('_'));
    const auto* other = std::ranges::find(stems, stem, &Stem::stem);
    std::vector<std::string_view> effects{name, other == stems.end() ? stem : other->effect};
    for (const EffectModel& entry : finding.entries) { effects.emplace_back(entry.effect); }
    for (const std::string_view effect : effects) {
        const std::string_view noun = noun_of(signature_of(effect), finding);
        if (!noun.empty()) { return std::string(noun); }
    }
    return fmt::format("`{}`", finding.entries.empty() ? finding.effect : finding.entries.front().effect);
}

std::vector<std::string> params_in(std::string_view words) {
    std::vector<std::string> names;
    for (std::size_t open = words.find('{'); open != std::string_view::npos;
         open = words.find('{', open + 1)) {
        names.emplace_back(words.substr(open + 1, words.find('}', open) - open - 1));
    }
    return names;
}

bool has_value(const Finding& finding, const std::string& name) {
    return std::ranges::any_of(finding.entries, [&](const EffectModel& entry) {
        return entry.params.contains(name_in(entry, name));
    });
}

// "a line at {f_hz}" is "a line".
std::string without_value(const std::string& noun) {
    const std::size_t value = noun.find(" {");
    return value == std::string::npos ? noun : noun.substr(0, noun.rfind(' ', value - 1));
}

}  // namespace

std::string quantity_text(std::string_view name, double value, double sd, const EffectParam* param) {
    const auto units = units_of(name, param);
    const auto unit = std::ranges::find_if(
        units, [&](const WrittenUnit& one) { return std::abs(value) >= one.from || &one == &units.back(); });
    if (!(sd > 0.0) || !std::isfinite(sd)) { return fmt::format("{:.3g}{}", value / unit->per, unit->name); }
    return with_uncertainty(value / unit->per, sd / unit->per) + std::string(unit->name);
}

std::string param_text(std::string_view name, double value, double sd) {
    const bool is_uncertain = sd > 0.0 && std::isfinite(sd);
    const std::string number = is_uncertain ? with_uncertainty(value, sd) : fmt::format("{:.6g}", value);
    const QuantityKind* kind = kind_of(name);
    return fmt::format("{} {}{}{}", name, number, kind == nullptr ? "" : " ",
                       kind == nullptr ? "" : kind->own_unit);
}

namespace {

// What stands in brackets is said where the finding has the values in it.
std::string without_brackets(std::string_view words, const Finding& finding) {
    std::string text;
    for (std::size_t at = 0; at < words.size();) {
        const std::size_t open = std::min(words.find('[', at), words.size());
        text += words.substr(at, open - at);
        const std::size_t close = words.find(']', open);
        if (close == std::string_view::npos) { return text.append(words.substr(open)); }
        const std::string_view part = words.substr(open + 1, close - open - 1);
        const std::vector<std::string> names = params_in(part);
        if (std::ranges::all_of(names, [&](const auto& name) { return has_value(finding, name); })) {
            text += part;
        }
        at = close + 1;
    }
    return text;
}

}  // namespace

std::string filled_words(std::string_view template_words, const Finding& finding) {
    const std::string words = without_brackets(template_words, finding);
    std::string text;
    for (std::size_t at = 0; at < words.size();) {
        const std::size_t open = std::min(words.find('{', at), words.size());
        text += words.substr(at, open - at);
        const std::size_t close = words.find('}', open);
        if (close == std::string::npos) { return text.append(words.substr(std::min(open, words.size()))); }
        text += value_text(finding, words.substr(open + 1, close - open - 1));
        at = close + 1;
    }
    return text;
}

std::string effect_words(const Finding& finding) {
    const std::string_view words = words_of(signature_of(finding.effect), finding);
    return words.empty() ? finding.effect : filled_words(words, finding);
}

std::string cause_words(const Cause& cause) {
    const Finding& finding = cause.finding;
    if (cause.sense == Sense::recording_has) { return effect_words(finding); }
    const std::string noun = noun_of(finding);
    if (noun.find("{factor}") == std::string::npos && has_value(finding, "factor")) {
        return fmt::format("The model has {}; the recording has {} times as much", without_value(noun),
                           value_text(finding, "factor"));
    }
    const bool is_known =
        std::ranges::all_of(params_in(noun), [&](const auto& name) { return has_value(finding, name); });
    return fmt::format("The model has {} that the recording lacks",
                       is_known ? filled_words(noun, finding) : without_value(noun));
}

namespace {

// In the order of the words; those that an entry has.
std::vector<std::string> named_params(const Finding& finding) {
    std::vector<std::string> names;
    for (const std::string& words : {std::string(words_of(signature_of(finding.effect), finding)),
                                     noun_of(finding), std::string("{factor}")}) {
        for (const std::string& name : params_in(words)) {
            if (has_value(finding, name) && std::ranges::count(names, name) == 0) { names.push_back(name); }
        }
    }
    return names;
}

bool has_unit(std::string_view name, const EffectParam* param) {
    return !units_of(name, param).front().name.empty();
}

std::vector<std::string> values_of(const Finding& finding, std::size_t entry) {
    std::vector<std::string> with_sd;
    std::vector<std::string> without_sd;
    for (const std::string& name : named_params(finding)) {
        const auto value = value_in(finding, entry, name);
        if (!value) { continue; }
        const EffectParam* param = find_param(finding, name);
        const std::string own_name = name_in(finding.entries[entry], name);
        const std::string text = (has_unit(own_name, param) ? "" : name + " ") +
                                 quantity_text(own_name, value->value, value->sd, param);
        (value->sd > 0.0 ? with_sd : without_sd).push_back(text);
    }
    return with_sd.empty() ? without_sd : with_sd;
}

}  // namespace

namespace {

bool is_fitted(const Finding& finding, const std::string& param) {
    const auto has_sd = [&](const auto& sd) { return sd.contains(param) && sd.at(param) > 0.0; };
    return std::ranges::none_of(finding.sd, [](const auto& sd) { return !sd.empty(); }) ||
           std::ranges::any_of(finding.sd, has_sd);
}

}  // namespace

std::vector<CauseSize> cause_sizes(const Cause& cause) {
    const Finding& finding = cause.finding;
    std::vector<CauseSize> sizes;
    for (std::size_t entry = 0; entry < finding.entries.size(); ++entry) {
        CauseSize size{axes_of(finding.entries[entry]), values_of(finding, entry)};
        const auto same = std::ranges::find(sizes, size.values, &CauseSize::values);
        if (same == sizes.end()) {
            sizes.push_back(std::move(size));
        } else if (!size.axes.empty()) {
            same->axes += (same->axes.empty() ? "" : ", ") + size.axes;
        }
    }
    if (sizes.empty()) { sizes.emplace_back(); }
    if (sizes.size() == 1) {
        std::vector<std::string> axes;
        for (const std::size_t axis : finding.where.axes) { axes.emplace_back(axis_names.at(axis)); }
        sizes.front().axes = fmt::format("{}", fmt::join(axes, ", "));
    }
    return sizes;
}

Cause without_uncertainty(Cause cause) {
    // What was fitted stays known as such: by its presence cause_sizes() chooses what it shows.
    for (auto& entry : cause.finding.entries) {
        std::erase_if(entry.params,
                      [&](const auto& param) { return !is_fitted(cause.finding, param.first); });
    }
    cause.finding.sd.clear();
    return cause;
}

std::string axes_text(const std::vector<std::size_t>& axes) {
    std::string text;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (i > 0) { text += i + 1 == axes.size() ? " and " : ", "; }
        text += axis_names.at(axes[i]);
    }
    return text;
}

}  // namespace gyrolog
