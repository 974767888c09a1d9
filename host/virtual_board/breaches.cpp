#include <algorithm>
#include <array>
#include <utility>

#include <gyrolog_protocol/cobs.h>
#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/message.h>

#include "host/virtual_board/breached_source.hpp"

namespace gyrolog {
namespace {

// ------------------------------------------------------------------------------------- fields of a payload

std::uint64_t field(const Bytes& payload, std::size_t at, unsigned bytes) {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < bytes; ++i) { value |= std::uint64_t{payload.at(at + i)} << (8U * i); }
    return value;
}

void set_field(Bytes& payload, std::size_t at, unsigned bytes, std::uint64_t value) {
    for (unsigned i = 0; i < bytes; ++i) {
        payload.at(at + i) = static_cast<std::uint8_t>(value >> (8U * i));
    }
}

bool is_event(const RawFrame& frame, unsigned code) {
    return frame.type == glp_frame_event && field(frame.payload, 16, 2) == code;
}

bool is_reply(const RawFrame& frame, unsigned command, unsigned result) {
    return frame.type == glp_frame_reply && frame.payload[4] == command && frame.payload[5] == result;
}

// Where device time stands in a frame that has it; all three begin with it.
bool has_ticks(const RawFrame& frame) {
    return frame.type == glp_frame_samples || frame.type == glp_frame_status || frame.type == glp_frame_event;
}

// A board may tell a text at any time while it streams: the frame that the next few breaches spoil.
RawFrame text_event(const RawFrame& status) {
    RawFrame event{.type = glp_frame_event, .payload = Bytes(24, 0)};
    std::copy_n(status.payload.begin(), 16, event.payload.begin());  // ticks and next_index
    set_field(event.payload, 16, 2, glp_event_text);
    set_field(event.payload, 18, 1, 2);
    event.payload.push_back('o');
    event.payload.push_back('k');
    return event;
}

bool is_periodic_status(const BreachedLine& line, const RawFrame& frame) {
    return frame.type == glp_frame_status && line.streaming;
}

// ------------------------------------------------------------------------------------------- frames: 1 to 3

void one_delimiter(BreachedLine& line, RawFrame& frame) {
    frame.sequence = line.next_number();
    line.set_next_number(frame.sequence + 1);
    const Bytes wire = frame.wire();
    line.send_bytes(ByteView(wire).subspan(1));
}

void version_2(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (!is_periodic_status(line, frame)) { return; }
    RawFrame event = text_event(frame);
    event.version = 2;
    line.send(event);
}

void flags_in_status(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_status) { frame.flags = 0x0008; }
    line.send(frame);
}

void empty_body(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (is_periodic_status(line, frame)) { line.send_bytes(wire_of_body(Bytes{1, 5, 0, 0})); }
}

void code_past_the_end(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (is_periodic_status(line, frame)) { line.send_bytes(Bytes{0, 9, 1, 5, 0}); }
}

// 254 bytes other than 00 at the end of a body, with the code byte behind them that other encoders write.
void empty_last_group(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (!is_periodic_status(line, frame)) { return; }
    Bytes wire(256, 0x33);
    wire.front() = 0;
    wire[1] = 0xFF;
    wire.push_back(0x01);
    wire.push_back(0);
    line.send_bytes(wire);
}

void wrong_checksum(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    // The final xor was left out.
    if (is_periodic_status(line, frame)) { line.send(text_event(frame), 0xFFFFFFFF); }
}

// ------------------------------------------------------------------------------------------ messages: 4

void unknown_type(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (is_periodic_status(line, frame)) { line.send({.type = 0x20, .payload = {1, 2, 3}}); }
}

void reserved_in_samples(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples) { frame.payload[26] = 0x5A; }
    line.send(frame);
}

void takes_short_commands(BreachedLine& line, RawFrame& frame) {
    if (is_reply(frame, glp_frame_configure, glp_result_bad_length)) { frame.payload[5] = glp_result_ok; }
    line.send(frame);
}

void empty_samples(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (frame.type != glp_frame_samples || line.noted++ % 50 != 49) { return; }
    RawFrame empty = frame;
    empty.payload.resize(GLP_SAMPLES_HEADER_BYTES);
    empty.payload[24] = 0;
    empty.flags = 0;
    line.send(empty);
}

