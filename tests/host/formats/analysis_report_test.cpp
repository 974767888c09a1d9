#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/formats/analysis_json.hpp"
#include "host/formats/analysis_text.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/text_file.hpp"
#include "host/formats/text_width.hpp"
#include "tests/analysis/allan/nbs14.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string csv_of(const std::vector<double>& values, const std::string& header) {
    std::string text = header + "\n";
    for (std::size_t i = 0; i < values.size(); ++i) { text += fmt::format("{},{}\n", i, values[i]); }
    return text;
}

Recording parsed(const std::string& text) {
    Result<Recording> recording = parse_recording_csv(text, "run.csv");
    EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message);
    return std::move(recording).value();
}

json report_of(const Recording& recording, const AnalysisOptions& options = {}) {
    return json::parse(analysis_json(analyze(recording, options)));
}

TEST(AnalysisJson, CarriesThePublishedNbs14ValuesThroughTextAndUnits) {
    AnalysisOptions options;
    options.m = {1, 10, 100};
    for (const char* header : {"t_s,gx_dps", "t_s,gx_rad_s"}) {
        const json report = report_of(parsed(csv_of(test::nbs14_1000_point_frequency(), header)), options);
        const json& points = report["axes"]["x"]["allan"];
        ASSERT_EQ(points.size(), 3U);
        EXPECT_NEAR(points[0]["value"].get<double>(), 2.922319e-01, 0.5001e-7);
        EXPECT_NEAR(points[1]["value"].get<double>(), 9.159953e-02, 0.5001e-8);
        EXPECT_NEAR(points[2]["value"].get<double>(), 3.241343e-02, 0.5001e-8);
        EXPECT_EQ(points[2]["terms"], 801);
    }
}

// x follows the temperature by so much, y does not; both have noise that no seed of a library changes.
std::string warm_text(double dps_per_C) {
    std::string text = "t_s,gx_dps,gy_dps,temp_C\n";
    std::uint32_t state = 1;
    const auto noise = [&] {  // Numerical Recipes' generator: evenly distributed
        state = 1664525U * state + 1013904223U;
        return (static_cast<double>(state) / 4294967296.0 - 0.5) * 0.1;
    };
    for (int i = 0; i < 4000; ++i) {
        const double temperature_C = 30.0 - 6.0 * std::exp(-i / 900.0);
        const double x_dps = dps_per_C * temperature_C + noise();
        text += fmt::format("{},{:.6f},{:.6f},{:.4f}\n", i, x_dps, noise(), temperature_C);
    }
    return text;
}

TEST(AnalysisJson, SaysHowTheBiasFollowsTheTemperature) {
    const Recording recording = parsed(warm_text(0.05));
    const json report = report_of(recording);
    const json& x = report["axes"]["x"]["temperature"];
    EXPECT_EQ(x["state"], "identified");
    EXPECT_EQ(x["taken_off"], true);
    EXPECT_EQ(x["coefficient"]["unit"], "dps/degC");
    const double sd = x["coefficient"]["sd"].get<double>();
    EXPECT_GT(sd, 0.0);
    EXPECT_LT(sd, 0.01);
    EXPECT_NEAR(x["coefficient"]["value"].get<double>(), 0.05, 4.0 * sd);
    EXPECT_LE(x["chance"].get<double>(), x["false_alarm"].get<double>());
    EXPECT_EQ(x["false_alarm"], 0.001);
    EXPECT_LT(x["from_C"].get<double>(), x["reference_C"].get<double>());
    EXPECT_LT(x["reference_C"].get<double>(), x["to_C"].get<double>());
    EXPECT_GT(x["K_left_in"]["value"].get<double>(), x["K_taken_off"]["value"].get<double>());
    EXPECT_EQ(x["K_left_in"]["unit"], "dps*sqrt(Hz)");
    const json& y = report["axes"]["y"]["temperature"];
    EXPECT_EQ(y["state"], "not_identifiable");
    EXPECT_EQ(y["taken_off"], false);
    EXPECT_GT(y["chance"].get<double>(), 0.001);
    AnalysisOptions keep;
    keep.keep_temperature = true;
    EXPECT_EQ(report_of(recording, keep)["axes"]["x"]["temperature"]["taken_off"], false);
}

