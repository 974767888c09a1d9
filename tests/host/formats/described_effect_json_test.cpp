#include "host/formats/described_effect_json.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* heater =
    R"({"schema": "gyrolog-effect/1", "name": "heater", "effect": "time_table", "axes": ["z"],
        "table": {"t_s": [0, 60], "bias_dps": [0, 0.5]}})";

std::string with(std::string text, const std::string& old, const std::string& now) {
    return text.replace(text.find(old), old.size(), now);
}

TEST(DescribedEffect, IsAnEntryOfAModelWithAName) {
    const auto read = parse_described_effect(heater, "h.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->name, "heater");
    EXPECT_EQ(read->entry.effect, "time_table");
    EXPECT_THAT(read->entry.axes, ElementsAre("z"));
    EXPECT_THAT(read->entry.table.at("bias_dps"), ElementsAre(0.0, 0.5));
    const auto filter = parse_described_effect(
        R"({"schema": "gyrolog-effect/1", "effect": "biquad", "params": {"b0": 0.5, "b1": 0.5}})", "f.json");
    ASSERT_TRUE(filter.ok()) << filter.error().message;
    EXPECT_EQ(filter->name, "biquad");
    EXPECT_EQ(filter->entry.params.at("b1"), 0.5);
}

TEST(DescribedEffect, SaysWhatIsWrongAndWhere) {
    const auto problem = [](const std::string& text) {
        const auto read = parse_described_effect(text, "h.json");
        return read.ok() ? "none" : read.error().message;
    };
    EXPECT_THAT(problem(with(heater, "gyrolog-effect/1", "gyrolog-model/1")),
                HasSubstr("schema is 'gyrolog-model/1', not 'gyrolog-effect/1'"));
    EXPECT_THAT(problem(with(heater, "time_table", "wobble")),
                HasSubstr("effect 'h.json': effect 'wobble' cannot be simulated"));
    EXPECT_THAT(problem(with(heater, "0, 60", "60, 0")), HasSubstr("'t_s' does not increase"));
    EXPECT_THAT(problem(with(heater, "0.5", "\"a\"")), HasSubstr("table.bias_dps[]"));
    EXPECT_THAT(problem(with(heater, "\"table\"", "\"tabel\"")), HasSubstr("tabel"));
    EXPECT_THAT(problem(with(heater, "[\"z\"]", "[\"w\"]")), HasSubstr("'w'"));
    EXPECT_THAT(problem("{"), HasSubstr("h.json"));
}

}  // namespace
}  // namespace gyrolog
