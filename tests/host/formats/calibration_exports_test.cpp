// The exported numbers, applied by the formulas of those who read them, give back gravity. The formulas are
// written here once more, from their sources (calibration_px4.hpp, calibration_ardupilot.hpp).

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/formats/calibration_ardupilot.hpp"
#include "host/formats/calibration_c_header.hpp"
#include "host/formats/calibration_px4.hpp"
#include "tests/host/formats/made_calibration.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;
using testing::Not;
using Parameters = std::map<std::string, double>;
constexpr const char* axes_upper[] = {"X", "Y", "Z"};

std::vector<std::string> parts_of(const std::string& line, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, separator);) { parts.push_back(part); }
    return parts;
}

Parameters px4_of(const Calibration& calibration) {
    Parameters parameters;
    std::istringstream lines(px4_parameters(calibration));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) { continue; }
        const std::vector<std::string> parts = parts_of(line, '\t');
        EXPECT_EQ(parts.size(), 5U) << line;
        EXPECT_LE(parts[2].size(), 16U) << "a name of MAVLink";
        EXPECT_TRUE(parts[4] == "9" || parts[4] == "6") << line;
        parameters[parts[2]] = std::stod(parts[3]);
    }
    return parameters;
}

Parameters ardupilot_of(const Calibration& calibration) {
    Parameters parameters;
    std::istringstream lines(ardupilot_parameters(calibration));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) { continue; }
        const std::vector<std::string> parts = parts_of(line, ',');
        EXPECT_EQ(parts.size(), 2U) << line;
        EXPECT_LE(parts[0].size(), 16U) << "a name of MAVLink";
        parameters[parts[0]] = std::stod(parts[1]);
    }
    return parameters;
}

// PX4: thermal offsets, then Correct(). In float, as the board has it.
Vector3 px4_corrected(const Parameters& p, char sensor, const Vector3& raw, double temperature_C) {
    Vector3 corrected{};
    const std::string tc = std::string("TC_") + sensor + "0_";
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string axis = std::to_string(i);
        const auto of = [&](const std::string& name) { return static_cast<float>(p.at(name)); };
        const float clipped = std::clamp(static_cast<float>(temperature_C), of(tc + "TMIN"), of(tc + "TMAX"));
        const float delta = clipped - of(tc + "TREF");
        const auto coefficient = [&](const char* power) {
            return of(std::string(tc).append(power).append(axis));
        };
        const float thermal = coefficient("X0_") + coefficient("X1_") * delta +
                              coefficient("X2_") * delta * delta + coefficient("X3_") * delta * delta * delta;
        const std::string cal = sensor == 'A' ? "CAL_ACC0_" : "CAL_GYRO0_";
        float value = static_cast<float>(raw[i]) - thermal - of(cal + axes_upper[i] + "OFF");
        if (sensor == 'A') { value *= of(cal + axes_upper[i] + "SCALE"); }
        corrected[i] = static_cast<double>(value);
    }
    return corrected;
}

float ardupilot_polynomial(const Parameters& p, const std::string& sensor, const std::string& axis, float s) {
    const auto c = [&](const char* order) {
        return static_cast<float>(
            p.at(std::string("INS_TCAL1_").append(sensor).append(order).append("_").append(axis)));
    };
    return (c("1") + (c("2") + c("3") * s) * s) * s * 1.0e-6F;
}

Vector3 ardupilot_corrected(const Parameters& p, bool is_acc, const Vector3& raw, double temperature_C) {
    Vector3 corrected{};
    const auto of = [&](const std::string& name) { return static_cast<float>(p.at(name)); };
    const auto kept = [&](float t) { return std::clamp(t, of("INS_TCAL1_TMIN"), of("INS_TCAL1_TMAX")); };
    const float now = kept(static_cast<float>(temperature_C)) - 35.0F;
    const float then = kept(of(is_acc ? "INS_ACC1_CALTEMP" : "INS_GYR1_CALTEMP")) - 35.0F;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string axis = axes_upper[i];
        const std::string sensor = is_acc ? "ACC" : "GYR";
        float value = static_cast<float>(raw[i]) - ardupilot_polynomial(p, sensor, axis, now) +
                      ardupilot_polynomial(p, sensor, axis, then);
        value -= of((is_acc ? "INS_ACCOFFS_" : "INS_GYROFFS_") + axis);
        if (is_acc) { value *= of("INS_ACCSCAL_" + axis); }
        corrected[i] = static_cast<double>(value);
    }
    return corrected;
}

// A sensor whose axes are orthogonal: what those programs can describe.
FaultySensor orthogonal_sensor() {
    FaultySensor sensor = warm_sensor();
    sensor.acc_M = {{{1.012, 0.0, 0.0}, {0.0, 0.991, 0.0}, {0.0, 0.0, 1.004}}};
    return sensor;
}

// Rests of a sensor that was not calibrated with, in other poses, cold and warm.
Calibration rests_of(const FaultySensor& sensor, double temperature_C) {
    MovedSensor moved(sensor, 77, 50.0);
    moved.set_temperature_C(temperature_C);
    rest_in(moved, {{1, 2, 3}, {-2, 1, 1}, {3, -1, -1}, {0, 1, -3}}, 4.0);
    return calibrate({moved.recording("rests.csv", true)});
}

class CalibrationExports : public testing::TestWithParam<double> {};

