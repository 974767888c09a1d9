#include "host/formats/recording_csv.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Recording parsed(std::string_view text, const CsvReadOptions& options = {}) {
    Result<Recording> recording = parse_recording_csv(text, "test.csv", options);
    EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message);
    return recording.ok() ? std::move(recording).value() : Recording{};
}

std::string refusal(std::string_view text, const CsvReadOptions& options = {}) {
    const Result<Recording> recording = parse_recording_csv(text, "test.csv", options);
    return recording.ok() ? "accepted" : recording.error().message;
}

const std::vector<double>& reals(const Recording& recording, std::string_view column) {
    return std::get<std::vector<double>>(recording.find(column)->data);
}

TEST(RecordingCsv, KeepsDegreesPerSecondToTheLastDigit) {
    const Recording recording = parsed("t_s,gx_dps\n0,0.1\n0.01,-0.30000000000000004\n0.02,1e-300\n0.03,7\n");
    EXPECT_THAT(reals(recording, "gx"), ElementsAre(0.1, -0.30000000000000004, 1e-300, 7.0));
    EXPECT_EQ(recording.find("gx")->source_unit, "dps");
    EXPECT_DOUBLE_EQ(recording.find("gx")->value(3), 7.0 * rad_per_deg);
    EXPECT_NEAR(recording.rate_hz, 100.0, 1e-9);
    EXPECT_EQ(recording.stamps, StampKind::sampling);
}

TEST(RecordingCsv, ReadsEveryUnitOfTheFormatIntoSi) {
    const CsvReadOptions options{.rate_hz = 10.0, .lsb_dps = 0.5, .lsb_g = 0.25};
    const Recording r = parsed(
        "gx_rad_s,gy_lsb,gz2_dps,ax_g,ay_m_s2,az_lsb,temp_C,ref_x_dps,ref_y_rad_s,ref_qw\n"
        "2,2,2,2,2,2,2,2,2,2\n",
        options);
    const auto si = [&](std::string_view name) { return r.find(name)->value(0); };
    EXPECT_DOUBLE_EQ(si("gx"), 2.0);
    EXPECT_DOUBLE_EQ(si("gy"), 2.0 * 0.5 * pi / 180.0);
    EXPECT_DOUBLE_EQ(si("gz2"), 2.0 * pi / 180.0);
    EXPECT_DOUBLE_EQ(si("ax"), 2.0 * 9.80665);
    EXPECT_DOUBLE_EQ(si("ay"), 2.0);
    EXPECT_DOUBLE_EQ(si("az"), 0.5 * 9.80665);
    EXPECT_DOUBLE_EQ(si("temp"), 2.0);
    EXPECT_DOUBLE_EQ(si("ref_x"), 2.0 * pi / 180.0);
    EXPECT_DOUBLE_EQ(si("ref_y"), 2.0);
    EXPECT_DOUBLE_EQ(si("ref_qw"), 2.0);
    EXPECT_TRUE(r.find("gy")->is_counts());
    EXPECT_EQ(r.find("temp")->unit, "degC");
}

TEST(RecordingCsv, PutsGyroColumnsFirst) {
    const Recording r = parsed("temp_C,gz_dps,t_s,gx_dps\n20,1,0,2\n20,1,1,2\n");
    EXPECT_EQ(r.columns[0].name, "gz");
    EXPECT_EQ(r.columns[1].name, "gx");
    EXPECT_EQ(r.columns[2].name, "temp");
}

TEST(RecordingCsv, TurnsAnglesAndIncrementsIntoRates) {
    const Recording angle = parsed("t_s,gx_deg\n0,10\n1,12\n2,15\n3,15\n");
    EXPECT_THAT(reals(angle, "gx"), ElementsAre(2.0, 3.0, 0.0));
    EXPECT_EQ(angle.find("gx")->source_unit, "dps");
    EXPECT_THAT(angle.t_s, ElementsAre(1.0, 2.0, 3.0));
    const Recording increment = parsed("dgx_rad\n0.5\n0.25\n", {.rate_hz = 2.0});
    EXPECT_THAT(reals(increment, "gx"), ElementsAre(1.0, 0.5));
}

