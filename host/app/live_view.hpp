// What the user watches while a capture runs.
#pragma once

#include <string>

#include "host/app/console.hpp"
#include "host/session/capture_session.hpp"

namespace gyrolog {

// "MPU-9250, 100 Hz, ±500 °/s, low-pass off": what the board said of itself.
std::string describe_sensor(const glp_hello& hello, const glp_config& config);

// One line, redrawn in place, cut to the terminal's width. Says nothing where the console has no progress.
class LiveView {
public:
    explicit LiveView(Console& console) : console_(console) {}
    void show(const CaptureProgress& progress);
    // Leaves the last state standing and ends the line.
    void finish();

private:
    Console& console_;
    bool announced_ = false;
    bool drawn_ = false;
};

// The line itself, without control codes.
std::string live_line(const CaptureProgress& progress);

}  // namespace gyrolog
