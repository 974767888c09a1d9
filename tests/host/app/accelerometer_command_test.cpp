// compare, diagnose and denoise of an accelerometer.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <sstream>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/recording_simulator.hpp"
#include "host/app/command_line.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/posed_recording.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr double g = standard_gravity_m_s2;

SensorModel six_axes() {
    SensorModel model = typical_mpu9250();
    AccelerometerModel& accelerometer = model.accelerometer.emplace();
    for (AxisModel& axis : accelerometer.axes) {
        axis.noise.N_rad_per_sqrt_s = 150e-6 * g;
        axis.noise.B_rad_per_s = 30e-6 * g;
    }
    accelerometer.lsb_m_s2 = g / 16384.0;
    accelerometer.full_scale_m_s2 = accelerometer.saturation_m_s2 = 2.0 * g;
    accelerometer.sd_rel = {{"N", 0.01}, {"B", 0.1}};
    return model;
}

EffectModel line_at(double f_hz, const char* amplitude, double size) {
    return {"tone", {"y"}, {{"f_hz", f_hz}, {amplitude, size}, {"phase_rad", 0.4}}, {}};
}

class AccelerometerCommands : public testing::Test {
protected:
    void SetUp() override { ASSERT_TRUE(write_model(six_axes(), model).ok()); }

    ExitCode run(std::vector<std::string> arguments) {
        out.str("");
        err.str("");
        return run_command_line(std::move(arguments), {out, err});
    }

    void write_recording_of(const SensorModel& sensor, std::size_t samples = 12'000) const {
        SimulationRequest request;
        request.samples = samples;
        request.seed = 5;
        ASSERT_TRUE(write_recording_csv(simulate_recording(sensor, request), recording).ok());
    }

    TemporaryFolder folder;
    std::string model = folder.path("model.json");
    std::string recording = folder.path("night.csv");
    std::ostringstream out;
    std::ostringstream err;
};

TEST_F(AccelerometerCommands, DiagnoseFindsALineInBothSensorsAndSaysThatTheyShareIt) {
    SensorModel shaken = six_axes();
    shaken.effects.push_back(line_at(31.4, "amplitude_dps", 0.03));
    shaken.accelerometer->effects.push_back(line_at(31.4, "amplitude_g", 800e-6));
    write_recording_of(shaken, 6000);
    const std::string corrected = folder.path("corrected.json");
    const std::string answer_path = folder.path("d.json");
    ASSERT_EQ(run({"diagnose", recording, "--model", model, "--sensor", "all", "--simulations", "20",
                   "--json", answer_path, "--plot", folder.path("d.png"), "--model-out", corrected}),
              ExitCode::ok)
        << err.str();
    std::ifstream text(answer_path);
    const json answer = json::parse(text);
    EXPECT_FALSE(answer.contains("sensor"));
    const json& of_force = answer["accelerometer"];
    EXPECT_EQ(of_force["sensor"], "accelerometer");
    EXPECT_EQ(of_force["verdict"], "known");
    ASSERT_EQ(of_force["causes"].size(), 1U) << of_force["causes"];
    const json& line = of_force["causes"][0];
    EXPECT_EQ(line["effect"], "tone");
    EXPECT_EQ(line["axes"], json({"y"}));
    EXPECT_NEAR(line["params"]["f_hz"].get<double>(), 31.4, 0.01);
    EXPECT_NEAR(line["params"]["amplitude_g"].get<double>(), 800e-6,
                4.0 * line["sd"]["amplitude_g"].get<double>());
    EXPECT_LT(line["sd"]["amplitude_g"].get<double>(), 50e-6);
    EXPECT_THAT(line["sentence"].get<std::string>(), HasSubstr("mg high"));
    EXPECT_EQ(answer["shared"], json({"tone"}));
    for (const json& one : of_force["untestable"]) { EXPECT_NE(one["effect"], "scale_factor"); }
    EXPECT_THAT(out.str(), HasSubstr("Both sensors have tone at the same place"));
    EXPECT_TRUE(std::filesystem::exists(folder.path("d.accelerometer.png")));

    const Result<SensorModel> written = read_model(corrected);
    ASSERT_TRUE(written.ok());
    ASSERT_EQ(written->effects.size(), 1U);
    ASSERT_EQ(written->accelerometer->effects.size(), 1U);
    EXPECT_NEAR(written->accelerometer->effects[0].params.at("amplitude_g"), 800e-6, 100e-6);
    EXPECT_NEAR(written->accelerometer->axes[0].noise.N_rad_per_sqrt_s, 150e-6 * g, 15e-6 * g);
    EXPECT_EQ(written->accelerometer->lsb_m_s2, g / 16384.0);
}

