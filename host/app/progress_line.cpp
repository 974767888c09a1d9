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

ProgressLine::ProgressLine(const Console& console, Clock::time_point (*now)())
    : console_(console), now_(now), began_(now()), stage_began_(began_), told_at_(began_) {}

ProgressLine::~ProgressLine() {
    if (is_drawn_) { console_.drawing() << "\r\x1b[K" << std::flush; }
}

bool ProgressLine::enters(std::string_view what, Clock::time_point now) {
    const bool is_new = what != stage_;
    if (is_new) {
        stage_ = what;
        stage_began_ = told_at_;
    }
    told_at_ = now;
    return now - began_ >= progress_options.quiet_for &&
           (is_new || now - drawn_at_ >= progress_options.between_drawings);
}

void ProgressLine::draw(const std::string& text) {
    drawn_at_ = told_at_;
    console_.drawing() << "\r\x1b[K  " << text << std::flush;
    is_drawn_ = true;
}

void ProgressLine::show(std::string_view what, double share) {
    if (!console_.progress || !enters(what, now_())) { return; }
    draw(progress_text(what, share, std::chrono::duration<double>(told_at_ - stage_began_).count()));
}

void ProgressLine::show(std::string_view what) {
    if (!console_.progress || !enters(what, now_())) { return; }
    draw(std::string(what));
}

void ProgressLine::show_analysis(std::string_view stage) {
    show(stage == "fit" ? "fitting the noise" : stage == "spectrum" ? "spectrum" : "Allan deviation");
}

std::function<void(double)> ProgressLine::of_reading() {
    return [this](double share) { show("reading", share); };
}

}  // namespace gyrolog
