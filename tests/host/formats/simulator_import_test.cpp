#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/formats/filters/filter_format.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/model_source.hpp"
#include "host/formats/simulators/simulator_format.hpp"
#include "tests/host/formats/simulator_files.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

ModelSource source_of(const std::string& text, const std::string& sensor = "") {
    auto source = parse_model_source(text, {"robot", sensor}, 1);
    EXPECT_TRUE(source.ok()) << source.error().message;
    return source.ok() ? *std::move(source) : ModelSource{};
}

std::string refusal_of(const std::string& text, const std::string& sensor = "") {
    const auto source = parse_model_source(text, {"robot", sensor}, 1);
    EXPECT_FALSE(source.ok());
    return source.ok() ? "" : source.error().message;
}

std::string all_of(const std::vector<std::string>& notes) {
    std::string text;
    for (const std::string& note : notes) { text += note + "\n"; }
    return text;
}

// The one process of an axis.
GaussMarkov process_on(const SensorModel& model, const std::string& axis) {
    GaussMarkov found;
    for (const EffectModel& effect : model.effects) {
        EXPECT_EQ(effect.effect, "gauss_markov");
        if (std::ranges::count(effect.axes, axis) == 0) { continue; }
        EXPECT_EQ(found.sigma_rad_per_s, 0.0);
        found = {effect.params.at("sigma_dps") * rad_per_deg, effect.params.at("tau_s")};
    }
    return found;
}

TEST(SimulatorImport, TakesTheStandardDeviationOfAnSdfSampleByItsRate) {
    const ModelSource source = source_of(x500_sdf);
    const SensorModel& model = source.file.model;
    EXPECT_EQ(model.rate_hz, 250.0);
    EXPECT_FALSE(source.file.unstated.rate);
    EXPECT_TRUE(source.file.unstated.step && source.file.unstated.full_scale);
    for (const AxisModel& axis : model.axes) {
        EXPECT_NEAR(axis.noise.N_rad_per_sqrt_s, 0.0008726646 / std::sqrt(250.0), 1e-15);
        EXPECT_EQ(axis.bias_rad_s, 0.0);
    }
    EXPECT_TRUE(model.effects.empty());
    EXPECT_EQ(source.file.notes.front(),
              "the model is taken from an imu sensor of SDF 'x500_base::base_link::imu_sensor'");
    EXPECT_THAT(all_of(source.file.notes), HasSubstr("linear_acceleration is left out"));
}

// gz-sensors, GaussianNoiseModel.cc: the bias decays by exp(-dt/T) and is driven by
// sqrt(d^2 T/2 (1 - exp(-2 dt/T))), so that its variance settles at d^2 T/2.
TEST(SimulatorImport, TakesADrivenBiasOfSdfForAGaussMarkovProcess) {
    ModelSource source = source_of(tutorial_sdf);
    const GaussMarkov slow = process_on(source.file.model, "y");
    EXPECT_NEAR(slow.sigma_rad_per_s, 4e-6 * std::sqrt(200.0), 1e-16);
    EXPECT_EQ(slow.correlation_s, 400.0);
    EXPECT_EQ(process_on(source.file.model, "x").sigma_rad_per_s, 0.0);
    EXPECT_EQ(source.file.model.axes[1].bias_rad_s, 0.01);
    EXPECT_EQ(source.file.model.lsb_rad_s, 2e-4);
    EXPECT_FALSE(source.file.unstated.step);
    const std::string notes = all_of(source.file.notes);
    EXPECT_THAT(notes, HasSubstr("bias_mean and bias_stddev are left out"));
    EXPECT_THAT(notes, HasSubstr("precision differs between the axes"));

    EXPECT_TRUE(source.file.unstated.rate);
    EXPECT_THAT(notes, HasSubstr("update_rate is not stated"));
    EXPECT_EQ(source.file.model.axes[0].noise.N_rad_per_sqrt_s, 0.0);
    state_rate(source.file, 400.0);
    EXPECT_NEAR(source.file.model.axes[0].noise.N_rad_per_sqrt_s, 1e-5, 1e-18);
    EXPECT_NEAR(source.file.model.axes[1].noise.N_rad_per_sqrt_s, 1.5e-5, 1e-18);
    EXPECT_EQ(source.file.model.axes[2].noise.N_rad_per_sqrt_s, 0.0);
}

