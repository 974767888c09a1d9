// Arrays byte by byte, as NumPy Enhancement Proposal 1 has them.

#include "host/formats/recording_npy.hpp"

#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/recording_file.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;

std::string preamble(int major, std::size_t header_bytes) {
    std::string text = "\x93NUMPY";
    text += static_cast<char>(major);
    text += '\0';
    for (std::size_t i = 0; i < (major == 1 ? 2U : 4U); ++i) {
        text += static_cast<char>(header_bytes >> (8U * i) & 0xFFU);
    }
    return text;
}

std::string with_header(const std::string& header, int major = 1) {
    return preamble(major, header.size()) + header;
}

template <typename Number>
std::string bytes_of(const std::vector<Number>& numbers) {
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

std::string described(const std::string& type, const std::string& order, const std::string& shape) {
    return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }          \n";
}

RecordingReadOptions of_columns(const std::string& columns = "t,gx,gy", const std::string& unit = "rad/s") {
    RecordingReadOptions options;
    options.choice.columns = columns;
    options.choice.gyro_unit = unit;
    return options;
}

Recording npy_read(const std::string& file, const RecordingReadOptions& options = of_columns()) {
    auto recording = parse_recording_npy(file, "a.npy", options);
    EXPECT_TRUE(recording.ok()) << (recording.ok() ? "" : recording.error().message);
    return recording.ok() ? std::move(recording).value() : Recording{};
}

std::string npy_refusal(const std::string& file, const RecordingReadOptions& options = of_columns()) {
    const auto recording = parse_recording_npy(file, "a.npy", options);
    return recording.ok() ? "accepted" : recording.error().message;
}

const std::vector<double> by_rows{0.0, 1.0, 2.0, 0.25, 3.0, 4.0, 0.5, 5.0, 6.0, 0.75, 7.0, 8.0};
const std::vector<double> by_columns{0.0, 0.25, 0.5, 0.75, 1.0, 3.0, 5.0, 7.0, 2.0, 4.0, 6.0, 8.0};

void expect_the_array(const Recording& r, double unit = 1.0) {
    ASSERT_EQ(r.rows(), 4U);
    EXPECT_NEAR(r.rate_hz, 4.0, 1e-12);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_DOUBLE_EQ(r.find("gx")->value(i), unit * static_cast<double>(2 * i + 1));
        EXPECT_DOUBLE_EQ(r.find("gy")->value(i), unit * static_cast<double>(2 * i + 2));
    }
}

TEST(RecordingNpy, IsReadInEveryOrderVersionAndType) {
    for (const int version : {1, 2, 3}) {
        expect_the_array(
            npy_read(with_header(described("<f8", "False", "(4, 3)"), version) + bytes_of(by_rows)));
    }
    expect_the_array(npy_read(with_header(described("<f8", "True", "(4, 3)")) + bytes_of(by_columns)));
    expect_the_array(npy_read(with_header(described("<f4", "False", "(4, 3)")) +
                              bytes_of(std::vector<float>(by_rows.begin(), by_rows.end()))));
    expect_the_array(npy_read(
        with_header("{\"shape\": (4,3), \"fortran_order\": False, \"descr\": \"<f8\"}") + bytes_of(by_rows)));
    RecordingReadOptions rated = of_columns("_,gx,gy", "lsb");
    rated.rate_hz = 4.0;
    rated.lsb_dps = deg_per_rad;
    expect_the_array(npy_read(with_header(described("<i2", "False", "(4, 3)")) +
                                  bytes_of(std::vector<std::int16_t>(by_rows.begin(), by_rows.end())),
                              rated));
    expect_the_array(npy_read(with_header(described("<i4", "True", "(4, 3)")) +
                                  bytes_of(std::vector<std::int32_t>(by_columns.begin(), by_columns.end())),
                              rated));
}

TEST(RecordingNpy, OfOneDimensionIsOneColumn) {
    RecordingReadOptions options = of_columns("gz_dps", "");
    options.rate_hz = 100.0;
    const Recording r = npy_read(with_header(described("<f8", "False", "(3,)")) +
                                     bytes_of(std::vector<double>{1.0, std::nan(""), 3.0}),
                                 options);
    EXPECT_EQ(r.rows(), 2U);
    EXPECT_EQ(r.missing_samples(), 1);
    EXPECT_DOUBLE_EQ(r.find("gz")->value(1), 3.0 * rad_per_deg);
}