void samples_with_a_tail(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples && frame.flags == 0 && line.noted++ % 20 == 19) {
        frame.payload.push_back(0x77);
    }
    line.send(frame);
}

void stale_generation(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples) { set_field(frame.payload, 16, 2, 0); }
    line.send(frame);
}

void no_first_flag(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples) {
        frame.flags &= static_cast<std::uint16_t>(~glp_flag_first_after_start);
    }
    line.send(frame);
}

void always_saturated(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples) { frame.flags |= glp_flag_saturated; }
    line.send(frame);
}

void garbage_behind_text(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_hello) { frame.payload[71] = 'x'; }
    line.send(frame);
}

void another_uid(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_hello) { frame.payload[16] = static_cast<std::uint8_t>(++line.noted); }
    line.send(frame);
}

void double_scale(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_config) { set_field(frame.payload, 16, 4, 2 * field(frame.payload, 16, 4)); }
    line.send(frame);
}

void register_says_otherwise(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_config) { frame.payload[34] ^= 0x08; }
    line.send(frame);
}

void hidden_decimation(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_config) { set_field(frame.payload, 14, 2, 1); }
    line.send(frame);
}

void never_streaming(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_status) { frame.payload[46] = 0; }
    line.send(frame);
}

void status_index_behind(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_status) { set_field(frame.payload, 8, 8, field(frame.payload, 8, 8) / 2); }
    line.send(frame);
}

void stopped_tells_samples(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_stopped)) {
        set_field(frame.payload, 20, 4, 100 + field(frame.payload, 8, 4));
    }
    line.send(frame);
}

void text_longer_than_told(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (!is_periodic_status(line, frame)) { return; }
    RawFrame event = text_event(frame);
    event.payload[18] = 40;
    line.send(event);
}

void reply_to_another_type(BreachedLine& line, RawFrame& frame) {
    if (is_reply(frame, glp_frame_get_status, glp_result_ok)) { frame.payload[4] = glp_frame_get_hello; }
    line.send(frame);
}

// Field by field of a CONFIGURE that is written whole and in order.
bool is_configure(const BreachedLine& /*line*/, ByteView bytes, RawFrame& frame) {
    std::array<std::uint8_t, GLP_FRAME_BODY_MAX> body{};
    glp_frame found{};
    if (bytes.size() < 3 || bytes.size() > GLP_FRAME_ENCODED_MAX + 2U ||
        glp_frame_decode(bytes.data() + 1, bytes.size() - 2, body.data(), &found) != glp_status_ok ||
        found.type != glp_frame_configure || found.payload_bytes != 16) {
        return false;
    }
    frame = {
        .type = found.type, .sequence = found.sequence, .payload = Bytes(found.payload, found.payload + 16)};
    return true;
}

Bytes same(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

Bytes ignores_full_scale(BreachedLine& line, ByteView bytes) {
    RawFrame configure;
    if (!is_configure(line, bytes, configure) || field(configure.payload, 4, 2) == 300) {
        return same(bytes);
    }
    set_field(configure.payload, 4, 2, 0);
    return configure.wire();
}

void refuses_a_third(BreachedLine& line, RawFrame& frame) {
    if (!line.kept && is_reply(frame, glp_frame_configure, glp_result_ok)) {
        line.kept = frame;  // until its CONFIG shows which rate it was
        return;
    }
    if (line.kept) {
        RawFrame reply = *std::exchange(line.kept, std::nullopt);
        if (frame.type == glp_frame_config && field(frame.payload, 4, 4) == 333'333) {
            reply.payload[5] = glp_result_bad_value;
            line.send(reply);
            ++line.noted;
            return;
        }
        line.send(reply);
    }
    // The generation that nobody heard of.
    if (frame.type == glp_frame_config) {
        set_field(frame.payload, 0, 2, field(frame.payload, 0, 2) - line.noted);
    }
    if (frame.type == glp_frame_samples) {
        set_field(frame.payload, 16, 2, field(frame.payload, 16, 2) - line.noted);
    }
    line.send(frame);
}

// A refused CONFIGURE changes the accelerometer's range all the same, up to the fifth one after it.
void half_applied(BreachedLine& line, RawFrame& frame) {
    if (is_reply(frame, glp_frame_configure, glp_result_bad_value) && !line.streaming) { line.noted = 1; }
    if (is_reply(frame, glp_frame_configure, glp_result_ok) && ++line.also_noted == 5) { line.noted = 0; }
    if (frame.type == glp_frame_config && line.noted == 1) {
        set_field(frame.payload, 10, 2, 2);
        set_field(frame.payload, 20, 4, 61'035'156);
        frame.payload[35] = 0;
    }
    line.send(frame);
}

void accepts_bad_values(BreachedLine& line, RawFrame& frame) {
    if (is_reply(frame, glp_frame_configure, glp_result_bad_value) && !line.streaming) {
        frame.payload[5] = glp_result_sensor_fault;
    }
    line.send(frame);
}

// --------------------------------------------------------------------------------- sequence and time: 5, 6

void sequence_restarts(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_started)) { line.set_next_number(0); }
    line.send(frame);
}

