// The schemas themselves. What the program writes is held against them wherever a test has it written
// (tests/support/schema_check.hpp).
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "host/capture/capture_metadata.hpp"
#include "tests/support/program.hpp"
#include "tests/support/schema_check.hpp"

namespace gyrolog {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::filesystem::path source(const char* folder) {
    return std::filesystem::path(std::getenv("GYROLOG_SOURCE_DIR")) / folder;
}

std::vector<std::filesystem::path> schema_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(source("host/formats/schemas"))) {
        files.push_back(entry.path());
    }
    return files;
}

// The places of objects with keys of their own that let others pass.
void collect_lenient(const Json& schema, const std::string& at, bool is_condition,
                     std::vector<std::string>& lenient) {
    if (schema.is_object()) {
        if (!is_condition && schema.contains("properties") && schema.contains("type") &&
            schema.value("additionalProperties", Json(true)) != Json(false)) {
            lenient.push_back(at);
        }
        for (const auto& item : schema.items()) {
            const bool inside =
                is_condition || item.key() == "if" || item.key() == "then" || item.key() == "else";
            collect_lenient(item.value(), at + "/" + item.key(), inside, lenient);
        }
    }
    for (std::size_t i = 0; schema.is_array() && i < schema.size(); ++i) {
        collect_lenient(schema[i], at + "/" + std::to_string(i), is_condition, lenient);
    }
}

Json sheet() {
    return {{"schema", "gyrolog-datasheet/1"},
            {"rate_hz", 1000},
            {"full_scale_dps", 500},
            {"noise_type", "one_sided"},
            {"noise_density_dps_per_sqrt_hz", 0.01}};
}

TEST(Schemas, StandForEachDocumentThatTheSourcesName) {
    std::set<std::string> named;
    const std::regex pattern("gyrolog-[a-z-]+/[0-9]+");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source("host"))) {
        const std::string ending = entry.path().extension();
        if (ending != ".cpp" && ending != ".hpp") { continue; }
        const std::string text = read_whole_file(entry.path());
        for (std::sregex_iterator found(text.begin(), text.end(), pattern), end; found != end; ++found) {
            named.insert(found->str());
        }
    }
    ASSERT_GT(named.size(), 15U) << "this test tests nothing";
    std::set<std::string> described;
    for (const auto& path : schema_files()) {
        const Json schema = Json::parse(read_whole_file(path));
        if (!schema["properties"].contains("schema")) { continue; }  // lines without an answer
        described.insert(schema["properties"]["schema"]["const"].get<std::string>());
    }
    EXPECT_EQ(described, named);
}

TEST(Schemas, LetNoUnknownKeyPass) {
    for (const auto& path : schema_files()) {
        std::vector<std::string> lenient;
        collect_lenient(Json::parse(read_whole_file(path)), "", false, lenient);
        EXPECT_THAT(lenient, IsEmpty()) << path;
    }
}

TEST(Schemas, FindARenamedKeyAndAWrongType) {
    EXPECT_THAT(schema_problems(sheet()), IsEmpty());
    Json renamed = sheet();
    renamed["range_dps"] = renamed["full_scale_dps"];
    renamed.erase("full_scale_dps");
    EXPECT_THAT(schema_problems(renamed), ::testing::Contains(HasSubstr("range_dps")));
    Json text = sheet();
    text["rate_hz"] = "1000";
    EXPECT_FALSE(schema_problems(text).empty());
    Json nothing = sheet();
    nothing.erase("noise_density_dps_per_sqrt_hz");
    EXPECT_FALSE(schema_problems(nothing).empty()) << "no white noise is given";
    Json later = sheet();
    later["schema"] = "gyrolog-datasheet/2";
    EXPECT_THAT(schema_problems(later), ElementsAre(HasSubstr("no schema is shipped")));
}

TEST(Schemas, DescribeWhatACaptureHolds) {
    CaptureMetadata metadata;
    metadata.source.uri = "sim:rate=100";
    metadata.segment.emplace();
    EXPECT_THAT(schema_problems(Json::parse(metadata_json(metadata))), IsEmpty());
    EXPECT_THAT(schema_problems(Json::parse(checkpoint_json({}))), IsEmpty());
    EXPECT_THAT(schema_problems(Json::parse(mark_json({}))), IsEmpty());
}

}  // namespace
}  // namespace gyrolog
