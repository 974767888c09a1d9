#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <nlohmann/json.hpp>

#include "host/formats/export_format.hpp"
#include "host/formats/filter_tuning_json.hpp"
#include "host/formats/filters/filters.hpp"
#include "host/formats/gyroparams_script.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/recording_mat.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

// N, B and K of z are known; of x only N; y has no gyro.
ExportSource made_source() {
    ExportSource source;
    source.name = "run.csv";
    source.rate_hz = 100.0;
    source.gyro = {{"x", {true, 1e-4, {}}, {false, 0.0, 3e-5}, {false, 0.0, 4e-6}, 0.01, {}},
                   {"z", {true, 2e-4, {}}, {true, 5e-5, {}}, {true, 3e-6, {}}, -0.02, 60.0}};
    return source;
}

// A white gyro of two axes with a temperature and a hole.
Recording made_recording() {
    std::string text = "t_s,gx_dps,gz_dps,temp_C\n";
    std::mt19937_64 generator(11);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 4000; ++i) {
        if (i == 1000) { continue; }
        text += std::to_string(i / 100.0) + "," + std::to_string(normal(generator)) + "," +
                std::to_string(normal(generator)) + ",25.5\n";
    }
    auto recording = parse_recording_csv(text, "run.csv");
    EXPECT_TRUE(recording.ok());
    return std::move(recording).value();
}

// A gyro and an accelerometer with random walk, a minute at rest.
Recording made_imu_recording() {
    std::string text = "t_s,gx_dps,ax_g,ay_g,az_g\n";
    std::mt19937_64 generator(12);
    std::normal_distribution<double> normal;
    double walk_g = 0.0;
    for (int i = 0; i < 6000; ++i) {
        walk_g += 1e-4 * normal(generator);
        text += std::to_string(i / 100.0) + "," + std::to_string(normal(generator)) + "," +
                std::to_string(1e-3 * normal(generator)) + "," +
                std::to_string(2e-3 * normal(generator) + walk_g) + "," +
                std::to_string(1.0 + 1e-3 * normal(generator)) + "\n";
    }
    auto recording = parse_recording_csv(text, "imu.csv");
    EXPECT_TRUE(recording.ok());
    return std::move(recording).value();
}

std::string temporary(const std::string& name) {
    return (std::filesystem::path(testing::TempDir()) / ("gyrolog_export_" + name)).string();
}

TEST(KalibrYaml, HasContinuousDensitiesOfWhiteNoiseAndRandomWalk) {
    const std::string yaml = filter_text(kalibr_format, made_source());
    EXPECT_THAT(yaml, HasSubstr("\nrostopic: /imu0\n"));
    EXPECT_THAT(yaml, HasSubstr("\nupdate_rate: 100.0 "));
    EXPECT_THAT(yaml, HasSubstr("\ngyroscope_noise_density: 0.0002\n"));
    EXPECT_THAT(yaml, HasSubstr("\ngyroscope_random_walk: 3.0e-06\n"));
    EXPECT_THAT(yaml, Not(HasSubstr("\naccelerometer")));
    EXPECT_THAT(yaml, HasSubstr("# accelerometer_noise_density: not measured"));
}

TEST(KalibrYaml, LeavesOutARandomWalkThatIsNotIdentified) {
    ExportSource source = made_source();
    source.gyro.pop_back();
    const std::string yaml = filter_text(kalibr_format, source);
    EXPECT_THAT(yaml, Not(HasSubstr("\ngyroscope_random_walk:")));
    EXPECT_THAT(yaml, HasSubstr("# gyroscope_random_walk: not identified, at most 4.0e-06 (at 68.3 %)"));
}