TEST_F(AccelerometerCommands, DiagnoseSeesNoGapWhereThereIsNone) {
    write_recording_of(six_axes());
    ASSERT_EQ(run({"diagnose", recording, "--model", model, "--sensor", "accelerometer", "--simulations",
                   "40", "--json", "-"}),
              ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["verdict"], "none");
    EXPECT_FALSE(answer.contains("accelerometer"));
}

TEST_F(AccelerometerCommands, DiagnoseTakesAPlainModelOfTheRecordingsOwn) {
    SensorModel shaken = six_axes();
    shaken.accelerometer->effects.push_back(line_at(20.0, "amplitude_g", 1e-3));
    write_recording_of(shaken);
    const std::string corrected = folder.path("corrected.json");
    ASSERT_EQ(run({"diagnose", recording, "--auto", "--sensor", "accelerometer", "--simulations", "20",
                   "--json", "-", "--model-out", corrected}),
              ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    ASSERT_GE(answer["causes"].size(), 1U);
    EXPECT_EQ(answer["causes"][0]["effect"], "tone");
    EXPECT_THAT(err.str(), HasSubstr("g/sqrt(Hz), read off"));
    const Result<SensorModel> written = read_model(corrected);
    ASSERT_TRUE(written.ok());
    EXPECT_NEAR(written->accelerometer->axes[2].noise.N_rad_per_sqrt_s, 150e-6 * g, 30e-6 * g);
}

// Motion of an accelerometer would be explained, cause after cause, for a quarter of an hour.
TEST_F(AccelerometerCommands, DiagnoseRefusesOneThatWasTurned) {
    SimulationRequest request;
    request.samples = 12'000;
    Recording turned = simulate_recording(six_axes(), request);
    for (Column& column : turned.columns) {
        std::vector<double> values = column.values();
        for (std::size_t i = 4000; i < 8000; ++i) {
            if (column.name == "ax") { values[i] += 0.3 * g; }
            if (column.name == "gy" && (i < 4300 || i >= 7700)) { values[i] += i < 4300 ? 0.1 : -0.1; }
        }
        if (column.name == "ax" || column.name == "gy") {
            column = Column{column.name, column.unit, std::move(values)};
        }
    }
    ASSERT_TRUE(write_recording_csv(turned, recording).ok());
    for (const char* sensor : {"accelerometer", "all"}) {
        for (const std::vector<std::string>& of : {std::vector<std::string>{"--auto"}, {"--model", model}}) {
            std::vector<std::string> line = {"diagnose", recording, "--sensor", sensor, "--json", "-"};
            line.insert(line.end(), of.begin(), of.end());
            ASSERT_EQ(run(line), ExitCode::failed) << err.str();
            EXPECT_THAT(err.str(), HasSubstr("for 33 % of the recording the accelerometer is turned or moved "
                                             "by more than 0.1 g"));
            EXPECT_THAT(err.str(), HasSubstr("columns ref_qw ref_qx ref_qy ref_qz"));
            EXPECT_THAT(err.str(), HasSubstr("`gyrolog calibrate`"));
        }
    }
    ASSERT_EQ(run({"diagnose", recording, "--sensor", "accelerometer", "--auto", "--still", "auto", "--json",
                   "-", "--simulations", "20"}),
              ExitCode::ok)
        << err.str();
}

// A recording of the sensor that is set down in six poses, whose orientation is known.
Recording seen_in_six_poses(const SensorModel& sensor) {
    SimulationRequest request;
    request.like = std::make_shared<const RecordedWorld>(
        std::make_shared<const Recording>(PosedRecording({.rest_s = 10.0}).recording()));
    request.accelerometer_in_poses = true;
    request.seed = 5;
    return simulate_recording(sensor, request);
}

TEST_F(AccelerometerCommands, DiagnoseFindsScaleAndMisalignmentInKnownPoses) {
    constexpr double eps = 0.005;
    constexpr double from_z = 0.003;
    SensorModel faulty = six_axes();
    faulty.accelerometer->axes[2].bias_rad_s = 0.02 * g;
    faulty.accelerometer->effects = {{"scale_factor", {"x"}, {{"eps", eps}}, {}},
                                     {"misalignment", {"y"}, {{"from_z", from_z}}, {}}};
    ASSERT_TRUE(write_recording_csv(seen_in_six_poses(faulty), recording).ok());
    const std::string corrected = folder.path("corrected.json");
    const std::string answer_path = folder.path("d.json");
    ASSERT_EQ(run({"diagnose", recording, "--model", model, "--sensor", "accelerometer", "--simulations",
                   "20", "--verbose", "--json", answer_path, "--model-out", corrected}),
              ExitCode::ok)
        << err.str();
    std::ifstream text(answer_path);
    const json answer = json::parse(text);
    EXPECT_EQ(answer["verdict"], "known");
    ASSERT_EQ(answer["causes"].size(), 2U) << answer["causes"];
    for (const json& cause : answer["causes"]) {
        const bool is_scale = cause["effect"] == "scale_factor";
        EXPECT_EQ(cause["effect"], is_scale ? "scale_factor" : "misalignment");
        EXPECT_EQ(cause["axes"], is_scale ? json({"x"}) : json({"y"}));
        const char* param = is_scale ? "eps" : "from_z";
        const double sd = cause["sd"][param].get<double>();
        EXPECT_NEAR(cause["params"][param].get<double>(), is_scale ? eps : from_z, 2.0 * sd);
        EXPECT_LT(sd, 1e-4);
        EXPECT_NEAR(cause["where"]["force_g"][1].get<double>(), 1.0, 1e-6);
        EXPECT_FALSE(cause["where"].contains("rate_dps"));
    }
    EXPECT_THAT(out.str(), HasSubstr("forces along other axes"));
    EXPECT_THAT(out.str(), HasSubstr("6 times in"));
    EXPECT_THAT(out.str(), Not(HasSubstr("deg/s")));
    EXPECT_THAT(out.str(), Not(HasSubstr("rates about")));
    for (const json& one : answer["untestable"]) { EXPECT_NE(one["effect"], "scale_factor"); }

    const Result<SensorModel> written = read_model(corrected);
    ASSERT_TRUE(written.ok());
    EXPECT_EQ(written->accelerometer->effects.size(), 2U);
    EXPECT_TRUE(written->effects.empty());
    // Gravity is no part of it; flicker leaves 30 ug of a mean.
    EXPECT_NEAR(written->accelerometer->axes[2].bias_rad_s / g, 0.02, 200e-6);
}

TEST_F(AccelerometerCommands, DiagnoseSeesNoGapInKnownPosesWhereThereIsNone) {
    ASSERT_TRUE(write_recording_csv(seen_in_six_poses(six_axes()), recording).ok());
    ASSERT_EQ(run({"diagnose", recording, "--model", model, "--sensor", "accelerometer", "--simulations",
                   "40", "--json", "-"}),
              ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["verdict"], "none");
    EXPECT_EQ(answer["causes"].size(), 0U);
}

// The same poses, told in a world whose x axis is upward.
TEST_F(AccelerometerCommands, DiagnoseRefusesAnOrientationThatContradictsGravity) {
    Recording poses = seen_in_six_poses(six_axes());
    const std::vector<double> w = poses.find("ref_qw")->values();
    const std::vector<double> x = poses.find("ref_qx")->values();
    const std::vector<double> y = poses.find("ref_qy")->values();
    const std::vector<double> z = poses.find("ref_qz")->values();
    const double h = std::sqrt(0.5);
    std::array<std::vector<double>, 4> turned;  // (h, 0, h, 0) times it
    for (std::size_t i = 0; i < w.size(); ++i) {
        turned[0].push_back(h * (w[i] - y[i]));
        turned[1].push_back(h * (x[i] + z[i]));
        turned[2].push_back(h * (y[i] + w[i]));
        turned[3].push_back(h * (z[i] - x[i]));
    }
    for (Column& column : poses.columns) {
        if (column.name.starts_with("ref_q")) {
            column.data = turned.at(std::string_view("wxyz").find(column.name.back()));
        }
    }
    ASSERT_TRUE(write_recording_csv(poses, recording).ok());
    EXPECT_EQ(run({"diagnose", recording, "--auto", "--sensor", "accelerometer", "--json", "-"}),
              ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("points along the world's +x axis"));
}

TEST_F(AccelerometerCommands, DiagnoseTakesNoHoldoutOfAnotherKind) {
    const std::string resting = folder.path("resting.csv");
    SimulationRequest request;
    request.samples = 6000;
    ASSERT_TRUE(write_recording_csv(simulate_recording(six_axes(), request), resting).ok());
    ASSERT_TRUE(write_recording_csv(seen_in_six_poses(six_axes()), recording).ok());
    EXPECT_EQ(
        run({"diagnose", recording, "--model", model, "--sensor", "accelerometer", "--holdout", resting}),
        ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("take two recordings of one kind"));
}

TEST_F(AccelerometerCommands, SimulateShowsGravityInThePosesOfARecording) {
    const std::string poses = folder.path("poses.csv");
    ASSERT_TRUE(write_recording_csv(PosedRecording({.rest_s = 2.0}).recording(), poses).ok());
    ASSERT_EQ(run({"simulate", model, "--like", poses, "-o", recording}), ExitCode::ok) << err.str();
    const Result<Recording> simulated = read_recording_csv(recording, {});
    ASSERT_TRUE(simulated.ok()) << simulated.error().message;
    // The second pose has y upward, from 4 s to 6 s; white noise of a mean of a second is 150 ug.
    const std::vector<double> y = simulated->find("ay")->values();
    EXPECT_NEAR(std::accumulate(y.begin() + 450, y.begin() + 550, 0.0) / 100.0 / g, 1.0, 1e-3);
}

TEST_F(AccelerometerCommands, CompareSaysByHowMuchTheSimulationIsTooQuiet) {
    write_recording_of(six_axes());
    ASSERT_EQ(run({"compare", recording, model, "--sensor", "accelerometer"}), ExitCode::ok) << err.str();
    EXPECT_THAT(out.str(), HasSubstr("z: the recording differs no more than simulations do"));
    EXPECT_THAT(out.str(), Not(HasSubstr("dps")));
    SensorModel loud = six_axes();
    loud.accelerometer->axes[2].noise.N_rad_per_sqrt_s *= 2.0;
    write_recording_of(loud);
    ASSERT_EQ(run({"compare", recording, model, "--sensor", "accelerometer", "--json", "-"}), ExitCode::ok);
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["sensor"], "accelerometer");
    // A sample's deviation, N sqrt(rate), in g.
    EXPECT_NEAR(answer["axes"]["z"]["standard_deviation"]["recording"].get<double>(), 3e-3, 0.1e-3);
    EXPECT_THAT(answer["axes"]["z"]["sentence"].get<std::string>(), HasSubstr("too quiet by"));
    EXPECT_THAT(answer["axes"]["x"]["sentence"].get<std::string>(), HasSubstr("no more than simulations"));
}

