// A board that breaks one rule of the protocol: the honest virtual board, with its stream or its commands
// tampered with on the way. For trying the conformance rules: `sim:breach=NAME`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gyrolog_protocol/frame_stream.h>

#include "host/transport/byte_source.hpp"
#include "host/transport/raw_frame.hpp"

namespace gyrolog {

// What a breach has to work with. Frames are numbered as they are sent: one that is left out or put in makes
// no hole in the sequence.
class BreachedLine {
public:
    void send(RawFrame frame, std::uint32_t checksum_error = 0);
    void send_bytes(ByteView bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }
    // For the next frame; a breach of its own.
    void set_next_number(std::uint32_t number) { next_number_ = number; }
    std::uint32_t next_number() const { return next_number_; }

    // What has been so far.
    bool raised = false;       // DTR
    bool just_raised = false;  // until the breach clears it
    bool streaming = false;    // by the EVENTs

    // The breach's own notes.
    std::uint64_t noted = 0;
    std::uint64_t also_noted = 0;
    std::optional<RawFrame> kept;

private:
    friend class BreachedSource;
    Bytes out_;
    std::uint32_t next_number_ = 0;
    bool numbered_ = false;
};

struct Breach {
    const char* name;
    const char* rule;  // of SPEC.md: the one that is broken, and no other
    const char* what;
    // Each may be null. A frame is sent on by the breach itself.
    void (*on_frame)(BreachedLine&, RawFrame&);
    // Bytes that the host writes, and the bytes that the board then gets: those are what the sink is told of.
    Bytes (*on_write)(BreachedLine&, ByteView);
    void (*on_identity)(SourceIdentity&);
};

std::span<const Breach> breaches();
const Breach* breach_named(std::string_view name);

class BreachedSource final : public ByteSource, private TransferSink {
public:
    BreachedSource(std::unique_ptr<ByteSource> board, const Breach& breach);
    BreachedSource(const BreachedSource&) = delete;
    BreachedSource& operator=(const BreachedSource&) = delete;
    ~BreachedSource() override { BreachedSource::stop(); }

    const SourceIdentity& identity() const override { return identity_; }
    bool can_wait() const override { return board_->can_wait(); }
    double tolerated_stall_s(double bytes_per_s, double bytes_per_completion) const override {
        return board_->tolerated_stall_s(bytes_per_s, bytes_per_completion);
    }
    Status start(TransferSink& sink) override;
    Status set_line_state(bool data_terminal_ready) override;
    Status write(ByteView bytes) override;
    void stop() override { board_->stop(); }
    void let_go() override { board_->let_go(); }

private:
    bool on_transfer(const Transfer& transfer) override;
    void on_end(SourceEnd end, const std::optional<Error>& error) override;
    void tamper(ByteView bytes);
    void take_frame(const glp_frame& frame);
    bool hand_on(Transfer transfer);

    std::unique_ptr<ByteSource> board_;
    const Breach& breach_;
    SourceIdentity identity_;
    TransferSink* sink_ = nullptr;
    glp_stream frames_{};

    std::mutex mutex_;  // for the line: the host's thread writes, the board's delivers
    BreachedLine line_;
    // Of a transfer that found no room: it comes again, and must not be tampered with twice.
    std::optional<Bytes> waiting_;
};

}  // namespace gyrolog
