#include "host/app/live_view.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "host/app/quantity.hpp"

namespace gyrolog {
namespace {

std::size_t terminal_columns() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
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
    line += fmt::format("  {} dropouts  {} CRC errors", progress.dropouts, progress.frames_corrupted);
    if (progress.temperature_C) { line += fmt::format("  {:.1f} °C", *progress.temperature_C); }
    return line + "  " + format_bytes(progress.file_bytes);
}

void LiveView::show(const CaptureProgress& progress) {
    if (!console_.progress) { return; }
    if (!announced_ && progress.hello && progress.config) {
        console_.err << "  " << describe_sensor(*progress.hello, *progress.config) << ", firmware "
                     << progress.hello->firmware << '\n';
        announced_ = true;
    }
    console_.err << "\r\x1b[K  " << cut(live_line(progress), terminal_columns() - 3) << std::flush;
    drawn_ = true;
}

void LiveView::finish() {
    if (drawn_) { console_.err << '\n' << std::flush; }
    drawn_ = false;
}

}  // namespace gyrolog
