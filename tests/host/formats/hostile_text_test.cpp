// Files that were made to harm who reads them: refused in time and memory that do not depend on what they ask
// for.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "host/formats/input_limits.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/text_file.hpp"
#include "tests/support/instrumented.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t long_message_bytes = 400;

class HostileText : public testing::Test {
protected:
    // Written as the name's ending says.
    std::string file(const std::string& name, std::string_view text) const {
        const std::string path = folder_.path(name);
        auto writer = TextWriter::create(path);
        EXPECT_TRUE(writer.ok() && writer->write(text).ok() && writer->close().ok());
        return path;
    }
    static std::string refusal_of_recording(const std::string& path) {
        const auto read = read_recording_csv(path, {});
        EXPECT_FALSE(read.ok());
        const std::string message = read.ok() ? "" : read.error().message;
        EXPECT_LT(message.size(), long_message_bytes);
        return message;
    }
    static std::string refusal_of_model(const std::string& path) {
        const auto read = read_model_file(path, 1);
        EXPECT_FALSE(read.ok());
        const std::string message = read.ok() ? "" : read.error().message;
        EXPECT_LT(message.size(), long_message_bytes);
        return message;
    }

    TemporaryFolder folder_{TemporaryFolder::Documents::are_wrong_on_purpose};
};

