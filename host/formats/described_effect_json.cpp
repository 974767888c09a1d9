#include "host/formats/described_effect_json.hpp"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/simulate/effect.hpp"
#include "host/base/printable.hpp"
#include "host/formats/json.hpp"
#include "host/formats/json_keys.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {
namespace {

constexpr const char* schema_name = "gyrolog-effect/1";

DescribedEffect read_document(const Json& document, std::optional<std::string>& problem) {
    JsonKeys keys(document, "", problem);
    keys.find("schema");  // judged by the caller
    DescribedEffect described;
    EffectModel& entry = described.entry;
    entry.effect = keys.text("effect");
    const Json* name = keys.find("name");
    described.name = name == nullptr ? entry.effect : keys.text_in(*name, "name");
    if (const Json* axes = keys.find("axes")) {
        if (!axes->is_array()) { keys.fail("axes", "is not a list"); }
        for (const Json& axis : *axes) { entry.axes.push_back(keys.text_in(axis, "axes[]")); }
    }
    if (const Json* params = keys.find("params")) { entry.params = keys.uncertainties(*params, "params"); }
    if (const Json* table = keys.find("table")) { entry.table = keys.columns(*table, "table"); }
    keys.refuse_left_over();
    return described;
}

}  // namespace

Result<DescribedEffect> parse_described_effect(std::string_view text, const std::string& name) {
    GYROLOG_TRY(const JsonDocument document, parse_json_document(text, name));
    const auto schema = document.json["schema"].get<std::string>();
    if (schema != schema_name) {
        return Error{ErrorCode::unsupported, fmt::format("effect '{}': schema is '{}', not '{}'", name,
                                                         printable(schema), schema_name)};
    }
    std::optional<std::string> problem;
    DescribedEffect described = read_document(document.json, problem);
    if (!problem && !document.plain) { problem = "holds a number that is not finite"; }
    if (!problem) { problem = effect_refusal(described.entry); }
    if (problem) { return Error{ErrorCode::malformed, fmt::format("effect '{}': {}", name, *problem)}; }
    return described;
}

Result<DescribedEffect> read_described_effect(const std::string& path) {
    GYROLOG_TRY(const std::string text, read_model_text(path, "effect"));
    return parse_described_effect(text, path);
}

}  // namespace gyrolog
