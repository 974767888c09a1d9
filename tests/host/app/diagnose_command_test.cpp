#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/recording_simulator.hpp"
#include "host/app/command_line.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class DiagnoseCommand : public testing::Test {
protected:
    void SetUp() override { ASSERT_TRUE(write_model(typical_mpu9250(), model).ok()); }

    ExitCode diagnose(std::vector<std::string> arguments) {
        out.str("");
        err.str("");
        arguments.insert(arguments.begin(), "diagnose");
        return run_command_line(std::move(arguments), {out, err});
    }

    void write_recording_of(const SensorModel& sensor) const {
        SimulationRequest request;
        request.samples = 6000;
        ASSERT_TRUE(write_recording_csv(simulate_recording(sensor, request), recording).ok());
    }

    // Of a sensor whose white noise is `factor` times the model's.
    void write_noisy_recording(double factor) const {
        SensorModel sensor = typical_mpu9250();
        for (AxisModel& axis : sensor.axes) { axis.noise.N_rad_per_sqrt_s *= factor; }
        write_recording_of(sensor);
    }

    // The model's own curve of x but for N.
    void write_curve(double factor) const {
        NoiseModel noise{typical_mpu9250().axes[0].noise, {}, {}, {}};
        noise.coefficients.N_rad_per_sqrt_s *= factor;
        std::ofstream text(curve);
        text << "tau_s,x_dps\n";
        for (double tau_s = 0.01; tau_s < 5000.0; tau_s *= 1.4) {
            text << tau_s << ',' << std::sqrt(noise.allan_variance(tau_s)) * deg_per_rad << '\n';
        }
    }

    TemporaryFolder folder;
    std::string model = folder.path("model.json");
    std::string recording = folder.path("night.csv");
    std::string curve = folder.path("curve.csv");
    std::ostringstream out;
    std::ostringstream err;
};

TEST_F(DiagnoseCommand, FindsTheCauseAndWritesTextJsonFigureAndModel) {
    write_noisy_recording(1.5);
    const std::string corrected = folder.path("corrected.json");
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", folder.path("d.json"),
                        "--plot", folder.path("d.png"), "--model-out", corrected}),
              ExitCode::ok)
        << err.str();
    EXPECT_THAT(out.str(), StartsWith("known: arw_scale on x, y and z"));
    const json answer = json::parse(read_whole_file(folder.path("d.json")));
    EXPECT_EQ(answer["schema"], "gyrolog-diagnosis/2");
    EXPECT_EQ(answer["verdict"], "known");
    ASSERT_FALSE(answer["causes"].empty());
    EXPECT_EQ(answer["causes"][0]["effect"], "arw_scale");
    EXPECT_NEAR(answer["causes"][0]["params"]["factor"].get<double>(), 1.5, 0.1);
    EXPECT_EQ(answer["causes"][0]["sense"], "recording_has");
    EXPECT_GT(answer["causes"][0]["share"].get<double>(), 0.5);
    for (const char* key : {"unnamed", "left", "gap_named", "shrink_modelled", "not_held_out"}) {
        EXPECT_TRUE(answer.contains(key)) << key;
    }
    EXPECT_EQ(answer["model"], "model.json");
    EXPECT_EQ(answer["simulations"], 20);
    EXPECT_EQ(read_whole_file(folder.path("d.png")).substr(1, 3), "PNG");
    EXPECT_EQ(err.str(), "written: " + folder.path("d.json") + "\nwritten: " + folder.path("d.png") +
                             "\nwritten: " + corrected + "\n");
    std::ostringstream simulated;
    EXPECT_EQ(run_command_line({"simulate", corrected, "-o", folder.path("s.csv"), "--duration", "10s"},
                               {simulated, err}),
              ExitCode::ok)
        << err.str();
    EXPECT_EQ(read_model(corrected)->effects.size(), 1U);
}