std::string with(std::string text, const std::string& old, const std::string& now) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return at == std::string::npos ? text : text.replace(at, old.size(), now);
}

TEST(SimulatorImport, KnowsWhereSdfDoesNotMeanWhatItSays) {
    const std::string fine = with(tutorial_sdf, "<precision>2e-4", "<precision>5e-7");
    EXPECT_TRUE(source_of(fine).file.unstated.step);
    EXPECT_THAT(all_of(source_of(fine).file.notes), HasSubstr("takes for none"));
    const std::string no_time =
        with(tutorial_sdf, "<dynamic_bias_correlation_time>400", "<dynamic_bias_correlation_time>0");
    EXPECT_TRUE(source_of(no_time).file.model.effects.empty());
    EXPECT_THAT(all_of(source_of(no_time).file.notes), HasSubstr("the simulator makes no noise of it then"));
    // Whatever its type says, gz-sensors rounds where there is a precision.
    const std::string not_said = with(tutorial_sdf, "gaussian_quantized", "gaussian");
    EXPECT_EQ(source_of(not_said).file.model.lsb_rad_s, 2e-4);
}

TEST(SimulatorImport, ReadsThePluginOfPx4) {
    const ModelSource source = source_of(iris_sdf);
    for (const AxisModel& axis : source.file.model.axes) {
        EXPECT_EQ(axis.noise.N_rad_per_sqrt_s, 0.00018665);
    }
    for (const char* axis : axis_names) {
        EXPECT_NEAR(process_on(source.file.model, axis).sigma_rad_per_s, 3.8785e-05 * std::sqrt(500.0),
                    1e-15);
        EXPECT_EQ(process_on(source.file.model, axis).correlation_s, 1000.0);
    }
    EXPECT_EQ(source.file.model.effects.size(), 1U);
    EXPECT_TRUE(source.file.unstated.rate);
    EXPECT_THAT(source.file.notes.front(), HasSubstr("PX4"));
    EXPECT_THAT(all_of(source.file.notes), AllOf(HasSubstr("gyroscopeTurnOnBiasSigma is left out"),
                                                 HasSubstr("the accelerometer's elements are left out")));
}

// Twice an ADIS16448's, as the plugins have it: 2 * 4 deg/h/sqrt(s) and 1000 s.
TEST(SimulatorImport, TakesWhatAPluginTakesForWhatIsNotStated) {
    const ModelSource source = source_of(rotors_urdf);
    EXPECT_THAT(source.file.notes.front(), HasSubstr("RotorS"));
    EXPECT_EQ(source.file.model.axes[2].noise.N_rad_per_sqrt_s, 0.0003394);
    EXPECT_NEAR(process_on(source.file.model, "z").sigma_rad_per_s,
                8.0 / 3600.0 * rad_per_deg * std::sqrt(500.0), 1e-15);
    EXPECT_THAT(
        all_of(source.file.notes),
        HasSubstr("does not state gyroscopeRandomWalk (3.879e-05), gyroscopeBiasCorrelationTime (1000)"));
}

// Several numbers stand in a line, and a number is another's: nothing but its own place is written to.
TEST(SimulatorImport, KalibrsNumbersAreChangedInTheirOwnPlaceOrNotAtAll) {
    const std::string one_line =
        "imu0: {\n  gyroscope_noise_density: 1.0e-3, accelerometer_random_walk: 2.0e-5, "
        "gyroscope_random_walk: 2.0e-5, update_rate: 200.0}\n";
    ModelSource source = source_of(one_line);
    SensorModel model = source.file.model;
    model.axes[0].noise.K_rad_per_s_sqrt_s = 7e-5;
    const auto changed = changed_simulator_file(source, model, "robot", 600.0);
    ASSERT_TRUE(changed.ok()) << changed.error().message;
    EXPECT_THAT(changed->text, HasSubstr("accelerometer_random_walk: 2.0e-5, gyroscope_random_walk: "));
    EXPECT_THAT(changed->text, Not(HasSubstr("gyroscope_random_walk: 2.0e-5")));
    const std::string aliased =
        "imu0:\n  gyroscope_noise_density: 1.0e-3\n  accelerometer_random_walk: &walk 2.0e-5\n"
        "  gyroscope_random_walk: *walk\n  update_rate: 200.0\n";
    ModelSource shared = source_of(aliased);
    EXPECT_FALSE(changed_simulator_file(shared, model, "robot", 600.0).ok());
}

