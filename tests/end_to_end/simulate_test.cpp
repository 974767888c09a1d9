// Simulated recordings through the whole program: files, exit codes, messages, and what the analysis finds.

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/sensor_model.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;

EffectModel effect_of(std::string name, std::map<std::string, double> params) {
    return {.effect = std::move(name), .axes = {}, .params = std::move(params), .carried_json = {}};
}

std::string write(const SensorModel& model, const TemporaryFolder& folder, const char* name = "model.json") {
    const std::string path = folder.path(name);
    EXPECT_TRUE(write_model(model, path).ok());
    return path;
}

SensorModel static_model() {
    SensorModel model = typical_mpu9250();
    model.rate_hz = 20.0;
    for (AxisModel& axis : model.axes) {
        axis.noise.N_rad_per_sqrt_s = 0.005 * rad_per_deg;
        axis.noise.B_rad_per_s = 0.004 * rad_per_deg;
        axis.noise.K_rad_per_s_sqrt_s = 0.0;
    }
    return model;
}

Recording read(const std::string& path) {
    auto recording = read_recording_csv(path);
    EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message);
    return recording.ok() ? std::move(recording).value() : Recording{};
}

TEST(Simulate, MakesARecordingInWhichTheAnalysisFindsTheModelsNoise) {
    const TemporaryFolder folder;
    const std::string recording = folder.path("run.csv");
    const ProgramResult made =
        run_gyrolog({"simulate", write(static_model(), folder), "-o", recording, "--duration", "3h"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(made.out, "");
    EXPECT_THAT(made.err, HasSubstr("216,000 samples in 3 h, seed 1"));
    ASSERT_EQ(run_gyrolog({"analyze", recording, "--json", folder.path("a.json")}).exit_code, 0);
    const json report = json::parse(read_whole_file(folder.path("a.json")));
    for (const char* axis : {"x", "y", "z"}) {
        const json& found = report["axes"][axis]["coefficients"];
        // Six standard uncertainties: six intervals a run, and they shall hold on other machines, too.
        const auto expect_near = [&](const char* term, double truth) {
            const json& fitted = found[term];
            ASSERT_TRUE(fitted.contains("value")) << term << " " << fitted;
            EXPECT_NEAR(fitted["value"].get<double>(), truth, 4.0 * fitted["sd"].get<double>())
                << axis << term;
        };
        expect_near("N", 0.005);
        expect_near("B", 0.004);
    }
}

TEST(Simulate, MakesADriftWithTheTemperatureThatTheAnalysisTakesOff) {
    const TemporaryFolder folder;
    SensorModel model = static_model();
    model.temperature = TemperatureModel{};
    model.temperature->bias_rad_s_per_C = {0.06 * rad_per_deg, -0.03 * rad_per_deg, 0.0};
    model.temp_noise_C = 0.03;
    const std::string recording = folder.path("run.csv");
    ASSERT_EQ(run_gyrolog({"simulate", write(model, folder), "-o", recording, "--duration", "3h"}).exit_code,
              0);
    const ProgramResult taken_off = run_gyrolog(
        {"analyze", recording, "--json", folder.path("a.json"), "--model", folder.path("m.json")});
    ASSERT_EQ(taken_off.exit_code, 0) << taken_off.err;
    EXPECT_THAT(taken_off.out, HasSubstr("bias over temperature"));
    EXPECT_THAT(taken_off.out, HasSubstr("dps/degC"));
    const ProgramResult kept =
        run_gyrolog({"analyze", recording, "--keep-temperature", "--json", folder.path("k.json")});
    ASSERT_EQ(kept.exit_code, 0) << kept.err;
    const json axes = json::parse(read_whole_file(folder.path("a.json")))["axes"];
    const json with_drift = json::parse(read_whole_file(folder.path("k.json")))["axes"];
    const auto expect_slope = [&](const char* axis, double truth) {
        const json& found = axes[axis]["temperature"];
        const json& slope = found["coefficient"];
        EXPECT_EQ(slope["unit"], "dps/degC");
        EXPECT_NEAR(slope["value"].get<double>(), truth, 4.0 * slope["sd"].get<double>()) << axis;
        EXPECT_EQ(found["state"], truth == 0.0 ? "not_identifiable" : "identified") << axis << found;
        EXPECT_EQ(found["taken_off"], truth != 0.0);
        EXPECT_EQ(with_drift[axis]["temperature"]["coefficient"], slope);
        EXPECT_EQ(with_drift[axis]["temperature"]["taken_off"], false);
    };
    expect_slope("x", 0.06);
    expect_slope("y", -0.03);
    expect_slope("z", 0.0);
    EXPECT_EQ(with_drift["z"]["allan"], axes["z"]["allan"]);
    const json& flicker = axes["x"]["coefficients"]["B"];
    ASSERT_TRUE(flicker.contains("value")) << flicker;
    EXPECT_NEAR(flicker["value"].get<double>(), 0.004, 4.0 * flicker["sd"].get<double>());
    const auto last_decade = [](const json& of) {
        return of["allan"][of["allan"].size() * 3 / 4]["value"].get<double>();
    };
    EXPECT_GT(last_decade(with_drift["x"]), 2.0 * last_decade(axes["x"]));
    const json written = json::parse(read_whole_file(folder.path("m.json")));
    EXPECT_EQ(written["effects"][0]["effect"], "temp_linear");
}

TEST(Simulate, ASeedIsAUnitToTheLastByte) {
    const TemporaryFolder folder;
    const std::string model = write(typical_mpu9250(), folder);
    for (const char* name : {"a.csv", "b.csv"}) {
        ASSERT_EQ(run_gyrolog({"simulate", model, "-o", folder.path(name), "--duration", "1m", "--seed", "7"})
                      .exit_code,
                  0);
    }
    ASSERT_EQ(run_gyrolog({"simulate", model, "-o", folder.path("c.csv"), "--duration", "1m", "--seed", "8"})
                  .exit_code,
              0);
    EXPECT_EQ(read_whole_file(folder.path("a.csv")), read_whole_file(folder.path("b.csv")));
    EXPECT_NE(read_whole_file(folder.path("a.csv")), read_whole_file(folder.path("c.csv")));
}

TEST(Simulate, LikeKeepsStampsHolesAndTheOtherColumns) {
    const TemporaryFolder folder;
    SensorModel real = typical_mpu9250();
    real.effects = {effect_of("dropped", {{"per_hour", 600.0}})};
    ASSERT_EQ(run_gyrolog({"simulate", write(real, folder, "real.json"), "-o", folder.path("real.csv.gz"),
                           "--duration", "5m"})
                  .exit_code,
              0);
    const ProgramResult made =
        run_gyrolog({"simulate", write(typical_mpu9250(), folder), "-o", folder.path("like.csv"), "--like",
                     folder.path("real.csv.gz"), "--seed", "2", "--json", "-"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.err,
                HasSubstr("the time stamps are copied: timestamp_jitter_s of the model does not act"));
    const Recording original = read(folder.path("real.csv.gz"));
    const Recording like = read(folder.path("like.csv"));
    EXPECT_EQ(like.t_s, original.t_s);
    EXPECT_EQ(like.find("temp")->data, original.find("temp")->data);
    EXPECT_GT(like.segments.size(), 10U);
    EXPECT_NE(like.find("gx")->data, original.find("gx")->data);
    const json answer = json::parse(made.out);
    EXPECT_EQ(answer["schema"], "gyrolog-simulate/1");
    EXPECT_EQ(answer["samples"], like.rows());
    EXPECT_EQ(answer["missing"]["samples"], like.missing_samples());
    EXPECT_EQ(answer["missing"]["dropouts"], like.segments.size() - 1);
}

TEST(Simulate, LikeACaptureHasItsTimesAndTemperature) {
    const TemporaryFolder folder;
    const std::string model = write(typical_mpu9250(), folder);
    ASSERT_EQ(run_gyrolog({"simulate", model, "-o", folder.path("a.pcapng"), "--duration", "20s"}).exit_code,
              0);
    ASSERT_EQ(run_gyrolog({"export", folder.path("a.pcapng"), "-o", folder.path("a.csv")}).exit_code, 0);
    ASSERT_EQ(run_gyrolog({"simulate", model, "-o", folder.path("b.csv"), "--like", folder.path("a.pcapng")})
                  .exit_code,
              0);
    const Recording captured = read(folder.path("a.csv"));
    const Recording like = read(folder.path("b.csv"));
    EXPECT_EQ(like.rows(), 2000U);
    EXPECT_EQ(like.t_s, captured.t_s);
    // The export has the digits that a count of 8 g needs.
    constexpr double step_m_s2 = 8.0 * 9.80665 / 32768.0;
    for (std::size_t row = 0; row < like.rows(); ++row) {
        ASSERT_NEAR(like.find("ax")->value(row), captured.find("ax")->value(row), 1e-3 * step_m_s2);
    }
    ASSERT_NE(like.find("temp"), nullptr);
}

TEST(Simulate, LikeAnArrayOrASingleAxisIsOneGyroOfThreeAxesAndIsSaidToBe) {
    const TemporaryFolder folder;
    const std::string model = write(typical_mpu9250(), folder);
    std::ofstream array(folder.path("array.csv"));
    std::ofstream single(folder.path("single.csv"));
    array << "t_s,gx1_dps,gx2_dps\n";
    single << "t_s,gz_dps\n";
    for (int row = 0; row < 500; ++row) {
        array << row << ",0,0\n";
        single << row << ",0\n";
    }
    array.close();
    single.close();
    const auto like = [&](const char* name) {
        const ProgramResult made =
            run_gyrolog({"simulate", model, "-o", folder.path("like.csv"), "--like", folder.path(name)});
        EXPECT_EQ(made.exit_code, 0) << made.err;
        const Recording recording = read(folder.path("like.csv"));
        for (const char* column : {"gx", "gy", "gz", "temp"}) { EXPECT_NE(recording.find(column), nullptr); }
        EXPECT_EQ(recording.rows(), 500U);
        EXPECT_THAT(made.err, HasSubstr("time stamps; not in it, so simulated: temperature, rest"));
        return made.err;
    };
    EXPECT_THAT(like("array.csv"), HasSubstr("array.csv is of several gyros; one is simulated"));
    EXPECT_THAT(like("single.csv"), HasSubstr("single.csv has no gx, gy; simulated all the same"));
}

TEST(Simulate, LikeAMotionTurnsAsItsOrientationReferenceDoes) {
    if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    const std::string real =
        shared_data("broad_ref_motion/05_undisturbed_slow_rotation_with_breaks_B.csv.xz");
    const TemporaryFolder folder;
    SensorModel model;
    model.full_scale_rad_s = model.saturation_rad_s = 35.0;
    const ProgramResult made =
        run_gyrolog({"simulate", write(model, folder), "-o", folder.path("like.csv"), "--like", real});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.err, HasSubstr("the reference rate is not known in"));
    const Recording original = read(real);
    const Recording like = read(folder.path("like.csv"));
    ASSERT_EQ(like.t_s, original.t_s);
    // The real gyro's scale is good to 0.5 %, its misalignment to the markers about 1 %, and the gyro is by
    // far the quieter of the two: the regression of the simulated rate on it is 1, unless axes, signs or
    // times are wrong; the gyro is some 5 ms late (METHODS.md).
    std::map<std::string, double> stated = {{"gx", 0.989}, {"gy", 0.993}, {"gz", 0.998}};
    for (const char* axis : {"gx", "gy", "gz"}) {
        double together = 0.0;
        double squares = 0.0;
        for (std::size_t row = 0; row < like.rows(); ++row) {
            const double real_rad_s = original.find(axis)->value(row);
            together += like.find(axis)->value(row) * real_rad_s;
            squares += real_rad_s * real_rad_s;
        }
        EXPECT_NEAR(together / squares, stated[axis], 0.005) << axis;
    }
}

TEST(Simulate, ADrawnUnitIsTheOneThatModelOutTells) {
    const TemporaryFolder folder;
    const std::string sheet = folder.path("sheet.json");
    std::ofstream(sheet) << R"({"schema": "gyrolog-datasheet/1", "rate_hz": 100, "full_scale_dps": 500,
        "sensitivity_lsb_per_dps": 65.5, "noise_type": "one_sided", "noise_density_dps_per_sqrt_hz": 0.01,
        "zero_rate_output_dps": 5, "nonlinearity_percent": 0.1})";
    const std::string unit = folder.path("unit.json");
    const ProgramResult drawn = run_gyrolog({"simulate", sheet, "-o", folder.path("a.csv"), "--duration",
                                             "1m", "--seed", "5", "--model-out", unit});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_THAT(drawn.err, HasSubstr("not in the data sheet, so not simulated: bias instability"));
    ASSERT_EQ(run_gyrolog({"simulate", unit, "-o", folder.path("b.csv"), "--duration", "1m", "--seed", "5"})
                  .exit_code,
              0);
    EXPECT_EQ(read_whole_file(folder.path("a.csv")), read_whole_file(folder.path("b.csv")));
}

