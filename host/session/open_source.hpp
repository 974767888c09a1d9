// From a device's name to the source of its bytes. A new kind of transport is one more line here.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host/base/result.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

// Where a simulated board ends: it has no hour of its own to be stopped at. Other sources are stopped by the
// session.
struct SourceLimit {
    std::optional<double> duration_s;
    std::optional<std::uint64_t> samples;
};

struct OpenedSource {
    std::unique_ptr<ByteSource> source;
    bool keeps_limit = false;  // it ends by itself where `limit` says, to the sample
};

// `uri` as in source_uri.hpp. `real_time` makes a simulated board keep to the clock, as if it had been asked
// with realtime=1.
Result<OpenedSource> open_source(const std::string& uri, const SourceLimit& limit, bool real_time);

}  // namespace gyrolog
