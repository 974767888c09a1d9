// The JSON that a capture carries in its section header, its checkpoints and its marks (FORMAT.md, sections 3
// and 5).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/clock.hpp"
#include "host/capture/capture_counters.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

constexpr std::string_view capture_schema = "gyrolog-capture/1";
constexpr std::string_view checkpoint_schema = "gyrolog-checkpoint/1";
constexpr std::string_view mark_schema = "gyrolog-mark/1";

// Which part of a capture a file is. A capture goes on in another file when its file is long enough, and when
// a board that was lost comes back.
struct CaptureSegment {
    std::string capture;           // differs from capture to capture
    std::uint64_t number = 1;      // from 1, in the order of the stream
    std::uint64_t connection = 1;  // from 1; another one begins the stream anew
};

struct CaptureMetadata {
    std::string program;  // program_name() of the one that wrote it
    SourceIdentity source;
    HostTime started;  // both clocks at one moment: the file's time stamps are real time by this pair
    std::optional<CaptureSegment> segment{};  // absent in files of older versions
};

struct CaptureCheckpoint {
    HostTime time;
    std::uint64_t transfers = 0;     // in the file before this checkpoint
    std::uint64_t stream_bytes = 0;  // bulk IN data in the file before this checkpoint
    CaptureCounters counters;
    bool last = false;  // the writer closed the file behind it
};

// What somebody noted while the capture ran.
struct CaptureMark {
    HostTime time;                   // when it was made; it stands in the file a little later
    std::string text;                // may be empty
    std::uint64_t stream_bytes = 0;  // bulk IN data in the file before it
};

// "2026-11-21T05:04:55.123456789Z"
std::string utc_text(std::int64_t realtime_ns);

std::string metadata_json(const CaptureMetadata& metadata);
std::string checkpoint_json(const CaptureCheckpoint& checkpoint);
// Text beyond 4096 bytes is cut off.
std::string mark_json(const CaptureMark& mark);

// No value when the text is no JSON of the right schema. Fields that are missing keep their defaults.
std::optional<CaptureMetadata> read_metadata_json(std::string_view text);
std::optional<CaptureCheckpoint> read_checkpoint_json(std::string_view text);
std::optional<CaptureMark> read_mark_json(std::string_view text);

}  // namespace gyrolog