TEST(RecordingNpy, GivesMeansAndNoMoreThanWanted) {
    RecordingReadOptions options = of_columns("gx", "rad/s");
    options.rate_hz = 10.0;
    std::vector<double> numbers(100);
    for (std::size_t i = 0; i < numbers.size(); ++i) { numbers[i] = static_cast<double>(i); }
    const std::string file = with_header(described("<f8", "False", "(100, 1)")) + bytes_of(numbers);
    options.rows_most = 41;
    EXPECT_EQ(npy_read(file, options).rows(), 41U);
    options.samples_per_row = 4;
    const Recording means = npy_read(file, options);
    EXPECT_EQ(means.rows(), 10U);
    EXPECT_DOUBLE_EQ(means.rate_hz, 2.5);
    EXPECT_DOUBLE_EQ(means.find("gx")->value(1), 5.5);
}

TEST(RecordingNpy, SaysWhatItCannotRead) {
    const std::string file = with_header(described("<f8", "False", "(4, 3)")) + bytes_of(by_rows);
    EXPECT_THAT(npy_refusal(file, {}),
                HasSubstr("an .npy does not name its columns, and this has 3: name them with "
                          "--columns, such as t,gx,gy,gz"));
    EXPECT_THAT(npy_refusal(file, of_columns("t,gx,gy", "")), HasSubstr("gx, gy: give it with --unit"));
    EXPECT_THAT(npy_refusal(file, of_columns("gx,gy,gz")), HasSubstr("--rate"));
    EXPECT_THAT(npy_refusal(file, of_columns("t,gx,gy,gz")), HasSubstr("--columns names 4, and there are 3"));
    EXPECT_THAT(npy_refusal(file.substr(0, file.size() - 5)),
                HasSubstr("4 x 3 numbers take 96 bytes, and 91 are there: it is cut off"));
    EXPECT_THAT(npy_refusal(file + "more"), HasSubstr("take 96 bytes, and 100 are there"));
    for (std::size_t cut = 0; cut < file.size(); ++cut) {
        EXPECT_NE(npy_refusal(file.substr(0, cut)), "accepted") << cut;
    }
    const auto of_header = [](const std::string& header) { return npy_refusal(with_header(header)); };
    EXPECT_THAT(of_header(described(">f8", "False", "(4, 3)")),
                HasSubstr("big endian ('>f8'): save it as a.astype('<f8')"));
    EXPECT_THAT(of_header(described("<c16", "False", "(4, 3)")), HasSubstr("its type is '<c16'"));
    EXPECT_THAT(of_header(described("|O", "False", "(4, 3)")), HasSubstr("its type is '|O'"));
    EXPECT_THAT(of_header("{'descr': [('t', '<f8')], 'fortran_order': False, 'shape': (4,), }\n"),
                HasSubstr("structured type"));
    EXPECT_THAT(of_header(described("<f8", "False", "(4, 3, 2)")), HasSubstr("it has 3 dimensions"));
    EXPECT_THAT(of_header(described("<f8", "False", "()")), HasSubstr("it has 0 dimensions"));
    EXPECT_THAT(of_header(described("<f8", "False", "(0, 3)")), HasSubstr("it holds no numbers"));
    EXPECT_THAT(of_header(described("<f8", "False", "(3, 100000)")), HasSubstr("save a.T"));
    EXPECT_THAT(of_header(described("<f8", "False", "(99999999999, 3)")),
                HasSubstr("more than any recording"));
    EXPECT_THAT(of_header("{'descr': '<f8', 'shape': (1,), }"), HasSubstr("its header is damaged"));
    EXPECT_THAT(of_header("{'descr': '<f8', 'descr': '<f8'}"), HasSubstr("there twice"));
    EXPECT_THAT(npy_refusal(preamble(2, input_limits.npy_header_bytes_most + 1)),
                HasSubstr("its header has"));
    EXPECT_THAT(npy_refusal(preamble(9, 0)), HasSubstr("its version is 9"));
}

TEST(RecordingNpy, RatesBeyondAnyGyroAreNamed) {
    const std::string file = with_header(described("<f8", "False", "(3, 2)")) +
                             bytes_of(std::vector<double>{0.0, 1.0, 1.0, HUGE_VAL, 2.0, 1.0});
    EXPECT_THAT(npy_refusal(file, of_columns("t,gx")),
                HasSubstr("row 2, column 'gx': inf is beyond what any sensor says"));
}

TEST(RecordingNpy, IsToldByItsContent) {
    const TemporaryFolder folder;
    const std::string path = folder.path("night.data");
    std::ofstream(path, std::ios::binary)
        << with_header(described("<f8", "False", "(4, 3)")) + bytes_of(by_rows);
    const auto recording = read_recording_file(path, of_columns());
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    expect_the_array(*recording);
    EXPECT_EQ(recording->name, "night.data");
    const std::string archive = folder.path("a.npz");
    std::ofstream(archive, std::ios::binary) << "PK\x03\x04rest of it";
    EXPECT_THAT(read_recording_file(archive, {}).error().message,
                HasSubstr("this is an archive (.npz, .zip, .xlsx)"));
}

}  // namespace
}  // namespace gyrolog
