// The options that every capturing command has, and what they ask of the board.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "host/app/live_denoise.hpp"
#include "host/base/result.hpp"
#include "host/session/capture_session.hpp"

namespace gyrolog {

struct CaptureOptions {
    std::vector<std::string> devices{"usb:"};
    std::string duration;
    std::optional<std::uint64_t> samples;
    std::optional<double> rate_hz;
    std::optional<std::uint16_t> full_scale_dps;
    std::string dlpf;
    bool force = false;
    std::string on_unplug = "wait";
    std::string rotate_size;
    std::string rotate_every;
    std::string min_free = "100M";
    LiveDenoiseOptions denoise;  // of one board; not declared by declare()

    void declare(CLI::App& app);
    // Of these, what the board is told: rate, full scale, filter. declare() declares them, too.
    void declare_settings(CLI::App& app);
    // Without the path. Error invalid_argument names the option.
    Result<CaptureRequest> request() const;
};

}  // namespace gyrolog