// The mean of a rest is known to 0.02 / sqrt(200) m/s^2 an axis, the parameters to about as much, and the
// polynomials to less: 0.01 m/s^2 are 1 mg.
constexpr double gravity_within_m_s2 = 0.01;

TEST_P(CalibrationExports, Px4GivesBackGravityAndRest) {
    const Parameters parameters = px4_of(made_calibration(orthogonal_sensor()));
    for (const Rest& rest : rests_of(orthogonal_sensor(), GetParam()).phases.rests) {
        const Vector3 force = px4_corrected(parameters, 'A', rest.force_m_s2, GetParam());
        EXPECT_NEAR(norm(force), standard_gravity_m_s2, gravity_within_m_s2);
        // The g-sensitivity stays in: up to 1.3e-4 rad/s per m/s^2.
        EXPECT_LT(norm(px4_corrected(parameters, 'G', rest.rate_rad_s, GetParam())), 2e-3);
    }
}

TEST_P(CalibrationExports, ArduPilotGivesBackGravityAndRest) {
    const Parameters parameters = ardupilot_of(made_calibration(orthogonal_sensor()));
    for (const Rest& rest : rests_of(orthogonal_sensor(), GetParam()).phases.rests) {
        const Vector3 force = ardupilot_corrected(parameters, true, rest.force_m_s2, GetParam());
        EXPECT_NEAR(norm(force), standard_gravity_m_s2, gravity_within_m_s2);
        EXPECT_LT(norm(ardupilot_corrected(parameters, false, rest.rate_rad_s, GetParam())), 2e-3);
    }
}

// A backslash at the end of a line would make the next one a comment.
TEST(CalibrationHeader, ANameFromOutsideGoesOnInNoLineOfTheCHeader) {
    Calibration calibration = made_calibration();
    calibration.recordings = {std::string(90, 'a') + "\\ " + std::string(90, 'b') + "\\"};
    const std::string text = calibration_c_header(calibration);
    EXPECT_EQ(text.find("\\\n"), std::string::npos) << text.substr(0, 400);
    EXPECT_NE(text.find("aaa/"), std::string::npos);
}

// With misalignment and g-sensitivity, compiled by the C compiler that a firmware's author has.
TEST_P(CalibrationExports, TheCHeaderGivesBackGravityAndRest) {
    if (!has_program("cc")) { GTEST_SKIP() << needs_program("cc"); }
    const TemporaryFolder folder;
    std::ofstream(folder.path("calibration.h")) << calibration_c_header(made_calibration());
    std::ofstream program(folder.path("apply.c"));
    program << "#include <stdio.h>\n#include <math.h>\n#include \"calibration.h\"\nint main(void) {\n"
               "  double f[3], w[3];\n";
    const Calibration rests = rests_of(warm_sensor(), GetParam());
    program.precision(17);
    for (const Rest& rest : rests.phases.rests) {
        const auto list = [](const Vector3& v) {
            std::ostringstream text;
            text.precision(17);
            text << "(const double[3]){" << v[0] << ", " << v[1] << ", " << v[2] << "}";
            return text.str();
        };
        program << "  gyrolog_calibrate_acc(" << list(rest.force_m_s2) << ", " << GetParam() << ", f);\n"
                << "  gyrolog_calibrate_gyro(" << list(rest.rate_rad_s) << ", f, " << GetParam() << ", w);\n"
                << R"(  printf("%.9f %.9f\n", sqrt(f[0]*f[0]+f[1]*f[1]+f[2]*f[2]), )"
                << R"(sqrt(w[0]*w[0]+w[1]*w[1]+w[2]*w[2]));)" << '\n';
    }
    program << "  return 0;\n}\n";
    program.close();
    const std::string build = "cc -std=c99 -Wall -Wextra -Werror -pedantic -o " + folder.path("apply") + " " +
                              folder.path("apply.c") + " -lm && " + folder.path("apply") + " > " +
                              folder.path("out.txt");
    ASSERT_EQ(std::system(build.c_str()), 0);  // NOLINT(cert-env33-c): a test's own fixed command
    std::istringstream out(read_whole_file(folder.path("out.txt")));
    std::size_t count = 0;
    for (double force = 0.0, rate = 0.0; out >> force >> rate; ++count) {
        EXPECT_NEAR(force, standard_gravity_m_s2, gravity_within_m_s2);
        EXPECT_LT(rate, 5e-4);
    }
    EXPECT_EQ(count, rests.phases.rests.size());
}

INSTANTIATE_TEST_SUITE_P(ColdAndWarm, CalibrationExports, testing::Values(14.0, 27.0, 41.0));

TEST(CalibrationExport, SaysWhatIsLeftOutAndWhatIsNotKnown) {
    MovedSensor moved({}, 61);
    rest_in(moved, faces());
    const Calibration calibration = calibrate({moved.recording("six\nfaces.csv")});
    for (const std::string& text : {px4_parameters(calibration), ardupilot_parameters(calibration)}) {
        EXPECT_THAT(text, HasSubstr("# Not determined: "));
        EXPECT_THAT(text, Not(HasSubstr("six\nfaces"))) << "a name is no line of its own";
        EXPECT_THAT(text, Not(HasSubstr("TC_A_ENABLE"))) << "there was no ramp";
        EXPECT_THAT(text, Not(HasSubstr("TCAL1_ENABLE")));
    }
    EXPECT_THAT(px4_parameters(made_calibration()), HasSubstr("% of the"));
}

}  // namespace
}  // namespace gyrolog
