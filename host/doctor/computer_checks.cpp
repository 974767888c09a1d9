#include <array>
#include <string>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/doctor/checks.hpp"

namespace gyrolog {
namespace {

constexpr double bytes_per_gb = 1e9;
// What figures are lettered with (analysis/plot/typeface.hpp).
constexpr std::array fonts{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                           "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"};
constexpr const char* elsewhere = "gyrolog capture -o /another/disk/night.pcapng";

}  // namespace

Diagnostic check_disk_space(const Machine& machine, const DoctorOptions& options) {
    const auto free = machine.free_bytes(machine.folder);
    if (!free.ok()) {
        return {false, "this folder's disk cannot be asked: " + printable(free.error().message), elsewhere};
    }
    const double free_gb = static_cast<double>(*free) / bytes_per_gb;
    if (*free >= options.free_bytes_least) { return {true, fmt::format("{:.1f} GB free here", free_gb), ""}; }
    return {false,
            fmt::format("{:.2f} GB free here, and a night takes up to {:.0f} GB", free_gb,
                        static_cast<double>(options.free_bytes_least) / bytes_per_gb),
            elsewhere};
}

Diagnostic check_disk_sync(const Machine& machine, const DoctorOptions& options) {
    const auto sync_s = machine.sync_s(machine.folder);
    if (!sync_s.ok()) {
        return {false, "no file can be written here: " + printable(sync_s.error().message), elsewhere};
    }
    const std::string took = fmt::format("the slowest of eight syncs took {:.3g} ms", 1e3 * *sync_s);
    if (*sync_s <= options.sync_s_most) { return {true, took, ""}; }
    return {false, took + ", and a capture asks for one every second: a loss of power costs more", elsewhere};
}

Diagnostic check_fonts(const Machine& machine, const DoctorOptions& /*options*/) {
    for (const char* font : fonts) {
        if (machine.has(font)) { continue; }
        return {false, std::string(font) + " is not there: no figure can be drawn",
                "sudo apt install fonts-dejavu-core"};
    }
    return {true, "DejaVu Sans is there", ""};
}

// Captures are timed by the monotonic clock; this one only says when they began.
Diagnostic check_clock(const Machine& machine, const DoctorOptions& options) {
    if (machine.now_s < options.now_s_least || machine.now_s > options.now_s_most) {
        return {false, "the computer's clock is wrong by years: captures would say that they began then",
                "sudo timedatectl set-ntp true"};
    }
    const bool is_told = machine.has("/run/systemd/timesync/synchronized");
    return {true, is_told ? "set by a time server" : "plausible; no time server of systemd's has set it", ""};
}

}  // namespace gyrolog