TEST(AnalysisText, SaysHowTheBiasFollowsTheTemperature) {
    const std::string text = analysis_text(analyze(parsed(warm_text(0.05))));
    EXPECT_THAT(text,
                testing::ContainsRegex("bias over temperature +dps/degC +0\\.0[45][0-9]*\\([0-9]{2}\\) +< "));
    EXPECT_THAT(text, HasSubstr("warning: axis x (0.05"));
    EXPECT_THAT(analysis_text(analyze(parsed(csv_of(test::nbs14_1000_point_frequency(), "t_s,gx_dps")))),
                testing::Not(HasSubstr("temperature")));
}

TEST(AnalysisJson, HasTheFormOfItsContract) {
    const json report = report_of(parsed(csv_of(test::nbs14_1000_point_frequency(), "t_s,gz2_dps")));
    EXPECT_EQ(report["schema"], "gyrolog-analysis/1");
    EXPECT_EQ(report["recording"]["name"], "run.csv");
    EXPECT_EQ(report["recording"]["samples"], 1000);
    EXPECT_NEAR(report["recording"]["duration_s"].get<double>(), 1000.0, 1e-6);
    EXPECT_EQ(report["recording"]["dropouts"], (json{{"events", 0}, {"samples", 0}}));
    EXPECT_EQ(report["recording"]["segments"], 1);
    EXPECT_EQ(report["deviation"], "overlapping");
    EXPECT_EQ(report["convention"], "sp1065");
    EXPECT_EQ(report["confidence"], 0.683);
    ASSERT_EQ(report["axes"].size(), 1U);
    const json& axis = report["axes"]["z2"];
    EXPECT_EQ(axis["bias"]["unit"], "dps");
    EXPECT_NEAR(axis["bias"]["value"].get<double>(), 0.48977446286, 1e-11);
    EXPECT_NEAR(axis["bias"]["coverage_factor"].get<double>(), 2.0, 0.01);
    for (const char* key : {"m", "tau_s", "value", "lo", "hi", "edf", "terms", "unit"}) {
        EXPECT_TRUE(axis["allan"][0].contains(key)) << key;
    }
    const char* units[] = {"dps*s", "dps/sqrt(Hz)", "dps", "dps*sqrt(Hz)", "dps/s"};
    const char* names[] = {"Q", "N", "B", "K", "R"};
    for (int i = 0; i < 5; ++i) {
        const json& coefficient = axis["coefficients"][names[i]];
        EXPECT_EQ(coefficient["unit"], units[i]);
        const bool identified = coefficient["state"] == "identified";
        EXPECT_EQ(coefficient.contains("value"), identified);
        EXPECT_EQ(coefficient.contains("upper"), !identified);
    }
    EXPECT_EQ(axis["coefficients"]["N"]["state"], "identified");
    EXPECT_TRUE(axis["slope_read"].contains("N"));
    EXPECT_FALSE(axis["slope_read"].contains("K"));
}

TEST(AnalysisJson, GivesUnitsAsTheTextHadThem) {
    const auto y = test::nbs14_10_point_frequency();
    EXPECT_EQ(report_of(parsed(csv_of(y, "t_s,gx_rad_s")))["axes"]["x"]["bias"]["unit"], "rad/s");
    EXPECT_EQ(report_of(parsed(csv_of(y, "t_s,gx_deg")))["axes"]["x"]["bias"]["unit"], "dps");
}