TEST(SimulatorImport, ABiasThatIsKnownTakesThePlaceOfOneThatIsDrawn) {
    ModelSource source = source_of(with(tutorial_sdf, "<mean>", "<bias_mean>0.01</bias_mean><mean>"));
    EXPECT_FALSE(changed_simulator_file(source, source.file.model, "robot", 600.0).ok())
        << "no rate is known";
    state_rate(source.file, 400.0);
    SensorModel model = source.file.model;
    for (AxisModel& axis : model.axes) { axis.bias_rad_s = 0.02; }
    const auto changed = changed_simulator_file(source, model, "robot", 600.0);
    ASSERT_TRUE(changed.ok()) << changed.error().message;
    EXPECT_THAT(changed->text, Not(HasSubstr("<bias_mean>0.01")));
    EXPECT_THAT(changed->text, HasSubstr("<bias_mean>0</bias_mean>"));
}

TEST(SimulatorImport, SensorsOfOneNameAreToldApart) {
    const TemporaryFolder folder;
    const auto imu = [](const char* reference, const char* stddev) {
        return std::string("<gazebo reference='") + reference +
               "'><sensor name='imu' "
               "type='imu'><update_rate>100</update_rate><imu><angular_velocity><x><noise "
               "type='gaussian'><mean>0</mean><stddev>" +
               stddev + "</stddev></noise></x></angular_velocity></imu></sensor></gazebo>";
    };
    const auto sd_of = [&](const std::string& text, const std::string& sensor) {
        std::ofstream(folder.path("robot.urdf")) << text;
        const auto source = read_model_source(folder.path("robot.urdf") + "#" + sensor, 1);
        return source.ok() ? source->file.model.axes[0].noise.N_rad_per_sqrt_s * 10.0 : 0.0;
    };
    const std::string two = "<robot name='r'>" + imu("left", "0.01") + imu("right", "0.02") + "</robot>";
    EXPECT_NEAR(sd_of(two, "left::imu"), 0.01, 1e-12);
    EXPECT_NEAR(sd_of(two, "right::imu"), 0.02, 1e-12);
    EXPECT_EQ(sd_of(two, "imu"), 0.0) << "which one?";
    const std::string same = "<robot name='r'>" + imu("base", "0.01") + imu("base", "0.02") + "</robot>";
    EXPECT_EQ(sd_of(same, "r::base::imu"), 0.0) << "which one?";
    EXPECT_NEAR(sd_of(same, "imu[2]"), 0.02, 1e-12);
}

TEST(SimulatorImport, ReadsAGyroOfMujoco) {
    const ModelSource source = source_of(robot_mjcf);
    EXPECT_EQ(source.file.model.rate_hz, 250.0);
    EXPECT_NEAR(source.file.model.axes[0].noise.N_rad_per_sqrt_s, 5e-4 / std::sqrt(250.0), 1e-18);
    EXPECT_EQ(source.file.model.full_scale_rad_s, 34.9);
    EXPECT_EQ(source.file.model.saturation_rad_s, 34.9);
    const std::string later =
        with(robot_mjcf, "noise=\"5e-4\"", "noise='5e-4' delay=\"0.003\" interval=\"0.01 0\" nsample=\"2\"");
    EXPECT_EQ(source_of(later).file.model.latency_s, 0.003);
    EXPECT_EQ(source_of(later).file.model.rate_hz, 100.0);
    const std::string unkept = with(later, " nsample=\"2\"", "");
    EXPECT_EQ(source_of(unkept).file.model.rate_hz, 250.0);
    EXPECT_EQ(source_of(unkept).file.model.latency_s, 0.0);
    EXPECT_EQ(source_of(with(robot_mjcf, " timestep=\"0.004\"", "")).file.model.rate_hz, 500.0);
}

TEST(SimulatorImport, ReadsAnImuOfAirsim) {
    const ModelSource source = source_of(airsim_settings);
    EXPECT_NEAR(source.file.model.axes[0].noise.N_rad_per_sqrt_s, 0.01 * rad_per_deg, 1e-15);
    // A random walk of density GyroBiasStability / sqrt(tau), with AirSim's own tau of 500 s.
    EXPECT_NEAR(source.file.model.axes[0].noise.K_rad_per_s_sqrt_s,
                9.2 / 3600.0 * rad_per_deg / std::sqrt(500.0), 1e-18);
    EXPECT_TRUE(source.file.unstated.rate);
    EXPECT_THAT(all_of(source.file.notes), AllOf(HasSubstr("does not state GyroBiasStabilityTau (500)"),
                                                 HasSubstr("'DefaultSensors::Imu'")));
}

