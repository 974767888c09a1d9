// What the capturing program knows at a checkpoint. The file keeps it for a reader that wants an overview at
// once.
#pragma once

#include <cstdint>

namespace gyrolog {

struct CaptureCounters {
    std::uint64_t stream_bytes = 0;
    std::uint64_t frames = 0;
    std::uint64_t samples = 0;
    std::uint64_t frames_missing = 0;
    std::uint64_t samples_missing = 0;
    std::uint64_t transfers_dropped = 0;  // on the host, for lack of room before the disk
    std::uint64_t bytes_dropped = 0;

    bool operator==(const CaptureCounters&) const = default;
};

}  // namespace gyrolog