TEST(AnalysisJson, TellsTheDropouts) {
    std::string text = csv_of(test::nbs14_1000_point_frequency(), "t_s,gx_dps");
    const std::size_t row = text.find("\n500,");
    text.erase(row, text.find("\n503,") - row);
    const json report = report_of(parsed(text));
    EXPECT_EQ(report["recording"]["dropouts"], (json{{"events", 1}, {"samples", 3}}));
    EXPECT_EQ(report["recording"]["segments"], 2);
}

// The accelerometer's z is up and a little tilted to x.
std::string imu_text() {
    const std::vector<double> noise = test::nbs14_1000_point_frequency();
    std::string text = "t_s,gx_dps,ax_g,ay_g,az_g\n";
    for (std::size_t i = 0; i + 2 < noise.size(); ++i) {
        text += fmt::format("{},{},{},{},{}\n", static_cast<double>(i) / 100.0, noise[i],
                            0.1 + 1e-3 * noise[i], 1e-3 * noise[i + 1], 1.0 + 1e-3 * noise[i + 2]);
    }
    return text;
}

TEST(AnalysisJson, HasTheAccelerometerBesideTheAxes) {
    const json report = report_of(parsed(imu_text()));
    EXPECT_EQ(report["axes"].size(), 1U);
    const json& axes = report["accelerometer"]["axes"];
    ASSERT_EQ(axes.size(), 3U);
    EXPECT_EQ(axes["x"]["coefficients"]["N"]["unit"], "g/sqrt(Hz)");
    EXPECT_EQ(axes["x"]["coefficients"]["Q"]["unit"], "g*s");
    EXPECT_EQ(axes["x"]["allan"][0]["unit"], "g");
    EXPECT_EQ(axes["x"]["mean"]["unit"], "g");
    EXPECT_FALSE(axes["x"].contains("bias"));
    // The same numbers as the gyro's, a thousandth in size.
    EXPECT_NEAR(axes["x"]["allan"][0]["value"].get<double>() * 1e3,
                report["axes"]["x"]["allan"][0]["value"].get<double>(), 1e-6);
    const json& gravity = report["accelerometer"]["gravity"];
    EXPECT_EQ(gravity["size"]["unit"], "g");
    EXPECT_NEAR(gravity["size"]["value"].get<double>(), std::hypot(0.1005, 1.0005), 1e-3);
    EXPECT_GT(gravity["size"]["expanded_uncertainty"].get<double>(), 0.0);
    EXPECT_EQ(gravity["tilt"]["unit"], "deg");
    EXPECT_NEAR(gravity["tilt"]["value"].get<double>(), 5.73, 0.1);
    EXPECT_EQ(gravity["up"], "+z");
    EXPECT_FALSE(report_of(parsed(csv_of({1.0, 2.0, 3.0}, "t_s,gx_dps"))).contains("accelerometer"));
}

TEST(AnalysisText, GivesTheAccelerometerInTheUnitsOfTheTrade) {
    const std::string text = analysis_text(analyze(parsed(imu_text())));
    for (const char* part : {"\ngyro\n", "\naccelerometer\n", "velocity random walk", "ug/√Hz", "m/s/√h",
                             "m/s^2/√Hz", "ug*√Hz", "gravity: 1.00", "+z is up, tilted by 5.7"}) {
        EXPECT_THAT(text, HasSubstr(part));
    }
    AnalysisOptions options;
    options.sensors = Sensors::accelerometer;
    const std::string alone = analysis_text(analyze(parsed(imu_text()), options));
    EXPECT_THAT(alone, testing::Not(HasSubstr("angle random walk")));
    EXPECT_THAT(alone, HasSubstr("Cramer-Rao bound"));
}

