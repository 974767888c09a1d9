#include "host/session/open_source.hpp"

#include "host/formats/model_json.hpp"
#include "host/transport/replay_source.hpp"
#include "host/transport/source_uri.hpp"
#include "host/transport/tty_source.hpp"
#include "host/transport/usb_source.hpp"
#include "host/virtual_board/sim_source.hpp"

namespace gyrolog {
namespace {

using Opened = Result<OpenedSource>;

template <typename Source>
Opened opened(Result<std::unique_ptr<Source>> source, bool keeps_limit = false) {
    if (!source.ok()) { return std::move(source).error(); }
    return OpenedSource{std::move(source).value(), keeps_limit};
}

Opened open_usb(const SourceUri& uri) {
    GYROLOG_TRY(std::shared_ptr<UsbContext> usb, UsbContext::create());
    return opened(UsbSource::open(std::move(usb), uri.rest));
}

Opened open_simulated(const SourceUri& uri, const SourceLimit& limit, bool real_time) {
    GYROLOG_TRY(SimOptions options, parse_sim_options(uri.options));
    options.realtime = options.realtime || real_time;
    SensorModel model = typical_mpu9250();
    if (!options.model_path.empty()) { GYROLOG_TRY(model, read_model(options.model_path)); }
    return opened(SimSource::create(options, model, {limit.samples, limit.duration_s}), true);
}

}  // namespace

Opened open_source(const std::string& uri, const SourceLimit& limit, bool real_time) {
    GYROLOG_TRY(const SourceUri parsed, parse_source_uri(uri));
    switch (parsed.kind) {
        case SourceUri::Kind::usb:
            return open_usb(parsed);
        case SourceUri::Kind::tty:
            return opened(TtySource::open(parsed.rest));
        case SourceUri::Kind::sim:
            return open_simulated(parsed, limit, real_time);
        case SourceUri::Kind::replay:
            return opened(ReplaySource::open(parsed.rest));
    }
    return Error{ErrorCode::invalid_argument, uri};
}

}  // namespace gyrolog
