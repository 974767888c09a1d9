// MAT-files written by libmatio in the form of MathWorks' example, and by gyrolog itself.

#include "host/formats/recording_mat_read.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include "analysis/noise/analyze.hpp"
#include "analysis/noise/noise_model.hpp"
#include "host/formats/export_source.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/recording_file.hpp"
#include "host/formats/recording_mat.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::Contains;
using testing::HasSubstr;

class RecordingMat : public testing::Test {
protected:
    struct Variable {
        const char* name;
        std::vector<double> values;  // column by column
        std::size_t columns = 1;
    };

    std::string written(const std::string& name, std::vector<Variable> variables,
                        matio_compression compression = MAT_COMPRESSION_NONE) const {
        const std::string path = folder_.path(name);
        mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
        EXPECT_NE(file, nullptr);
        for (Variable& variable : variables) {
            std::size_t size[] = {variable.values.size() / variable.columns, variable.columns};
            matvar_t* made =
                Mat_VarCreate(variable.name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, variable.values.data(), 0);
            EXPECT_EQ(Mat_VarWrite(file, made, compression), 0);
            Mat_VarFree(made);
        }
        Mat_Close(file);
        return path;
    }

    static Recording read(const std::string& path, const RecordingReadOptions& options = {}) {
        auto recording = read_recording_file(path, options);
        EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message);
        return recording.ok() ? std::move(recording).value() : Recording{};
    }
    static std::string refusal(const std::string& path, const RecordingReadOptions& options = {}) {
        const auto recording = read_recording_file(path, options);
        return recording.ok() ? "accepted" : recording.error().message;
    }

    TemporaryFolder folder_;
};

TEST_F(RecordingMat, IsReadInTheFormOfMathWorksExample) {
    const Recording r = read(written("logged.mat", {{"Fs", {100.0}}, {"omega", {0.1, 0.2, 0.3, 0.4}}}));
    EXPECT_EQ(r.rate_hz, 100.0);
    EXPECT_EQ(r.rows(), 4U);
    EXPECT_DOUBLE_EQ(r.find("gx")->value(2), 0.3);
    EXPECT_EQ(r.find("gx")->unit, "rad/s");
    EXPECT_THAT(r.warnings, Contains("omega_x is taken for gx_rad_s"));
    const Recording rated = read(folder_.path("logged.mat"), {.rate_hz = 50.0});
    EXPECT_EQ(rated.rate_hz, 50.0);
}

TEST_F(RecordingMat, ItsMatricesAreAxesWhicheverWayTheyLie) {
    RecordingReadOptions options;
    options.choice.gyro_unit = "deg/s";
    const std::string stands = written(
        "a.mat", {{"time", {0.0, 0.1, 0.2, 0.3}}, {"gyro", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 3}});
    const std::string lies = written(
        "b.mat", {{"time", {0.0, 0.1, 0.2, 0.3}}, {"gyro", {1, 5, 9, 2, 6, 10, 3, 7, 11, 4, 8, 12}, 4}});
    for (const std::string& path : {stands, lies}) {
        const Recording r = read(path, options);
        EXPECT_NEAR(r.rate_hz, 10.0, 1e-9);
        EXPECT_DOUBLE_EQ(r.find("gx")->value(3), 4.0 * rad_per_deg);
        EXPECT_DOUBLE_EQ(r.find("gz")->value(0), 9.0 * rad_per_deg);
    }
    EXPECT_THAT(refusal(stands), HasSubstr("gyro_x, gyro_y, gyro_z: give it with --unit"));
}

TEST_F(RecordingMat, GyrologsOwnComesBackAsItWent) {
    std::string text = "t_s,gx_dps,gy_dps,ax_g,temp_C\n";
    for (int i = 0; i < 400; ++i) {
        if (i == 200) { continue; }
        text += fmt::format("{},{},{},{},{}\n", 0.01 * i, 0.01 * (i % 7), 0.02 * (i % 5),
                            1.0 + 0.001 * (i % 3), 25);
    }
    const auto before = parse_recording_csv(text, "run.csv");
    ASSERT_TRUE(before.ok());
    const AnalysisReport report = analyze(*before);
    const std::string path = folder_.path("own.mat");
    ASSERT_TRUE(write_recording_mat(export_source(*before, report), path).ok());
    const Recording after = read(path);
    EXPECT_NEAR(after.rate_hz, before->rate_hz, 1e-9);
    EXPECT_EQ(after.missing_samples(), 1);
    ASSERT_EQ(after.rows(), before->rows());
    for (const Column& column : before->columns) {
        const Column* same = after.find(column.name);
        ASSERT_NE(same, nullptr) << column.name;
        EXPECT_EQ(same->unit, column.unit);
        EXPECT_EQ(same->values(), column.values()) << column.name;
    }
}

TEST_F(RecordingMat, SaysWhatItCannotRead) {
    const std::string whole =
        written("whole.mat", {{"Fs", {100.0}}, {"omega", std::vector<double>(500, 0.1)}});
    const std::string bytes = read_whole_file(whole);
    const std::string cut = folder_.path("cut.mat");
    std::ofstream(cut, std::ios::binary) << bytes.substr(0, bytes.size() - 100);
    EXPECT_THAT(refusal(cut), HasSubstr("its last variable ends 100 bytes behind the file: it is cut off"));
    for (std::size_t size = 0; size < bytes.size(); size += 97) {
        std::ofstream(cut, std::ios::binary) << bytes.substr(0, size);
        EXPECT_NE(refusal(cut), "accepted") << size;
    }
    EXPECT_THAT(refusal(written("c.mat", {{"omega", {1, 2, 3}}})), HasSubstr("--rate"));
    EXPECT_THAT(refusal(written("d.mat", {{"Fs", {1}}})), HasSubstr("it holds no variable of numbers"));
    EXPECT_THAT(refusal(written("e.mat", {{"t", {0, 1}}, {"omega", {1, 2, 3}}})),
                HasSubstr("'t' has 2 numbers, and 'omega_x' has 3"));
    EXPECT_THAT(refusal(written("f.mat", {{"pressure", {1, 2, 3}}})),
                HasSubstr("no gyro column, but pressure"));
}