TEST(AnalysisText, FitsATerminalOf80Columns) {
    std::string three_axes = "t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g\n";
    const std::vector<double> noise = test::nbs14_1000_point_frequency();
    for (std::size_t i = 0; i < noise.size(); ++i) {
        const double x = noise[i];
        const double y = noise[(i + 300) % noise.size()];
        three_axes += fmt::format("{},{},{},{},{},{},{}\n", 0.01 * static_cast<double>(i), -437.0 + x, y,
                                  1e-3 * x, 1e-2 * y, 1e-2 * x, 1.0 + 1e-2 * x);
    }
    const std::string text = analysis_text(analyze(parsed(three_axes)));
    for (std::size_t from = 0; from < text.size(); from = text.find('\n', from) + 1) {
        const std::string line = text.substr(from, text.find('\n', from) - from);
        EXPECT_LE(width_of(line), 80U) << line;
    }
    EXPECT_THAT(text, testing::ContainsRegex("\n +x +y +z\n  bias .*-43.*\n")) << "not in one table";
}

std::string in_one_line(const std::string& text) {
    std::string line;
    std::istringstream words(text);
    for (std::string word; words >> word;) { line += word + ' '; }
    return line;
}

// A model has 0 where diagnose may find a B or K: without the sentence the two seem to contradict each other.
TEST(AnalysisText, SaysWhatDiagnoseMayFindBelowALimit) {
    AnalysisReport report = analyze(parsed(warm_text(0.0)));
    const auto text_with = [&](bool B_is_limit, bool K_is_limit) {
        for (AxisReport& axis : report.axes) {
            FittedCoefficient known;
            known.state = FittedCoefficient::State::identified;
            known.value = 1e-4;
            FittedCoefficient limit;
            limit.upper = 2e-4;
            const auto set = [&](NoiseTerm term, bool is_limit) {
                axis.fit.terms.at(static_cast<std::size_t>(term)) = is_limit ? limit : known;
            };
            set(NoiseTerm::B, B_is_limit && axis.axis == "y");
            set(NoiseTerm::K, K_is_limit && axis.axis == "x");
        }
        return in_one_line(analysis_text(report));
    };
    EXPECT_THAT(text_with(false, false), testing::Not(HasSubstr("diagnose")));
    EXPECT_THAT(text_with(true, false), HasSubstr("may find a B (flicker_missing): a size below the limit"));
    EXPECT_THAT(text_with(false, true), HasSubstr("may find a K (rrw_missing): a size below the limit"));
    EXPECT_THAT(text_with(true, true),
                HasSubstr("may find a B (flicker_missing) or K (rrw_missing): a size"));
}

TEST(AnalysisText, OfCountsHasNoUnitsOfTheTrade) {
    const std::string text = "t_s,gx_dps,ax_lsb\n0,1,3\n1,2,5\n2,1,4\n3,2,3\n";
    const std::string report = analysis_text(analyze(parsed(text)));
    EXPECT_THAT(report, HasSubstr("lsb/√Hz"));
    EXPECT_THAT(report, testing::Not(HasSubstr("m/s")));
}

TEST(AnalysisText, NamesEveryAxisWithItsUnits) {
    const std::string text =
        analysis_text(analyze(parsed(csv_of(test::nbs14_1000_point_frequency(), "t_s,gx_dps"))));
    EXPECT_THAT(text, HasSubstr("run.csv: 1,000 samples"));
    EXPECT_THAT(text, HasSubstr("no dropouts"));
    EXPECT_THAT(text, HasSubstr("deg/√h"));
    EXPECT_THAT(text, HasSubstr("deg/h"));
    EXPECT_THAT(text, HasSubstr("not identifiable"));
}