// Indices go on from one run to the next.
void index_goes_on(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_started)) { line.noted = line.also_noted; }
    if (has_ticks(frame) && !is_event(frame, glp_event_started)) {
        set_field(frame.payload, 8, 8, field(frame.payload, 8, 8) + line.noted);
    }
    if (frame.type == glp_frame_samples) { line.also_noted = field(frame.payload, 8, 8) + frame.payload[24]; }
    line.send(frame);
}

bool drops_this(BreachedLine& line, const RawFrame& frame) {
    return frame.type == glp_frame_samples && frame.flags == 0 && line.noted++ % 40 == 39;
}

void hides_a_loss(BreachedLine& line, RawFrame& frame) {
    if (!drops_this(line, frame)) { line.send(frame); }
}

// Counted, but neither flagged nor told.
void unflagged_loss(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_started)) { line.also_noted = 0; }
    if (drops_this(line, frame)) {
        line.also_noted += frame.payload[24];
        return;
    }
    if (frame.type == glp_frame_samples) {
        set_field(frame.payload, 20, 4, field(frame.payload, 20, 4) + line.also_noted);
    }
    if (frame.type == glp_frame_status) {
        set_field(frame.payload, 16, 4, field(frame.payload, 16, 4) + line.also_noted);
    }
    if (is_event(frame, glp_event_stopped)) { set_field(frame.payload, 20, 4, line.also_noted); }
    line.send(frame);
}

void boot_id_changes(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_hello) { set_field(frame.payload, 8, 4, ++line.noted); }
    line.send(frame);
}

void wide_ticks(BreachedLine& line, RawFrame& frame) {
    if (has_ticks(frame)) { frame.payload[5] = 0x01; }
    line.send(frame);
}

void ticks_jump_back(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_status && line.streaming && line.noted++ % 3 == 2) {
        set_field(frame.payload, 0, 8, (field(frame.payload, 0, 8) - 1'500'000) & 0xFFFFFFFF);
    }
    line.send(frame);
}

// A counter of 1 GHz with 32 bits.
void quick_wrap(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_hello) { set_field(frame.payload, 4, 4, 1'000'000'000); }
    if (has_ticks(frame)) {
        set_field(frame.payload, 0, 8, (field(frame.payload, 0, 8) * 1000) & 0xFFFFFFFF);
    }
    line.send(frame);
}

// The time of sending, which is that of the last sample: every other frame waits for the main loop. The frame
// before tells the period.
void ticks_when_sent(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples) {
        const RawFrame honest = frame;
        const std::uint64_t ticks = field(frame.payload, 0, 8);
        const std::uint64_t index = field(frame.payload, 8, 8);
        if (line.noted++ % 2 == 1 && index > field(line.kept->payload, 8, 8)) {
            const std::uint64_t since = (ticks - field(line.kept->payload, 0, 8)) & 0xFFFFFFFF;
            const std::uint64_t period = since / (index - field(line.kept->payload, 8, 8));
            set_field(frame.payload, 0, 8, (ticks + (frame.payload[24] - 1U) * period) & 0xFFFFFFFF);
        }
        line.kept = honest;
    }
    line.send(frame);
}