TEST_F(HostileText, CompressedInLayersIsRefused) {
    const std::string once = file("once.csv.gz", std::string(100'000, 'a'));
    const std::string twice = file("twice.csv.gz", read_whole_file(once));
    EXPECT_THAT(refusal_of_recording(twice), HasSubstr("compressed more than once"));
    EXPECT_THAT(refusal_of_model(file("thrice.json.xz", read_whole_file(twice))),
                HasSubstr("compressed more than once"));
}

// A pipe has no name that says how it is compressed.
TEST_F(HostileText, OfAPipeIsReadByItsContent) {
    const std::string packed = read_whole_file(file("rows.csv.gz", "t_s,gx_dps\n0,1\n1,2\n2,1\n3,2\n"));
    const std::string pipe = folder_.path("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << packed; });
    const auto read = read_recording_csv(pipe, {});
    writer.join();
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->rows(), 4U);
    std::ofstream(folder_.path("rows.csv"), std::ios::binary) << packed;
    EXPECT_THAT(refusal_of_recording(folder_.path("rows.csv")), HasSubstr("it should end in .gz"));
}

TEST_F(HostileText, ALineWithoutEndIsRefused) {
    const std::string path = file("line.csv.gz", "t_s,gx_dps\n" + std::string(64U << 20U, '1'));
    EXPECT_LT(std::filesystem::file_size(path), 100'000U);
    EXPECT_THAT(refusal_of_recording(path), HasSubstr("line 2 is longer than 1048576 bytes"));
    EXPECT_THAT(refusal_of_model(file("line.json.gz", std::string(64U << 20U, ' '))),
                HasSubstr("longer than 16.8 MB, and no model is"));
}

// 80 MB out of 80 kB; what it was made of would fill as many rows as bytes.
TEST_F(HostileText, UnpacksInProportionToTheFile) {
    const std::string path = file("rows.csv.gz", "gx_dps\n" + std::string(80U << 20U, '\n'));
    EXPECT_LT(std::filesystem::file_size(path), 200'000U);
    auto reader = TextReader::open(path);
    ASSERT_TRUE(reader.ok());
    std::size_t unpacked = 0;
    auto piece = reader->read();
    for (; piece.ok() && !piece->empty(); piece = reader->read()) { unpacked += piece->size(); }
    ASSERT_FALSE(piece.ok());
    EXPECT_THAT(piece.error().message, HasSubstr("it unpacks to more than 200 times its size"));
    const auto unpacked_bytes = static_cast<double>(unpacked);
    EXPECT_NEAR(unpacked_bytes, static_cast<double>(input_limits.unpacked_free_bytes) + 0.2 * unpacked_bytes,
                unpacked_bytes / 20.0);
}

// libarchive would run lrzip, lzop or grzip from the PATH for these, and decode the last.
TEST_F(HostileText, NoProgramRunsForAFile) {
    const std::string old_path = std::getenv("PATH");
    for (const char* program : {"lrzip", "lzop", "grzip", "gzip", "uudecode"}) {
        const std::string path = folder_.path(program);
        std::ofstream(path) << "#!/bin/sh\ntouch " << folder_.path("it_ran") << "\n";
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    }
    setenv("PATH", (folder_.path(".") + ":" + old_path).c_str(), 1);
    using namespace std::string_literals;
    const std::string rows = "t_s,gx_dps\n0,1\n1,2\n";
    for (const std::string& text :
         {"LRZI\x00\x06"s + rows, "\x89LZO\x00\x0D\x0A\x1A\x0A"s + rows, "GRZipII\x00\x02\x04:)"s + rows,
          "begin 644 run.csv\n3=%]S+&=X7V1P<PHP+#$*,2PR\"@``\n`\nend\n"s}) {
        const auto read = read_recording_csv(file("strange.csv", text), {});
        EXPECT_FALSE(read.ok());
    }
    setenv("PATH", old_path.c_str(), 1);
    EXPECT_FALSE(std::filesystem::exists(folder_.path("it_ran")));
}

std::string columns(std::size_t count) {
    std::string header = "t_s,gx_dps";
    for (std::size_t i = 2; i < count; ++i) { header += ",c" + std::to_string(i); }
    return header + "\n0" + std::string(count - 1, ',') + "\n1" + std::string(count - 1, ',') + "\n";
}

TEST_F(HostileText, HasNoMoreColumnsThanAnyArray) {
    EXPECT_THAT(refusal_of_recording(file("many.csv", columns(input_limits.columns_most + 1))),
                HasSubstr("line 1 names more than 10000 columns"));
    EXPECT_THAT(refusal_of_recording(file("most.csv", columns(input_limits.columns_most))),
                Not(HasSubstr("names more than")));
}

TEST_F(HostileText, OfAModelHasNoMoreKeysThanAnyModel) {
    std::string keys = R"({"schema": "gyrolog-model/1")";
    for (int i = 0; i < 100'000; ++i) { keys += ", \"k" + std::to_string(i) + "\": 1"; }
    EXPECT_THAT(refusal_of_model(file("keys.json", keys + "}")), HasSubstr("more than 10000 keys"));
    // The same where a number is none, for which the text is read once more.
    EXPECT_THAT(refusal_of_model(file("nan.json", R"({"a": NaN, )" + keys.substr(1) + "}")),
                HasSubstr("more than 10000 keys"));
    EXPECT_THAT(refusal_of_model(file("deep.json", std::string(100'000, '['))), HasSubstr("nested more"));
}

// Fewer under a sanitizer: the plain build judges the time, and the text is read as far by fewer keys.
constexpr int readings = GYROLOG_IS_INSTRUMENTED ? 2 : 5;
constexpr std::size_t few_keys = GYROLOG_IS_INSTRUMENTED ? 400 : 1200;

// Processor time of the fastest of some readings, and of writing what was read.
double reading_s(const std::string& model) {
    double least_s = std::numeric_limits<double>::infinity();
    for (int i = 0; i < readings; ++i) {
        const std::clock_t begin = std::clock();
        const auto read = parse_model(model, "made.json");
        if (read.ok()) { static_cast<void>(format_model(*read)); }
        least_s = std::min(least_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return least_s;
}

// What a reader did for each key, or each element, with all those before it took 1 s below the limits, or
// hours.
TEST_F(HostileText, IsReadInTimeThatGrowsWithItAndNoFaster) {
    const std::string model = format_model(typical_mpu9250());
    // In place of the last brace, in an axis, in an effect's parameters.
    const auto with = [&](const std::string& place, const std::string& more) {
        std::string text = model;
        if (place.empty()) { return text.replace(text.rfind('}'), 1, "," + more + "}"); }
        const std::size_t at = text.find(place);
        EXPECT_NE(at, std::string::npos) << place;
        return text.insert(
            at + place.size(),
            more +
                (std::string_view("]}").find(text[at + place.size()]) == std::string_view::npos ? "," : ""));
    };
    const auto keys = [](std::size_t count) {
        std::string text = "\"k\": 0";
        for (std::size_t i = 0; i < count; ++i) { text += ", \"k" + std::to_string(i) + "\": 1"; }
        return text;
    };
    const auto elements = [](std::size_t count) {
        std::string text = "\"list\": [{}";
        for (std::size_t i = 0; i < count; ++i) { text += ", {}"; }
        return text + "]";
    };
    const std::vector<std::pair<std::string, std::function<std::string(std::size_t)>>> made{
        {"keys of the model", [&](std::size_t n) { return with("", keys(n)); }},
        {"keys of an axis", [&](std::size_t n) { return with("\"x\": {", keys(n)); }},
        {"uncertainties", [&](std::size_t n) { return with("\"sd_rel\": {", keys(n)); }},
        {"parameters",
         [&](std::size_t n) {
             return with("\"effects\": [",
                         R"({"effect": "warmup", "axes": [], "params": {)" + keys(n) + "}}");
         }},
        {"elements of a list", [&](std::size_t n) { return with("", elements(4 * n)); }}};
    constexpr double times = 8.0;
    for (const auto& [what, make] : made) {
        ASSERT_TRUE(parse_model(make(few_keys), "made.json").ok())
            << what << parse_model(make(few_keys), "made.json").error().message;
        const double ratio =
            reading_s(make(static_cast<std::size_t>(times * few_keys))) / reading_s(make(few_keys));
        // Halfway, in powers, between in proportion and with the square.
        EXPECT_LT(ratio, times * std::sqrt(times)) << what;
    }
}

TEST_F(HostileText, IsCutAndShownInMessages) {
    EXPECT_THAT(
        refusal_of_model(file("schema.json", R"({"schema": ")" + std::string(1'000'000, 's') + "\"}")),
        HasSubstr("ssss...'"));
    const std::string twice = "t_s,\x1b[2J" + std::string(1000, 'x');
    EXPECT_THAT(refusal_of_recording(file("twice.csv", twice + twice.substr(3) + "\n")),
                AllOf(HasSubstr("column '\\u001b[2Jxxx"), HasSubstr("x...' appears twice")));
    EXPECT_THAT(refusal_of_recording(file("field.csv", "t_s,gx_dps\n0,\x1b[2J\n")),
                AllOf(HasSubstr("line 2, column 'gx_dps': '\\u001b[2J' is no number")));
}

}  // namespace
}  // namespace gyrolog