TEST_F(DiagnoseCommand, WithoutAModelItIsHeldAgainstItsOwnWhiteNoiseAndBias) {
    SensorModel wandering = typical_mpu9250();
    for (AxisModel& axis : wandering.axes) {
        axis.noise = {};
        axis.noise.N_rad_per_sqrt_s = 0.005 * rad_per_deg;
        axis.bias_rad_s = 0.3 * rad_per_deg;
    }
    wandering.effects.push_back(
        {"tone", {"y"}, {{"f_hz", 17.0}, {"amplitude_dps", 0.05}, {"phase_rad", 0.0}}, ""});
    write_recording_of(wandering);
    const std::string corrected = folder.path("corrected.json");
    ASSERT_EQ(diagnose({recording, "--auto", "--simulations", "20", "--json", "-", "--model-out", corrected}),
              ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["model"], "white noise and bias");
    ASSERT_EQ(answer["causes"].size(), 1U) << answer["causes"];
    EXPECT_EQ(answer["causes"][0]["effect"], "tone");
    EXPECT_THAT(err.str(), HasSubstr("the model is white noise and a bias, taken from 0 s to 60 s"));
    EXPECT_THAT(err.str(), HasSubstr("read off the Allan deviation at 1 s"));
    const Result<SensorModel> written = read_model(corrected);
    ASSERT_TRUE(written.ok());
    EXPECT_NEAR(written->axes[0].noise.N_rad_per_sqrt_s * deg_per_rad, 0.005, 0.001);
    EXPECT_NEAR(written->axes[0].bias_rad_s * deg_per_rad, 0.3, 0.01);
    EXPECT_EQ(written->axes[0].noise.B_rad_per_s, 0.0);

    EXPECT_EQ(diagnose({recording, "--auto", "--model", model}), ExitCode::usage);
    EXPECT_EQ(diagnose({"--curve", curve, "--auto"}), ExitCode::usage);
    EXPECT_EQ(diagnose({recording}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("--auto"));

    wandering.effects = {{"tone", {}, {{"f_hz", 0.3}, {"amplitude_dps", 20.0}, {"phase_rad", 0.0}}, ""}};
    write_recording_of(wandering);
    EXPECT_EQ(diagnose({recording, "--auto"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("no part of four seconds in which nothing turns"));
}

TEST_F(DiagnoseCommand, AnswersWhatAPersonAsks) {
    SensorModel heated = typical_mpu9250();
    heated.effects.push_back(
        {"time_table", {"z"}, {}, "", {{"t_s", {0.0, 30.0, 60.0}}, {"bias_dps", {0.0, 0.1, 0.0}}}});
    write_recording_of(heated);
    const std::string heater = folder.path("heater.json");
    std::ofstream(heater) << R"({"schema": "gyrolog-effect/1", "name": "heater", "effect": "time_table",
        "axes": ["z"], "table": {"t_s": [0, 30, 60], "bias_dps": [0, 0.1, 0]}})";
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--ask", heater, "--json", "-"}),
              ExitCode::ok)
        << err.str();
    const json asked = json::parse(out.str())["asked"];
    ASSERT_EQ(asked.size(), 1U);
    EXPECT_EQ(asked[0]["name"], "heater");
    EXPECT_EQ(asked[0]["alone"]["called_for"], true);
    EXPECT_NEAR(asked[0]["alone"]["amount"].get<double>(), 1.0, 0.2);

    EXPECT_EQ(diagnose({recording, "--model", model, "--ask", model}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("not 'gyrolog-effect/1'"));
    EXPECT_EQ(diagnose({recording, "--model", model, "--ask", heater, "--average", "10"}), ExitCode::usage);
    EXPECT_EQ(diagnose({recording, "--model", model, "--ask", heater, "--json", heater}), ExitCode::usage);
}

TEST_F(DiagnoseCommand, RefusesAtOnceASensorThatWasTurnedWithoutAReference) {
    SensorModel swung = typical_mpu9250();
    write_recording_of(swung);
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", "-"}), ExitCode::ok);
    EXPECT_THAT(err.str(), Not(HasSubstr("turned")));
    swung.effects.push_back({"tone", {}, {{"f_hz", 0.7}, {"amplitude_dps", 20.0}}, ""});
    write_recording_of(swung);
    ASSERT_EQ(diagnose({recording, "--model", model, "--json", "-"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("the gyro was turned for 100 % of the time, and without a reference"));
    EXPECT_THAT(err.str(), HasSubstr("nowhere does it rest"));

    // It is turned from pose to pose after half a minute.
    SimulationRequest request;
    request.samples = 6000;
    Recording turned = simulate_recording(typical_mpu9250(), request);
    Column& x = turned.columns.front();
    std::vector<double> values = x.values();
    for (std::size_t row = 3000; row < values.size(); ++row) { values[row] += row % 600 < 200 ? 0.8 : 0.0; }
    x = {"gx", "rad/s", std::move(values)};
    ASSERT_TRUE(write_recording_csv(turned, recording).ok());
    for (const std::vector<std::string>& by :
         {std::vector<std::string>{"--auto"}, std::vector<std::string>{"--model", model}}) {
        std::vector<std::string> arguments{recording, "--json", "-"};
        arguments.insert(arguments.end(), by.begin(), by.end());
        EXPECT_EQ(diagnose(arguments), ExitCode::failed);
        EXPECT_THAT(err.str(), HasSubstr("the gyro was turned for "));
        EXPECT_THAT(err.str(),
                    HasSubstr("--still auto ...` judges its longest part at rest, 30 s from 0 s on"));
    }
    ASSERT_EQ(diagnose({recording, "--auto", "--still", "auto", "--simulations", "20", "--json", "-"}),
              ExitCode::ok)
        << err.str();
    EXPECT_THAT(err.str(), Not(HasSubstr("turned")));
    EXPECT_EQ(diagnose({recording, "--auto", "--from", "28", "--to", "50"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("samples; a diagnosis needs at least 2048"));
}

// Three gyros that swing about x, the second by 3 % too much; at rest first.
void write_array(const std::string& path) {
    constexpr std::size_t rows = 6000;
    Recording still;
    still.rate_hz = 100.0;
    still.segments = {{0, rows, 0}};
    for (const char* name : {"gx", "gy", "gz", "ref_x", "ref_y", "ref_z"}) {
        still.columns.push_back({name, "rad/s", std::vector<double>(rows, 0.0)});
    }
    std::vector<double> swing(rows, 0.0);
    for (std::size_t row = 2500; row < rows; ++row) {
        swing[row] = std::sin(0.03 * static_cast<double>(row - 2500));
    }
    still.columns[3].data = std::move(swing);
    const auto world = std::make_shared<const RecordedWorld>(std::make_shared<const Recording>(still));
    Recording array;
    for (std::size_t gyro = 1; gyro <= 3; ++gyro) {
        SensorModel sensor = typical_mpu9250();
        if (gyro == 2) { sensor.effects.push_back({"scale_factor", {"x"}, {{"eps", 0.03}}, ""}); }
        SimulationRequest request;
        request.like = world;
        request.seed = gyro;
        Recording one = simulate_recording(sensor, request);
        std::erase_if(one.columns, [](const Column& column) { return !column.name.starts_with('g'); });
        for (Column& column : one.columns) { column.name += std::to_string(gyro); }
        if (gyro == 1) {
            array = std::move(one);
            continue;
        }
        std::ranges::move(one.columns, std::back_inserter(array.columns));
    }
    ASSERT_TRUE(write_recording_csv(array, path).ok());
}

TEST_F(DiagnoseCommand, JudgesAGyroOfAnArrayAgainstTheOthers) {
    write_array(recording);
    ASSERT_EQ(diagnose({recording, "--model", model, "--gyro", "2", "--reference", "others", "--simulations",
                        "20", "--json", folder.path("d.json")}),
              ExitCode::ok)
        << err.str();
    EXPECT_THAT(out.str(), HasSubstr("the array's 2 other gyros"));
    const json answer = json::parse(read_whole_file(folder.path("d.json")));
    EXPECT_EQ(answer["reference"]["of"], "units");
    EXPECT_EQ(answer["reference"]["gyros"], 2);
    ASSERT_EQ(answer["causes"].size(), 1U) << answer["causes"];
    EXPECT_EQ(answer["causes"][0]["effect"], "scale_factor");
    EXPECT_NEAR(answer["causes"][0]["params"]["eps"].get<double>(), 0.03, 0.003);

    EXPECT_EQ(diagnose({recording, "--model", model}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("--gyro takes one of an array"));
    EXPECT_EQ(diagnose({recording, "--model", model, "--gyro", "2"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("the gyro was turned for "));
    EXPECT_EQ(diagnose({recording, "--model", model, "--gyro", "7", "--reference", "others"}),
              ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("has no gyro 7: its gyros are 1, 2, 3"));
    EXPECT_EQ(diagnose({recording, "--model", model, "--reference", "others"}), ExitCode::usage);
    EXPECT_EQ(diagnose({recording, "--model", model, "--gyro", "2", "--sensor", "all"}), ExitCode::usage);
    write_recording_of(typical_mpu9250());
    EXPECT_EQ(diagnose({recording, "--model", model, "--gyro", "1", "--reference", "others"}),
              ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("has no array of gyros"));
}

TEST_F(DiagnoseCommand, SaysThatALineOfTheModelIsNotInTheRecording) {
    SensorModel humming = typical_mpu9250();
    humming.effects.push_back({"tone", {}, {{"f_hz", 31.0}, {"amplitude_dps", 0.05}}, ""});
    ASSERT_TRUE(write_model(humming, model).ok());
    write_recording_of(humming);
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", "-"}), ExitCode::ok);
    EXPECT_THAT(err.str(), Not(HasSubstr("of its amplitude")));
    write_recording_of(typical_mpu9250());
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", "-"}), ExitCode::ok);
    EXPECT_THAT(err.str(), HasSubstr("the model's tone at 31 Hz has "));
}

double mean_of(const std::string& path, const char* column) {
    const Result<Recording> recording = read_recording_csv(path);
    if (!recording.ok()) {
        ADD_FAILURE() << recording.error().message;
        return 0.0;
    }
    const std::vector<double> values = recording.value().find(column)->values();
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST_F(DiagnoseCommand, WritesAModelThatHasTheRecordingsMean) {
    SensorModel drifting = typical_mpu9250();
    drifting.effects.push_back({"rate_ramp", {"x"}, {{"ramp_dps_per_s", 0.01}}, ""});
    write_recording_of(drifting);
    const std::string corrected = folder.path("corrected.json");
    const std::string simulated = folder.path("s.csv");
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", "-", "--model-out",
                        corrected}),
              ExitCode::ok);
    ASSERT_EQ(read_model(corrected)->effects.size(), 1U);
    ASSERT_EQ(run_command_line({"simulate", corrected, "-o", simulated, "--duration", "60s"}, {out, err}),
              ExitCode::ok)
        << err.str();
    // The ramp's own mean is 0.3 deg/s; of the noise's either has a few thousandths.
    EXPECT_NEAR(mean_of(simulated, "gx"), mean_of(recording, "gx"), 0.02 * rad_per_deg);
}

TEST_F(DiagnoseCommand, LooksAtMeans) {
    write_noisy_recording(1.5);
    const std::string corrected = folder.path("corrected.json");
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", "-", "--average", "2",
                        "--model-out", corrected}),
              ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["samples"], 3000);
    EXPECT_NEAR(answer["rate_hz"].get<double>(), 50.0, 1e-3);
    EXPECT_EQ(answer["causes"][0]["effect"], "arw_scale");
    EXPECT_NEAR(answer["causes"][0]["params"]["factor"].get<double>(), 1.5, 0.1);
    // What was found is for samples, not for means.
    EXPECT_EQ(read_model(corrected)->rate_hz, typical_mpu9250().rate_hz);
    EXPECT_EQ(read_model(corrected)->lsb_rad_s, typical_mpu9250().lsb_rad_s);
    EXPECT_NEAR(read_model(corrected)->axes[0].bias_rad_s, mean_of(recording, "gx"), 1e-6);
    EXPECT_EQ(diagnose({recording, "--model", model, "--average", "3"}), ExitCode::failed);
    EXPECT_THAT(err.str(),
                HasSubstr("in means of 3 samples it has 2000 samples; a diagnosis needs at least"));
}

TEST_F(DiagnoseCommand, MeasuresTheGapOnASecondRecording) {
    write_noisy_recording(1.5);
    const std::string second = folder.path("second.csv");
    SimulationRequest request;
    request.samples = 5000;
    request.seed = 2;
    ASSERT_TRUE(write_recording_csv(simulate_recording(typical_mpu9250(), request), second).ok());
    ASSERT_EQ(
        diagnose({recording, "--model", model, "--simulations", "20", "--json", "-", "--holdout", second}),
        ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["held_out"], "second.csv");
    // The second sensor has no such gap: the cause that the first one shows would open one there, and is no
    // part of the answer.
    EXPECT_LT(answer["gap_before"]["value"].get<double>(), 1.5);
    EXPECT_EQ(answer["gap_named"], answer["gap_before"]);
    EXPECT_EQ(answer["shrink"].get<double>(), 0.0);
    EXPECT_EQ(answer["verdict"], "unexplained");
    EXPECT_TRUE(answer["causes"].empty());
    EXPECT_THAT(answer["warnings"].dump(), HasSubstr("arw_scale is left out"));
}

TEST_F(DiagnoseCommand, GivesTheSameAnswerForAnyNumberOfThreads) {
    write_noisy_recording(1.5);
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", "-", "--threads", "1"}),
              ExitCode::ok)
        << err.str();
    const std::string one = out.str();
    ASSERT_EQ(diagnose({recording, "--model", model, "--simulations", "20", "--json", "-", "--threads", "2"}),
              ExitCode::ok);
    EXPECT_EQ(out.str(), one);
    EXPECT_TRUE(json::parse(one)["p_none"].is_number());
}

TEST_F(DiagnoseCommand, OfACurveFindsTheCoefficientThatIsOff) {
    write_curve(1.4);
    const std::string corrected = folder.path("corrected.json");
    ASSERT_EQ(diagnose({"--curve", curve, "--model", model, "--json", folder.path("d.json"), "--plot",
                        folder.path("d.png"), "--model-out", corrected}),
              ExitCode::ok)
        << err.str();
    EXPECT_THAT(out.str(), StartsWith("known: arw_scale on x (factor "));
    const json answer = json::parse(read_whole_file(folder.path("d.json")));
    EXPECT_EQ(answer["verdict"], "known");
    EXPECT_EQ(answer["causes"][0]["effect"], "arw_scale");
    EXPECT_NEAR(answer["causes"][0]["params"]["factor"].get<double>(), 1.4, 0.02);
    EXPECT_EQ(read_whole_file(folder.path("d.png")).substr(1, 3), "PNG");
    EXPECT_NEAR(read_model(corrected)->axes[0].noise.N_rad_per_sqrt_s,
                1.4 * typical_mpu9250().axes[0].noise.N_rad_per_sqrt_s, 1e-6);
    EXPECT_EQ(read_model(corrected)->axes[1].noise.N_rad_per_sqrt_s,
              typical_mpu9250().axes[1].noise.N_rad_per_sqrt_s);
    write_curve(1.0);
    ASSERT_EQ(diagnose({"--curve", curve, "--model", model, "--json", "-"}), ExitCode::ok) << err.str();
    EXPECT_EQ(json::parse(out.str())["verdict"], "none");
}

TEST_F(DiagnoseCommand, OfACurveWithItsSimulationNeedsNoModel) {
    std::ofstream(curve) << "tau_s,sensor_y_dps,simulation_y_dps\n"
                            "0.01,0.14,0.1\n0.1,0.0443,0.0316\n1,0.014,0.01\n10,0.00443,0.00316\n"
                            "100,0.0014,0.001\n1000,0.000443,0.000316\n";
    ASSERT_EQ(diagnose({"--curve", curve, "--json", "-"}), ExitCode::ok) << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["causes"][0]["effect"], "arw_scale");
    EXPECT_EQ(answer["causes"][0]["axes"], json({"y"}));
    write_curve(1.0);
    EXPECT_EQ(diagnose({"--curve", curve}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("give the --model"));
    EXPECT_EQ(diagnose({"--curve", curve, "--model-out", folder.path("m.json")}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("--model-out corrects a model"));
}

TEST_F(DiagnoseCommand, SaysWhatIsMissingAndWhatDoesNotGoTogether) {
    EXPECT_EQ(diagnose({}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("give a RECORDING, or --curve"));
    EXPECT_EQ(diagnose({recording, "--curve", curve, "--model", model}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("not both"));
    EXPECT_EQ(diagnose({recording}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("give the --model"));
    EXPECT_EQ(diagnose({"--curve", curve, "--model", model, "--seed", "3"}), ExitCode::usage);
    EXPECT_EQ(diagnose({recording, "--model", model, "--simulations", "3"}), ExitCode::usage);
    EXPECT_EQ(diagnose({recording, "--model", model, "--plot", "d.jpg"}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("a figure has no other form"));
    EXPECT_EQ(out.str(), "");
}

TEST_F(DiagnoseCommand, WritesOverNothingThatItReads) {
    write_noisy_recording(1.0);
    write_curve(1.0);
    const std::string model_before = read_whole_file(model);
    EXPECT_EQ(diagnose({recording, "--model", model, "--model-out", model}), ExitCode::usage);
    EXPECT_EQ(diagnose({recording, "--model", model, "--json", recording}), ExitCode::usage);
    EXPECT_EQ(diagnose({"--curve", curve, "--model", model, "--model-out", model}), ExitCode::usage);
    EXPECT_EQ(
        diagnose({recording, "--model", model, "--json", folder.path("a"), "--model-out", folder.path("a")}),
        ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("--model-out"));
    EXPECT_EQ(read_whole_file(model), model_before);
}

TEST_F(DiagnoseCommand, SaysWhichFileCannotBeUsedAndWhy) {
    write_curve(1.0);
    EXPECT_EQ(diagnose({folder.path("none.csv"), "--model", model}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("none.csv"));
    EXPECT_EQ(diagnose({"--curve", curve, "--model", folder.path("none.json")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("none.json"));
    std::ofstream(folder.path("short.csv")) << "t_s,gx_dps\n0,1\n0.01,2\n0.02,1\n";
    EXPECT_EQ(diagnose({folder.path("short.csv"), "--model", model}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("short.csv"));
    json unknown = json::parse(read_whole_file(model));
    unknown["effects"] = {{{"effect", "gremlins"}, {"axes", {"x"}}, {"params", json::object()}}};
    std::ofstream(folder.path("unknown.json")) << unknown;
    EXPECT_EQ(diagnose({"--curve", curve, "--model", folder.path("unknown.json")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("gremlins"));
    std::ofstream(folder.path("no_axis.csv")) << "tau_s,gyro_dps\n0.01,1\n0.1,0.3\n1,0.1\n10,0.03\n";
    EXPECT_EQ(diagnose({"--curve", folder.path("no_axis.csv"), "--model", model}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("no curve is of an axis"));
    EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace gyrolog
