#include "host/formats/effect_catalogue.hpp"

#include <fmt/format.h>

#include "analysis/simulate/chain.hpp"
#include "host/formats/json.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {

namespace {

std::string allowed(const EffectParam& param) {
    if (param.whole_up_to != 0.0) { return fmt::format("a whole number from 1 to {:g}", param.whole_up_to); }
    const std::string most = param.most ? fmt::format(", at most {:g}", *param.most) : "";
    switch (param.range) {
        case EffectParam::Range::positive:
            return "above 0" + most;
        case EffectParam::Range::not_negative:
            return "0 or above" + most;
        case EffectParam::Range::above_two:
            return "above 2";
        case EffectParam::Range::share:
            return "from 0 to 1";
        case EffectParam::Range::yes_no:
            return "0 or 1";
        case EffectParam::Range::any:
            break;
    }
    return param.most ? fmt::format("from {:g} to {:g}", -*param.most, *param.most) : "any number";
}

bool has_plausible(const EffectParam& param) {
    return param.plausible_from != param.plausible_to || param.plausible_from != 0.0;
}

std::string table_text(const EffectTable& table) {
    return wrapped_text("    table                    ",
                        fmt::format("{} over {}: {}{}", table.value, table.at, table.meaning,
                                    table.positive ? "; above 0" : ""));
}

Json table_json(const EffectTable& table) {
    return {{"at", table.at},
            {"value", table.value},
            {"meaning", table.meaning},
            {"allowed", table.positive ? "above 0" : "any number"}};
}

std::string param_text(const EffectParam& param) {
    std::string text = fmt::format("{}; {}", param.meaning, allowed(param));
    if (has_plausible(param)) {
        text += fmt::format(", plausible {:g} to {:g}", param.plausible_from, param.plausible_to);
    }
    if (param.otherwise) { text += fmt::format("; without it {:g}", *param.otherwise); }
    return wrapped_text(fmt::format("    {:<24} ", param.name), text);
}

Json param_json(const EffectParam& param) {
    Json json;
    json["name"] = param.name;
    json["meaning"] = param.meaning;
    json["allowed"] = allowed(param);
    if (has_plausible(param)) { json["plausible"] = {param.plausible_from, param.plausible_to}; }
    json["needed"] = !param.otherwise.has_value() && !param.from_model;
    if (param.otherwise) { json["otherwise"] = *param.otherwise; }
    return json;
}

}  // namespace

std::string effect_catalogue_text() {
    std::string text =
        "Effects that a model may list, in the order in which they act on a sample. An\n"
        "entry of the model; without axes it acts on all:\n"
        "  {\"effect\": NAME, \"axes\": [\"x\", \"y\", \"z\"], \"params\": {NAME: NUMBER}}\n"
        "One that follows a course has a table of its points, straight between them:\n"
        "  \"table\": {COLUMN: [NUMBER, ...], COLUMN: [NUMBER, ...]}.\n"
        "Plausible ranges are those of an MPU-9250.\n";
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr) { continue; }
        const EffectDefinition& effect = *link.effect;
        text += fmt::format("\n{}\n", effect.name) + wrapped_text("    ", effect.model);
        for (const EffectParam& param : effect.params) { text += param_text(param); }
        if (effect.table) { text += table_text(*effect.table); }
        if (!effect.source.empty()) { text += wrapped_text("    source: ", effect.source); }
    }
    return text;
}

Json effect_catalogue_json() {
    Json json;
    json["schema"] = "gyrolog-effects/1";
    json["effects"] = Json::array();
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr) { continue; }
        Json entry;
        entry["effect"] = link.effect->name;
        entry["model"] = link.effect->model;
        entry["source"] = link.effect->source;
        entry["params"] = Json::array();
        for (const EffectParam& param : link.effect->params) { entry["params"].push_back(param_json(param)); }
        if (link.effect->table) { entry["table"] = table_json(*link.effect->table); }
        json["effects"].push_back(std::move(entry));
    }
    return json;
}

}  // namespace gyrolog
