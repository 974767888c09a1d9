#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/app/command_line.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/analysis/calibrate/moved_sensor.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

class CalibrateCommand : public testing::Test {
protected:
    std::string written(const std::string& name, const Recording& recording) const {
        std::string path = folder.path(name);
        EXPECT_TRUE(write_recording_csv(recording, path).ok());
        return path;
    }
    std::string session() const {
        MovedSensor moved({}, 71, 50.0);
        whole_session(moved);
        return written("session.csv", moved.recording());
    }

    ExitCode calibrate(std::vector<std::string> arguments) {
        out.str("");
        err.str("");
        arguments.insert(arguments.begin(), "calibrate");
        return run_command_line(std::move(arguments), {out, err});
    }

    TemporaryFolder folder;
    std::ostringstream out;
    std::ostringstream err;
};

TEST_F(CalibrateCommand, WritesTextJsonModelAndParameters) {
    EXPECT_EQ(calibrate({session(), "--turn", "360", "--json", folder.path("c.json"), "--model-out",
                         folder.path("m.json"), "--px4", folder.path("c.params"), "--ardupilot",
                         folder.path("c.param"), "--header", folder.path("c.h")}),
              ExitCode::ok)
        << err.str();
    EXPECT_THAT(out.str(), HasSubstr("3 turns by a known angle"));
    const json answer = json::parse(read_whole_file(folder.path("c.json")));
    EXPECT_EQ(answer["schema"], "gyrolog-calibration/1");
    EXPECT_THAT(answer["reported_by"].get<std::string>(), HasSubstr("gyrolog"));
    EXPECT_NEAR(answer["gyro"]["M"][0][0].get<double>(), 1.021, 0.01);
    EXPECT_THAT(read_whole_file(folder.path("c.params")), HasSubstr("CAL_ACC0_XOFF\t"));
    EXPECT_THAT(read_whole_file(folder.path("c.param")), HasSubstr("INS_ACCOFFS_X,"));
    EXPECT_THAT(read_whole_file(folder.path("c.h")), HasSubstr("gyrolog_calibrate_gyro"));
    const Result<SensorModel> model = read_model(folder.path("m.json"));
    ASSERT_TRUE(model.ok());
    EXPECT_NEAR(model->M[0][0], 1.021, 0.01);
}

// The model that comes out goes into the other commands.
TEST_F(CalibrateCommand, TheModelIsSimulatedAndCompared) {
    const std::string recording = session();
    const std::string model = folder.path("m.json");
    ASSERT_EQ(calibrate({recording, "--model-out", model}), ExitCode::ok) << err.str();
    EXPECT_EQ(
        run_command_line({"simulate", model, "-o", folder.path("sim.csv"), "--duration", "20s"}, {out, err}),
        ExitCode::ok)
        << err.str();
    EXPECT_EQ(run_command_line({"compare", folder.path("sim.csv"), model, "--simulations", "9"}, {out, err}),
              ExitCode::ok)
        << err.str();
}

TEST_F(CalibrateCommand, TakesSeveralRecordings) {
    MovedSensor one({}, 72, 50.0);
    rest_in(one, faces());
    MovedSensor other({}, 73, 50.0);
    rest_in(other, edges());
    EXPECT_EQ(
        calibrate({written("a.csv", one.recording()), written("b.csv", other.recording()), "--json", "-"}),
        ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["recordings"], json({"a.csv", "b.csv"}));
    EXPECT_TRUE(answer["accelerometer"]["has_misalignment"].get<bool>());
}

