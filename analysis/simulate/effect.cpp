#include "analysis/simulate/effect.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

namespace {

const EffectParam* find_param(const EffectDefinition& definition, std::string_view name) {
    const auto found = std::ranges::find(definition.params, name, &EffectParam::name);
    return found == definition.params.end() ? nullptr : &*found;
}

std::string name_in_quotes(std::string_view text) { return std::string(1, '\'').append(text).append("'"); }

std::optional<std::string> range_refusal(const EffectParam& param, double value) {
    if (param.range == EffectParam::Range::positive && value <= 0.0) { return "is not above zero"; }
    if (param.range == EffectParam::Range::above_two && value <= 2.0) { return "is not above two"; }
    if (param.range == EffectParam::Range::not_negative && value < 0.0) { return "is negative"; }
    if (param.range == EffectParam::Range::share && (value < 0.0 || value > 1.0)) {
        return "is not between 0 and 1";
    }
    if (param.range == EffectParam::Range::yes_no && value != 0.0 && value != 1.0) { return "is not 0 or 1"; }
    if (param.most && std::fabs(value) > *param.most) {
        return "is beyond " + std::to_string(*param.most) + " in size";
    }
    if (param.whole_up_to != 0.0 &&
        (value < 1.0 || value > param.whole_up_to || value != std::floor(value))) {
        return "is not a whole number from 1 to " + std::to_string(static_cast<long long>(param.whole_up_to));
    }
    return std::nullopt;
}

std::optional<std::string> table_refusal(const EffectTable& table, const EffectModel& effect) {
    const auto at = effect.table.find(std::string(table.at));
    const auto value = effect.table.find(std::string(table.value));
    for (const auto& [column, name] : {std::pair(at, table.at), std::pair(value, table.value)}) {
        if (column == effect.table.end() || column->second.empty()) {
            return "lacks the column " + name_in_quotes(name) + " of its table";
        }
    }
    if (at->second.size() != value->second.size()) {
        return "has columns of " + std::to_string(at->second.size()) + " and " +
               std::to_string(value->second.size()) + " numbers in its table";
    }
    if (std::ranges::adjacent_find(at->second, std::ranges::greater_equal{}) != at->second.end()) {
        return "has a table whose " + name_in_quotes(table.at) + " does not increase";
    }
    if (table.positive && std::ranges::any_of(value->second, [](double v) { return v <= 0.0; })) {
        return "has a " + name_in_quotes(table.value) + " in its table that is not above zero";
    }
    return std::nullopt;
}

std::optional<std::string> refusal_of_columns(const EffectDefinition& definition, const EffectModel& effect) {
    for (const auto& [name, column] : effect.table) {
        if (!definition.table || (name != definition.table->at && name != definition.table->value)) {
            return "has no column " + name_in_quotes(name) + " in its table";
        }
    }
    return definition.table ? table_refusal(*definition.table, effect) : std::nullopt;
}

std::string names_of(std::span<const EffectParam> params) {
    std::string names;
    for (const EffectParam& param : params) { names.append(names.empty() ? "" : ", ").append(param.name); }
    return names;
}

// A misspelt name comes first: the one that was meant is then missing as well.
std::optional<std::string> refusal_of_params(const EffectDefinition& definition, const EffectModel& effect) {
    for (const auto& given : effect.params) {
        if (find_param(definition, given.first) != nullptr) { continue; }
        return " has no parameter " + name_in_quotes(given.first) +
               (definition.params.empty() ? "" : "; it has " + names_of(definition.params));
    }
    for (const EffectParam& param : definition.params) {
        const auto given = effect.params.find(std::string(param.name));
        if (given == effect.params.end()) {
            if (param.otherwise || param.from_model) { continue; }
            return " lacks its parameter " + name_in_quotes(param.name);
        }
        if (const auto refusal = range_refusal(param, given->second)) {
            return ": " + std::string(param.name) + " " + *refusal;
        }
    }
    return std::nullopt;
}

Course course_of(const EffectTable& table, const EffectModel& effect) {
    return {effect.table.at(std::string(table.at)), effect.table.at(std::string(table.value))};
}

}  // namespace

double EffectUse::operator[](std::string_view param) const {
    const auto given = effect_->params.find(std::string(param));
    return given != effect_->params.end() ? given->second : *find_param(*definition_, param)->otherwise;
}

double EffectUse::or_else(std::string_view param, double from_model) const {
    const auto given = effect_->params.find(std::string(param));
    return given != effect_->params.end() ? given->second : from_model;
}

Course EffectUse::course() const { return course_of(*definition_->table, *effect_); }

Course EffectValues::course() const { return course_of(*find_effect(effect_->effect)->table, *effect_); }

bool EffectUse::acts_on(std::size_t axis) const { return gyrolog::acts_on(*effect_, axis); }

double EffectValues::operator[](std::string_view param) const {
    const auto given = effect_->params.find(std::string(param));
    return given != effect_->params.end() ? given->second
                                          : *find_param(*find_effect(effect_->effect), param)->otherwise;
}

RandomStream EffectUse::stream(std::size_t axis, unsigned part) const {
    return context_->stream({'e', static_cast<char>(place_)}, axis, part);
}

std::optional<std::string> effect_refusal(const EffectModel& effect) {
    const EffectDefinition* definition = find_effect(effect.effect);
    const std::string name = "effect " + name_in_quotes(effect.effect);
    if (definition == nullptr) { return name + " cannot be simulated by this version"; }
    if (const auto refusal = refusal_of_params(*definition, effect)) { return name + *refusal; }
    if (const auto refusal = refusal_of_columns(*definition, effect)) { return name + " " + *refusal; }
    if (definition->refusal != nullptr) {
        if (const auto refusal = definition->refusal(effect)) { return name + " " + *refusal; }
    }
    for (const std::string& axis : effect.axes) {
        if (std::ranges::find(axis_names, axis) == axis_names.end()) {
            return name + " names an axis " + name_in_quotes(axis) + " that is not x, y or z";
        }
    }
    return std::nullopt;
}

}  // namespace gyrolog
