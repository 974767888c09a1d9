// JSON that the program writes, held against the schemas that the package ships (host/formats/schemas).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace gyrolog {

// What of a document is against the schema that it names in "schema" (a line of --jsonl without one: against
// that of lines without an answer), each with its place. A document of a kind that has no schema has this
// problem.
std::vector<std::string> schema_problems(const nlohmann::json& document);

// Fails the test that runs for each problem of what the program wrote: a text that is one document or a line
// for each, and the .json and .jsonl files of a folder. What is no whole JSON, or no document of gyrolog's,
// is passed over.
void expect_schemas_kept(std::string_view text, const std::string& name);
void expect_schemas_kept_in(const std::filesystem::path& folder);

}  // namespace gyrolog