TEST(SimulatorImport, ReadsBothFilesOfKalibr) {
    for (const char* text : {kalibr_imu, kalibr_chain}) {
        const ModelSource source = source_of(text);
        EXPECT_EQ(source.file.model.rate_hz, 500.0);
        EXPECT_EQ(source.file.model.axes[1].noise.N_rad_per_sqrt_s, 1.87e-4);
        EXPECT_EQ(source.file.model.axes[1].noise.K_rad_per_s_sqrt_s, 2.66e-5);
        ASSERT_TRUE(source.file.model.accelerometer);
        EXPECT_EQ(source.file.model.accelerometer->axes[2].noise.N_rad_per_sqrt_s, 1.86e-3);
        EXPECT_EQ(source.file.model.accelerometer->axes[2].noise.K_rad_per_s_sqrt_s, 4.33e-4);
    }
}

// What a model has, and an exporter writes.
struct Holding {
    std::string name;  // of --for, or "kalibr"
    bool per_axis;
    bool bias;
    bool walk;  // else a Gauss-Markov process
    bool slow;  // one of the two at all
    bool rate;
    bool step;
    bool range;
};

const Holding holdings[] = {
    {"sdf", true, true, false, true, true, true, false},
    {"px4-classic", false, false, false, true, false, false, false},
    {"rotors", false, false, false, true, false, false, false},
    {"mjcf", false, false, false, false, true, false, true},
    {"airsim", false, false, true, true, false, false, false},
    {"kalibr", false, false, true, true, true, false, false},
};

SensorModel held_model(const Holding& holding) {
    SensorModel model;
    model.rate_hz = 125.0;
    model.full_scale_rad_s = holding.range ? 8.7 : no_range_rad_s;
    model.saturation_rad_s = model.full_scale_rad_s;
    model.lsb_rad_s = holding.step ? 2.66e-4 : 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double own = holding.per_axis ? 1.0 + 0.3 * static_cast<double>(axis) : 1.0;
        AxisModel& of = model.axes.at(axis);
        of.noise.N_rad_per_sqrt_s = 8.7e-5 * own;
        if (holding.bias) { of.bias_rad_s = 0.003 * own; }
        if (!holding.slow) { continue; }
        if (holding.walk) {
            of.noise.K_rad_per_s_sqrt_s = 1.7e-6;
        } else {
            model.effects.push_back({.effect = "gauss_markov",
                                     .axes = {axis_names.at(axis)},
                                     .params = {{"sigma_dps", 0.004 * own}, {"tau_s", 30.0 * own}},
                                     .carried_json = ""});
        }
    }
    return model;
}

std::string exported(const Holding& holding, const SensorModel& model) {
    if (holding.name == "kalibr") {
        return filter_text(*find_filter_format("kalibr"), export_source(model, "m.json"));
    }
    return simulator_text(*find_simulator_format(holding.name), model, "m.json", 600.0);
}

void expect_same(const Holding& holding, const ModelFile& file, const SensorModel& wanted) {
    constexpr double printed_rel = 1e-8;
    const auto near = [](double value) { return testing::DoubleNear(value, std::fabs(value) * printed_rel); };
    ModelFile read = file;
    EXPECT_EQ(read.unstated.rate, !holding.rate);
    if (!holding.rate) { state_rate(read, wanted.rate_hz); }
    EXPECT_THAT(read.model.rate_hz, near(wanted.rate_hz));
    EXPECT_THAT(read.model.full_scale_rad_s, near(wanted.full_scale_rad_s));
    EXPECT_THAT(read.model.lsb_rad_s, near(wanted.lsb_rad_s));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const AxisModel& of = read.model.axes.at(axis);
        EXPECT_THAT(of.noise.N_rad_per_sqrt_s, near(wanted.axes.at(axis).noise.N_rad_per_sqrt_s));
        EXPECT_THAT(of.noise.K_rad_per_s_sqrt_s, near(wanted.axes.at(axis).noise.K_rad_per_s_sqrt_s));
        EXPECT_EQ(of.noise.B_rad_per_s, 0.0);
        EXPECT_THAT(of.bias_rad_s, near(wanted.axes.at(axis).bias_rad_s));
        const GaussMarkov slow = process_on(read.model, axis_names.at(axis));
        const GaussMarkov before = process_on(wanted, axis_names.at(axis));
        EXPECT_THAT(slow.sigma_rad_per_s, near(before.sigma_rad_per_s));
        EXPECT_THAT(slow.correlation_s, near(before.correlation_s));
    }
}

