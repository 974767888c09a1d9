#include "host/app/live_view.hpp"

#include <cstring>
#include <sstream>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

glp_hello a_hello() {
    glp_hello hello{};
    std::strcpy(hello.sensor, "MPU-9250");
    std::strcpy(hello.firmware, "lpc-1.2");
    return hello;
}

glp_config a_config() {
    glp_config config{};
    config.rate_mHz = 100'000;
    config.gyro_full_scale_dps = 500;
    config.dlpf_hz = 41;
    return config;
}

CaptureProgress some_progress() {
    CaptureProgress progress;
    progress.device_s = 3723.9;
    progress.samples = 372'390;
    progress.rate_hz = 100.4567;
    progress.dropouts = 2;
    progress.frames_corrupted = 1;
    progress.temperature_C = 31.25;
    progress.file_bytes = 9'870'000;
    progress.hello = a_hello();
    progress.config = a_config();
    return progress;
}

TEST(LiveView, SensorIsDescribedByWhatTheBoardSaidOfItself) {
    glp_config config = a_config();
    EXPECT_EQ(describe_sensor(a_hello(), config), "MPU-9250, 100 Hz, ±500 °/s, low-pass 41 Hz");
    config.rate_mHz = 333'333;
    config.dlpf_hz = 0;
    EXPECT_EQ(describe_sensor(a_hello(), config), "MPU-9250, 333.333 Hz, ±500 °/s, low-pass off");
}

TEST(LiveView, LineTellsLengthRateLossesTemperatureAndSize) {
    EXPECT_EQ(live_line(some_progress()),
              "1:02:03  372,390 samples  100.46 Hz  2 dropouts  1 CRC error  31.2 °C  9.87 MB");
}

TEST(LiveView, LineLeavesOutWhatIsNotKnownYet) {
    EXPECT_EQ(live_line({}), "0:00:00  0 samples  0 dropouts  0 CRC errors  0 B");
}

TEST(LiveView, TerminalIsToldOnceWhoTheBoardIsAndTheLineIsDrawnInPlace) {
    std::ostringstream out;
    std::ostringstream err;
    Console console{out, err, true};
    LiveView view(console);
    view.show(some_progress());
    view.show(some_progress());
    view.finish();
    view.finish();
    const std::string announcement = "  MPU-9250, 100 Hz, ±500 °/s, low-pass 41 Hz, firmware lpc-1.2\n";
    ASSERT_EQ(err.str().substr(0, announcement.size()), announcement);
    const std::string drawn = err.str().substr(announcement.size());
    EXPECT_EQ(drawn.find("firmware"), std::string::npos);
    const std::string begin = "\r\x1b[K  1:02:03  372,390 samples";
    EXPECT_EQ(drawn.substr(0, begin.size()), begin);
    EXPECT_EQ(drawn.find(begin, begin.size()), (drawn.size() - 1) / 2) << "twice the same";
    EXPECT_EQ(drawn.find('\n'), drawn.size() - 1) << "one line, ended once";
    EXPECT_EQ(out.str(), "");
}

TEST(LiveView, SaysNothingWhereNoLineCanBeRedrawn) {
    std::ostringstream out;
    std::ostringstream err;
    Console console{out, err, false};
    LiveView view(console);
    view.show(some_progress());
    view.finish();
    EXPECT_EQ(err.str(), "");
}

}  // namespace
}  // namespace gyrolog
