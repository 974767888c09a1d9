#include "host/app/capture_report.hpp"

#include <array>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/app/quantity.hpp"
#include "host/session/capture_session.hpp"
#include "host/session/open_source.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using Json = nlohmann::ordered_json;

// Five seconds at 1 kHz.
class CaptureReport : public testing::Test {
protected:
    static constexpr std::uint64_t instants = 5000;

    LoadedCapture captured(const std::string& faults) const {
        const std::string uri = "sim:rate=1000,seed=7" + faults;
        const auto opened = open_source(uri, {5.0, std::nullopt}, false);
        EXPECT_TRUE(opened.ok());
        CaptureRequest request;
        request.path = path_;
        const auto outcome =
            run_capture(*opened->source, request, [](const CaptureProgress&) { return true; });
        EXPECT_TRUE(outcome.ok());
        return load();
    }
    LoadedCapture load() const {
        auto loaded = load_capture(path_, false);
        EXPECT_TRUE(loaded.ok());
        return std::move(loaded).value();
    }

    TemporaryFolder folder_;
    const std::string path_ = folder_.path("run.pcapng");
};

// The number that a row of the table ends in, without its separators.
std::uint64_t number_of(const std::string& text, const std::string& row) {
    const std::size_t at = text.find("\n  " + row + " ");
    EXPECT_NE(at, std::string::npos) << row << " is not in\n" << text;
    std::string digits;
    for (std::size_t i = at + 3 + row.size(); i < text.size() && text[i] != '\n'; ++i) {
        if (text[i] >= '0' && text[i] <= '9') { digits += text[i]; }
    }
    return digits.empty() ? 0 : std::stoull(digits);
}

TEST_F(CaptureReport, TellsRateUncertaintyJitterAndAClockThatWasSet) {
    LoadedCapture capture = captured("");
    Json info = info_json(path_, capture);
    EXPECT_NEAR(info["sensor"]["measured_rate_hz"].get<double>(), 1000.0, 0.1);
    EXPECT_GT(info["sensor"]["rate_sd_hz"].get<double>(), 0.0);
    EXPECT_LT(info["sensor"]["rate_sd_hz"].get<double>(), 0.01);
    EXPECT_GT(info["sensor"]["stamp_jitter_s"].get<double>(), 0.0);
    EXPECT_LT(info["sensor"]["stamp_jitter_s"].get<double>(), 10e-6);
    EXPECT_EQ(info["host_clock_set_by_s"], 0.0);
    EXPECT_NE(info_text(path_, capture).find("jitter"), std::string::npos);

    ASSERT_TRUE(capture.last_checkpoint.has_value());
    capture.last_checkpoint->time.realtime_ns -= 3'600'000'000'000;
    info = info_json(path_, capture);
    EXPECT_NEAR(info["host_clock_set_by_s"].get<double>(), -3600.0, 0.01);
    EXPECT_NE(info_text(path_, capture).find("-3600.00"), std::string::npos) << info_text(path_, capture);
}

TEST_F(CaptureReport, OfAWholeCaptureSaysThatNothingIsMissing) {
    const LoadedCapture capture = captured("");
    EXPECT_TRUE(nothing_missing(capture));
    const Json check = check_json(path_, capture);
    EXPECT_EQ(check["schema"], "gyrolog-check/1");
    EXPECT_EQ(check["file"], path_);
    EXPECT_EQ(check["end"], "clean");
    EXPECT_EQ(check["samples"]["good"], instants);
    EXPECT_EQ(check["samples"]["missing"], 0);
    EXPECT_EQ(check["bytes"]["total"], check["bytes"]["in_frames"]);
    EXPECT_TRUE(check["dropouts"].empty());
    EXPECT_TRUE(check["corrupted_by_reason"].empty());
    EXPECT_EQ(check["boots"], 1);
    EXPECT_EQ(check["runs"], 1);
    EXPECT_EQ(check["file_bytes"]["total"], std::filesystem::file_size(path_));
    EXPECT_EQ(check["file_bytes"]["total"], check["file_bytes"]["in_blocks"]);
    EXPECT_NE(check_text(path_, capture).find("\n  nothing is missing\n"), std::string::npos);
}

TEST_F(CaptureReport, CountsTheLossAndSaysWhereItIs) {
    const LoadedCapture capture = captured(",fault=drop_packet@2.345");
    EXPECT_FALSE(nothing_missing(capture));
    const Json check = check_json(path_, capture);
    const auto missing = check["samples"]["missing"].get<std::uint64_t>();
    EXPECT_GT(missing, 0U);
    EXPECT_EQ(check["samples"]["good"].get<std::uint64_t>() + missing, instants);
    EXPECT_GT(check["frames"]["missing"], 0);
    EXPECT_EQ(check["lost_on_device"]["samples"], 0);
    ASSERT_EQ(check["dropouts"].size(), 1U);
    EXPECT_EQ(check["dropouts"][0]["samples"], missing);
    EXPECT_EQ(check["dropouts"][0]["cause"], "link");
    // 64 bytes touch two frames at the most.
    const double frame_s = static_cast<double>(missing) * 1e-3;
    EXPECT_NEAR(check["dropouts"][0]["at_s"].get<double>(), 2.345, 2.0 * frame_s);

    const std::string text = check_text(path_, capture);
    EXPECT_NE(text.find("\n  dropout at "), std::string::npos);
    EXPECT_NE(text.find(": " + std::to_string(missing) + " samples, link\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\n  something is missing\n"), std::string::npos);
}

