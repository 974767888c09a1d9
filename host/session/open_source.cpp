#include "host/session/open_source.hpp"

#include <charconv>

#include "host/formats/model_source.hpp"
#include "host/transport/replay_source.hpp"
#include "host/transport/source_uri.hpp"
#include "host/transport/tty_source.hpp"
#include "host/transport/usb_source.hpp"
#include "host/virtual_board/breached_source.hpp"
#include "host/virtual_board/sim_source.hpp"

namespace gyrolog {
namespace {

using Opened = Result<OpenedSource>;

template <typename Source>
Opened opened(Result<std::unique_ptr<Source>> source, bool keeps_limit = false) {
    if (!source.ok()) { return std::move(source).error(); }
    return OpenedSource{std::move(source).value(), keeps_limit};
}

// A file that is not there is no missing device.
Error file_error(Error error) {
    const bool file = error.code == ErrorCode::not_found || error.code == ErrorCode::permission_denied;
    return {file ? ErrorCode::failed : error.code, std::move(error.message)};
}

Opened open_replay(const SourceUri& uri) {
    auto replay = ReplaySource::open(uri.rest);
    if (!replay.ok()) { return file_error(std::move(replay).error()); }
    return opened(std::move(replay));
}

Opened open_usb(const SourceUri& uri) {
    GYROLOG_TRY(std::shared_ptr<UsbContext> usb, UsbContext::create());
    return opened(UsbSource::open(std::move(usb), uri.rest));
}

Opened open_tty(const SourceUri& uri) {
    TtySpeed speed;
    for (const auto& [key, value] : uri.options) {
        unsigned baud = 0;
        const auto [end, status] = std::from_chars(value.data(), value.data() + value.size(), baud);
        if (status != std::errc{} || end != value.data() + value.size() || baud == 0) {
            return Error{ErrorCode::invalid_argument, "open serial port '" + uri.rest + "': option speed=" +
                                                          value + ": wants a number of baud"};
        }
        speed = baud;
    }
    return opened(TtySource::open(uri.rest, speed));
}

Opened open_simulated(const SourceUri& uri, const SourceLimit& limit, bool real_time) {
    GYROLOG_TRY(SimOptions options, parse_sim_options(uri.options));
    options.realtime = options.realtime || real_time;
    SensorModel model = typical_mpu9250();
    if (!options.model_path.empty()) {
        auto read = read_model_source(options.model_path, options.seed);
        if (!read.ok()) { return file_error(std::move(read).error()); }
        if (read->file.unstated.rate) {
            if (!options.rate_hz) {
                return malformed("model '" + options.model_path +
                                 "': rate_hz is missing: state it there, or rate=HZ");
            }
            state_rate(read->file, *options.rate_hz);
        }
        model = std::move(read->file.model);
    }
    GYROLOG_TRY(std::unique_ptr<ByteSource> board,
                SimSource::create(options, model, {limit.samples, limit.duration_s}));
    if (const Breach* breach = breach_named(options.breach)) {
        board = std::make_unique<BreachedSource>(std::move(board), *breach);
    }
    return OpenedSource{std::move(board), true};
}

}  // namespace

Opened open_source(const std::string& uri, const SourceLimit& limit, bool real_time) {
    GYROLOG_TRY(const SourceUri parsed, parse_source_uri(uri));
    switch (parsed.kind) {
        case SourceUri::Kind::usb:
            return open_usb(parsed);
        case SourceUri::Kind::tty:
            return open_tty(parsed);
        case SourceUri::Kind::sim:
            return open_simulated(parsed, limit, real_time);
        case SourceUri::Kind::replay:
            return open_replay(parsed);
    }
    return Error{ErrorCode::invalid_argument, uri};
}

}  // namespace gyrolog
