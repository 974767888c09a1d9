// How far a long command is, on a terminal: one line, redrawn, with the time that is left. It begins after a
// second, and is gone when the object is.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

#include "host/app/console.hpp"

namespace gyrolog {

struct ProgressOptions {
    std::chrono::milliseconds quiet_for{1000};        // nobody waits so long for a word
    std::chrono::milliseconds between_drawings{100};  // quicker changes are not read
    // A share, and s: before so much is done, or so much time has passed, the time left is a guess.
    double time_left_share_least = 0.02;
    double time_left_elapsed_least_s = 0.5;
};

inline constexpr ProgressOptions progress_options{};

class ProgressLine {
public:
    using Clock = std::chrono::steady_clock;

    // `now`: for tests.
    explicit ProgressLine(const Console& console, Clock::time_point (*now)() = &Clock::now);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // `what` is being done, this share of it is. The time left goes by how long that share took; another
    // `what` began when the one before was last told of.
    void show(std::string_view what, double share);
    // Of what nobody knows how long it takes.
    void show(std::string_view what);

    // For whoever reads a recording: "reading".
    std::function<void(double)> of_reading();
    // A stage that AnalysisOptions::on_stage tells of.
    void show_analysis(std::string_view stage);

private:
    // Whether it is time to draw.
    bool enters(std::string_view what, Clock::time_point now);
    void draw(const std::string& text);

    const Console& console_;
    Clock::time_point (*now_)();
    Clock::time_point began_;
    Clock::time_point stage_began_;
    Clock::time_point told_at_;
    Clock::time_point drawn_at_{};
    std::string stage_;
    bool is_drawn_ = false;
};

// "simulating  42 %  1 min 20 s left"; without the time where it cannot be told yet.
std::string progress_text(std::string_view what, double share, double elapsed_s);

}  // namespace gyrolog
