#include "host/app/progress_line.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/app/quantity.hpp"

namespace gyrolog {
std::string progress_text(std::string_view what, double share, double elapsed_s) {
    share = std::clamp(share, 0.0, 1.0);
    std::string text = fmt::format("{}  {:.0f} %", what, std::floor(100.0 * share));
    const bool is_a_guess = share < progress_options.time_left_share_least ||
                            elapsed_s < progress_options.time_left_elapsed_least_s;
    if (is_a_guess || share >= 1.0) { return text; }
    return text + fmt::format("  {} left", format_elapsed(std::ceil(elapsed_s * (1.0 - share) / share)));
}

ProgressLine::ProgressLine(const Console& console) : ProgressLine(console, &Clock::now) {
    if (!console.progress) { return; }
    looking_ = std::jthread([this](const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        while (!ending_.wait_for(lock, stop, progress_options.between_looks,
                                 [&] { return stop.stop_requested(); })) {
            lock.unlock();
            look();
            lock.lock();
        }
    });
}

ProgressLine::ProgressLine(const Console& console, Clock::time_point (*now)())
    : console_(console), now_(now), began_(now()), stage_began_(began_), told_at_(began_) {}

ProgressLine::~ProgressLine() {
    if (looking_.joinable()) {
        looking_.request_stop();
        looking_.join();
    }
    if (is_drawn_) { console_.drawing() << "\r\x1b[K" << std::flush; }
}

bool ProgressLine::enters(std::string_view what, Clock::time_point now) {
    const bool is_new = what != stage_;
    if (is_new) {
        stage_ = what;
        stage_began_ = told_at_;
        is_stage_drawn_ = false;
    }
    told_at_ = now;
    return now - began_ >= progress_options.quiet_for &&
           (is_new || now - drawn_at_ >= progress_options.between_drawings);
}

void ProgressLine::draw(Clock::time_point now) {
    const auto since_stage_began = [&](Clock::time_point at) {
        return std::chrono::duration<double>(at - stage_began_).count();
    };
    const std::string text = share_ ? progress_text(stage_, *share_, since_stage_began(told_at_))
                                    : fmt::format("{}  {}", stage_, format_elapsed(since_stage_began(now)));
    drawn_at_ = now;
    is_drawn_ = true;
    is_stage_drawn_ = true;
    console_.drawing() << "\r\x1b[K  " << text << std::flush;
}

void ProgressLine::tell(std::string_view what, std::optional<double> share) {
    if (!console_.progress) { return; }
    const std::scoped_lock lock(mutex_);
    const Clock::time_point now = now_();
    const bool draws = enters(what, now);
    share_ = share;
    if (draws) { draw(now); }
}

void ProgressLine::look() {
    const std::scoped_lock lock(mutex_);
    const Clock::time_point now = now_();
    if (stage_.empty() || now - began_ < progress_options.quiet_for) { return; }
    if (!is_stage_drawn_ || !share_) { draw(now); }
}

void ProgressLine::show(std::string_view what, double share) { tell(what, share); }

void ProgressLine::show(std::string_view what) { tell(what, std::nullopt); }

void ProgressLine::show_analysis(std::string_view stage) {
    show(stage == "fit" ? "fitting the noise" : stage == "spectrum" ? "spectrum" : "Allan deviation");
}

std::function<void(double)> ProgressLine::of_reading() {
    return [this](double share) { show("reading", share); };
}

}  // namespace gyrolog
