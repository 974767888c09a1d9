// What is written for MuJoCo, in MuJoCo: Debian's 2.2.2, which still adds the noise of the file by itself.

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/sensor_model.hpp"
#include "host/formats/model_json.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using Body = std::unique_ptr<mjModel, void (*)(mjModel*)>;
using State = std::unique_ptr<mjData, void (*)(mjData*)>;

constexpr double rate_hz = 100.0;

// White noise alone: MuJoCo has nothing else, and one number for all axes.
SensorModel white_sensor() {
    SensorModel model;
    model.rate_hz = rate_hz;
    model.full_scale_rad_s = model.saturation_rad_s = 250.0 * rad_per_deg;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        model.axes[axis].noise.N_rad_per_sqrt_s = (axis == 1 ? 0.007 : 0.006) * rad_per_deg;
    }
    return model;
}

std::string exported(const SensorModel& model, const TemporaryFolder& folder) {
    EXPECT_TRUE(write_model(model, folder.path("white.model.json")).ok());
    const ProgramResult done = run_gyrolog(
        {"export", folder.path("white.model.json"), "-o", folder.path("imu.xml"), "--for", "mjcf"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return read_whole_file(folder.path("imu.xml"));
}

// As the file's head tells users of MuJoCo before 3.1.4.
std::string with_noise_on(std::string text) {
    const std::string option = R"(<option timestep="0.01"/>)";
    const std::size_t at = text.find(option);
    EXPECT_NE(at, std::string::npos) << text;
    EXPECT_NE(text.find(R"(<flag sensornoise="enable"/>)"), std::string::npos) << "not told in the head";
    return text.replace(at, option.size(),
                        R"(<option timestep="0.01"><flag sensornoise="enable"/></option>)");
}

Body load(const std::string& text, const TemporaryFolder& folder) {
    std::ofstream(folder.path("body.xml")) << text;
    std::array<char, 512> why{};
    Body body{mj_loadXML(folder.path("body.xml").c_str(), nullptr, why.data(), why.size()), mj_deleteModel};
    EXPECT_NE(body, nullptr) << why.data();
    EXPECT_STREQ(why.data(), "");
    return body;
}

State start(const Body& body) { return {mj_makeData(body.get()), mj_deleteData}; }

// What the gyro of the file shows, as text. The body falls and does not turn.
void record(const Body& body, std::size_t samples, const std::string& path) {
    const State state = start(body);
    std::ofstream out(path);
    out.precision(12);
    out << "t_s,gx_rad_s,gy_rad_s,gz_rad_s\n";
    for (std::size_t i = 0; i < samples; ++i) {
        const double time_s = state->time;
        mj_step(body.get(), state.get());
        const mjtNum* shown = state->sensordata + body->sensor_adr[0];
        out << time_s << ',' << shown[0] << ',' << shown[1] << ',' << shown[2] << '\n';
    }
}

TEST(MuJoCo, ReadsWhatWasWritten) {
    const TemporaryFolder folder;
    const Body body = load(exported(white_sensor(), folder), folder);
    ASSERT_NE(body, nullptr);
    ASSERT_EQ(body->nsensor, 1);
    EXPECT_EQ(body->sensor_type[0], mjSENS_GYRO);
    EXPECT_EQ(mj_name2id(body.get(), mjOBJ_SENSOR, "gyro"), 0);
    EXPECT_NEAR(body->opt.timestep, 1.0 / rate_hz, 1e-12);
    EXPECT_NEAR(body->sensor_noise[0] / (0.007 * rad_per_deg * std::sqrt(rate_hz)), 1.0, 1e-8);
    EXPECT_NEAR(body->sensor_cutoff[0] / (250.0 * rad_per_deg), 1.0, 1e-8);
}

TEST(MuJoCo, AddsNoNoiseUntilItIsToldTo) {
    const TemporaryFolder folder;
    const Body body = load(exported(white_sensor(), folder), folder);
    ASSERT_NE(body, nullptr);
    const State state = start(body);
    for (int i = 0; i < 100; ++i) { mj_step(body.get(), state.get()); }
    for (int axis = 0; axis < 3; ++axis) { EXPECT_NEAR(state->sensordata[axis], 0.0, 1e-12); }
}

TEST(MuJoCo, NoiseThatItAddsIsTheModels) {
    const TemporaryFolder folder;
    const Body body = load(with_noise_on(exported(white_sensor(), folder)), folder);
    ASSERT_NE(body, nullptr);
    record(body, 200'000, folder.path("mujoco.csv"));
    const ProgramResult done =
        run_gyrolog({"analyze", folder.path("mujoco.csv"), "--json", folder.path("found.json")});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const json found = json::parse(read_whole_file(folder.path("found.json")));
    for (const char* axis : {"x", "y", "z"}) {
        const json& N = found["axes"][axis]["coefficients"]["N"];
        // Of the noisiest axis, as the head says. Four standard uncertainties: three intervals.
        const double truth_rad_per_sqrt_s = 0.007 * rad_per_deg;
        EXPECT_NEAR(N["value"].get<double>(), truth_rad_per_sqrt_s, 4.0 * N["sd"].get<double>()) << axis;
        EXPECT_LT(N["sd"].get<double>(), 0.01 * truth_rad_per_sqrt_s) << axis;
    }
}

TEST(MuJoCo, ClipsAtTheRange) {
    SensorModel model = white_sensor();
    const TemporaryFolder folder;
    const Body body = load(exported(model, folder), folder);
    ASSERT_NE(body, nullptr);
    const State state = start(body);
    state->qvel[3] = 300.0 * rad_per_deg;
    state->qvel[4] = -300.0 * rad_per_deg;
    mj_forward(body.get(), state.get());
    EXPECT_NEAR(state->sensordata[0], 250.0 * rad_per_deg, 1e-8);
    EXPECT_NEAR(state->sensordata[1], -250.0 * rad_per_deg, 1e-8);
}

}  // namespace
}  // namespace gyrolog