TEST(SimulatorImport, IsTheInverseOfExport) {
    for (const Holding& holding : holdings) {
        SCOPED_TRACE(holding.name);
        const SensorModel model = held_model(holding);
        const std::string text = exported(holding, model);
        const ModelSource source = source_of(text);
        expect_same(holding, source.file, model);
        // And once more, from what was read.
        ModelFile again = source.file;
        if (!holding.rate) { state_rate(again, model.rate_hz); }
        const auto changed = changed_simulator_file(source, again.model, "m.json", 600.0);
        ASSERT_TRUE(changed.ok()) << changed.error().message;
        expect_same(holding, source_of(changed->text).file, model);
    }
}

TEST(SimulatorImport, OfSeveralSensorsOneIsNamed) {
    const std::string two = with(x500_sdf, "    </link>\n", R"(      <sensor name="second" type="imu"/>
    </link>
    <link name="arm"><sensor name="imu_sensor" type="imu"><update_rate>90</update_rate></sensor></link>
)");
    EXPECT_EQ(refusal_of(two),
              "model 'robot': 3 sensors are in it: 'x500_base::base_link::imu_sensor', "
              "'x500_base::base_link::second', 'x500_base::arm::imu_sensor'; name one behind the path: "
              "'robot#x500_base::arm::imu_sensor'");
    EXPECT_EQ(source_of(two, "arm::imu_sensor").file.model.rate_hz, 90.0);
    EXPECT_EQ(source_of(two, "arm::imu_sensor").file.notes.back(), "the file states no noise of the gyro");
    EXPECT_EQ(source_of(two, "x500_base::base_link::imu_sensor").file.model.rate_hz, 250.0);
    EXPECT_EQ(source_of(two, "second").name, "robot#x500_base::base_link::second");
    EXPECT_THAT(refusal_of(two, "imu_sensor"), HasSubstr("several sensors are called 'imu_sensor'"));
    EXPECT_THAT(refusal_of(two, "sensor"), HasSubstr("no sensor is called 'sensor'"));
    EXPECT_EQ(source_of(x500_sdf).name, "robot");
    EXPECT_THAT(refusal_of(R"({"schema": "gyrolog-model/1"})", "imu"), HasSubstr("it is one sensor"));
}

TEST(SimulatorImport, AFileWithTheMarkInItsNameComesFirst) {
    const TemporaryFolder folder;
    const std::string plain = folder.path("robot.sdf");
    const std::string marked = folder.path("robot.sdf#arm");
    EXPECT_EQ(model_path(plain + "#arm").file, plain + "#arm");  // nothing is there yet
    std::ofstream(plain) << x500_sdf;
    EXPECT_EQ(model_path(plain + "#a#b").file, plain);
    EXPECT_EQ(model_path(plain + "#a#b").sensor, "a#b");
    std::ofstream(marked) << iris_sdf;
    EXPECT_EQ(model_path(marked).file, marked);
    EXPECT_EQ(model_path(marked).sensor, "");
    EXPECT_TRUE(is_model_file(plain));
    EXPECT_TRUE(is_model_file(plain + "#imu_sensor"));
    std::ofstream(folder.path("night.csv")) << "t_s,gx_dps\n0,1\n";
    EXPECT_FALSE(is_model_file(folder.path("night.csv")));
    std::ofstream(folder.path("imu.txt")) << kalibr_imu;
    EXPECT_TRUE(is_model_file(folder.path("imu.txt")));
}

