#include "host/decode/frame_decoder.hpp"

#include <algorithm>

namespace gyrolog {
namespace {

template <typename Message>
glp_status deliver_as(const ReceivedFrame& received, MessageHandler& handler,
                      glp_status (*read)(const glp_frame*, Message*),
                      void (MessageHandler::*hand_over)(const ReceivedFrame&, const Message&)) {
    Message message{};
    const glp_status status = read(&received.frame, &message);
    if (status == glp_status_ok) { (handler.*hand_over)(received, message); }
    return status;
}

glp_status deliver_by_type(const ReceivedFrame& received, MessageHandler& handler) {
    switch (received.frame.type) {
        case glp_frame_hello:
            return deliver_as(received, handler, glp_hello_read, &MessageHandler::on_hello);
        case glp_frame_config:
            return deliver_as(received, handler, glp_config_read, &MessageHandler::on_config);
        case glp_frame_samples:
            return deliver_as(received, handler, glp_samples_read, &MessageHandler::on_samples);
        case glp_frame_status:
            return deliver_as(received, handler, glp_device_status_read, &MessageHandler::on_status);
        case glp_frame_event:
            return deliver_as(received, handler, glp_event_read, &MessageHandler::on_event);
        case glp_frame_reply:
            return deliver_as(received, handler, glp_reply_read, &MessageHandler::on_reply);
        default:
            handler.on_unknown(received);
            return glp_status_ok;
    }
}

}  // namespace

// How many of the bytes to take at once: at the head up to the first delimiter, so that what it ends is
// judged by itself.
std::size_t FrameDecoder::head_of(ByteView bytes) {
    if (!at_head_) { return bytes.size(); }
    const auto delimiter = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
    if (delimiter == bytes.end()) { return bytes.size(); }
    at_head_ = false;
    return static_cast<std::size_t>(delimiter - bytes.begin()) + 1;
}

void FrameDecoder::feed(ByteView bytes, HostTime arrival, MessageHandler& handler) {
    while (!bytes.empty()) {
        ReceivedFrame received{{}, arrival};
        bool have_frame = false;
        const bool was_at_head = at_head_;
        const std::size_t offered = head_of(bytes);
        const std::size_t taken =
            glp_stream_push(&stream_, bytes.data(), offered, &received.frame, &have_frame);
        bytes = bytes.subspan(taken);
        if (was_at_head && !at_head_) {
            std::copy_n(stream_.rejected, rejected_at_head_.size(), rejected_at_head_.begin());
        }
        if (have_frame) { deliver(received, handler); }
    }
}

void FrameDecoder::cut() {
    stream_.bytes_skipped += glp_stream_buffered(&stream_);
    stream_.encoded_bytes = 0;
    stream_.leading_delimiter = false;
    stream_.overlong = false;
}

void FrameDecoder::deliver(const ReceivedFrame& received, MessageHandler& handler) {
    if (stream_.frames == 1) { skipped_at_head_ = stream_.bytes_skipped; }
    const glp_status status = deliver_by_type(received, handler);
    if (status != glp_status_ok) {
        ++malformed_[status];
        handler.on_malformed(received, status);
    }
}

ByteAccounts FrameDecoder::bytes() const {
    return {stream_.bytes_in, stream_.bytes_in_frames, stream_.bytes_skipped, glp_stream_buffered(&stream_)};
}

std::uint64_t FrameDecoder::bytes_skipped_at_head() const {
    return stream_.frames == 0 ? stream_.bytes_skipped : skipped_at_head_;
}

}  // namespace gyrolog