// The tick runs at 0.85 of what HELLO says.
void wrong_rate(BreachedLine& line, RawFrame& frame) {
    if (has_ticks(frame)) { set_field(frame.payload, 0, 8, field(frame.payload, 0, 8) * 85 / 100); }
    line.send(frame);
}

// --------------------------------------------------------------------------------- the board as receiver

// The command that a write holds, put right where the host made it wrong on purpose.
Bytes mended(ByteView bytes, bool version) {
    Bytes body(GLP_FRAME_BODY_MAX + 8);
    if (bytes.size() < 3) { return same(bytes); }
    const glp_cobs_result plain =
        glp_cobs_decode(bytes.data() + 1, bytes.size() - 2, body.data(), body.size());
    if (plain.status != glp_status_ok || plain.size < GLP_FRAME_BODY_MIN || (body[0] != 1) != version) {
        return same(bytes);
    }
    body.resize(plain.size);
    const RawFrame frame{.type = body[1],
                         .sequence = static_cast<std::uint32_t>(field(body, 4, 4)),
                         .payload = Bytes(body.begin() + 8, body.end() - 4)};
    return frame.wire();
}

Bytes takes_wrong_checksums(BreachedLine& /*line*/, ByteView bytes) { return mended(bytes, false); }
Bytes takes_other_versions(BreachedLine& /*line*/, ByteView bytes) { return mended(bytes, true); }

// Two commands that share a delimiter: the second one is not seen.
Bytes wants_own_delimiters(BreachedLine& /*line*/, ByteView bytes) {
    Bytes kept;
    bool open = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (bytes[i] != 0) { continue; }
        if (open && i > begin + 1) {
            kept.insert(kept.end(), bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                        bytes.begin() + static_cast<std::ptrdiff_t>(i) + 1);
            open = false;
        } else {
            open = true;
            begin = i;
        }
    }
    return kept.empty() ? same(bytes) : kept;
}

Bytes wants_whole_writes(BreachedLine& /*line*/, ByteView bytes) {
    return bytes.size() == 1 ? Bytes{} : same(bytes);
}

// What is too long takes the command behind it along.
Bytes overflows(BreachedLine& line, ByteView bytes) {
    const bool delimited =
        std::any_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; });
    if (!delimited && bytes.size() > 1) {
        line.noted += bytes.size();
        return {};
    }
    if (line.noted > 1020 && bytes.size() > 1) {
        line.noted = 0;
        return {};
    }
    return same(bytes);
}

// Noise in front of a command spoils it, too.
Bytes resynchronises_late(BreachedLine& /*line*/, ByteView bytes) {
    return !bytes.empty() && bytes.size() > 1 && bytes[0] != 0 && bytes[0] != 0x2A ? Bytes{} : same(bytes);
}

// ------------------------------------------------------------------------------------------- the device: 8

void no_hello_at_dtr(BreachedLine& line, RawFrame& frame) {
    if (line.just_raised && frame.type == glp_frame_hello) {
        line.just_raised = false;
        return;
    }
    line.send(frame);
}

void no_event_at_dtr(BreachedLine& line, RawFrame& frame) {
    if (line.just_raised && is_event(frame, glp_event_started)) {
        line.just_raised = false;
        return;
    }
    line.send(frame);
}

void no_stopped_at_dtr(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_stopped) && !line.raised) { return; }
    line.send(frame);
}

void talks_after_stop(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_status) { line.kept = frame; }
    line.send(frame);
    if (!is_event(frame, glp_event_stopped) || line.raised || !line.kept) { return; }
    line.kept->payload[46] = 0;
    std::copy_n(frame.payload.begin(), 16, line.kept->payload.begin());
    line.send(*line.kept);
}

void start_while_streaming(BreachedLine& line, RawFrame& frame) {
    if (has_ticks(frame)) { line.noted = field(frame.payload, 0, 8); }
    line.send(frame);
    // At a START that starts, the REPLY comes before the EVENT.
    if (!is_reply(frame, glp_frame_start, glp_result_ok) || !line.streaming) { return; }
    RawFrame event{.type = glp_frame_event, .payload = Bytes(24, 0)};
    set_field(event.payload, 0, 8, line.noted);
    set_field(event.payload, 16, 2, glp_event_started);
    line.send(event);
}

