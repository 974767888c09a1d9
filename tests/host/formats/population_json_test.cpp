#include "host/formats/population_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/formats/model_json.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;

json population() {
    return json::parse(
        R"({"schema": "gyrolog-population/1", "units": 200, "rate_hz": {"median": 100, "sd": 0.1},
        "axes": {"x": {"bias": {"median": 0.5, "sd": 0.25, "count": 200}, "N": {"median": 0.01, "sd": 0}}}})");
}

std::string refusal_of(const json& text) {
    const auto file = parse_model_file(text.dump(), "p.json", 1);
    return file.ok() ? "accepted" : file.error().message;
}

TEST(PopulationJson, IsReadInDegrees) {
    const auto file = parse_model_file(population().dump(), "p.json", 7);
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_TRUE(file->is_drawn);
    EXPECT_DOUBLE_EQ(file->model.axes[0].noise.N_rad_per_sqrt_s, 0.01 * rad_per_deg);
    EXPECT_DOUBLE_EQ(file->model.sd_abs.at("bias_dps"), 0.25);
    EXPECT_EQ(file->model.rate_hz, 100.0);
    EXPECT_THAT(file->notes, Contains("a unit drawn from the population by seed 7"));
    EXPECT_THAT(file->notes, Contains(HasSubstr("bias of y")));
    EXPECT_FALSE(file->unstated.rate);
    EXPECT_TRUE(file->unstated.step);
}

TEST(PopulationJson, WithoutARateARecordingTellsIt) {
    json without = population();
    without.erase("rate_hz");
    EXPECT_EQ(refusal_of(without), "accepted");
    EXPECT_TRUE(parse_model_file(without.dump(), "p.json", 1)->unstated.rate);
    EXPECT_EQ(parse_model(without.dump(), "p.json").error().message, "model 'p.json': rate_hz is missing");
}

TEST(PopulationJson, WhatIsWrongIsNamed) {
    json wrong = population();
    wrong["axes"]["x"]["bias"].erase("sd");
    EXPECT_EQ(refusal_of(wrong), "model 'p.json': axes.x.bias.sd is missing");
    wrong = population();
    wrong["axes"]["x"]["N"]["median"] = -1;
    EXPECT_EQ(refusal_of(wrong), "model 'p.json': axes.x.N.median is negative");
    wrong = population();
    wrong["axes"]["x"]["n"] = 1;
    EXPECT_EQ(refusal_of(wrong), "model 'p.json': axes.x.n is no key of this schema");
    wrong = population();
    wrong["axes"] = json::object();
    EXPECT_EQ(refusal_of(wrong), "model 'p.json': axes.x is missing, as are y and z: one of them is needed");
    wrong = population();
    wrong["axes"]["x"]["N"] = {{"median", 1e-300}, {"sd", 1e300}};
    EXPECT_THAT(refusal_of(wrong), HasSubstr("model 'p.json': "));
}

TEST(PopulationJson, WhatIsWrittenIsRead) {
    MeasuredPopulation measured;
    measured.units = 5;
    measured.parameters = {{"", "rate_hz", {5, 100.0, 0.1, 0.1, 0.05, 0.3}},
                           {"z", "N", {5, 0.01, 0.002, 0.001, 0.0005, 0.004}}};
    const std::string text = format_population(measured);
    const auto file = parse_model_file(text, "p.json", 1);
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_NEAR(file->model.axes[2].sd_rel.at("N"), 0.1, 1e-12);
    const json written = json::parse(text);
    EXPECT_EQ(written["axes"]["z"]["N"]["observed_sd"], 0.002);
    EXPECT_EQ(written["axes"]["z"]["N"]["sd_hi"], 0.004);
    EXPECT_EQ(written["rate_hz"]["count"], 5);
}

}  // namespace
}  // namespace gyrolog