TEST(SimulatorImport, SaysWhatIsWrongAndWhere) {
    EXPECT_THAT(
        refusal_of(with(x500_sdf, ">0.0008726646<", ">${noise}<")),
        AllOf(StartsWith("model 'robot', sensor 'x500_base::base_link::imu_sensor': x: stddev is '${noise}', "
                         "which is no finite number"),
              HasSubstr("xacro")));
    EXPECT_THAT(refusal_of(with(x500_sdf, ">0.0008726646<", ">-1<")), HasSubstr("x: stddev is below zero"));
    EXPECT_THAT(refusal_of(with(x500_sdf, ">0.0008726646<", ">1e999<")), HasSubstr("no finite number"));
    EXPECT_THAT(refusal_of(with(x500_sdf, ">0.0008726646<", ">nan<")), HasSubstr("no finite number"));
    EXPECT_THAT(refusal_of(with(x500_sdf, ">0.0008726646<", ">1e308<")), HasSubstr("too large or too small"));
    EXPECT_THAT(refusal_of(with(x500_sdf, "\"gaussian\"", "\"pink\"")),
                HasSubstr("x: type is 'pink', which is no noise of SDF"));
    EXPECT_THAT(refusal_of(with(x500_sdf, "type=\"imu\"", "type=\"gps\"")),
                AllOf(HasSubstr("no imu sensor is in it (its root is <sdf>)"), HasSubstr("<gyro>")));
    EXPECT_THAT(refusal_of(with(x500_sdf, "</imu>", "")), HasSubstr("no XML: line"));
    EXPECT_THAT(refusal_of("<sdf><sensor type='imu'><imu><noise><rate/></noise></imu></sensor></sdf>"),
                HasSubstr("put it into <angular_velocity>"));
    EXPECT_THAT(refusal_of(with(iris_sdf, ">1000.0<", ">0<")),
                HasSubstr("gyroscopeBiasCorrelationTime is not above zero"));
    EXPECT_THAT(refusal_of(with(airsim_settings, "\"SensorType\": 2", "\"SensorType\": 3")),
                HasSubstr("without an imu sensor"));
    EXPECT_THAT(refusal_of(with(airsim_settings, "0.6", "\"0.6\"")), HasSubstr("AngularRandomWalk"));
    EXPECT_THAT(refusal_of(with(kalibr_imu, "1.87e-04", "fast")),
                HasSubstr("gyroscope_noise_density is 'fast', which is no finite number"));
    EXPECT_THAT(refusal_of(with(kalibr_imu, "rostopic: ", "rostopic: [")), HasSubstr("no YAML: line"));
    EXPECT_THAT(
        refusal_of(std::string("cameras:\n  left:\n    imu:\n      ") + "gyroscope_noise_density: 1\n"),
        HasSubstr("no imu of Kalibr is in it"));
}