TEST_F(CalibrateCommand, WithoutARestThereIsNoAnswer) {
    MovedSensor moved({}, 74, 50.0);
    for (int i = 0; i < 8; ++i) { moved.turn({1, 1, 0}, 3.0, 2.0); }
    EXPECT_EQ(calibrate({written("moving.csv", moved.recording())}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("moving.csv"));
    EXPECT_THAT(err.str(), HasSubstr("no rest was found"));
    EXPECT_THAT(out.str(), IsEmpty());
}

TEST_F(CalibrateCommand, TooFewPosesAreRefusedWithWhatToAdd) {
    MovedSensor moved({}, 75, 50.0);
    moved.rest(5.0);
    EXPECT_EQ(calibrate({written("one.csv", moved.recording()), "--model-out", folder.path("m.json")}),
              ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("not determined: accelerometer: scale x"));
    EXPECT_THAT(err.str(), HasSubstr("add: rests of two seconds or more with"));
    EXPECT_FALSE(std::filesystem::exists(folder.path("m.json")));
}

TEST_F(CalibrateCommand, OneAxisIsCalibratedAndTheOthersAreNamed) {
    MovedSensor moved({}, 76, 50.0);
    moved.rest(3.0);
    moved.turn({0, 0, 1}, 2.0 * std::numbers::pi, 3.0);
    moved.rest(3.0);
    EXPECT_EQ(calibrate({written("z.csv", moved.recording()), "--turn", "360"}), ExitCode::ok) << err.str();
    EXPECT_THAT(out.str(), HasSubstr("not determined: gyro: scale and misalignment of turns about x"));
    EXPECT_THAT(out.str(), HasSubstr("not determined: gyro: scale and misalignment of turns about y"));
}

TEST_F(CalibrateCommand, TurnsNeedAnAccelerometerOrAReference) {
    MovedSensor moved({}, 77, 50.0);
    moved.rest(3.0);
    moved.turn({0, 0, 1}, 2.0 * std::numbers::pi, 3.0);
    moved.rest(3.0);
    const std::string gyro = written("gyro.csv", moved.recording("gyro.csv", false, false, false));
    EXPECT_EQ(calibrate({gyro, "--turn", "360"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("--turn needs an accelerometer"));
    EXPECT_EQ(calibrate({gyro}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("accelerometer: the recording has none"));
    EXPECT_THAT(err.str(), HasSubstr("a reference rate (ref_x_dps ref_y_dps ref_z_dps)"));
}

TEST_F(CalibrateCommand, CountsNeedTheirScale) {
    std::ofstream(folder.path("raw.csv")) << "t_s,ax_lsb,ay_lsb,az_lsb\n0,1,2,3\n0.01,2,2,3\n0.02,2,2,4\n";
    EXPECT_EQ(calibrate({folder.path("raw.csv")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("--lsb-g"));
}

TEST_F(CalibrateCommand, AnArrayIsRefusedWithTheOptionThatChoosesAUnit) {
    std::ofstream(folder.path("array.csv")) << "t_s,gx1_dps,gx2_dps,ax1_g\n0,1,2,3\n0.01,2,2,3\n0.02,2,2,4\n";
    EXPECT_EQ(calibrate({folder.path("array.csv")}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("is of an array (gx1 ...), and a calibration is of one unit: choose it "
                                     "with --columns"));
}

// Beside a gyro an accelerometer whose columns have no unit is left out, and that is why nothing is found.
TEST_F(CalibrateCommand, ARefusalSaysWhatWasLeftOutInLinesOfItsOwn) {
    std::ofstream file(folder.path("unit.csv"));
    file << "t_s,gx_dps,gy_dps,gz_dps,acc_x,acc_y,acc_z\n";
    for (int row = 0; row < 50; ++row) { file << 0.01 * row << ",50,-50,9,0,0,1\n"; }
    file.close();
    EXPECT_EQ(calibrate({folder.path("unit.csv")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("\nnot determined: accelerometer"));
    EXPECT_THAT(err.str(), HasSubstr("warning: "));
    EXPECT_THAT(err.str(), HasSubstr("--acc-unit"));
}

TEST_F(CalibrateCommand, WrongArgumentsAreRefused) {
    EXPECT_EQ(calibrate({}), ExitCode::usage);
    EXPECT_EQ(calibrate({folder.path("none.csv")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("none.csv"));
    const std::string recording = session();
    EXPECT_EQ(calibrate({recording, "--turn", "-90"}), ExitCode::usage);
    EXPECT_EQ(calibrate({recording, "--turn-sd", "2"}), ExitCode::usage);
    EXPECT_EQ(calibrate({recording, "--gravity", "1"}), ExitCode::usage);
    EXPECT_EQ(calibrate({recording, "--px4", recording}), ExitCode::usage);
    EXPECT_EQ(calibrate({recording, "--px4", "-"}), ExitCode::usage);
    EXPECT_EQ(calibrate({recording, "--json", folder.path("a"), "--header", folder.path("a")}),
              ExitCode::usage);
}

}  // namespace
}  // namespace gyrolog