TEST(RecordingCsv, DropsTheAngleIncrementThatCoversAHole) {
    const Recording r = parsed("dgx_rad\n1\n1\n\n9\n1\n", {.rate_hz = 1.0});
    EXPECT_THAT(reals(r, "gx"), ElementsAre(1.0, 1.0, 1.0));
    EXPECT_EQ(r.segments[1].first_index, 4);
    EXPECT_EQ(r.dropouts.at(0).samples, 2);
}

TEST(RecordingCsv, TakesEmptyAndNanGyroFieldsForMissingSamples) {
    const Recording r = parsed("t_s,gx_lsb,gy_lsb,temp_C\n0,1,2,\n1,,2,20\n2,1,nan,20\n3,1,2,nan\n4,5,6,20\n",
                               {.lsb_dps = 1.0});
    EXPECT_EQ(r.rows(), 3U);
    ASSERT_THAT(r.segments, SizeIs(2));
    EXPECT_EQ(r.segments[1].first_index, 3);
    EXPECT_EQ(r.missing_samples(), 2);
    EXPECT_EQ(r.dropouts.at(0).cause, "empty_fields");
    EXPECT_THAT(std::get<std::vector<std::int16_t>>(r.find("gx")->data), ElementsAre(1, 1, 5));
    EXPECT_TRUE(std::isnan(r.find("temp")->value(0)));
    EXPECT_THAT(r.t_s, ElementsAre(0.0, 3.0, 4.0));
}

TEST(RecordingCsv, TheRateGivenReplacesTheStamps) {
    const Recording r = parsed("t_s,gx_dps\n0,1\n0,2\n-50,3\n", {.rate_hz = 200.0});
    EXPECT_EQ(r.rate_hz, 200.0);
    EXPECT_EQ(r.stamps, StampKind::none);
    EXPECT_THAT(r.t_s, IsEmpty());
}

TEST(RecordingCsv, TheRateGivenKeepsTheHolesThatTheStampsShow) {
    std::string text = "t_s,gx_dps\n";
    for (int i = 0; i < 200; ++i) {
        if (i < 100 || i >= 105) { text += std::to_string(i / 100.0) + ",1\n"; }
    }
    const Recording r = parsed(text, {.rate_hz = 101.0});
    EXPECT_EQ(r.rate_hz, 101.0);
    EXPECT_FALSE(r.rate_sd_hz.has_value());
    ASSERT_THAT(r.segments, SizeIs(2));
    EXPECT_EQ(r.segments[1].first_index, 105);
    EXPECT_EQ(r.missing_samples(), 5);
    EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("taken as 101 Hz, as given; the time stamps say 100 Hz")));
    EXPECT_THAT(parsed(text, {.rate_hz = 100.0}).warnings, IsEmpty());
}

TEST(RecordingCsv, TheRateGivenWarnsWhereStampsAreNone) {
    const Recording r = parsed("t_s,gx_dps\n0,1\n0,2\n-50,3\n", {.rate_hz = 200.0});
    EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("missing samples cannot be seen")));
}

TEST(RecordingCsv, MeansOfLinesAreThoseOfSamples) {
    std::string text = "t_s,gx_dps,gy_lsb,gz_rad,temp_C\n";
    for (int i = 0; i < 1001; ++i) {
        text += fmt::format("{},{},{},{},{}\n", 0.001 * i, 0.01 * (i % 17), i % 5, 1e-3 * i * i,
                            i % 10 == 3 ? "" : "25");
    }
    CsvReadOptions options{.lsb_dps = 0.5};
    options.samples_per_row = 10;
    const Recording means = parsed(text, options);
    // The angle's first row has no rate.
    EXPECT_EQ(means.rows(), 99U);
    EXPECT_EQ(means.samples_per_row, 10U);
    EXPECT_NEAR(means.rate_hz, 100.0, 1e-9);
    EXPECT_EQ(means.stamps, StampKind::none);
    EXPECT_THAT(means.t_s, IsEmpty());
    EXPECT_THAT(means.find("temp")->values(), testing::Each(25.0));
    for (std::size_t row = 0; row < means.rows(); ++row) {
        double sum = 0.0;
        for (std::size_t i = 10 * (row + 1); i < 10 * (row + 2); ++i) {
            sum += 0.01 * static_cast<double>(i % 17);
        }
        EXPECT_NEAR(means.find("gx")->value(row), 0.1 * sum * rad_per_deg, 1e-15) << row;
        EXPECT_NEAR(means.find("gy")->value(row), rad_per_deg, 1e-12) << row;
    }
    // From the mean of the angle over lines 0 to 9 to that over the next ten.
    EXPECT_NEAR(means.find("gz")->value(0), 1e-3 * (14.5 * 14.5 - 4.5 * 4.5) * 100.0, 1e-9);
}

