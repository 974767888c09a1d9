// A conformance run as the rules see it: the transcript, and what was meant by each part of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/conform/transcript.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

// What the host says, one each. The order is that of the conversation.
enum class Ask : std::uint8_t {
    // before the first start
    hello,
    status,
    unknown_type,
    echo,              // a frame of the device's own kind: not answered
    bad_checksum,      // a CONFIGURE that would change something: not answered
    other_version,     // likewise
    short_configure,   // 8 bytes
    long_hello,        // 4 bytes that a later minor version may have
    shared_delimiter,  // two commands with one 00 between them, the second one
    many_delimiters,
    in_pieces,        // byte by byte
    after_noise,      // behind bytes that no frame owns
    after_damage,     // behind a command that lacks a byte
    after_overlong,   // behind 3000 bytes without a delimiter
    bad_full_scale,   // 300 °/s
    bad_combination,  // a good range beside a rate that no sensor has
    bad_layout,
    too_many_samples,
    hello_after_refusals,
    stop_while_stopped,
    rate_slow,       // 3.906 Hz
    rate_third,      // 333.333 Hz
    rate_kilohertz,  // 1000 Hz
    one_field,       // full scale 1000 °/s, the rest is left
    standard,        // 100 Hz, 500 °/s, 8 g, 41 Hz, gyro and accelerometer, samples per frame by the device
    start,           // only without DTR
    // while it streams
    start_again,
    hello_streaming,
    status_streaming,
    refused_streaming,  // a CONFIGURE
    unknown_streaming,
    configure_streaming,  // 20 Hz, 20 samples a frame
    // stopped once more
    status_stopped,
    decimated,  // 200 Hz by leaving out samples
    // while it streams again
    stop,
    status_after_stop,
    start_by_command,
    status_at_end,
    stop_at_end,
    restore,
    count
};

// What a CONFIGURE asks for; 0 as in the specification.
struct AskedSettings {
    std::uint32_t rate_mHz = 0;
    std::uint16_t gyro_full_scale_dps = 0;
    std::uint16_t accel_full_scale_g = 0;
    std::uint16_t dlpf_hz = 0;
    std::uint8_t layout = 0;
    std::uint8_t samples_per_frame = 0;
};

struct Exchange {
    unsigned type = 0;
    std::uint32_t number = 0;
    std::size_t sent = 0;              // entries before this one came earlier than the command
    std::optional<std::size_t> reply;  // the entry of the first REPLY
    std::optional<glp_reply> answer;
    std::size_t replies = 0;
    std::size_t end = 0;      // one behind the last entry that came before anything else was said or answered
    AskedSettings configure;  // of a CONFIGURE
};

// Entries [begin, end) of a transcript.
struct Passage {
    std::size_t begin = 0;
    std::size_t end = 0;
};

// From a start to the next one.
struct Run {
    enum class By : std::uint8_t { line, command, configure };
    By by = By::line;
    Passage entries;
    std::optional<glp_config> config = std::nullopt;  // the one in force
    std::optional<Ask> ask = std::nullopt;            // the command that began it
};

struct Dialogue {
    SourceIdentity identity;
    bool on_usb = false;    // for real, not a virtual board's descriptors
    bool has_line = false;  // DTR
    bool held_up = false;
    Transcript transcript;
    std::array<std::optional<Exchange>, static_cast<std::size_t>(Ask::count)> exchanges;
    std::size_t first_start = 0;       // entries before this one came before any start
    std::optional<Passage> lowered;    // from the falling DTR up to the next thing the host did
    std::optional<Passage> quiet_run;  // the first run, as long as the host said nothing
    std::vector<Run> runs;
    bool never_quiet = false;  // it talked on after it had been told to stop, before the conversation began
    std::string broken_off;    // why the conversation ended before its end; empty when it did not

    const std::vector<TranscriptEntry>& entries() const { return transcript.entries(); }
    const std::optional<Exchange>& asked(Ask ask) const { return exchanges[static_cast<std::size_t>(ask)]; }
    const TranscriptEntry& entry(std::size_t i) const { return transcript.entries()[i]; }
    // The last well-formed HELLO.
    std::optional<glp_hello> hello() const;
    std::optional<glp_config> last_config_before(std::size_t entry) const;
    bool answers_commands() const;
    // Ticks that have passed from one to the other, by the width that HELLO tells.
    double elapsed_s(std::uint64_t from_ticks, std::uint64_t to_ticks) const;
};

}  // namespace gyrolog