void stop_says_nothing(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_stopped) && line.raised && line.also_noted == 0) {
        line.kept = frame;  // of a STOP, unless the REPLY shows that it was a CONFIGURE
        return;
    }
    if (line.kept) {
        const RawFrame event = *std::exchange(line.kept, std::nullopt);
        if (frame.type != glp_frame_reply || frame.payload[4] != glp_frame_stop) { line.send(event); }
    }
    line.send(frame);
}

void ignores_unknown(BreachedLine& line, RawFrame& frame) {
    if (!is_reply(frame, 0xF0, glp_result_unknown_command)) { line.send(frame); }
}

void replies_twice(BreachedLine& line, RawFrame& frame) {
    line.send(frame);
    if (is_reply(frame, glp_frame_get_status, glp_result_ok)) { line.send(frame); }
}

void config_before_reply(BreachedLine& line, RawFrame& frame) {
    if (is_reply(frame, glp_frame_get_hello, glp_result_ok)) {
        line.kept = frame;
        return;
    }
    line.send(frame);
    if (line.kept && frame.type == glp_frame_config) { line.send(*std::exchange(line.kept, std::nullopt)); }
}

// A frame of the device's own kind is answered as if it were a command.
Bytes answers_echoes(BreachedLine& /*line*/, ByteView bytes) {
    std::array<std::uint8_t, GLP_FRAME_BODY_MAX> body{};
    glp_frame found{};
    if (bytes.size() < 3 || bytes.size() > GLP_FRAME_ENCODED_MAX + 2U ||
        glp_frame_decode(bytes.data() + 1, bytes.size() - 2, body.data(), &found) != glp_status_ok ||
        found.type >= 0x80) {
        return same(bytes);
    }
    return RawFrame{.type = 0xF0, .sequence = found.sequence, .payload = {}}.wire();
}

void same_generation(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_config) { set_field(frame.payload, 0, 2, 1); }
    if (frame.type == glp_frame_samples) { set_field(frame.payload, 16, 2, 1); }
    line.send(frame);
}

// A CONFIGURE while streaming does not tell that the old run has ended.
void configures_silently(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_stopped) && line.raised) {
        line.kept = frame;
        return;
    }
    if (line.kept) {
        const RawFrame event = *std::exchange(line.kept, std::nullopt);
        if (frame.type != glp_frame_reply || frame.payload[4] != glp_frame_configure) { line.send(event); }
    }
    line.send(frame);
}

void rare_status(BreachedLine& line, RawFrame& frame) {
    const bool asked = std::exchange(line.also_noted, frame.type == glp_frame_reply ? 1U : 0U) == 1;
    if (is_periodic_status(line, frame) && !asked && line.noted++ % 2 == 1) { return; }
    line.send(frame);
}

void hello_once(BreachedLine& line, RawFrame& frame) {
    if (is_event(frame, glp_event_started)) { line.noted = 1; }
    if (frame.type == glp_frame_reply || is_event(frame, glp_event_stopped)) { line.noted = 0; }
    const bool introduction = frame.type == glp_frame_hello || frame.type == glp_frame_config;
    if (!introduction || line.noted == 0) { line.send(frame); }
}

// Frames are held back until they are full.
void waits_for_full_frames(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_config) { line.noted = frame.payload[3]; }
    if (frame.type != glp_frame_samples) {
        if (line.kept) { line.send(*std::exchange(line.kept, std::nullopt)); }
        line.send(frame);
        return;
    }
    if (line.kept && frame.flags == 0 &&
        line.kept->payload[24] + frame.payload[24] <= static_cast<int>(line.noted)) {
        line.kept->payload[24] = static_cast<std::uint8_t>(line.kept->payload[24] + frame.payload[24]);
        line.kept->payload.insert(line.kept->payload.end(), frame.payload.begin() + GLP_SAMPLES_HEADER_BYTES,
                                  frame.payload.end());
    } else {
        if (line.kept) { line.send(*line.kept); }
        line.kept = frame;
    }
    if (line.kept->payload[24] >= line.noted) { line.send(*std::exchange(line.kept, std::nullopt)); }
}

