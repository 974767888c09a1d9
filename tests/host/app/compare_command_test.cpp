#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/recording_simulator.hpp"
#include "host/app/command_line.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/wrapped_text.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class CompareCommand : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(write_model(typical_mpu9250(), model).ok());
        ASSERT_TRUE(write_recording_csv(simulated(3000, 1), recording).ok());
    }

    static Recording simulated(std::uint64_t samples, std::uint64_t seed) {
        SimulationRequest request;
        request.samples = samples;
        request.seed = seed;
        return simulate_recording(typical_mpu9250(), request);
    }

    ExitCode compare(std::vector<std::string> arguments) {
        out.str("");
        err.str("");
        arguments.insert(arguments.begin(), "compare");
        return run_command_line(std::move(arguments), {out, err});
    }

    TemporaryFolder folder;
    std::string model = folder.path("model.json");
    std::string recording = folder.path("night.csv");
    std::ostringstream out;
    std::ostringstream err;
};

TEST_F(CompareCommand, WithAModelWritesTextJsonAndFigure) {
    EXPECT_EQ(compare({recording, model, "--simulations", "12", "--plot", folder.path("c.png"), "--json",
                       folder.path("c.json")}),
              ExitCode::ok)
        << err.str();
    EXPECT_THAT(out.str(), HasSubstr("night.csv, 30 s, against 12 simulations of model.json"));
    EXPECT_EQ(read_whole_file(folder.path("c.png")).substr(1, 3), "PNG");
    const json answer = json::parse(read_whole_file(folder.path("c.json")));
    EXPECT_EQ(answer["schema"], "gyrolog-compare/1");
    EXPECT_EQ(answer["samples"], 3000);
    EXPECT_EQ(answer["axes"].size(), 3U);
    EXPECT_EQ(err.str(), "written: " + folder.path("c.json") + "\nwritten: " + folder.path("c.png") + "\n");
}

// A table whose reference is known 8 s of 10; what it turns meanwhile is nobody's gap.
TEST_F(CompareCommand, WithAModelLeavesOutWhatTheReferenceDoesNotKnow) {
    Recording turning = simulated(6000, 3);
    std::vector<double> reference_rad_s(turning.rows(), 0.0);
    for (std::size_t row = 0; row < turning.rows(); ++row) {
        if (row % 1000 < 800) { continue; }
        reference_rad_s[row] = std::nan("");
        auto& counts = std::get<std::vector<std::int16_t>>(turning.columns[0].data);
        counts[row] = static_cast<std::int16_t>(counts[row] + 5000);
    }
    turning.columns.push_back({"ref_x", "rad/s", std::move(reference_rad_s)});
    ASSERT_TRUE(write_recording_csv(turning, recording).ok());
    ASSERT_EQ(compare({recording, model, "--simulations", "12", "--json", "-"}), ExitCode::ok) << err.str();
    const json answer = json::parse(out.str());
    // 0.1 s may be one row more of a rate that is estimated, on each of eleven sides.
    EXPECT_NEAR(answer["samples"].get<double>(), 800.0 - 10.0 + 5.0 * (800.0 - 20.0), 11.0);
    EXPECT_LT(answer["axes"]["x"]["standard_deviation"]["recording"].get<double>(), 1.0) << "dps";
    EXPECT_THAT(answer["warnings"].dump(), HasSubstr("is not known in 1200 of 6000 samples"));
}

TEST_F(CompareCommand, WithARecordingTakesNoModel) {
    ASSERT_TRUE(write_recording_csv(simulated(2000, 2), folder.path("day.csv")).ok());
    EXPECT_EQ(compare({recording, folder.path("day.csv"), "--json", "-"}), ExitCode::ok) << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["with"], "recording");
    EXPECT_EQ(answer["other"], "day.csv");
    EXPECT_TRUE(answer["axes"]["x"]["allan"].contains("recording_lo"));
}