TEST(KalibrYaml, HasTheUpperLimitInItsPlaceWhereThatIsAskedFor) {
    ExportSource source = made_source();
    source.gyro.pop_back();
    source.upper_limits = true;
    const std::string yaml = filter_text(kalibr_format, source);
    EXPECT_THAT(yaml, HasSubstr("\ngyroscope_random_walk: 4.0e-06\n"));
    EXPECT_THAT(yaml, HasSubstr("# not identified: this is its upper limit at 68.3 %\n"));
    EXPECT_THAT(yaml, HasSubstr("# UPPER LIMITS at 68.3 % stand in the place of what is not identified"));
    EXPECT_EQ(numbers_at_upper_limit(kalibr_format, source), "gyroscope_random_walk");
    EXPECT_EQ(numbers_at_upper_limit(kalibr_format, made_source()), "") << "it is identified";
    source.inflate = 2.0;
    EXPECT_THAT(filter_text(kalibr_format, source), HasSubstr("\ngyroscope_random_walk: 8.0e-06\n"));
}

TEST(KalibrYaml, SaysThatAnAccelerometerHasCounts) {
    std::string text = "t_s,gx_dps,ax_lsb\n";
    for (int i = 0; i < 100; ++i) { text += fmt::format("{},{},{}\n", i * 0.01, i % 3, i % 5); }
    const auto recording = parse_recording_csv(text, "imu.csv");
    ASSERT_TRUE(recording.ok());
    const std::string yaml = filter_text(kalibr_format, export_source(*recording, analyze(*recording)));
    EXPECT_THAT(yaml,
                HasSubstr("# accelerometer_noise_density: the accelerometer has counts, --lsb-g gives"));
    EXPECT_THAT(yaml, Not(HasSubstr("not measured")));
}

TEST(KalibrYaml, HasTheNumbersOfTheAnalysisForTheAccelerometer) {
    const Recording recording = made_imu_recording();
    const AnalysisReport report = analyze(recording);
    ASSERT_TRUE(report.accelerometer);
    const NoiseFit& noisiest = report.accelerometer->axes.at(1).fit;
    ASSERT_EQ(noisiest.method, FitMethod::likelihood);
    ASSERT_EQ(noisiest[NoiseTerm::K].state, FittedCoefficient::State::identified);
    const std::string yaml = filter_text(kalibr_format, export_source(recording, report));
    EXPECT_THAT(yaml, HasSubstr("\naccelerometer_noise_density: " + real_text(noisiest[NoiseTerm::N].value)));
    EXPECT_THAT(yaml, HasSubstr("\naccelerometer_random_walk: " + real_text(noisiest[NoiseTerm::K].value)));
    // Within four of its standard deviations of the truth.
    EXPECT_NEAR(noisiest[NoiseTerm::N].value, 2e-4 * 9.80665, 4.0 * noisiest[NoiseTerm::N].sd);
}

TEST(KalibrYaml, OfAModelHasItsAccelerometer) {
    SensorModel model;
    for (AxisModel& axis : model.accelerometer.emplace().axes) { axis.noise.N_rad_per_sqrt_s = 2e-3; }
    EXPECT_THAT(filter_text(kalibr_format, export_source(model, "imu.json")),
                HasSubstr("\naccelerometer_noise_density: 0.002\n"));
}

TEST(GyroparamsScript, NeverTakesOneCoefficientForAnother) {
    const std::string script = gyroparams_script(made_source());
    EXPECT_THAT(script, HasSubstr("params.NoiseDensity = [0.0001 0 0.0002];"));
    EXPECT_THAT(script, HasSubstr("params.BiasInstability = [0 0 5e-05];"));
    EXPECT_THAT(script, HasSubstr("params.RandomWalk = [0 0 3e-06];"));
    EXPECT_THAT(script, HasSubstr("0 of x: not identified, at most 4e-06 (at 68.3 %), y: not measured"));
    EXPECT_THAT(script, HasSubstr("params.ConstantBias = [0.01 0 -0.02];"));
    EXPECT_THAT(script, HasSubstr("params.NoiseType = 'single-sided';"));
    EXPECT_THAT(script, HasSubstr("    params.NoiseDensity = params.NoiseDensity*sqrt(2);"));
    EXPECT_THAT(script, HasSubstr("    params.RandomWalk = params.RandomWalk/sqrt(2);"));
    EXPECT_THAT(script, Not(HasSubstr("MeasurementRange")));
}

