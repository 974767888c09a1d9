// What the user watches while a capture runs.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "host/app/console.hpp"
#include "host/app/live_allan.hpp"
#include "host/app/live_denoise.hpp"
#include "host/app/live_keys.hpp"
#include "host/session/capture_session.hpp"

namespace gyrolog {

// "MPU-9250, 100 Hz, ±500 °/s, low-pass off": what the board said of itself.
std::string describe_sensor(const glp_hello& hello, const glp_config& config);

// Lines redrawn in place, cut to the terminal's width. Says nothing where the console has no progress.
class LiveView {
public:
    // One line: how far it has come.
    explicit LiveView(Console& console) : console_(console) {}
    // Below it the Allan deviation, where the terminal is high enough, what is known of K, and the keys.
    LiveView(Console& console, const LiveAllan& allan, const LiveKeys& keys)
        : console_(console), allan_(&allan), keys_(&keys) {}
    // And what becomes of the samples that are denoised.
    void add(const LiveDenoise& denoise) { denoise_ = &denoise; }
    void show(const CaptureProgress& progress);
    // Leaves the last state standing and ends the line.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    void draw(const std::vector<std::string>& lines);
    void add_allan(std::vector<std::string>& lines, std::size_t columns, std::size_t rows);
    std::string keys_line(const CaptureProgress& progress) const;

    Console& console_;
    const LiveAllan* allan_ = nullptr;
    const LiveKeys* keys_ = nullptr;
    const LiveDenoise* denoise_ = nullptr;
    bool announced_ = false;
    std::size_t lines_drawn_ = 0;
    std::size_t columns_drawn_ = 0;
    std::array<LiveAxis, 3> axes_;  // as last worked out
    std::uint64_t axes_samples_ = 0;
    Clock::time_point axes_next_{};
};

// The line itself, without control codes.
std::string live_line(const CaptureProgress& progress);

}  // namespace gyrolog
