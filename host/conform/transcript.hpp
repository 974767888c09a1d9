// What was said on the line, in order: what the device sent, cut at its delimiters and judged, and what the
// host did. The rules look at nothing else.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/message.h>

#include "host/base/bytes.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

struct TranscriptEntry {
    enum class Kind : std::uint8_t {
        frame,    // from the device, intact
        refused,  // from the device: bytes between two delimiters that are no frame
        sent,     // by the host
        line,     // DTR, set by the host
    };

    Kind kind = Kind::frame;
    double at_s = 0.0;  // since the transcript began, of the transfer that brought it
    Bytes bytes;        // without delimiters; `sent`: as written. At most bytes_kept of them
    // frame: how its payload stands to its type (ok for a type that this version does not know).
    // refused: the first failure.
    glp_status status = glp_status_ok;
    std::size_t delimiters_before = 0;  // frame, refused: how many 00 stand in front
    std::uint8_t version = 0;           // frame, and refused for its version
    std::uint8_t type = 0;              // frame, as are the following
    std::uint16_t flags = 0;
    std::uint32_t sequence = 0;
    Bytes payload;
    bool raised = false;  // line

    static constexpr std::size_t bytes_kept = 1100;

    bool is_frame(unsigned of_type) const { return kind == Kind::frame && type == of_type; }
    glp_frame view() const { return {type, flags, sequence, payload.data(), payload.size()}; }
};

// Of a message by its type: nothing unless this is a well-formed frame of that type. `samples` point into the
// entry.
std::optional<glp_hello> hello_in(const TranscriptEntry& entry);
std::optional<glp_config> config_in(const TranscriptEntry& entry);
std::optional<glp_samples> samples_in(const TranscriptEntry& entry);
std::optional<glp_device_status> status_in(const TranscriptEntry& entry);
std::optional<glp_event> event_in(const TranscriptEntry& entry);
std::optional<glp_reply> reply_in(const TranscriptEntry& entry);

// Bounded: a device that talks without end fills it, and what comes then is only counted.
class Transcript {
public:
    static constexpr std::size_t entries_max = 60'000;
    static constexpr std::size_t bytes_max = std::size_t{8} << 20U;

    void take(const Transfer& transfer);
    // What came so far was there before the conversation: it is forgotten, a frame that has begun with it.
    void begin_here();

    const std::vector<TranscriptEntry>& entries() const { return entries_; }
    bool full() const { return entries_.size() >= entries_max || kept_bytes_ >= bytes_max; }
    std::size_t kept_bytes() const { return kept_bytes_; }
    std::uint64_t bytes_received() const { return bytes_received_; }
    // Of the candidate that no delimiter has ended yet.
    const Bytes& unended() const { return candidate_; }
    double now_s() const { return now_s_; }

private:
    void take_stream(ByteView bytes);
    void end_candidate();
    void add(TranscriptEntry entry);

    std::vector<TranscriptEntry> entries_;
    Bytes candidate_;
    std::size_t candidate_bytes_ = 0;  // as they came, also those that are not kept
    std::size_t delimiters_ = 0;
    bool foreign_ = false;  // the candidate began before the conversation
    std::uint64_t bytes_received_ = 0;
    std::size_t kept_bytes_ = 0;  // of all entries
    std::optional<std::int64_t> origin_ns_;
    double now_s_ = 0.0;
};

}  // namespace gyrolog