TEST(RecordingCsv, MeansOfIncrementsAreRates) {
    CsvReadOptions options{.rate_hz = 100.0};
    options.samples_per_row = 2;
    const Recording means = parsed("dgx_rad\n0.01\n0.03\n0.05\n0.07\n0.09\n", options);
    ASSERT_EQ(means.rows(), 2U);
    EXPECT_DOUBLE_EQ(means.find("gx")->value(0), 2.0);
    EXPECT_DOUBLE_EQ(means.find("gx")->value(1), 6.0);
    EXPECT_DOUBLE_EQ(means.rate_hz, 50.0);
}

TEST(RecordingCsv, MeansAreOfTheLinesThatHaveAGyro) {
    CsvReadOptions options{.rate_hz = 100.0};
    options.samples_per_row = 3;
    const Recording means = parsed(
        "gx_dps,temp_C\n1,20\n2,\n3,\n5,20\nnan,20\n7,20\nnan,20\nnan,20\n9,20\n9,\n10,30\n11,\n", options);
    EXPECT_THAT(reals(means, "gx"), ElementsAre(2.0, 6.0, 10.0));
    EXPECT_THAT(reals(means, "temp"), ElementsAre(20.0, 20.0, 30.0));
    EXPECT_EQ(means.segments.back().first_index, 3);
}

TEST(RecordingCsv, RatesBeyondAnyGyroAreRefused) {
    EXPECT_THAT(refusal("t_s,gx_dps\n0,1\n1,1.1e15\n"), HasSubstr("line 3, column 'gx_dps'"));
    EXPECT_THAT(refusal("t_s,gx_rad_s\n0,-1e160\n1,1\n"), HasSubstr("line 2, column 'gx_rad_s'"));
    EXPECT_EQ(refusal("t_s,gx_dps\n0,-1e15\n1,1e15\n"), "accepted");
}

TEST(RecordingCsv, WarnsOnceAboutUnknownColumns) {
    const Recording r = parsed("t_s,seq,gx_dps,moving,gx\n0,a,1,b,c\n1,a,1,b,c\n");
    EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("seq, moving, gx")));
}

TEST(RecordingCsv, ReadsCarriageReturnsBlanksPlusSignsAndAByteOrderMark) {
    const Recording r = parsed("\xEF\xBB\xBFt_s, gx_dps \r\n0, +1.5\r\n1 ,-2\r\n\r\n");
    EXPECT_THAT(reals(r, "gx"), ElementsAre(1.5, -2.0));
}

TEST(RecordingCsv, AMalformedLineIsNamedWithItsColumn) {
    EXPECT_THAT(refusal("t_s,gx_dps\n0,1\n1,abc\n"),
                HasSubstr("line 3, column 'gx_dps': 'abc' is no number"));
    EXPECT_THAT(refusal("t_s,gx_dps\n0,1\n1,2x\n"), HasSubstr("line 3, column 'gx_dps'"));
    EXPECT_THAT(refusal("t_s,gx_dps\n0,inf\n"), HasSubstr("line 2, column 'gx_dps'"));
    EXPECT_THAT(
        refusal("t_s,gx_dps\n0,1\n1\n"),
        HasSubstr("line 3: 1 field where line 1 names 2 columns; the first without one is column 'gx_dps'"));
    EXPECT_THAT(refusal("t_s,gx_dps\n0,1,\n"), HasSubstr("line 2: 3 fields where line 1 names 2"));
    EXPECT_THAT(refusal("t_s,gx_dps\n0,1\n,1\n"), HasSubstr("line 3, column 't_s': no time stamp"));
}

