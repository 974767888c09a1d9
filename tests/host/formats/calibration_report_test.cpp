#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/formats/calibration_json.hpp"
#include "host/formats/calibration_text.hpp"
#include "host/formats/json.hpp"
#include "host/formats/text_width.hpp"
#include "tests/host/formats/made_calibration.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;

TEST(CalibrationReport, TextFitsEightyColumns) {
    MovedSensor few({}, 41);
    few.rest(3.0);
    rest_in(few, faces());
    for (const Calibration& calibration :
         {made_calibration(), calibrate({few.recording("a_long_name_of_a_file.csv")})}) {
        std::istringstream lines(calibration_text(calibration));
        for (std::string line; std::getline(lines, line);) { EXPECT_LE(width_of(line), 80U) << line; }
    }
}

TEST(CalibrationReport, TextHasEachParameterWithItsUncertaintyAndWhatToDoNext) {
    const std::string text = calibration_text(made_calibration());
    EXPECT_THAT(text, HasSubstr("accelerometer: y = M a + bias"));
    EXPECT_THAT(text, HasSubstr("gyro: y = M w + bias + K f"));
    EXPECT_THAT(text, HasSubstr("degC^3"));
    EXPECT_THAT(text, HasSubstr("±"));
    EXPECT_THAT(text, HasSubstr("next rests that help most"));
}

TEST(CalibrationReport, TextSaysWhatIsNotDeterminedAndWhatToAdd) {
    MovedSensor moved({}, 42);
    rest_in(moved, faces());
    const std::string text = calibration_text(calibrate({moved.recording()}));
    EXPECT_THAT(text, HasSubstr("not determined: accelerometer: misalignment of y from x"));
    EXPECT_THAT(text, HasSubstr("add: rests of two seconds or more with the "));
    EXPECT_THAT(text, HasSubstr("not determined: temperature"));
}

TEST(CalibrationReport, JsonHasTheKeysOfItsSchema) {
    const Calibration calibration = made_calibration();
    const Json json = Json::parse(written_out(calibration_json(calibration), 2));
    EXPECT_EQ(json["schema"], "gyrolog-calibration/1");
    EXPECT_EQ(json["rests"].size(), calibration.phases.rests.size());
    EXPECT_EQ(json["turns"], 3);
    EXPECT_NEAR(json["accelerometer"]["M"][1][0].get<double>(), 0.008, 0.002);
    EXPECT_NEAR(json["accelerometer"]["bias_g"][0].get<double>(), 0.21 / standard_gravity_m_s2, 1e-3);
    EXPECT_EQ(json["accelerometer"]["covariance"].size(), 9U);
    // At 27 degC, two above where the sensor's own polynomial begins.
    EXPECT_EQ(json["temperature"]["gyro"]["reference_C"], 27.0);
    EXPECT_NEAR(json["gyro"]["bias_dps"][0].get<double>(), (0.012 + 2.0 * 4e-4 + 4.0 * 5e-6) * deg_per_rad,
                0.01);
    EXPECT_EQ(json["gyro"]["g_sensitivity_dps_per_g"].size(), 3U);
    EXPECT_EQ(json["gyro"]["names"].size(), 21U);
    EXPECT_EQ(json["temperature"]["gyro"]["unit"], "dps");
    EXPECT_EQ(json["temperature"]["gyro"]["axes"]["x"]["order"], 3);
    EXPECT_NEAR(json["temperature"]["gyro"]["axes"]["x"]["c"][0].get<double>(), 4e-4 * deg_per_rad, 2e-3);
    EXPECT_EQ(json["undetermined"].size(), 0U);
    EXPECT_EQ(json["next_poses"].size(), 3U);
    EXPECT_TRUE(json["rests"][0].contains("residual_g"));
}

}  // namespace
}  // namespace gyrolog
