#include "host/fleet/fleet_line.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/formats/input_limits.hpp"
#include "tests/host/fleet/made_lines.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;

std::string refusal_of(const std::string& text) {
    const auto line = parse_fleet_line(text);
    return line.ok() ? "accepted" : line.error().message;
}

TEST(FleetLine, OfAnAnalysisHasItsNumbers) {
    const FleetLine line = parsed(analysis_of({}));
    EXPECT_EQ(line.error, "");
    EXPECT_EQ(line.command, "analyze");
    EXPECT_EQ(line.board, "S1");
    EXPECT_EQ(line.started, "2026-11-21T05:04:55Z");
    EXPECT_EQ(line.rate_hz, 100.0);
    EXPECT_EQ(line.duration_s, 60.0);
    EXPECT_EQ(line.samples, 5990U);
    EXPECT_EQ(line.missing, 10U);
    EXPECT_EQ(line.temperature_C, 31.5);
    EXPECT_EQ(line.exit, 0);
    ASSERT_EQ(line.axes.size(), 3U);
    EXPECT_EQ(line.axes[1].axis, "y");
    EXPECT_EQ(line.axes[1].unit, "dps");
    EXPECT_EQ(line.axes[1].bias.value, 0.1);
    EXPECT_EQ(line.axes[1].bias.sd, 0.001) << "the standard uncertainty, not the expanded one";
    EXPECT_EQ(line.axes[1].coefficients[1].value, 0.005);
    EXPECT_EQ(line.axes[1].coefficients[1].sd, 1e-5);
    EXPECT_FALSE(line.axes[1].coefficients[1].upper);
    EXPECT_FALSE(line.axes[1].coefficients[3].value);
    EXPECT_EQ(line.axes[1].coefficients[3].upper, 1e-4);
}

TEST(FleetLine, OfADiagnosisHasVerdictCausesAndGaps) {
    const FleetLine line = parsed(diagnosis_of("a.csv"));
    EXPECT_EQ(line.error, "");
    EXPECT_EQ(line.command, "diagnose");
    EXPECT_EQ(line.verdict, "partly");
    ASSERT_EQ(line.causes.size(), 2U);
    EXPECT_EQ(line.causes[1].effect, "rtn");
    EXPECT_EQ(line.causes[1].axes, (std::vector<std::string>{"x", "z"}));
    EXPECT_EQ(line.gap_before, 7.9);
    EXPECT_FALSE(line.gap_after) << "null is a number that is not finite";
    EXPECT_EQ(line.seed, 7U);
}

TEST(FleetLine, OfAnErrorKeepsIt) {
    const FleetLine line = parsed({{"file", "a.csv"}, {"exit", 1}, {"error", "not found"}});
    EXPECT_EQ(line.error, "not found");
    EXPECT_EQ(line.exit, 1);
    EXPECT_EQ(line.command, "");
}

TEST(FleetLine, WhatIsWrongIsNamed) {
    EXPECT_THAT(refusal_of(R"({"file": "a", "exit")"), HasSubstr("no JSON: column 21: "));
    EXPECT_EQ(refusal_of("[1]"), "no JSON object");
    EXPECT_EQ(refusal_of(R"({"file": "a"})"), "schema is missing, and so is error");
    EXPECT_EQ(refusal_of(R"({"error": "x"})"), "file is missing: --jsonl writes it into each line");
    EXPECT_THAT(refusal_of(R"({"file": "a", "schema": "gyrolog-model/1"})"), HasSubstr("not one of analyze"));
    EXPECT_EQ(refusal_of(R"({"file": 1, "error": "x"})"), "file is not text");
    nlohmann::json line = analysis_of({});
    line["axes"]["y"]["coefficients"]["N"]["value"] = "much";
    EXPECT_EQ(refusal_of(line.dump()), "axes.y.coefficients.N.value is not a finite number");
    line = analysis_of({});
    line["recording"]["samples"] = -1;
    EXPECT_EQ(refusal_of(line.dump()), "recording.samples is no whole number");
    line = diagnosis_of("a");
    line["causes"][1]["axes"] = "x";
    EXPECT_EQ(refusal_of(line.dump()), "causes[1].axes is not a list");
}

TEST(FleetLine, ReadingNamesTheFileAndTheLine) {
    const TemporaryFolder folder(TemporaryFolder::Documents::are_wrong_on_purpose);  // short, too
    const std::string path = folder.path("lines.jsonl");
    std::ofstream(path) << analysis_of({}).dump() << "\r\n\n" << diagnosis_of("a.csv").dump();
    auto lines = read_fleet_lines(path);
    ASSERT_TRUE(lines.ok()) << lines.error().message;
    EXPECT_EQ(lines->size(), 2U) << "the last one needs no line break";

    std::ofstream(path, std::ios::app) << "\n" << analysis_of({}).dump().substr(0, 100);
    lines = read_fleet_lines(path);
    ASSERT_FALSE(lines.ok());
    EXPECT_THAT(lines.error().message, HasSubstr("read '" + path + "': line 4: no JSON: column 10"));
    EXPECT_EQ(lines.error().code, ErrorCode::malformed);
}

TEST(FleetLine, ALineBeyondTheLimitIsRefused) {
    const TemporaryFolder folder;
    const std::string path = folder.path("lines.jsonl");
    std::ofstream(path) << std::string(input_limits.json_bytes_most + 1, ' ') << "\n";
    const auto lines = read_fleet_lines(path);
    ASSERT_FALSE(lines.ok());
    EXPECT_THAT(lines.error().message, HasSubstr("line 1: longer than 16777216 bytes"));
}

TEST(FleetLine, AnAnalysisOfAThousandAveragingTimesIsNoTrouble) {
    nlohmann::json line = analysis_of({});
    for (int m = 1; m <= 5000; ++m) {
        line["axes"]["x"]["allan"].push_back({{"m", m}, {"tau_s", m * 0.01}, {"value", 0.1}, {"lo", 0.1}});
    }
    EXPECT_EQ(refusal_of(line.dump()), "accepted");
}

}  // namespace
}  // namespace gyrolog
