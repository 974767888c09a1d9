// The diagnosis of recordings of others, where the shared data are there.
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
using testing::HasSubstr;

// The line of one run stands 0.7 Hz lower in the model of another. White noise and a filter that seem to
// take it off make the simulations three times as far from the recording as the model's are.
TEST(DiagnoseRealRecording, LeavesOutWhatWidensTheGap) {
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
    EXPECT_GE(answer["shrink"].get<double>(), 0.0);
    EXPECT_THAT(out.str(), HasSubstr("tone is left out"));
    const Result<SensorModel> given = read_model(model);
    const Result<SensorModel> written = read_model(corrected);
    ASSERT_TRUE(given.ok() && written.ok());
    EXPECT_EQ(written->effects.size() > given->effects.size(), !answer["causes"].empty());
}

}  // namespace
}  // namespace gyrolog