TEST(Simulate, ListsEveryEffect) {
    const ProgramResult text = run_gyrolog({"simulate", "--effects"});
    ASSERT_EQ(text.exit_code, 0);
    EXPECT_THAT(text.out, HasSubstr("\ntemp_lag\n"));
    const ProgramResult machine = run_gyrolog({"simulate", "--effects", "--json", "-"});
    EXPECT_EQ(json::parse(machine.out)["schema"], "gyrolog-effects/1");
}

TEST(Simulate, CtrlCLeavesAWholeFileAndSaysSo) {
    const TemporaryFolder folder;
    const std::string path = folder.path("long.csv");
    const ProgramResult stopped =
        run_gyrolog_and_signal({"simulate", write(typical_mpu9250(), folder), "-o", path, "--duration", "5d"},
                               std::chrono::milliseconds(300), SIGINT, path);
    ASSERT_EQ(stopped.exit_code, 128 + SIGINT) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("stopped early, whole up to there"));
    const Recording recording = read(path);
    EXPECT_EQ(recording.rows() % 1024, 0U);
    EXPECT_GT(recording.rows(), 0U);
    EXPECT_EQ(read_whole_file(path).back(), '\n');
}

class Refusals : public testing::Test {
protected:
    ProgramResult simulate(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "simulate");
        return run_gyrolog(arguments);
    }
    TemporaryFolder folder_;
    std::string model_ = write(typical_mpu9250(), folder_);
    std::string output_ = folder_.path("out.csv");
};

