// Bytes in, typed messages out. Keeps nothing but the frame that is not complete yet.
#pragma once

#include <array>
#include <cstdint>

#include "host/base/bytes.hpp"
#include "host/base/clock.hpp"
#include "host/decode/protocol.hpp"

namespace gyrolog {

// An intact frame. A view: its payload is valid during the call that hands it over.
struct ReceivedFrame {
    glp_frame frame;
    HostTime arrival;  // of the transfer that completed the frame
};

// Takes what a FrameDecoder finds, in the order of the stream. Pointers inside a message are valid during the
// call.
class MessageHandler {
public:
    virtual ~MessageHandler() = default;

    virtual void on_hello(const ReceivedFrame& /*frame*/, const glp_hello& /*hello*/) {}
    virtual void on_config(const ReceivedFrame& /*frame*/, const glp_config& /*config*/) {}
    virtual void on_samples(const ReceivedFrame& /*frame*/, const glp_samples& /*samples*/) {}
    virtual void on_status(const ReceivedFrame& /*frame*/, const glp_device_status& /*status*/) {}
    virtual void on_event(const ReceivedFrame& /*frame*/, const glp_event& /*event*/) {}
    virtual void on_reply(const ReceivedFrame& /*frame*/, const glp_reply& /*reply*/) {}
    // A type this version does not know. Not an error: a newer minor version may have more.
    virtual void on_unknown(const ReceivedFrame& /*frame*/) {}
    // Intact by its checksum, but its payload is not what its type promises.
    virtual void on_malformed(const ReceivedFrame& /*frame*/, glp_status /*reason*/) {}
};

// Every byte fed is in an intact frame, skipped, or waiting for the rest of its frame.
struct ByteAccounts {
    std::uint64_t total = 0;
    std::uint64_t in_frames = 0;
    std::uint64_t skipped = 0;
    std::uint64_t buffered = 0;

    bool balanced() const { return total == in_frames + skipped + buffered; }
};

class FrameDecoder {
public:
    FrameDecoder() { glp_stream_init(&stream_); }

    // The cuts between feeds carry no meaning: any slicing of a stream gives the same messages.
    void feed(ByteView bytes, HostTime arrival, MessageHandler& handler);

    // What comes next does not continue what came before: a frame that waits for its rest is skipped.
    void cut();

    ByteAccounts bytes() const;
    // Bytes skipped before the first intact frame: a stream that was joined in its middle begins with half a
    // frame.
    std::uint64_t bytes_skipped_at_head() const;
    std::uint64_t intact_frames() const { return stream_.frames; }
    // Candidates that were no intact frame, by glp_status, and intact frames with a malformed payload.
    // Half a frame at the head of a stream that was joined in its middle is none of them: it came whole to
    // somebody else.
    std::uint64_t rejected(std::size_t reason) const {
        return stream_.rejected[reason] - rejected_at_head_[reason];
    }
    const std::array<std::uint64_t, glp_status_count>& malformed() const { return malformed_; }

private:
    void deliver(const ReceivedFrame& received, MessageHandler& handler);
    std::size_t head_of(ByteView bytes);

    glp_stream stream_;
    std::array<std::uint64_t, glp_status_count> malformed_{};
    std::uint64_t skipped_at_head_ = 0;
    bool at_head_ = true;  // no delimiter has come yet
    std::array<std::uint64_t, glp_status_count> rejected_at_head_{};
};

}  // namespace gyrolog