// One sample a frame where the choice is the board's.
Bytes chooses_single_samples(BreachedLine& line, ByteView bytes) {
    RawFrame configure;
    if (!is_configure(line, bytes, configure) || configure.payload[11] != 0) { return same(bytes); }
    configure.payload[11] = 1;
    return configure.wire();
}

void speaks_unasked(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_status) { line.kept = frame; }
    line.send(frame);
    if (is_reply(frame, 0xF0, glp_result_unknown_command) && !line.streaming && line.kept) {
        line.send(*line.kept);
    }
}

// --------------------------------------------------------------------------------------------------- USB: 10

void another_vendor(SourceIdentity& identity) {
    identity.vendor_id = 0x0483;
    identity.product = "STM32 Virtual COM Port";
}

// NXP's example of a serial port, by its product string.
void another_product(SourceIdentity& identity) { identity.product = "VCOM Port"; }

// The endpoint for notifications is a bulk endpoint (USB 2.0, table 9-13).
void another_kind(SourceIdentity& identity) {
    Bytes& bytes = identity.configuration_descriptor;
    for (std::size_t i = 0; i + 3 < bytes.size() && bytes[i] >= 2; i += bytes[i]) {
        if (bytes[i + 1] == 5 && bytes[i + 3] == 3) { bytes[i + 3] = 2; }
    }
}

constexpr Breach in_frames(const char* name, const char* rule, const char* what,
                           void (*hook)(BreachedLine&, RawFrame&)) {
    return {name, rule, what, hook, nullptr, nullptr};
}
constexpr Breach in_writes(const char* name, const char* rule, const char* what,
                           Bytes (*hook)(BreachedLine&, ByteView)) {
    return {name, rule, what, nullptr, hook, nullptr};
}
constexpr Breach in_identity(const char* name, const char* rule, const char* what,
                             void (*hook)(SourceIdentity&)) {
    return {name, rule, what, nullptr, nullptr, hook};
}