// Of x the last point is lowest by chance, of y no point is known well enough.
TEST(AnalysisText, GivesTheLowestDeviationThatIsKnown) {
    AnalysisReport report;
    report.rate_hz = 1.0;
    report.unit = {"dps", 1.0};
    report.axes.resize(2);
    report.axes[0].axis = "x";
    report.axes[0].curve.points = {{1, 1.0, 0.4, 0.39, 0.41, 900.0, 999},
                                   {10, 10.0, 0.2, 0.17, 0.23, 10.0, 90},
                                   {30, 30.0, 0.1, 0.05, 0.3, 2.0, 40}};
    report.axes[1].axis = "y";
    report.axes[1].curve.points = {{1, 1.0, 0.4, 0.3, 0.6, 9.0, 9}};
    const std::string text = analysis_text(report);
    EXPECT_THAT(text, testing::ContainsRegex("lowest deviation +dps +0\\.2 +-\n"
                                             " +from +dps +0\\.17 +-\n"
                                             " +to +dps +0\\.23 +-\n"
                                             " +at tau +s +10 +-\n"));
    EXPECT_THAT(text, HasSubstr("where 10 degrees of freedom"));
}

class AnalysisOfRealRecordings : public testing::Test {
protected:
    void SetUp() override {
        if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    }

    AnalysisReport report(const std::string& file, const CsvReadOptions& options = {}) const {
        const Result<Recording> recording = read_recording_csv(shared_data(file), options);
        EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message);
        return recording.ok() ? analyze(*recording) : AnalysisReport{};
    }
};

// The deviations that its source states at 1.28 s, with the repository's scale for each axis.
TEST_F(AnalysisOfRealRecordings, WhiteNoiseOfAPublishedSensorIsWhatItsSourceSays) {
    const AnalysisReport r = report("mpu6050_uncuyo/static_7min.csv.xz", {.lsb_dps = deg_per_rad});
    ASSERT_EQ(r.axes.size(), 3U);
    const double rad_s_per_lsb[] = {1.37374e-4, 1.32925e-4, 1.33944e-4};
    const double expected[] = {1.39e-4, 2.00e-4, 1.60e-4};
    for (std::size_t i = 0; i < 3; ++i) {
        const FittedCoefficient& N = r.axes[i].fit[NoiseTerm::N];
        EXPECT_EQ(N.state, FittedCoefficient::State::identified);
        EXPECT_NEAR(N.value * rad_s_per_lsb[i] / expected[i], 1.0, 0.1) << r.axes[i].axis;
        EXPECT_NEAR(r.axes[i].slopes.N->coefficient * rad_s_per_lsb[i] / expected[i], 1.0, 0.1);
    }
    // Turn-on biases that the source states in counts; they move by 10 counts between its own runs.
    EXPECT_NEAR(r.axes[0].bias.value, -427.46, 15.0);
    EXPECT_NEAR(r.axes[1].bias.value, 147.95, 15.0);
    EXPECT_NEAR(r.axes[2].bias.value, -80.72, 20.0);
}

// Their sources state no noise of the accelerometers. The expected numbers are the mean levels, above a
// fiftieth of the rate, of Welch spectra of the same samples (numpy, Hann windows of 1024 samples, of 256
// where the record is short), two-sided: an estimator that has nothing in common with the likelihood.
void expect_white_noise(const std::vector<AxisReport>& axes, const std::string& unit,
                        const std::array<double, 3>& expected) {
    constexpr std::array names = {"x", "y", "z"};
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto axis = std::ranges::find(axes, names[i] + unit, &AxisReport::axis);
        ASSERT_NE(axis, axes.end()) << names[i] << unit;
        const FittedCoefficient& N = axis->fit[NoiseTerm::N];
        EXPECT_EQ(N.state, FittedCoefficient::State::identified);
        EXPECT_NEAR(N.value / expected[i], 1.0, 0.1) << axis->axis;
    }
}

TEST_F(AnalysisOfRealRecordings, AnAccelerometersWhiteNoiseIsTheLevelOfItsSpectrum) {
    const AnalysisReport uncuyo = report("mpu6050_uncuyo/static_7min.csv.xz", {.lsb_dps = deg_per_rad});
    ASSERT_TRUE(uncuyo.accelerometer);
    expect_white_noise(uncuyo.accelerometer->axes, "", {5.345, 4.927, 7.536});
    const AnalysisReport frdm = report("mpu6050_frdm/static_11min.csv.xz");
    ASSERT_TRUE(frdm.accelerometer);
    expect_white_noise(frdm.accelerometer->axes, "", {3.078e-3, 3.056e-3, 4.898e-3});
    ASSERT_EQ(frdm.accelerometer->gravity.size(), 1U);
    EXPECT_STREQ(frdm.accelerometer->gravity[0].gravity.up_name(), "-z");
}

