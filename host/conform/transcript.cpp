#include "host/conform/transcript.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>

namespace gyrolog {
namespace {

template <typename Message>
std::optional<Message> message_in(const TranscriptEntry& entry, unsigned type,
                                  glp_status (*read)(const glp_frame*, Message*)) {
    if (!entry.is_frame(type)) { return std::nullopt; }
    const glp_frame frame = entry.view();
    Message message{};
    if (read(&frame, &message) != glp_status_ok) { return std::nullopt; }
    return message;
}

template <typename Message>
glp_status judged(const glp_frame& frame, glp_status (*read)(const glp_frame*, Message*)) {
    Message message{};
    return read(&frame, &message);
}

glp_status status_of_payload(const glp_frame& frame) {
    switch (frame.type) {
        case glp_frame_hello:
            return judged(frame, glp_hello_read);
        case glp_frame_config:
            return judged(frame, glp_config_read);
        case glp_frame_samples:
            return judged(frame, glp_samples_read);
        case glp_frame_status:
            return judged(frame, glp_device_status_read);
        case glp_frame_event:
            return judged(frame, glp_event_read);
        case glp_frame_reply:
            return judged(frame, glp_reply_read);
        default:
            return glp_status_ok;
    }
}

}  // namespace

std::optional<glp_hello> hello_in(const TranscriptEntry& entry) {
    return message_in(entry, glp_frame_hello, glp_hello_read);
}
std::optional<glp_config> config_in(const TranscriptEntry& entry) {
    return message_in(entry, glp_frame_config, glp_config_read);
}
std::optional<glp_samples> samples_in(const TranscriptEntry& entry) {
    return message_in(entry, glp_frame_samples, glp_samples_read);
}
std::optional<glp_device_status> status_in(const TranscriptEntry& entry) {
    return message_in(entry, glp_frame_status, glp_device_status_read);
}
std::optional<glp_event> event_in(const TranscriptEntry& entry) {
    return message_in(entry, glp_frame_event, glp_event_read);
}
std::optional<glp_reply> reply_in(const TranscriptEntry& entry) {
    return message_in(entry, glp_frame_reply, glp_reply_read);
}

void Transcript::take(const Transfer& transfer) {
    if (!origin_ns_) { origin_ns_ = transfer.time.monotonic_ns; }
    now_s_ = static_cast<double>(transfer.time.monotonic_ns - *origin_ns_) * 1e-9;
    if (transfer.carries_stream()) {
        take_stream(transfer.data);
        return;
    }
    if (transfer.event != Transfer::Event::submission) { return; }
    if (transfer.kind == TransferKind::control) {
        if (transfer.setup[1] != GLP_CDC_SET_CONTROL_LINE_STATE) { return; }
        TranscriptEntry line;
        line.kind = TranscriptEntry::Kind::line;
        line.raised = (transfer.setup[2] & GLP_CDC_LINE_DTR) != 0;
        add(std::move(line));
    } else if ((transfer.endpoint & 0x80U) == 0) {
        TranscriptEntry sent;
        sent.kind = TranscriptEntry::Kind::sent;
        const std::size_t kept = std::min(transfer.data.size(), TranscriptEntry::bytes_kept);
        sent.bytes.assign(transfer.data.begin(), transfer.data.begin() + static_cast<std::ptrdiff_t>(kept));
        add(std::move(sent));
    }
}

void Transcript::begin_here() {
    entries_.clear();
    kept_bytes_ = 0;
    foreign_ = candidate_bytes_ > 0;
    bytes_received_ = candidate_bytes_;
    delimiters_ = std::max<std::size_t>(delimiters_, 1);
}

void Transcript::take_stream(ByteView bytes) {
    bytes_received_ += bytes.size();
    for (const std::uint8_t byte : bytes) {
        if (byte != 0) {
            if (candidate_.size() < TranscriptEntry::bytes_kept) { candidate_.push_back(byte); }
            ++candidate_bytes_;
        } else {
            if (candidate_bytes_ > 0) { end_candidate(); }
            ++delimiters_;
        }
    }
}

void Transcript::end_candidate() {
    TranscriptEntry entry;
    entry.delimiters_before = std::exchange(delimiters_, 0);
    const bool overlong = std::exchange(candidate_bytes_, 0) > GLP_FRAME_ENCODED_MAX;
    entry.bytes = std::exchange(candidate_, {});
    if (std::exchange(foreign_, false)) { return; }
    std::array<std::uint8_t, GLP_FRAME_BODY_MAX> body{};
    glp_frame frame{};
    const glp_status status =
        overlong ? glp_status_bad_length
                 : glp_frame_decode(entry.bytes.data(), entry.bytes.size(), body.data(), &frame);
    if (status == glp_status_ok || status == glp_status_bad_version) { entry.version = body[0]; }
    if (status == glp_status_ok) {
        entry.kind = TranscriptEntry::Kind::frame;
        entry.type = frame.type;
        entry.flags = frame.flags;
        entry.sequence = frame.sequence;
        entry.payload.assign(frame.payload, frame.payload + frame.payload_bytes);
        entry.status = status_of_payload(frame);
    } else {
        entry.kind = TranscriptEntry::Kind::refused;
        entry.status = status;
    }
    add(std::move(entry));
}

void Transcript::add(TranscriptEntry entry) {
    if (full()) { return; }
    entry.at_s = now_s_;
    kept_bytes_ += entry.bytes.size() + entry.payload.size();
    entries_.push_back(std::move(entry));
}

}  // namespace gyrolog
