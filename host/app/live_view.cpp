#include "host/app/live_view.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "host/app/allan_chart.hpp"
#include "host/app/quantity.hpp"
#include "host/base/byte_size.hpp"
#include "host/base/counted.hpp"
#include "host/base/printable.hpp"

namespace gyrolog {
namespace {

struct TerminalSize {
    std::size_t columns = 80;
    std::size_t rows = 24;
};

TerminalSize terminal_size() {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) { return {}; }
    return {size.ws_col, size.ws_row};
}

// A job in the background would write over what its user types to the shell.
bool in_background() {
    const pid_t foreground = tcgetpgrp(STDERR_FILENO);
    return foreground > 0 && foreground != getpgrp();
}

// The first `columns` characters of UTF-8 text.
std::string cut(const std::string& text, std::size_t columns) {
    std::size_t at = 0;
    for (; at < text.size(); ++at) {
        const bool starts_character = (static_cast<unsigned char>(text[at]) & 0xC0U) != 0x80U;
        if (starts_character && columns-- == 0) { break; }
    }
    return text.substr(0, at);
}

}  // namespace

std::string describe_sensor(const glp_hello& hello, const glp_config& config) {
    std::string text =
        fmt::format("{}, {:g} Hz, ±{} °/s", hello.sensor, config.rate_mHz * 1e-3, config.gyro_full_scale_dps);
    text += config.dlpf_hz == 0 ? ", low-pass off" : fmt::format(", low-pass {} Hz", config.dlpf_hz);
    return text;
}

std::string live_line(const CaptureProgress& progress) {
    std::string line =
        fmt::format("{}  {} samples", format_elapsed(progress.device_s), format_count(progress.samples));
    if (progress.rate_hz) { line += fmt::format("  {:.2f} Hz", *progress.rate_hz); }
    line += fmt::format("  {}  {}", counted(progress.dropouts, "dropout"),
                        counted(progress.frames_corrupted, "CRC error"));
    if (progress.temperature_C) { line += fmt::format("  {:.1f} °C", *progress.temperature_C); }
    return line + "  " + format_bytes(progress.file_bytes);
}

void LiveView::show(const CaptureProgress& progress) {
    if (!console_.progress || in_background()) { return; }
    if (!announced_ && progress.hello && progress.config) {
        console_.err << "  " << describe_sensor(*progress.hello, *progress.config) << ", firmware "
                     << progress.hello->firmware << '\n';
        announced_ = true;
    }
    const TerminalSize terminal = terminal_size();
    if (terminal.columns != columns_drawn_ && lines_drawn_ > 1) {
        // The terminal has wrapped what was drawn: it cannot be drawn over.
        console_.err << '\n';
        lines_drawn_ = 0;
    }
    columns_drawn_ = terminal.columns;
    std::vector<std::string> lines{"  " + live_line(progress)};
    if (allan_ != nullptr) { add_allan(lines, terminal.columns, terminal.rows); }
    if (denoise_ != nullptr) { lines.push_back("  " + denoise_->line()); }
    if (keys_ != nullptr) { lines.push_back(keys_line(progress)); }
    for (std::string& line : lines) { line = cut(printable(line), terminal.columns - 1); }
    draw(lines);
}

// The sums grow with every sample, the fit to them is worth its time once a second at first and, since it
// says less and less that is new, once for every hundredth more of the capture.
void LiveView::add_allan(std::vector<std::string>& lines, std::size_t columns, std::size_t rows) {
    constexpr std::chrono::seconds pause(1);
    const std::size_t other_lines = denoise_ == nullptr ? 8 : 11;  // of this view, and what stands above it
    constexpr std::size_t chart_rows_max = 14;
    const std::uint64_t samples = allan_->samples();
    const bool grown = samples > axes_samples_ + axes_samples_ / 100 || samples < axes_samples_;
    if (grown && Clock::now() >= axes_next_) {
        axes_ = allan_->axes();
        axes_samples_ = samples;
        axes_next_ = Clock::now() + pause;
    }
    const std::size_t room = rows > other_lines ? std::min(rows - other_lines, chart_rows_max) : 0;
    for (std::string& row :
         allan_chart({&axes_[0].curve, &axes_[1].curve, &axes_[2].curve}, columns - 3, room)) {
        lines.push_back("  " + std::move(row));
    }
    constexpr std::array names{'x', 'y', 'z'};
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        lines.push_back(fmt::format("  {}  {}", names[i], walk_text(axes_[i])));
    }
}

std::string LiveView::keys_line(const CaptureProgress& progress) const {
    if (keys_->note()) {
        return fmt::format("  mark: {}_   Enter keeps it, Escape drops it", *keys_->note());
    }
    const std::string marks = progress.marks > 0 ? fmt::format(" ({} so far)", progress.marks) : "";
    return fmt::format("  keys: m mark{}, s {}, q end", marks,
                       progress.streaming ? "stop the board" : "start the board, which stands still");
}

void LiveView::draw(const std::vector<std::string>& lines) {
    std::string text = "\r";
    if (lines_drawn_ > 1) { text += fmt::format("\x1b[{}A", lines_drawn_ - 1); }
    for (std::size_t i = 0; i < lines.size(); ++i) { text += (i == 0 ? "\x1b[K" : "\n\x1b[K") + lines[i]; }
    if (lines.size() < lines_drawn_) { text += "\x1b[J"; }
    console_.drawing() << text << std::flush;
    lines_drawn_ = lines.size();
}

void LiveView::finish() {
    if (lines_drawn_ == 0) { return; }
    // The keys mean nothing any more.
    console_.drawing() << (keys_ != nullptr ? "\r\x1b[K" : "\n") << std::flush;
    lines_drawn_ = 0;
}

}  // namespace gyrolog
