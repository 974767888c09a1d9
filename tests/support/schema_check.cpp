#include "tests/support/schema_check.hpp"

#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace gyrolog {
namespace {

using Json = nlohmann::json;
using Adapter = valijson::adapters::NlohmannJsonAdapter;

constexpr std::string_view prefix = "gyrolog-";

// "gyrolog-model/1" is described by gyrolog-model-1.schema.json.
std::filesystem::path file_of(std::string name) {
    for (char& c : name) { c = c == '/' ? '-' : c; }
    return std::filesystem::path(GYROLOG_SCHEMA_FOLDER) / (name + ".schema.json");
}

// Read once; null: there is none.
const valijson::Schema* schema_of(const std::string& name) {
    static std::map<std::string, std::unique_ptr<valijson::Schema>> read;
    const auto [found, is_new] = read.try_emplace(name);
    std::ifstream file(file_of(name));
    if (is_new && file) {
        const Json text = Json::parse(file);
        found->second = std::make_unique<valijson::Schema>();
        valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(text), *found->second);
    }
    return found->second.get();
}

// Empty: no document of gyrolog's.
std::string schema_name_of(const Json& document) {
    if (!document.is_object()) { return {}; }
    if (const auto named = document.find("schema"); named != document.end() && named->is_string()) {
        const auto name = named->get<std::string>();
        return name.starts_with(prefix) ? name : std::string();
    }
    const bool is_line = document.contains("file") && document.contains("error");
    return is_line ? "gyrolog-unanswered-line" : "";
}

void expect_schema_kept(const Json& document, const std::string& name) {
    if (schema_name_of(document).empty()) { return; }
    for (const std::string& problem : schema_problems(document)) { ADD_FAILURE() << name << ": " << problem; }
}

std::string text_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

}  // namespace

std::vector<std::string> schema_problems(const Json& document) {
    const std::string name = schema_name_of(document);
    const valijson::Schema* schema = schema_of(name);
    if (schema == nullptr) { return {"no schema is shipped for '" + name + "'"}; }
    valijson::ValidationResults results;
    // Of 1 and 1.0 JSON makes no difference, but of "1" and 1 it does.
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    if (validator.validate(*schema, Adapter(document), &results)) { return {}; }
    std::vector<std::string> problems;
    for (const valijson::ValidationResults::Error& error : results) {
        std::string place;
        for (const std::string& step : error.context) { place += step; }
        problems.push_back(name + " at " + place + ": " + error.description);
    }
    return problems;
}

void expect_schemas_kept(std::string_view text, const std::string& name) {
    const Json whole = Json::parse(text, nullptr, false);
    if (!whole.is_discarded()) { return expect_schema_kept(whole, name); }
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('{')) { expect_schema_kept(Json::parse(line, nullptr, false), name); }
    }
}

void expect_schemas_kept_in(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string ending = entry.path().extension();
        if (!entry.is_regular_file() || (ending != ".json" && ending != ".jsonl")) { continue; }
        expect_schemas_kept(text_of(entry.path()), entry.path().filename());
    }
}

}  // namespace gyrolog