TEST_F(CaptureReport, TextAndJsonTellTheSameNumbers) {
    const LoadedCapture capture = captured(",fault=drop_packet@2+corrupt_byte@3+duplicate_packet@4");
    const Json check = check_json(path_, capture);
    const std::string text = check_text(path_, capture);
    EXPECT_EQ(number_of(text, "bytes of the stream"), check["bytes"]["total"]);
    EXPECT_EQ(number_of(text, "  in frames"), check["bytes"]["in_frames"]);
    EXPECT_EQ(number_of(text, "  skipped"), check["bytes"]["skipped"]);
    EXPECT_EQ(number_of(text, "frames good"), check["frames"]["good"]);
    EXPECT_EQ(number_of(text, "  corrupted"), check["frames"]["corrupted"]);
    EXPECT_EQ(number_of(text, "samples good"), check["samples"]["good"]);
    std::uint64_t corrupted = 0;
    for (const auto& reason : check["corrupted_by_reason"]) { corrupted += reason.get<std::uint64_t>(); }
    EXPECT_GT(corrupted, 0U);
    EXPECT_EQ(corrupted, check["frames"]["corrupted"]);
    EXPECT_EQ(check["bytes"]["total"], check["bytes"]["in_frames"].get<std::uint64_t>() +
                                           check["bytes"]["skipped"].get<std::uint64_t>() +
                                           check["bytes"]["buffered"].get<std::uint64_t>());
}

TEST_F(CaptureReport, TornFileIsCalledTornAndItsBytesAreAccountedFor) {
    static_cast<void>(captured(""));
    const auto whole_bytes = std::filesystem::file_size(path_);
    std::filesystem::resize_file(path_, whole_bytes / 2 + 1);
    const LoadedCapture capture = load();
    const Json check = check_json(path_, capture);
    EXPECT_EQ(check["end"], "torn_tail");
    EXPECT_EQ(check["file_bytes"]["total"], whole_bytes / 2 + 1);
    EXPECT_GT(check["file_bytes"]["in_tail"], 0);
    EXPECT_EQ(check["file_bytes"]["total"], check["file_bytes"]["in_blocks"].get<std::uint64_t>() +
                                                check["file_bytes"]["in_tail"].get<std::uint64_t>());
    EXPECT_NE(check_text(path_, capture).find("torn tail"), std::string::npos);
}

TEST_F(CaptureReport, DamagedFileIsCalledDamagedAndTheMendIsNamed) {
    static_cast<void>(captured(""));
    std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(path_) / 2));
    file << std::string(5000, '\x5A');
    file.close();
    const LoadedCapture capture = load();
    EXPECT_EQ(check_json(path_, capture)["end"], "damaged");
    EXPECT_NE(check_text(path_, capture).find("gyrolog recover " + path_), std::string::npos);
}

TEST_F(CaptureReport, NamesTheSensorOfEveryKnownIdentity) {
    const std::array<const char*, 3> known[] = {
        {"mpu9250", "MPU-9250", "71"}, {"mpu9255", "MPU-9255", "73"}, {"mpu9250_75", "MPU-9250 (75)", "75"}};
    for (const auto& [option, name, who_am_i] : known) {
        const LoadedCapture capture = captured(std::string(",endpoints=fixed_kind,sensor=") + option);
        const Json info = info_json(path_, capture);
        EXPECT_EQ(info["sensor"]["name"], name);
        EXPECT_EQ(info["sensor"]["who_am_i"], who_am_i);
        EXPECT_EQ(info["samples"], instants);
        EXPECT_NE(info_text(path_, capture).find(std::string(name) + ", 1000 Hz"), std::string::npos);
        std::filesystem::remove(path_);
    }
}

TEST_F(CaptureReport, InfoTellsWhatTheCaptureIsACaptureOf) {
    const LoadedCapture capture = captured(",full_scale=1000,dlpf=92");
    const Json info = info_json(path_, capture);
    EXPECT_EQ(info["schema"], "gyrolog-info/1");
    EXPECT_EQ(info["board"]["serial"], "SIM0001");
    EXPECT_EQ(info["board"]["vid"], "1209");
    EXPECT_EQ(info["board"]["pid"], "6779");
    EXPECT_EQ(info["sensor"]["name"], "MPU-9250");
    EXPECT_EQ(info["sensor"]["who_am_i"], "71");
    EXPECT_EQ(info["sensor"]["rate_hz"], 1000.0);
    EXPECT_EQ(info["sensor"]["full_scale_dps"], 1000);
    EXPECT_EQ(info["sensor"]["dlpf"], 92);
    EXPECT_EQ(info["samples"], instants);
    EXPECT_NEAR(info["duration_s"].get<double>(), 5.0, 5.0 * 0.03) << "an MPU-9250 is off by some percent";
    const std::string text = info_text(path_, capture);
    for (const char* part : {"serial SIM0001", "sim:rate=1000,seed=7", "±1000 °/s", "low-pass 92 Hz",
                             "5,000 samples", "missing    no sample"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
    }
}

}  // namespace
}  // namespace gyrolog
