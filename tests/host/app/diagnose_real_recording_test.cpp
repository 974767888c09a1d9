// The diagnosis of recordings of others, where the shared data are there.
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/app/command_line.hpp"
#include "host/formats/model_json.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::AnyOf;
using testing::UnorderedElementsAre;

// The line of one run stands 0.7 Hz lower in the model of another; nothing else differs by much. A change of
// variance beside white noise that is 1.4 times the model's, a filter and a colour that undo each other, make
// the simulations on an axis without a gap six times as far from the recording as the model's are.
TEST(DiagnoseRealRecording, NamesTheLineThatMovedAndNothingBeside) {
    if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    const TemporaryFolder folder;
    const std::string lsb_dps = "0.00763359";
    const std::string model = folder.path("model.json");
    const std::string corrected = folder.path("corrected.json");
    std::ostringstream out;
    std::ostringstream err;
    const auto run = [&](std::vector<std::string> arguments) {
        return run_command_line(std::move(arguments), {out, err});
    };
    ASSERT_EQ(run({"analyze", shared_data("mpu6050_uncuyo/static_7min.csv.xz"), "--lsb-dps", lsb_dps,
                   "--model", model}),
              ExitCode::ok)
        << err.str();
    ASSERT_EQ(
        run({"diagnose", shared_data("mpu6050_uncuyo/static_100s.csv.xz"), "--model", model, "--lsb-dps",
             lsb_dps, "--simulations", "60", "--json", folder.path("d.json"), "--model-out", corrected}),
        ExitCode::ok)
        << err.str();
    const json answer = json::parse(read_whole_file(folder.path("d.json")));
    EXPECT_LT(answer["p_none"].get<double>(), 0.01);
    const double before = answer["gap_before"]["value"];
    EXPECT_LE(answer["gap_named"]["value"].get<double>(), before);
    EXPECT_GE(answer["shrink"].get<double>(), 0.6);
    ASSERT_EQ(answer["causes"].size(), 2U) << out.str();
    std::vector<std::string> senses;
    for (const json& cause : answer["causes"]) {
        EXPECT_THAT(cause["effect"].get<std::string>(), AnyOf("tone", "narrowband"));
        EXPECT_EQ(cause["axes"], json({"y"}));
        senses.push_back(cause["sense"]);
    }
    EXPECT_THAT(senses, UnorderedElementsAre("recording_has", "model_has"));
    const Result<SensorModel> given = read_model(model);
    const Result<SensorModel> written = read_model(corrected);
    ASSERT_TRUE(given.ok() && written.ok());
    EXPECT_EQ(written->effects.size() > given->effects.size(), !answer["causes"].empty());
}

// A line at 116 Hz that wanders, beside others: each cause is fitted at its own place, not at what the
// strongest of them leaves.
TEST(DiagnoseRealRecording, NamesNoLineTwice) {
    if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    const TemporaryFolder folder;
    const std::string model = folder.path("model.json");
    const std::string bench = shared_data("px4_auav_bench/sample.csv.xz");
    std::ostringstream out;
    std::ostringstream err;
    const auto run = [&](std::vector<std::string> arguments) {
        return run_command_line(std::move(arguments), {out, err});
    };
    ASSERT_EQ(run({"analyze", bench, "--from", "12", "--to", "40", "--sensor", "gyro", "--model", model}),
              ExitCode::ok)
        << err.str();
    ASSERT_EQ(run({"diagnose", bench, "--from", "40", "--model", model, "--simulations", "60", "--json",
                   folder.path("d.json")}),
              ExitCode::ok)
        << err.str();
    const json answer = json::parse(read_whole_file(folder.path("d.json")));
    EXPECT_GT(answer["shrink"].get<double>(), 0.7);
    const double apart_hz = 10.0 / answer["duration_s"].get<double>();
    std::vector<std::pair<std::string, double>> lines;
    for (const json& cause : answer["causes"]) {
        const json& params = cause["params"];
        if (!params.contains("f_hz")) { continue; }
        const double f_hz = params["f_hz"];
        for (const auto& [effect, other_hz] : lines) {
            EXPECT_FALSE(effect == cause["effect"] && std::abs(other_hz - f_hz) < apart_hz)
                << effect << " at " << other_hz << " and at " << f_hz << " Hz";
        }
        lines.emplace_back(cause["effect"].get<std::string>(), f_hz);
    }
    EXPECT_GE(lines.size(), 1U);
}

}  // namespace
}  // namespace gyrolog