// Four equal units have half the noise of one.
TEST_F(AccelerometerCommands, DenoiseHalvesTheNoiseOfFourUnits) {
    std::vector<std::string> arguments{"denoise"};
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        SimulationRequest request;
        request.samples = 12'000;
        request.seed = seed;
        SensorModel unit = six_axes();
        unit.accelerometer->axes[0].noise.B_rad_per_s = 0.0;
        arguments.push_back(folder.path("unit" + std::to_string(seed) + ".csv"));
        ASSERT_TRUE(write_recording_csv(simulate_recording(unit, request), arguments.back()).ok());
    }
    const std::string denoised = folder.path("denoised.csv");
    arguments.insert(arguments.end(), {"--sensor", "accelerometer", "--still", "0,60", "--method", "kalman",
                                       "-o", denoised, "--json", "-"});
    ASSERT_EQ(run(arguments), ExitCode::ok) << err.str();
    std::ifstream text(denoised);
    std::string head;
    std::getline(text, head);
    EXPECT_THAT(head, HasSubstr("ax_m_s2,ay_m_s2,az_m_s2"));
    const Result<Recording> read = read_recording_csv(denoised, {.needs_gyro = false});
    ASSERT_TRUE(read.ok()) << read.error().message;
    const std::vector<double> x = read->find("ax")->values();
    double squares = 0.0;
    for (std::size_t i = 1; i < x.size(); ++i) { squares += (x[i] - x[i - 1]) * (x[i] - x[i - 1]); }
    const double sd_g = std::sqrt(squares / (2.0 * static_cast<double>(x.size() - 1))) / g;
    // N sqrt(rate) / 2; with 12000 samples its own deviation is 0.8 %.
    EXPECT_NEAR(sd_g / 0.75e-3, 1.0, 0.03);
    const std::vector<double> z = read->find("az")->values();
    EXPECT_NEAR(std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(z.size()) / g, 1.0, 1e-4);
}

TEST_F(AccelerometerCommands, SayWhatIsMissing) {
    write_recording_of(typical_mpu9250(), 3000);
    EXPECT_EQ(run({"diagnose", recording, "--model", model, "--sensor", "accelerometer"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("there is no accelerometer in it"));
    write_recording_of(six_axes(), 3000);
    ASSERT_TRUE(write_model(typical_mpu9250(), model).ok());
    EXPECT_EQ(run({"compare", recording, model, "--sensor", "accelerometer"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("has no accelerometer"));
    EXPECT_EQ(run({"diagnose", recording, "--model", model, "--sensor", "thermometer"}), ExitCode::usage);
}

}  // namespace
}  // namespace gyrolog
