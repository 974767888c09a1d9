// How far a long command is, on a terminal: one line, redrawn, with the time that is left. It begins after a
// second, and is gone when the object is. Nothing else writes to the console meanwhile: what goes on without
// a word is drawn by a thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "host/app/console.hpp"

namespace gyrolog {

struct ProgressOptions {
    std::chrono::milliseconds quiet_for{1000};        // nobody waits so long for a word
    std::chrono::milliseconds between_drawings{100};  // quicker changes are not read
    std::chrono::milliseconds between_looks{1000};    // at what has not told anything meanwhile
    // A share, and s: before so much is done, or so much time has passed, the time left is a guess.
    double time_left_share_least = 0.02;
    double time_left_elapsed_least_s = 0.5;
};

inline constexpr ProgressOptions progress_options{};

class ProgressLine {
public:
    using Clock = std::chrono::steady_clock;

    explicit ProgressLine(const Console& console);
    // For tests: with a clock of their own, and without a thread.
    ProgressLine(const Console& console, Clock::time_point (*now)());
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // `what` is being done, this share of it is. The time left goes by how long that share took; another
    // `what` began when the one before was last told of.
    void show(std::string_view what, double share);
    // Of what nobody knows how long it takes: for how long it has been done.
    void show(std::string_view what);
    // Draws what was told last, if that was too early to be drawn or has no share. The thread calls it.
    void look();

    // For whoever reads a recording: "reading".
    std::function<void(double)> of_reading();
    // A stage that AnalysisOptions::on_stage tells of.
    void show_analysis(std::string_view stage);

private:
    void tell(std::string_view what, std::optional<double> share);
    // Whether it is time to draw.
    bool enters(std::string_view what, Clock::time_point now);
    void draw(Clock::time_point now);

    const Console& console_;
    Clock::time_point (*now_)();
    std::mutex mutex_;  // of all below
    Clock::time_point began_;
    Clock::time_point stage_began_;
    Clock::time_point told_at_;
    Clock::time_point drawn_at_{};
    std::string stage_;
    std::optional<double> share_;
    bool is_stage_drawn_ = false;
    bool is_drawn_ = false;
    std::condition_variable_any ending_;
    std::jthread looking_;
};

// "simulating  42 %  1 min 20 s left"; without the time where it cannot be told yet.
std::string progress_text(std::string_view what, double share, double elapsed_s);

}  // namespace gyrolog
