// The program stands still in the middle of a capture, as on a busy computer, and the board does not.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

struct HeldCapture {
    ProgramResult capture;
    json check;
};

HeldCapture capture_held(const std::string& rate, const std::string& duration, milliseconds held) {
    const TemporaryFolder folder;
    const std::string file = folder.path("a.pcapng");
    HeldCapture result;
    result.capture = run_gyrolog_and_hold(
        {"capture", "--device", "sim:realtime=1,rate=" + rate, "--duration", duration, "-o", file},
        milliseconds(1000), held);
    result.check = json::parse(run_gyrolog({"check", file, "--json", "-"}).out);
    return result;
}

void expect_nothing_lost(const HeldCapture& held, std::uint64_t samples) {
    EXPECT_EQ(held.capture.exit_code, 0) << held.capture.err;
    EXPECT_NE(held.capture.err.find("for up to 2."), std::string::npos) << "2 s is what it promises\n"
                                                                        << held.capture.err;
    EXPECT_EQ(held.check["samples"]["missing"], 0);
    EXPECT_EQ(held.check["samples"]["good"], samples);
    EXPECT_EQ(held.check["lost_on_device"]["samples"], 0);
}

TEST(Standstill, OfTwoSecondsAt8kHzLosesNothing) {
    expect_nothing_lost(capture_held("8000", "4s", milliseconds(2000)), 32'000);
}

// In the long tier.
TEST(LongStandstill, OfTwoSecondsAt1kHzLosesNothing) {
    const HeldCapture held = capture_held("1000", "4s", milliseconds(2000));
    EXPECT_EQ(held.capture.exit_code, 0) << held.capture.err;
    EXPECT_EQ(held.check["samples"]["good"], 4'000);
    EXPECT_EQ(held.check["samples"]["missing"], 0);
}

TEST(LongStandstill, OfTenSecondsCostsWhatTheBoardCounted) {
    for (const char* rate : {"1000", "8000"}) {
        const HeldCapture held = capture_held(rate, "13s", milliseconds(10'000));
        EXPECT_EQ(held.capture.exit_code, 5) << held.capture.err;
        const std::uint64_t missing = held.check["samples"]["missing"];
        const std::uint64_t rate_hz = std::stoull(rate);
        EXPECT_GT(missing, 5 * rate_hz);
        EXPECT_LT(missing, 8 * rate_hz) << "the promised 2.5 s are not among them";
        EXPECT_EQ(held.check["lost_on_device"]["samples"], missing);
        EXPECT_EQ(held.check["samples"]["good"].get<std::uint64_t>() + missing, 13 * rate_hz);
    }
}

}  // namespace
}  // namespace gyrolog