// The still pose that its statistics name, 469 to 495 s.
TEST_F(AnalysisOfRealRecordings, EachAccelerometerOfAnArrayHasItsOwnWhiteNoise) {
    const auto recording =
        read_recording_csv(shared_data("mimu8_array/exp1.csv.xz"), {.lsb_dps = deg_per_rad});
    ASSERT_TRUE(recording.ok());
    const Recording still = rows_of(*recording, segments_where(recording->segments, [&](std::size_t row) {
        return recording->t_s[row] >= 469.0 && recording->t_s[row] < 495.0;
    }));
    AnalysisOptions options;
    options.sensors = Sensors::accelerometer;
    const AnalysisReport report = analyze(still, options);
    ASSERT_TRUE(report.accelerometer);
    EXPECT_EQ(report.accelerometer->gravity.size(), 8U);
    expect_white_noise(report.accelerometer->axes, "1", {0.962, 0.880, 1.275});
    expect_white_noise(report.accelerometer->axes, "2", {0.884, 0.857, 1.220});
    expect_white_noise(report.accelerometer->axes, "5", {0.907, 0.867, 1.258});
}

// Its rate is not in the file; at 204.8 Hz its turns are whole ones.
TEST_F(AnalysisOfRealRecordings, AFewSecondsOfAnAccelerometerAreEnoughForItsWhiteNoise) {
    auto file = TextReader::open(shared_data("nilspod_ferraris/annotated_session.csv.xz"));
    ASSERT_TRUE(file.ok());
    std::string text;
    for (auto piece = file->read(); piece.ok() && !piece->empty(); piece = file->read()) {
        text.append(*piece);
    }
    std::string face = "ax_lsb,ay_lsb,az_lsb\n";
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        if (!line.starts_with("x_a,")) { continue; }
        // part,samples,acc_x,acc_y,acc_z,gyr_x,gyr_y,gyr_z
        std::size_t from = line.find(',', line.find(',') + 1) + 1;
        std::size_t to = from;
        for (int field = 0; field < 3; ++field) { to = line.find(',', to) + 1; }
        face += line.substr(from, to - 1 - from) + "\n";
    }
    const auto recording = parse_recording_csv(face, "x_a", {.rate_hz = 204.8, .needs_gyro = false});
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->rows(), 1061U);
    const AnalysisReport report = analyze(*recording);
    ASSERT_TRUE(report.accelerometer);
    expect_white_noise(report.accelerometer->axes, "", {0.455, 0.436, 0.520});
    EXPECT_STREQ(report.accelerometer->gravity.at(0).gravity.up_name(), "-x");
}

TEST_F(AnalysisOfRealRecordings, BurstyStampsDoNotSpoilTheCurve) {
    const AnalysisReport r = report("mpu6050_frdm/static_11min.csv.xz");
    ASSERT_EQ(r.axes.size(), 3U);
    EXPECT_NEAR(r.rate_hz, 99.317, 3.0 * *r.rate_sd_hz);
    // Its statistics state a mean of 4.53532 deg/s and a standard deviation of 0.126355 deg/s for x.
    EXPECT_NEAR(r.axes[0].bias.value * deg_per_rad, 4.53532, 1e-3);
    EXPECT_NEAR(r.axes[0].curve.points.front().deviation * deg_per_rad, 0.126355, 0.0126);
    EXPECT_EQ(r.axes[0].fit[NoiseTerm::N].state, FittedCoefficient::State::identified);
}

}  // namespace
}  // namespace gyrolog
