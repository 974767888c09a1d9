// The conversation of a conformance run. It takes about 9 s with a real device, and leaves the device stopped
// and set up as it was.
#pragma once

#include <functional>

#include "host/base/result.hpp"
#include "host/conform/dialogue.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

// `go_on` is asked now and then; false breaks the conversation off.
// Errors: what the source says when it cannot be started or takes no commands (`unsupported`); `device_lost`;
// `timeout` when nothing at all came.
Result<Dialogue> converse(ByteSource& source, const std::function<bool()>& go_on);

}  // namespace gyrolog