// Refused before it is parsed, or parsed without a thing being made of it.
TEST(SimulatorImport, DoesNotDoWhatAHostileFileAsks) {
    const std::string bomb =
        "<!DOCTYPE sdf [<!ENTITY a \"1111111111\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">\n"
        "<!ENTITY f SYSTEM \"file:///etc/hostname\">]>\n";
    for (const char* entity : {"&b;", "&f;"}) {
        const std::string text =
            with(with(x500_sdf, "<sdf", bomb + "<sdf"), ">0.0008726646<", std::string(">") + entity + "<");
        EXPECT_THAT(refusal_of(text),
                    HasSubstr(std::string("stddev is '") + entity + "', which is no finite number"));
    }
    std::string deep = "<sdf>";
    for (int i = 0; i < 100'000; ++i) { deep += "<model>"; }
    for (int i = 0; i < 100'000; ++i) { deep += "</model>"; }
    EXPECT_THAT(refusal_of(deep + "</sdf>"), HasSubstr("nested deeper than 256 elements"));
    EXPECT_THAT(refusal_of("<sdf>" + std::string(input_limits.xml_elements_most, '<')),
                HasSubstr("more than"));
    std::string many = "<sdf>";
    for (int i = 0; i < 100'000; ++i) { many += "<sensor type='imu' name='" + std::string(50, 'n') + "'/>"; }
    EXPECT_THAT(refusal_of(many + "</sdf>"), HasSubstr("more than 1000 imu sensors"));
    many = "<sdf name='" + std::string(1'000'000, 'n') + "'>";
    for (int i = 0; i < 1000; ++i) { many += "<sensor type='imu' name='s" + std::to_string(i) + "'/>"; }
    EXPECT_LT(refusal_of(many + "</sdf>").size(), 6000U);
    EXPECT_LT(refusal_of(with(x500_sdf, ">0.0008726646<", ">" + std::string(100'000, 'x') + "<")).size(),
              400U);

    const std::string imu = "gyroscope_noise_density: ";
    EXPECT_THAT(refusal_of(imu + std::string(100'000, '[')), HasSubstr("nested deeper than 32"));
    EXPECT_THAT(refusal_of(imu + "1\nx: " + std::string(input_limits.yaml_bytes_most, 'x')),
                HasSubstr("longer than"));
    std::string laughs = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
    for (char c = 'b'; c < 'z'; ++c) {
        const std::string before = std::string("*") + static_cast<char>(c - 1);
        laughs += std::string(1, c) + ": &" + c + " [" + before + ", " + before + ", " + before + "]\n";
    }
    EXPECT_THAT(refusal_of(laughs + imu + "*y\n"), HasSubstr("gyroscope_noise_density is 'a list or a map'"));
    std::string stairs = imu + "1\n";
    for (int i = 0; i < 600; ++i) { stairs += std::string(static_cast<std::size_t>(i) * 1, ' ') + "k:\n"; }
    static_cast<void>(parse_model_source(stairs, {"robot", ""}, 1));
}

SensorModel changed_model(const ModelSource& source, double rate_hz) {
    ModelFile file = source.file;
    if (file.unstated.rate) { state_rate(file, rate_hz); }
    for (AxisModel& axis : file.model.axes) {
        axis.noise.N_rad_per_sqrt_s *= 2.0;
        axis.noise.K_rad_per_s_sqrt_s *= 3.0;
    }
    for (EffectModel& effect : file.model.effects) { effect.params["sigma_dps"] *= 4.0; }
    file.model.effects.push_back({.effect = "stale", .axes = {"x"}, .params = {}, .carried_json = ""});
    return file.model;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) { lines.push_back(line); }
    return lines;
}

// Each line of the user's that is not there any more.
std::vector<std::string> lines_lost(const std::string& before, const std::string& after) {
    std::vector<std::string> left = lines_of(after);
    std::vector<std::string> lost;
    for (const std::string& line : lines_of(before)) {
        const auto found = std::ranges::find(left, line);
        if (found == left.end()) {
            lost.push_back(line);
        } else {
            left.erase(found);
        }
    }
    return lost;
}

TEST(SimulatorImport, ChangesNumbersAndNothingElse) {
    using testing::Contains;
    const auto changed = [](const char* text) {
        const ModelSource source = source_of(text);
        auto file = changed_simulator_file(source, changed_model(source, 200.0), "robot", 600.0);
        EXPECT_TRUE(file.ok()) << file.error().message;
        EXPECT_THAT(all_of(file->told), HasSubstr("Not in this file: ")) << text;
        EXPECT_THAT(all_of(file->told), HasSubstr("effect stale")) << text;
        EXPECT_THAT(file->text, HasSubstr("effect stale"));
        return file->text;
    };
    const std::string stddev = "                <stddev>0.0008726646</stddev>";
    EXPECT_THAT(
        lines_lost(x500_sdf, changed(x500_sdf)),
        testing::ElementsAre("<sdf version='1.9'>", "  <model name='x500_base'>", stddev, stddev, stddev));
    EXPECT_THAT(changed(x500_sdf), HasSubstr("<stddev>0.0017453292</stddev>\n              </noise>\n"));
    // Single quotes of attributes become double ones.
    EXPECT_THAT(changed(iris_sdf),
                AllOf(HasSubstr("      <gyroscopeNoiseDensity>0.0003733</gyroscopeNoiseDensity>\n"),
                      HasSubstr("      <gyroscopeRandomWalk>0.00015514</gyroscopeRandomWalk>\n"),
                      HasSubstr("      <gyroscopeTurnOnBiasSigma>0.0087</gyroscopeTurnOnBiasSigma>\n"),
                      HasSubstr("libgazebo_gps_plugin.so")));
    EXPECT_THAT(changed(rotors_urdf),
                HasSubstr("\n      <gyroscopeBiasCorrelationTime>1000</gyroscopeBiasCorrelationTime>\n"
                          "    </plugin>\n"));
    EXPECT_THAT(lines_lost(robot_mjcf, changed(robot_mjcf)),
                testing::ElementsAre(HasSubstr("noise=\"5e-4\"")));
    EXPECT_THAT(changed(robot_mjcf),
                AllOf(HasSubstr("<gyro name=\"body_gyro\" site=\"imu\" noise=\"0.001\" cutoff=\"34.9\"/>"),
                      HasSubstr("def gyro(data)")));
    EXPECT_THAT(lines_lost(airsim_settings, changed(airsim_settings)),
                AllOf(Contains(HasSubstr("AngularRandomWalk")), Contains(HasSubstr("GyroBiasStability")),
                      Not(Contains(HasSubstr("SimMode")))));
    EXPECT_THAT(changed(airsim_settings), HasSubstr("\n    \"SimMode\": \"Multirotor\",\n"));
    EXPECT_THAT(lines_lost(kalibr_imu, changed(kalibr_imu)),
                testing::ElementsAre(HasSubstr("1.87e-04"), HasSubstr("2.66e-05")));
    EXPECT_THAT(changed(kalibr_imu), HasSubstr("gyroscope_noise_density:     0.000374   #Noise density"));
    EXPECT_THAT(lines_lost(kalibr_chain, changed(kalibr_chain)).size(), 2U);
}

TEST(SimulatorImport, PutsOneHeadHoweverOften) {
    for (const char* text : {x500_sdf, iris_sdf, robot_mjcf, airsim_settings, kalibr_imu}) {
        const ModelSource first = source_of(text);
        const SensorModel model = changed_model(first, 200.0);
        const auto once = changed_simulator_file(first, model, "robot", 600.0);
        ASSERT_TRUE(once.ok());
        const auto twice = changed_simulator_file(source_of(once->text), model, "robot", 600.0);
        ASSERT_TRUE(twice.ok());
        EXPECT_EQ(once->text, twice->text);
    }
}

TEST(SimulatorImport, WritesWhatWasNotThereWhereItBelongs) {
    const ModelSource source = source_of(tutorial_sdf);
    SensorModel model = changed_model(source, 200.0);
    model.axes[2].noise.N_rad_per_sqrt_s = 1e-5;
    const auto changed = changed_simulator_file(source, model, "robot", 600.0);
    ASSERT_TRUE(changed.ok());
    const ModelSource again = source_of(changed->text);
    EXPECT_EQ(again.file.model.rate_hz, 200.0);
    EXPECT_NEAR(again.file.model.axes[2].noise.N_rad_per_sqrt_s, 1e-5, 1e-13);
    EXPECT_NEAR(process_on(again.file.model, "y").sigma_rad_per_s, 16e-6 * std::sqrt(200.0), 1e-12);
    // What the simulator draws is the user's still.
    EXPECT_THAT(changed->text, HasSubstr("<bias_mean>0.0000075</bias_mean>"));

    const ModelSource kalibr = source_of(with(kalibr_imu, "gyroscope_random_walk: ", "gyroscope_walk: "));
    SensorModel walking = kalibr.file.model;
    walking.axes[1].noise.K_rad_per_s_sqrt_s = 1e-6;
    const auto added = changed_simulator_file(kalibr, walking, "robot", 600.0);
    ASSERT_TRUE(added.ok()) << added.error().message;
    EXPECT_EQ(source_of(added->text).file.model.axes[0].noise.K_rad_per_s_sqrt_s, 1e-6);
}

// Java reads \\u000a as the end of a line wherever it stands: the rest of the name would be a program.
TEST(SimulatorExport, OfAHostileNameIsNoCode) {
    const std::string text = simulator_text(*find_simulator_format("jmavsim"), typical_mpu9250(),
                                            "m\\u000aSystem.exit(1);.json", 600.0);
    EXPECT_THAT(text, HasSubstr("System.exit"));
    EXPECT_THAT(text, Not(HasSubstr("\\")));
}

// Python takes the encoding of a file from a comment of its first two lines, unless the first has named one.
TEST(SimulatorExport, OfANameThatNamesAnEncodingIsReadAsUtf8) {
    for (const char* format : {"carla", "genesis", "gnss-ins-sim", "isaaclab", "pegasus"}) {
        const std::string text = simulator_text(*find_simulator_format(format), typical_mpu9250(),
                                                "coding:utf-7 +AAo-import os", 600.0);
        EXPECT_TRUE(text.starts_with("# -*- coding: utf-8 -*-\n")) << format;
        EXPECT_THAT(text, HasSubstr("coding:utf-7")) << format;
    }
}

}  // namespace
}  // namespace gyrolog
