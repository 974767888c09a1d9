// What is written for Gazebo, as libsdformat reads it, which Gazebo does, too.

#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sdf/sdf.hh>

#include "analysis/simulate/sensor_model.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/simulators/simulator_format.hpp"

namespace gyrolog {
namespace {

constexpr double ten_digits_rel = 1e-8;

const SimulatorFormat& format() { return *find_simulator_format("sdf"); }

SensorModel fitted_sensor() {
    SensorModel model = typical_mpu9250();
    const Vector3 bias_rad_s = {0.31 * rad_per_deg, -0.12 * rad_per_deg, 0.08 * rad_per_deg};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        AxisModel& one = model.axes[axis];
        one.bias_rad_s = bias_rad_s[axis];
        one.noise.N_rad_per_sqrt_s *= 1.0 + 0.1 * static_cast<double>(axis);
        one.noise.B_rad_per_s *= 1.0 + 0.2 * static_cast<double>(axis);
    }
    return model;
}

std::string problems(const sdf::Errors& errors) {
    std::ostringstream text;
    for (const sdf::Error& error : errors) { text << error << '\n'; }
    return text.str();
}

std::array<const sdf::Noise*, 3> noise_of(const sdf::Imu& imu) {
    return {&imu.AngularVelocityXNoise(), &imu.AngularVelocityYNoise(), &imu.AngularVelocityZNoise()};
}

void expect_same(double read, double written) {
    EXPECT_LE(std::fabs(read - written), ten_digits_rel * std::fabs(written)) << read << " of " << written;
}

void expect_what_was_written(const sdf::Sensor& sensor, const SimulatorSource& source) {
    ASSERT_EQ(sensor.Type(), sdf::SensorType::IMU);
    ASSERT_NE(sensor.ImuSensor(), nullptr);
    expect_same(sensor.UpdateRate(), source.rate_hz);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        SCOPED_TRACE(axis_names[axis]);
        const sdf::Noise& read = *noise_of(*sensor.ImuSensor())[axis];
        EXPECT_EQ(read.Type(),
                  source.lsb_rad_s > 0.0 ? sdf::NoiseType::GAUSSIAN_QUANTIZED : sdf::NoiseType::GAUSSIAN);
        expect_same(read.Mean(), source.bias_rad_s[axis]);
        expect_same(read.StdDev(), source.sample_sd_rad_s(axis));
        expect_same(read.Precision(), source.lsb_rad_s);
        expect_same(read.BiasMean(), 0.0);
        expect_same(read.BiasStdDev(), 0.0);
        const GaussMarkov& slow = source.noise[axis].gauss_markov;
        expect_same(read.DynamicBiasStdDev(), source.noise[axis].drive_rad_per_s_sqrt_s());
        expect_same(read.DynamicBiasCorrelationTime(), slow.sigma_rad_per_s > 0.0 ? slow.correlation_s : 0.0);
    }
}

void expect_read_as_written(const SensorModel& model) {
    constexpr double horizon_s = 600.0;
    const SimulatorSource source = simulator_source(model, "imu.model.json", format().abilities, horizon_s);
    sdf::Root root;
    const sdf::Errors errors =
        root.LoadSdfString(simulator_text(format(), model, "imu.model.json", horizon_s));
    ASSERT_TRUE(errors.empty()) << problems(errors);
    ASSERT_NE(root.Model(), nullptr);
    const sdf::Link* const link = root.Model()->LinkByName("imu_link");
    ASSERT_NE(link, nullptr);
    ASSERT_EQ(link->SensorCount(), 1U);
    expect_what_was_written(*link->SensorByIndex(0), source);
}

TEST(SdFormat, ReadsWhatWasWritten) {
    const SensorModel model = fitted_sensor();
    ASSERT_GT(model.lsb_rad_s, 0.0);
    expect_read_as_written(model);
}

TEST(SdFormat, ReadsASensorWithoutStepsOrDrift) {
    SensorModel model = fitted_sensor();
    model.lsb_rad_s = 0.0;
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = axis.noise.K_rad_per_s_sqrt_s = 0.0; }
    expect_read_as_written(model);
}

// Without it no imu sensor is made.
bool has_imu_system(const sdf::World& world) {
    for (auto plugin = world.Element()->FindElement("plugin"); plugin != nullptr;
         plugin = plugin->GetNextElement("plugin")) {
        if (plugin->Get<std::string>("name") == "gz::sim::systems::Imu") { return true; }
    }
    return false;
}

// The example's sensor is the one that `gyrolog export` writes of the example's model.
TEST(SdFormat, ReadsTheExampleWorld) {
    const char* const tree = std::getenv("GYROLOG_SOURCE_DIR");
    ASSERT_NE(tree, nullptr);
    const std::string folder = std::string(tree) + "/host/sensor/examples/";
    const auto model = read_model(folder + "imu.model.json");
    ASSERT_TRUE(model.ok()) << model.error().message;

    sdf::Root root;
    const sdf::Errors errors = root.Load(folder + "gyro_world.sdf");
    ASSERT_TRUE(errors.empty()) << problems(errors);
    ASSERT_EQ(root.WorldCount(), 1U);
    const sdf::World& world = *root.WorldByIndex(0);
    EXPECT_TRUE(has_imu_system(world));
    const sdf::Model* const box = world.ModelByName("box");
    ASSERT_NE(box, nullptr);
    const sdf::Link* const link = box->LinkByName("imu_link");
    ASSERT_NE(link, nullptr);
    const sdf::Sensor* const sensor = link->SensorByName("imu");
    ASSERT_NE(sensor, nullptr);
    EXPECT_EQ(sensor->Topic(), "imu");
    expect_what_was_written(*sensor, simulator_source(*model, "imu.model.json", format().abilities, 600.0));
}

}  // namespace
}  // namespace gyrolog