TEST(GyroparamsScript, OfAModelHasItsRangeAndTemperature) {
    SensorModel model;
    model.full_scale_rad_s = 500.0 * rad_per_deg;
    model.lsb_rad_s = model.full_scale_rad_s / 32768.0;
    model.axes[1].noise.N_rad_per_sqrt_s = 1e-4;
    model.temperature = TemperatureModel{25.0, {0.1, 0.2, 0.3}, {0.04, 0.04, 0.04}};
    const std::string script = gyroparams_script(export_source(model, "mpu.json"));
    EXPECT_THAT(script, HasSubstr("params.MeasurementRange = 8.72664626;"));
    EXPECT_THAT(script, HasSubstr("params.Resolution = 0.000266316109;"));
    EXPECT_THAT(script, HasSubstr("params.TemperatureBias = [0.1 0.2 0.3];"));
    EXPECT_THAT(script, HasSubstr("params.TemperatureScaleFactor = [4 4 4];"));
}

// The covariance of (angle, bias) after dt, by small steps of the continuous process instead of its closed
// form.
std::array<double, 3> stepped_covariance(double N, double K, double dt_s) {
    constexpr int steps = 20000;
    const double h = dt_s / steps;
    double angle = 0.0;
    double cross = 0.0;
    double bias = 0.0;
    for (int i = 0; i < steps; ++i) {
        angle += h * (N * N - 2.0 * cross);
        cross -= h * bias;
        bias += h * K * K;
    }
    return {angle, cross, bias};
}

TEST(FilterTuning, MatrixIsTheContinuousProcessOverOneSample) {
    ExportSource source = made_source();
    source.rate_hz = 0.5;  // a long step, so that all its parts count
    source.gyro[1].K.value = 1e-4;
    const json tuning = json::parse(filter_tuning_json(source));
    const json& Q = tuning["axes"]["z"]["angle_and_bias"]["Q"];
    const auto [angle, cross, bias] = stepped_covariance(2e-4, 1e-4, 2.0);
    EXPECT_NEAR(Q[0][0].get<double>(), angle, 1e-3 * angle);
    EXPECT_NEAR(Q[0][1].get<double>(), cross, -1e-3 * cross);
    EXPECT_EQ(Q[0][1], Q[1][0]);
    EXPECT_NEAR(Q[1][1].get<double>(), bias, 1e-9 * bias);
    EXPECT_DOUBLE_EQ(tuning["axes"]["z"]["white_rate_noise"]["discrete"]["Q_angle"].get<double>(),
                     4e-8 * 2.0);
}

TEST(FilterTuning, MatrixHasAUnitForEachOfItsElements) {
    const json tuning = json::parse(filter_tuning_json(made_source()));
    const json& matrix = tuning["axes"]["z"]["angle_and_bias"];
    EXPECT_EQ(matrix["unit"], json::parse(R"([["rad^2", "rad^2/s"], ["rad^2/s", "rad^2/s^2"]])"));
    ASSERT_EQ(matrix["Q"].size(), 2U);
    for (const json& row : matrix["Q"]) { EXPECT_EQ(row.size(), 2U); }
}

TEST(FilterTuning, GaussMarkovOfBTouchesTheFlatOfTheCurve) {
    ExportSource source = made_source();
    source.gyro[1].K.identified = false;  // the flat is then where the curve was read
    const json tuning = json::parse(filter_tuning_json(source));
    const json& process = tuning["axes"]["z"]["bias_instability"]["gauss_markov"];
    const GaussMarkov noise{process["sigma"].get<double>(), process["correlation_s"].get<double>()};
    double highest = 0.0;
    double highest_tau_s = 0.0;
    for (double tau_s = 1.0; tau_s < 1000.0; tau_s *= 1.001) {
        if (noise.allan_variance(tau_s) > highest) {
            highest = noise.allan_variance(tau_s);
            highest_tau_s = tau_s;
        }
    }
    EXPECT_NEAR(std::sqrt(highest), std::sqrt(2.0 * std::numbers::ln2 / pi) * 5e-5, 1e-9);
    EXPECT_NEAR(highest_tau_s, 60.0, 0.1);
    const json& discrete = process["discrete"];
    const double phi = discrete["phi"].get<double>();
    EXPECT_NEAR(discrete["Q"].get<double>() / (1.0 - phi * phi),
                noise.sigma_rad_per_s * noise.sigma_rad_per_s,
                1e-6 * noise.sigma_rad_per_s * noise.sigma_rad_per_s);
}

