#include "host/app/capture_options.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/app/option_check.hpp"
#include "host/app/quantity.hpp"
#include "host/session/board_control.hpp"

namespace gyrolog {
namespace {

template <std::size_t count>
std::vector<std::string> texts_of(const std::array<std::uint16_t, count>& values) {
    std::vector<std::string> texts;
    texts.reserve(count);
    for (const std::uint16_t value : values) { texts.push_back(std::to_string(value)); }
    return texts;
}

}  // namespace
namespace {

Result<std::uint16_t> parse_dlpf(const std::string& text) {
    if (text == "off") { return std::uint16_t{GLP_DLPF_OFF}; }
    std::uint16_t bandwidth_hz = 0;
    const auto [rest, problem] = std::from_chars(text.data(), text.data() + text.size(), bandwidth_hz);
    if (problem != std::errc() || rest != text.data() + text.size() || bandwidth_hz == 0) {
        return Error{
            ErrorCode::invalid_argument,
            fmt::format("--dlpf '{}': write a bandwidth in Hz (5, 10, 20, 41, 92, 184, 250, 3600) or off",
                        text)};
    }
    return bandwidth_hz;
}

}  // namespace

void CaptureOptions::declare_settings(CLI::App& app) {
    app.add_option("--rate", rate_hz, "Output rate of the sensor")->type_name("HZ")->check(positive_number());
    app.add_option("--full-scale", full_scale_dps, "Range of the gyroscope: 250, 500, 1000 or 2000")
        ->type_name("DPS")
        ->check(whole_number(1, std::numeric_limits<std::uint16_t>::max()))
        ->check(offered(texts_of(mpu9250_full_scales_dps)));
    std::vector<std::string> dlpfs = texts_of(mpu9250_dlpfs_hz);
    dlpfs.emplace_back("off");
    app.add_option("--dlpf", dlpf,
                   "The sensor's low-pass filter: 5, 10, 20, 41, 92, 184, 250 or 3600 Hz, or off")
        ->type_name("HZ|off")
        ->check(offered(dlpfs));
}

void CaptureOptions::declare(CLI::App& app) {
    app.add_option("--device", devices,
                   "usb: (the only board), usb:SERIAL, tty:PATH[,speed=BAUD], sim:KEY=VALUE,... or "
                   "replay:FILE; several "
                   "times, or usb:* for all boards: each has its own file")
        ->type_name("URI")
        ->expected(1)
        ->take_all()
        ->capture_default_str();
    app.add_option("--duration", duration, "Stop after this time: 90s, 15m, 6h, 1d")
        ->type_name("T")
        ->check(gyrolog::duration());
    app.add_option("--samples", samples, "Stop after this many samples")
        ->type_name("N")
        ->check(whole_number(1));
    declare_settings(app);
    app.add_option("--on-unplug", on_unplug,
                   "When the board is lost: wait for it and go on in FILE.2, or exit")
        ->type_name("wait|exit")
        ->check(CLI::IsMember({"wait", "exit"}))
        ->capture_default_str();
    app.add_option("--rotate-size", rotate_size, "Go on in the next file after so many bytes: 500M, 2G")
        ->type_name("SIZE")
        ->check(size());
    app.add_option("--rotate-every", rotate_every, "Go on in the next file after this time: 15m, 6h")
        ->type_name("T")
        ->check(gyrolog::duration());
    app.add_option("--min-free", min_free, "End before the disk has less room than this; 0 fills it")
        ->type_name("SIZE")
        ->check(size_or_none())
        ->capture_default_str();
    app.add_flag("--force", force, "Replace a file that exists");
}

Result<CaptureRequest> CaptureOptions::request() const {
    CaptureRequest request;
    request.overwrite = force;
    request.samples = samples;
    if (!duration.empty()) { GYROLOG_TRY(request.duration_s, parse_duration_s(duration)); }
    request.on_unplug = on_unplug == "exit" ? OnUnplug::end : OnUnplug::wait;
    if (!rotate_size.empty()) { GYROLOG_TRY(request.rotate_bytes, parse_bytes(rotate_size)); }
    if (!rotate_every.empty()) { GYROLOG_TRY(request.rotate_s, parse_duration_s(rotate_every)); }
    if (min_free != "0") { GYROLOG_TRY(request.min_free_bytes, parse_bytes(min_free)); }
    if (!dlpf.empty()) { GYROLOG_TRY(request.configure.dlpf_hz, parse_dlpf(dlpf)); }
    if (full_scale_dps) { request.configure.gyro_full_scale_dps = *full_scale_dps; }
    if (rate_hz) {
        const double rate_mHz = std::round(*rate_hz * 1e3);
        if (!(rate_mHz >= 1.0 && rate_mHz <= 4e9)) {
            return Error{ErrorCode::invalid_argument, fmt::format("--rate {:g}: out of range", *rate_hz)};
        }
        request.configure.rate_mHz = static_cast<std::uint32_t>(rate_mHz);
    }
    return request;
}

}  // namespace gyrolog