TEST_F(CompareCommand, ComparesAsMuchAsTheDurationSays) {
    EXPECT_EQ(compare({recording, model, "--simulations", "9", "--duration", "10s", "--json", "-"}),
              ExitCode::ok)
        << err.str();
    EXPECT_EQ(json::parse(out.str())["samples"], 1000);
    EXPECT_EQ(compare({recording, model, "--duration", "soon"}), ExitCode::usage);
    EXPECT_EQ(compare({recording, model, "--duration", "0.1s"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("10 samples; 64 are needed"));
}

TEST_F(CompareCommand, SaysWhichFileCannotBeUsedAndWhy) {
    EXPECT_EQ(compare({folder.path("none.csv"), model}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("none.csv"));
    EXPECT_EQ(compare({recording, folder.path("none.json")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("none.json"));

    std::ofstream(folder.path("broken.json")) << R"({"schema": "gyrolog-model/1")";
    EXPECT_EQ(compare({recording, folder.path("broken.json")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("broken.json"));

    json unknown = json::parse(read_whole_file(model));
    unknown["effects"] = {{{"effect", "gremlins"}, {"axes", {"x"}}, {"params", json::object()}}};
    std::ofstream(folder.path("unknown.json")) << unknown;
    EXPECT_EQ(compare({recording, folder.path("unknown.json")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("gremlins"));

    std::ofstream(folder.path("no_rates.csv")) << "t_s,temp_C\n0,20\n0.01,20\n0.02,21\n";
    EXPECT_EQ(compare({folder.path("no_rates.csv"), model}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("no_rates.csv"));
    EXPECT_EQ(out.str(), "");
}

TEST_F(CompareCommand, RefusesADataSheetForItIsNoSingleSensor) {
    const std::string sheet = folder.path("sheet.json");
    std::ofstream(sheet) << R"({"schema": "gyrolog-datasheet/1", "rate_hz": 100, "full_scale_dps": 500,
        "sensitivity_lsb_per_dps": 65.5, "noise_type": "one_sided", "noise_density_dps_per_sqrt_hz": 0.01})";
    EXPECT_EQ(compare({recording, sheet}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("a data sheet is no single sensor"));
    EXPECT_THAT(err.str(), HasSubstr("--model-out unit.json"));
    EXPECT_EQ(out.str(), "");
}

TEST_F(CompareCommand, TellsTheNotesOfTheModelFile) {
    const std::string parameters = folder.path("gyroparams.json");
    std::ofstream(parameters) << R"({"schema": "gyrolog-gyroparams/1", "SampleRate": 100,
        "NoiseDensity": 1.7e-4, "BiasInstability": 3.5e-5, "RandomWalk": 1.7e-6, "NoiseType": "single-sided",
        "BiasInstabilityCoefficients": {"Numerator": 1}})";
    const auto notes = read_model_file(parameters, 1)->notes;
    ASSERT_FALSE(notes.empty());
    EXPECT_EQ(compare({recording, parameters, "--simulations", "9"}), ExitCode::ok) << err.str();
    EXPECT_THAT(out.str(), HasSubstr(wrapped_text("model: ", notes[0])));
    EXPECT_EQ(compare({recording, parameters, "--simulations", "9", "--json", "-"}), ExitCode::ok);
    EXPECT_EQ(json::parse(out.str())["notes"], notes);
}

TEST_F(CompareCommand, WritesOverNothingItReadsAndNothingTwice) {
    const auto refusal = [&](const std::vector<std::string>& outputs) {
        std::vector<std::string> arguments{recording, model, "--simulations", "9"};
        arguments.insert(arguments.end(), outputs.begin(), outputs.end());
        EXPECT_EQ(compare(arguments), ExitCode::usage) << outputs[1];
        return err.str();
    };
    const std::string model_before = read_whole_file(model);
    const std::string recording_before = read_whole_file(recording);
    EXPECT_THAT(refusal({"--json", model}), HasSubstr("WITH and --json are the same file"));
    EXPECT_THAT(refusal({"--json", recording}), HasSubstr("RECORDING and --json are the same file"));
    std::filesystem::create_hard_link(recording, folder.path("linked.png"));
    EXPECT_THAT(refusal({"--plot", folder.path("linked.png")}), HasSubstr("RECORDING and --plot"));
    EXPECT_EQ(read_whole_file(model), model_before);
    EXPECT_EQ(read_whole_file(recording), recording_before);
    EXPECT_THAT(refusal({"--plot", folder.path("c.png"), "--json", folder.path("./c.png")}),
                HasSubstr("--json and --plot are the same file"));
    EXPECT_FALSE(std::filesystem::exists(folder.path("c.png")));
}

TEST_F(CompareCommand, RefusesTooFewSimulationsAndOtherPictures) {
    EXPECT_EQ(compare({recording, model, "--simulations", "8"}), ExitCode::usage);
    EXPECT_EQ(compare({recording, model, "--plot", "c.jpg"}), ExitCode::usage);
    EXPECT_EQ(compare({recording}), ExitCode::usage);
}

}  // namespace
}  // namespace gyrolog