TEST_F(Refusals, SayWhatIsWrongAndWriteNothing) {
    std::ofstream(output_) << "precious";
    SensorModel unknown = typical_mpu9250();
    unknown.effects = {effect_of("gremlins", {})};
    SensorModel lacking = typical_mpu9250();
    lacking.effects = {effect_of("bias_step", {{"at_s", 1.0}})};
    SensorModel backwards = typical_mpu9250();
    backwards.effects = {effect_of("clock_rate", {{"rel", -2.0}})};
    SensorModel torrent = typical_mpu9250();
    torrent.effects = {effect_of("dropped", {{"per_hour", 1e12}})};
    std::ofstream(folder_.path("empty.csv")) << "";
    std::ofstream(folder_.path("broken.csv")) << "t_s,gx_dps\n0,1\n1,x\n";
    std::ofstream(folder_.path("headed.csv")) << "t_s,gx_dps\n";
    const struct {
        std::vector<std::string> arguments;
        int exit_code;
        const char* message;
    } cases[] = {
        {{}, 2, "give the MODEL to simulate"},
        {{model_}, 2, "give the recording to write with -o"},
        {{model_, "-o", folder_.path("out.docx")}, 2, "none of the endings"},
        {{folder_.path("none.json"), "-o", output_}, 1, "none.json': no such file"},
        {{write(unknown, folder_, "u.json"), "-o", output_}, 1, "effect 'gremlins' cannot be simulated"},
        {{write(lacking, folder_, "l.json"), "-o", output_}, 1, "lacks its parameter 'step_dps'"},
        {{write(backwards, folder_, "b.json"), "-o", output_}, 1, "rel is beyond 0.5"},
        {{write(torrent, folder_, "t.json"), "-o", output_}, 1, "per_hour is beyond 1000000"},
        {{model_, "-o", output_, "--seed", "-1"}, 2, "'-1' is no whole number"},
        {{model_, "-o", output_, "--seed", "18446744073709551616"}, 2, "is no whole number"},
        {{model_, "-o", output_, "--duration", "0"}, 2, "'0' is no duration"},
        {{model_, "-o", output_, "--duration", "-5"}, 2, "is no duration"},
        {{model_, "-o", output_, "--duration", "0.001s"}, 2, "holds no sample"},
        {{model_, "-o", output_, "--duration", "3000d", "--rate", "10000"}, 2, "at most 2^40"},
        {{model_, "-o", output_, "--like", folder_.path("none.csv")}, 1, "no such file"},
        {{model_, "-o", output_, "--like", folder_.path("empty.csv")}, 1, "empty.csv"},
        {{model_, "-o", output_, "--like", folder_.path("headed.csv")}, 1, "no samples"},
        {{model_, "-o", output_, "--like", folder_.path("broken.csv")}, 1, "line 3"},
        {{model_, "-o", folder_.path("a.pcapng"), "--like", output_}, 2, "write a .csv instead"},
        {{model_, "-o", output_, "--like", output_}, 2, "--like and --output are the same file"},
        {{model_, "-o", output_, "--model-out", model_}, 2, "MODEL and --model-out are the same file"},
        {{model_, "-o", output_, "--model-out", output_}, 2, "are the same file"},
        {{model_, "-o", folder_.path("no/where.csv")}, 1, "no such directory"},
        {{model_, "-o", output_, "--model-out", folder_.path("no/where.json")}, 1, "where.json"},
        {{model_, "-o", output_, "--rate", "0"}, 2, "must be from"},
    };
    for (const auto& c : cases) {
        const ProgramResult result = simulate(c.arguments);
        EXPECT_EQ(result.exit_code, c.exit_code) << result.err;
        EXPECT_THAT(result.err, HasSubstr(c.message));
        EXPECT_EQ(result.out, "");
    }
    EXPECT_EQ(read_whole_file(output_), "precious");
    EXPECT_FALSE(std::filesystem::exists(output_ + ".part"));
}