constexpr std::array all_breaches{
    in_frames("one_delimiter", "1.3", "frames share one delimiter", one_delimiter),
    in_writes("own_delimiters", "1.3", "commands that share a delimiter are not seen", wants_own_delimiters),
    in_frames("version_2", "1.4", "some frames are of major version 2", version_2),
    in_frames("status_flags", "1.4", "STATUS has flags", flags_in_status),
    in_frames("short_body", "1.5", "a body of 4 bytes now and then", empty_body),
    in_writes("overflow", "1.6", "an overlong candidate takes the next command along", overflows),
    in_frames("cobs", "2.1", "a code byte points past the end now and then", code_past_the_end),
    in_frames("last_group", "2.2", "a code byte 01 follows a full last group", empty_last_group),
    in_frames("checksum", "3.1", "the final xor of the checksum is left out now and then", wrong_checksum),
    in_writes("takes_checksum", "3.2", "a command with a wrong checksum is obeyed", takes_wrong_checksums),
    in_frames("unknown_type", "4.1", "a frame of type 20 now and then", unknown_type),
    in_frames("reserved", "4.2", "a reserved byte of SAMPLES is not 0", reserved_in_samples),
    in_frames("short_command", "4.2", "a CONFIGURE of 8 bytes is answered ok", takes_short_commands),
    in_frames("empty_samples", "4.3.1", "SAMPLES without a sample now and then", empty_samples),
    in_frames("samples_tail", "4.3.2", "a byte behind the samples now and then", samples_with_a_tail),
    in_frames("generation", "4.3.3", "SAMPLES always have generation 0", stale_generation),
    in_frames("first_flag", "4.3.4", "first_after_start is never set", no_first_flag),
    in_frames("saturated", "4.3.4", "saturated is always set", always_saturated),
    in_frames("hello_padding", "4.4", "garbage behind the sensor's name", garbage_behind_text),
    in_frames("hello_changes", "4.4", "each HELLO has another uid", another_uid),
    in_frames("scale", "4.5", "the gyro's scale is twice the right one", double_scale),
    in_frames("register", "4.5", "GYRO_CONFIG says another range", register_says_otherwise),
    in_frames("decimation", "4.5.2", "decimation is always told as 1", hidden_decimation),
    in_frames("never_streaming", "4.6", "STATUS says 0 for streaming", never_streaming),
    in_frames("status_index", "4.6", "next_index is half of what it should be", status_index_behind),
    in_frames("stopped_value", "4.7", "EVENT stopped tells samples taken instead of lost",
              stopped_tells_samples),
    in_frames("event_text", "4.7.1", "a text shorter than it says now and then", text_longer_than_told),
    in_frames("reply_type", "4.8", "REPLY to GET_STATUS names GET_HELLO", reply_to_another_type),
    in_writes("full_scale", "4.9", "CONFIGURE does not set the gyro's range", ignores_full_scale),
    in_frames("rate_third", "4.9.1", "333.333 Hz is refused, 1000 Hz is not", refuses_a_third),
    in_frames("half_applied", "4.9.2", "a refused CONFIGURE changes the accelerometer's range", half_applied),
    in_frames("bad_value", "4.9.2", "what the sensor does not have is answered by sensor_fault",
              accepts_bad_values),
    in_frames("sequence", "5.1", "the sequence begins at 0 at each start", sequence_restarts),
    in_frames("index", "5.2", "indices go on across a start", index_goes_on),
    in_frames("hidden_loss", "5.3", "a frame of samples is dropped and not counted", hides_a_loss),
    in_frames("boot_id", "5.6", "each HELLO has another boot_id", boot_id_changes),
    in_frames("wide_ticks", "6.1", "ticks have bits above tick_bits", wide_ticks),
    in_frames("ticks_back", "6.1", "STATUS's ticks go backward now and then", ticks_jump_back),
    in_frames("quick_wrap", "6.2", "ticks wrap after 4.3 s", quick_wrap),
    in_frames("sent_ticks", "6.3", "first_ticks is the time of sending", ticks_when_sent),
    in_frames("rate", "6.4", "the tick runs at 0.85 of tick_hz", wrong_rate),
    in_writes("takes_version", "7.1", "a command of version 2 is obeyed", takes_other_versions),
    in_frames("no_hello", "8.1", "no HELLO when DTR rises", no_hello_at_dtr),
    in_frames("no_started", "8.1", "no EVENT started when DTR rises", no_event_at_dtr),
    in_frames("no_stopped", "8.2", "no EVENT stopped when DTR falls", no_stopped_at_dtr),
    in_frames("after_stop", "8.2", "a STATUS behind EVENT stopped when DTR falls", talks_after_stop),
    in_frames("start_twice", "8.3", "START while streaming brings another EVENT started",
              start_while_streaming),
    in_frames("silent_stop", "8.3", "STOP brings no EVENT stopped", stop_says_nothing),
    in_frames("no_reply", "8.4", "an unknown command is not answered", ignores_unknown),
    in_frames("two_replies", "8.4", "GET_STATUS is answered twice", replies_twice),
    in_frames("reply_late", "8.4", "REPLY comes behind HELLO and CONFIG", config_before_reply),
    in_writes("echo", "8.4", "a frame of the device's own kind is answered", answers_echoes),
    in_frames("same_generation", "8.5", "the generation does not count", same_generation),
    in_frames("silent_configure", "8.5", "CONFIGURE while streaming brings no EVENT stopped",
              configures_silently),
    in_frames("rare_status", "8.6", "STATUS comes every 2 s", rare_status),
    in_frames("hello_once", "8.6", "HELLO and CONFIG are not repeated", hello_once),
    in_frames("full_frames", "8.8", "samples wait until their frame is full", waits_for_full_frames),
    in_writes("single_samples", "8.9", "one sample a frame where the board may choose",
              chooses_single_samples),
    in_frames("unflagged_loss", "8.10", "a loss is counted and not flagged", unflagged_loss),
    in_writes("whole_writes", "9.2", "a command that comes byte by byte is not seen", wants_whole_writes),
    in_writes("late_resync", "9.4", "noise spoils the command behind it", resynchronises_late),
    in_identity("vendor", "10.1", "another vendor's id and product string", another_vendor),
    in_identity("product", "10.1", "another product string", another_product),
    in_identity("endpoint", "10.2", "the interrupt endpoint is a bulk endpoint", another_kind),
    in_frames("unasked", "10.5", "a STATUS that nobody asked for before the first start", speaks_unasked),
};

}  // namespace

std::span<const Breach> breaches() { return all_breaches; }

}  // namespace gyrolog