// A file goes where the report does not.
TEST(Exports, CarryTheWarningsOfTheAnalysis) {
    AnalysisReport report;
    report.warnings = {"axis x: the samples are clipped", "a second\none"};
    ExportSource source = made_source();
    source.report = &report;
    EXPECT_THAT(gyroparams_script(source), HasSubstr("\n% Warning: axis x: the samples are clipped\n"));
    EXPECT_THAT(gyroparams_script(source), HasSubstr("\n% Warning: a second"));
    EXPECT_THAT(gyroparams_script(source), Not(HasSubstr("\none")));
    EXPECT_EQ(json::parse(filter_tuning_json(source))["warnings"], report.warnings);
    EXPECT_FALSE(json::parse(filter_tuning_json(made_source())).contains("warnings"));
}

TEST(FilterTuning, WhatIsNotIdentifiedHasNoNumbersToMistakeForIt) {
    const json tuning = json::parse(filter_tuning_json(made_source()));
    const json& x = tuning["axes"]["x"];
    EXPECT_EQ(x["rate_random_walk"]["state"], "not_identifiable");
    EXPECT_EQ(x["rate_random_walk"]["upper"], 4e-6);
    EXPECT_FALSE(x.contains("angle_and_bias"));
    EXPECT_FALSE(x["rate_random_walk"].contains("discrete"));
}

TEST(ExportCsv, ComesBackToTheLastBit) {
    const Recording recording = made_recording();
    ExportSource source;
    source.recording = &recording;
    for (const std::string name : {"run.csv", "run.csv.gz", "run.csv.xz"}) {
        const std::string path = temporary(name);
        const ExportFormat* format = export_format_of(path);
        ASSERT_NE(format, nullptr);
        ASSERT_TRUE(write_export(*format, source, path).ok());
        const auto back = read_recording_csv(path);
        std::filesystem::remove(path);
        ASSERT_TRUE(back.ok());
        EXPECT_EQ(back->t_s, recording.t_s);
        ASSERT_EQ(back->columns.size(), recording.columns.size());
        for (std::size_t c = 0; c < recording.columns.size(); ++c) {
            EXPECT_EQ(back->columns[c].name, recording.columns[c].name);
            EXPECT_EQ(back->columns[c].data, recording.columns[c].data);
        }
        EXPECT_EQ(back->missing_samples(), 1);
    }
}

// As a capture has them: 16 bits with the scale of a data sheet, and a temperature with an offset.
TEST(ExportCsv, OfCountsHasTheDigitsThatTheirStepNeedsAndGivesTheCountsBack) {
    std::vector<std::int16_t> counts;
    for (int count = -32768; count <= 32767; ++count) { counts.push_back(static_cast<std::int16_t>(count)); }
    Recording recording;
    recording.rate_hz = 1000.0;
    recording.segments = {{0, counts.size(), 0}};
    recording.columns = {{"gx", "rad/s", counts, 15.267176e-3 * rad_per_deg, 0.0, ""},
                         {"gy", "rad/s", counts, 7.633588e-3 * rad_per_deg, 0.0, ""},
                         {"az", "m/s^2", counts, 9.80665 / 16384.0, 0.0, ""},
                         {"temp", "degC", counts, 1.0 / 333.87, 21.0, ""}};
    ExportSource source;
    source.recording = &recording;
    const std::string path = temporary("counts.csv");
    ASSERT_TRUE(write_export(*export_format_of(path), source, path).ok());
    const auto bytes = std::filesystem::file_size(path);
    const auto back = read_recording_csv(path);
    std::filesystem::remove(path);
    ASSERT_TRUE(back.ok());
    EXPECT_LT(bytes / counts.size(), 50U);  // with all 17 digits of each: 80
    for (const Column& column : recording.columns) {
        const Column* read = back->find(column.name);
        ASSERT_NE(read, nullptr) << column.name;
        for (std::size_t row = 0; row < counts.size(); ++row) {
            const double in_counts = (read->value(row) - column.offset) / column.scale;
            ASSERT_NEAR(in_counts, counts[row], 1e-3) << column.name;
        }
    }
}

struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

std::vector<double> numbers_of(const matvar_t* variable) {
    EXPECT_NE(variable, nullptr);
    if (variable == nullptr) { return {}; }
    const auto* first = static_cast<const double*>(variable->data);
    return {first, first + variable->nbytes / sizeof(double)};
}

TEST(ExportMat, HoldsSamplesAndAnalysisInSiUnits) {
    const Recording recording = made_recording();
    const AnalysisReport report = analyze(recording);
    const std::string path = temporary("run.mat");
    ASSERT_TRUE(write_recording_mat(export_source(recording, report), path).ok());
    mat_t* file = Mat_Open(path.c_str(), MAT_ACC_RDONLY);
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(Mat_GetVersion(file), MAT_FT_MAT5);
    EXPECT_EQ(numbers_of(Variable(Mat_VarRead(file, "t")).get()), recording.t_s);
    const Variable gyro(Mat_VarRead(file, "gyro"));
    ASSERT_NE(gyro, nullptr);
    EXPECT_EQ(gyro->dims[0], recording.rows());
    EXPECT_EQ(gyro->dims[1], 2U);
    std::vector<double> both = recording.find("gx")->values();
    const std::vector<double> second = recording.find("gz")->values();
    both.insert(both.end(), second.begin(), second.end());
    EXPECT_EQ(numbers_of(gyro.get()), both);
    EXPECT_EQ(numbers_of(Variable(Mat_VarRead(file, "temperature_degC")).get()).front(), 25.5);
    const Variable analysis(Mat_VarRead(file, "analysis"));
    ASSERT_NE(analysis, nullptr);
    matvar_t* z = Mat_VarGetStructFieldByName(analysis.get(), "z", 0);
    ASSERT_NE(z, nullptr);
    matvar_t* N = Mat_VarGetStructFieldByName(z, "N", 0);
    ASSERT_NE(N, nullptr);
    const FittedCoefficient& fitted = report.axes[1].fit[NoiseTerm::N];
    EXPECT_EQ(numbers_of(Mat_VarGetStructFieldByName(N, "value", 0)), std::vector{fitted.value});
    EXPECT_EQ(numbers_of(Mat_VarGetStructFieldByName(z, "tau", 0)).size(),
              report.axes[1].curve.points.size());
    Mat_Close(file);
    std::filesystem::remove(path);
}

TEST(ExportMat, LeavesNothingBehindWhereItCannotWrite) {
    const Recording recording = made_recording();
    const AnalysisReport report = analyze(recording);
    const Status status = write_recording_mat(export_source(recording, report), "/nowhere/run.mat");
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message, HasSubstr("write '/nowhere/run.mat'"));
}

TEST(ExportFormats, AreToldByTheWholeEnding) {
    EXPECT_EQ(export_format_of("a.json"), nullptr);
    EXPECT_EQ(export_format_of("csv"), nullptr);
    ASSERT_NE(export_format_of("a.tuning.json"), nullptr);
    EXPECT_EQ(export_format_of("a.b.yaml")->ending, ".yaml");
    EXPECT_EQ(export_format_of("night.m")->ending, ".m");
}

}  // namespace
}  // namespace gyrolog