TEST_F(Refusals, AFullDiskIsSaid) {
    if (!has_full_disk()) { GTEST_SKIP() << needs_full_disk; }
    const ProgramResult result = simulate({model_, "-o", "/dev/full"});
    EXPECT_EQ(result.exit_code, 6) << result.err;
}

// What a row takes is counted: it is more than the shortest row or sample that there can be.
TEST(Simulate, WhatFillsTheDiskIsNotBegun) {
    struct Case {
        const char* name;
        double bytes_too_few;  // for a row, or a sample
    };
    const TemporaryFolder folder;
    const std::string model = write(static_model(), folder);
    const auto free_bytes = static_cast<double>(std::filesystem::space(folder.path(".")).available);
    constexpr double rate_hz = 8000.0;
    for (const auto& [name, bytes_too_few] : {Case{"run.csv", 30.0}, Case{"run.pcapng", 9.0}}) {
        const auto duration_s = static_cast<std::uint64_t>(free_bytes / bytes_too_few / rate_hz);
        // The signal: should it begin all the same, the disk is not to be filled.
        const ProgramResult made =
            run_gyrolog_and_signal({"simulate", model, "-o", folder.path(name), "--rate", "8000",
                                    "--duration", std::to_string(duration_s) + "s"},
                                   std::chrono::seconds(3), SIGTERM);
        EXPECT_EQ(made.exit_code, 6) << name << ": " << made.err;
        EXPECT_THAT(made.err, HasSubstr("it takes about")) << name;
        EXPECT_FALSE(std::filesystem::exists(folder.path(name))) << name;
    }
}

// Days of work, for a disk that cannot hold it.
TEST(Simulate, WhatNoDiskHoldsIsNotBegun) {
    constexpr double capture_bytes_least = 1000.0 * 86'400.0 * 8000.0 * 6.0;
    const TemporaryFolder folder;
    if (static_cast<double>(std::filesystem::space(folder.path(".")).available) > capture_bytes_least) {
        GTEST_SKIP() << "this disk would hold it";
    }
    const std::string model = write(static_model(), folder);
    for (const char* name : {"run.csv", "run.pcapng"}) {
        const ProgramResult made = run_gyrolog(
            {"simulate", model, "-o", folder.path(name), "--rate", "8000", "--duration", "1000d"});
        EXPECT_EQ(made.exit_code, 6) << name << ": " << made.err;
        EXPECT_THAT(made.err, HasSubstr("takes about")) << name;
        EXPECT_FALSE(std::filesystem::exists(folder.path(name))) << name;
    }
}

}  // namespace
}  // namespace gyrolog