TEST(RecordingCsv, AnAccelerometerAloneIsARecordingWhereNoGyroIsNeeded) {
    const std::string text = "t_s,ax_g,az_g\n0,0.1,1\n1,0.2,1\n2,,1\n3,0.4,1\n";
    EXPECT_THAT(refusal(text), HasSubstr("line 1: no gyro column, but t_s, ax_g, az_g: "));
    const Recording recording = parsed(text, {.needs_gyro = false});
    EXPECT_THAT(reals(recording, "ax"), ElementsAre(0.1, 0.2, 0.4));
    EXPECT_EQ(recording.missing_samples(), 1);
    EXPECT_THAT(refusal("t_s,ax_m\n0,1\n", {.needs_gyro = false}),
                HasSubstr("line 1: no gyro column and none of an accelerometer, but t_s, ax_m: "));
}

TEST(RecordingCsv, AnAccelerometerThatIsNotWantedIsNotReadAtAll) {
    const Recording recording =
        parsed("t_s,gx_dps,ax_g,note\n0,1,unreadable,1\n1,2,0.5,2\n", {.with_accelerometer = false});
    EXPECT_EQ(recording.columns.size(), 1U);
    EXPECT_THAT(recording.warnings, ElementsAre("ignored columns of unknown name: note"));
}

TEST(RecordingCsv, SaysWhatIsMissingAndWhatGivesIt) {
    EXPECT_THAT(refusal(""), HasSubstr("empty"));
    EXPECT_THAT(refusal("0,1\n1,2\n"), HasSubstr("line 1 holds numbers"));
    EXPECT_THAT(refusal("gx_dps\n1\n"), HasSubstr("--rate"));
    EXPECT_THAT(refusal("t_s,gx_lsb\n0,1\n1,2\n"), HasSubstr("--lsb-dps"));
    EXPECT_THAT(refusal("t_s,gx_dps,gx_dps\n0,1,1\n"), HasSubstr("'gx_dps' appears twice"));
    EXPECT_THAT(refusal("t_s,gx_dps\n"), HasSubstr("no samples"));
    EXPECT_EQ(parsed("t_s,gx_lsb\n0,1\n1,2\n", {.allow_unscaled_counts = true}).find("gx")->unit, "lsb");
}

TEST(RecordingCsv, PiecesMayEndAnywhere) {
    const auto directory = std::filesystem::temp_directory_path() / "gyrolog_recording_csv_test";
    std::filesystem::create_directories(directory);
    const std::string path = directory / "long.csv";
    std::string text = "t_s,gx_dps\n";
    for (int i = 0; i < 60000; ++i) { text += std::to_string(i) + "," + std::to_string(i % 977) + ".25\n"; }
    std::ofstream(path) << text;
    const Result<Recording> recording = read_recording_csv(path);
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    ASSERT_EQ(recording->rows(), 60000U);
    for (std::size_t i = 0; i < 60000; ++i) {
        ASSERT_EQ(reals(*recording, "gx")[i], static_cast<double>(i % 977) + 0.25) << i;
    }
    std::filesystem::remove_all(directory);
}

TEST(RecordingCsv, ComesBackFromEveryCompressionAsItWent) {
    const auto directory = std::filesystem::temp_directory_path() / "gyrolog_recording_csv_round_trip";
    std::filesystem::create_directories(directory);
    const Recording before = parsed(
        "t_s,gx_dps,gy_rad_s,ax_g,temp_C\n0.1,0.1,1e-17,1,\n0.2,0.2,3,1,20.5\n0.35,0.3,-0.7,1,20\n0.4,1,1,1,"
        "nan\n");
    for (const char* ending : {"", ".xz", ".gz", ".zst", ".bz2"}) {
        const std::string path = (directory / "r.csv").string() + ending;
        ASSERT_TRUE(write_recording_csv(before, path).ok());
        const Result<Recording> after = read_recording_csv(path);
        ASSERT_TRUE(after.ok()) << after.error().message;
        EXPECT_EQ(after->t_s, before.t_s);
        ASSERT_EQ(after->columns.size(), before.columns.size());
        for (std::size_t c = 0; c < before.columns.size(); ++c) {
            EXPECT_EQ(after->columns[c].name, before.columns[c].name);
            EXPECT_EQ(after->columns[c].source_unit, before.columns[c].source_unit);
            if (c < 3) { EXPECT_EQ(after->columns[c].data, before.columns[c].data); }
        }
    }
    std::filesystem::remove_all(directory);
}