// 112 MB of zeros in some 110 kB.
TEST_F(RecordingMat, UnpacksInProportionToTheFile) {
    const std::string path = written(
        "packed.mat", {{"Fs", {100.0}}, {"omega", std::vector<double>(14'000'000)}}, MAT_COMPRESSION_ZLIB);
    EXPECT_LT(std::filesystem::file_size(path), 200'000U);
    EXPECT_THAT(refusal(path),
                HasSubstr("'omega' has 14000000 x 1 numbers, more than any recording of its size"));
    const std::string less =
        written("less.mat", {{"Fs", {100.0}}, {"omega", std::vector<double>(100'000)}}, MAT_COMPRESSION_ZLIB);
    EXPECT_EQ(read(less).rows(), 100'000U);
}

// Lengths, dimensions and depths that the library believes: it takes all memory, or crashes.
// The process that reads may have been taken over by the file.
TEST_F(RecordingMat, BelievesNothingThatItIsTold) {
    const auto number = [](std::uint64_t value) {
        Bytes bytes(sizeof value);
        std::memcpy(bytes.data(), &value, sizeof value);
        return bytes;
    };
    const auto refusal = [](const Bytes& told) {
        const auto read = recording_of_mat_answer(told, "a.mat", {});
        return read.ok() ? std::string() : read.error().message;
    };
    Bytes without_reason = number(0);
    EXPECT_EQ(refusal({}), "it is damaged");
    EXPECT_EQ(refusal(without_reason), "it is damaged");
    for (const std::uint8_t byte : number(0)) { without_reason.push_back(byte); }
    EXPECT_EQ(refusal(without_reason), "it is damaged");
    Bytes long_reason = number(0);
    for (const std::uint8_t byte : number(1'000'000)) { long_reason.push_back(byte); }
    long_reason.resize(long_reason.size() + 1'000'000, 'x');
    EXPECT_EQ(refusal(long_reason).size(), 400U);
}

TEST_F(RecordingMat, BelievesNoNumberInTheFile) {
    const auto number = [](std::uint32_t value) {
        std::string bytes(4, '\0');
        std::memcpy(bytes.data(), &value, 4);
        return bytes;
    };
    const auto element = [&](std::uint32_t type, std::string content) {
        const auto size = static_cast<std::uint32_t>(content.size());
        content.resize((content.size() + 7) / 8 * 8);
        return number(type) + number(size) + content;
    };
    const auto cells = [&](std::uint32_t rows, const std::string& name, const std::string& inside) {
        constexpr std::uint32_t flags = 6, sizes = 5, text = 1, matrix = 14, of_cells = 1;
        return element(matrix, element(flags, number(of_cells) + number(0)) +
                                   element(sizes, number(rows) + number(1)) + element(text, name) + inside);
    };
    const auto nested_cells = [&](std::uint32_t depth) {
        const std::string empty = cells(1, "", "");
        std::string all;
        for (std::uint32_t level = 0; level < depth; ++level) {
            const auto inside = static_cast<std::uint32_t>(empty.size()) * (depth - level) - 8;
            all += empty.substr(0, 4) + number(inside) + empty.substr(8);
        }
        return all;
    };
    const std::string header = "MATLAB 5.0 MAT-file" + std::string(105, ' ') + std::string("\0\1IM", 4);
    const std::pair<std::string, const char*> hostile[] = {
        {cells(1U << 30U, "many", ""), ""},
        {nested_cells(300'000), ""},
        {cells(1, std::string(100'000, 'n'), ""), "has a name of"},
    };
    for (const auto& [bytes, expected] : hostile) {
        const std::string path = folder_.path("hostile.mat");
        std::ofstream(path, std::ios::binary) << header << bytes;
        EXPECT_THAT(refusal(path), HasSubstr(expected));
        EXPECT_NE(refusal(path), "accepted");
    }
}

TEST_F(RecordingMat, OfTextIsText) {
    const std::string path = folder_.path("ascii.mat");
    std::ofstream(path) << "  0.0e+00   1.0e+00\n  1.0e-01   2.0e+00\n";
    RecordingReadOptions options;
    options.choice = {.columns = "t,gx", .gyro_unit = "rad/s"};
    EXPECT_DOUBLE_EQ(read(path, options).find("gx")->value(1), 2.0);
}

// A sensor that would be left out without a word costs whoever calibrates it a measurement.
TEST_F(RecordingMat, SensorsOfTwoLengthsAreNoRecording) {
    const std::string path =
        written("lengths.mat", {{"t", {0.0, 0.1, 0.2, 0.3}},
                                {"gyro", {1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0}, 3},
                                {"acc", {1.0, 2.0, 1.0, 2.0, 1.0, 2.0}, 3}});
    RecordingReadOptions options;
    options.choice = {.gyro_unit = "deg/s", .accelerometer_unit = "m/s^2"};
    EXPECT_THAT(refusal(path, options), HasSubstr("'acc_x' has 3 numbers, and 'gyro_x' has 4"));
}

}  // namespace
}  // namespace gyrolog
