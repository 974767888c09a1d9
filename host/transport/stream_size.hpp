// How large the stream of a board is that is set up in a known way.
#pragma once

#include <cmath>

extern "C" {
#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/message.h>
}

namespace gyrolog {

// A full SAMPLES frame on the wire: header, payload and checksum, stuffed, and its delimiters.
inline double wire_bytes(const glp_config& config) {
    constexpr double before_samples = double{GLP_FRAME_BODY_MIN} + double{GLP_SAMPLES_HEADER_BYTES};
    constexpr double stuffed_run_bytes = 254.0;
    const double body =
        before_samples + static_cast<double>(config.samples_per_frame * glp_sample_bytes(config.layout));
    return body + 1.0 + std::floor(body / stuffed_run_bytes) + 1.0;
}

}  // namespace gyrolog
