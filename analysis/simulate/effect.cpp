#include "analysis/simulate/effect.hpp"

#include <algorithm>

#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

const EffectParam* find_param(const EffectDefinition& definition, std::string_view name) {
    const auto found = std::ranges::find(definition.params, name, &EffectParam::name);
    return found == definition.params.end() ? nullptr : &*found;
}

std::string quoted(std::string_view text) { return std::string(1, '\'').append(text).append("'"); }

std::optional<std::string> range_refusal(const EffectParam& param, double value) {
    if (param.range == EffectParam::Range::positive && value <= 0.0) { return "is not above zero"; }
    if (param.range == EffectParam::Range::not_negative && value < 0.0) { return "is negative"; }
    return std::nullopt;
}

}  // namespace

double EffectUse::operator[](std::string_view param) const {
    const auto given = effect_->params.find(std::string(param));
    return given != effect_->params.end() ? given->second : *find_param(*definition_, param)->otherwise;
}

bool EffectUse::acts_on(std::size_t axis) const {
    return effect_->axes.empty() || std::ranges::count(effect_->axes, axis_names[axis]) != 0;
}

RandomStream EffectUse::stream(std::size_t axis, unsigned part) const {
    return context_->stream({'e', static_cast<char>(place_)}, axis, part);
}

std::optional<std::string> effect_refusal(const EffectModel& effect) {
    const EffectDefinition* definition = find_effect(effect.effect);
    const std::string name = "effect " + quoted(effect.effect);
    if (definition == nullptr) { return name + " cannot be simulated by this version"; }
    for (const EffectParam& param : definition->params) {
        const auto given = effect.params.find(std::string(param.name));
        if (given == effect.params.end()) {
            if (!param.otherwise) { return name + " lacks its parameter " + quoted(param.name); }
        } else if (const auto refusal = range_refusal(param, given->second)) {
            return name + ": " + std::string(param.name) + " " + *refusal;
        }
    }
    for (const auto& given : effect.params) {
        if (find_param(*definition, given.first) == nullptr) {
            return name + " has no parameter " + quoted(given.first);
        }
    }
    for (const std::string& axis : effect.axes) {
        if (std::ranges::find(axis_names, axis) == axis_names.end()) {
            return name + " names an axis " + quoted(axis) + " that is not x, y or z";
        }
    }
    return std::nullopt;
}

}  // namespace gyrolog