TEST(RecordingCsv, AFileThatIsNotThereIsNamed) {
    const Result<Recording> recording = read_recording_csv("/nowhere/run.csv");
    ASSERT_FALSE(recording.ok());
    EXPECT_EQ(recording.error().code, ErrorCode::not_found);
    EXPECT_EQ(recording.error().message, "read '/nowhere/run.csv': no such file");
}

class RealRecordings : public testing::Test {
protected:
    void SetUp() override {
        if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    }

    Recording read(const std::string& file, const CsvReadOptions& options = {}) const {
        Result<Recording> recording = read_recording_csv(shared_data(file), options);
        EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message);
        return recording.ok() ? std::move(recording).value() : Recording{};
    }
};

TEST_F(RealRecordings, DropoutsOfAFlightControllersLogAreFound) {
    const Recording r = read("px4_auav_bench/sample.csv.xz");
    EXPECT_EQ(r.stamps, StampKind::sampling);
    EXPECT_THAT(r.dropouts, SizeIs(8));
    EXPECT_NEAR(static_cast<double>(r.missing_samples()), 51.0, 2.0);
    EXPECT_NEAR(r.dropouts.at(1).at_s, 41.24, 0.01);
}

TEST_F(RealRecordings, BurstsOfASerialPortGiveTheMeanRateAndAWarning) {
    const Recording r = read("mpu6050_frdm/static_11min.csv.xz");
    EXPECT_EQ(r.stamps, StampKind::arrival);
    EXPECT_NEAR(r.rate_hz, 99.317, 0.02);
    EXPECT_THAT(r.dropouts, IsEmpty());
    EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("arrival times")));
    EXPECT_EQ(r.rows(), 65067U);
    EXPECT_EQ(read("mpu6050_frdm/static_set1_xup.csv.xz").stamps, StampKind::arrival);
    EXPECT_EQ(read("mpu6050_frdm/rot2x360_y.csv.xz").stamps, StampKind::arrival);
}

TEST_F(RealRecordings, CompleteLogsShowNoDropout) {
    for (const char* file : {"mpu6050_uncuyo/static_7min.csv.xz", "mimu8_array/exp1.csv.xz",
                             "broad_ref_motion/26_disturbed_phone_vibration_A.csv.xz"}) {
        const Recording r = read(file, {.lsb_dps = 1.0 / 131.0});
        EXPECT_EQ(r.stamps, StampKind::sampling) << file;
        EXPECT_THAT(r.dropouts, IsEmpty()) << file;
        EXPECT_THAT(r.segments, SizeIs(1)) << file;
    }
}

TEST(RecordingCsv, ReadsNoFurtherThanWanted) {
    const std::string path = testing::TempDir() + "long.csv";
    constexpr int rows = 2'000'000;
    {
        std::ofstream file(path);
        file << "t_s,gx_dps\n";
        for (int i = 0; i < rows; ++i) { file << i << ",1\n"; }
        file << "this is no number\n";
    }
    EXPECT_FALSE(read_recording_csv(path).ok());
    const Result<Recording> recording = read_recording_csv(path, {.rows_most = 1000});
    const Result<Recording> means = read_recording_csv(path, {.rows_most = 1000, .samples_per_row = 7});
    std::filesystem::remove(path);
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_GE(recording.value().rows(), 1000U);
    EXPECT_LT(recording.value().rows(), static_cast<std::size_t>(rows));
    ASSERT_TRUE(means.ok()) << means.error().message;
    EXPECT_EQ(means.value().rows(), recording.value().rows() / 7);
}

}  // namespace
}  // namespace gyrolog
