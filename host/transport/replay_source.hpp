// A stored capture behind the seam of a live device: the same transfers, bit for bit, as fast as the sink
// takes them.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "host/capture/capture_reader.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

class ReplaySource final : public ByteSource {
public:
    // Errors: those of CaptureReader::open.
    static Result<std::unique_ptr<ReplaySource>> open(const std::string& path);

    ReplaySource(const ReplaySource&) = delete;
    ReplaySource& operator=(const ReplaySource&) = delete;
    ~ReplaySource() override;

    // The captured device's, with the file as its URI.
    const SourceIdentity& identity() const override { return identity_; }
    bool can_wait() const override { return true; }
    double tolerated_stall_s(double bytes_per_s, double bytes_per_frame) const override;

    // Plays once. Transfers keep the times of the capture. Damage in the file is passed over, as its
    // transfers are lost; the reader's accounts tell of it.
    Status start(TransferSink& sink) override;
    // A capture obeys no one: error `unsupported`.
    Status set_line_state(bool data_terminal_ready) override;
    Status write(ByteView bytes) override;
    void stop() override;

    // After on_end.
    CaptureAccounts accounts() const { return reader_.accounts(); }

private:
    ReplaySource(CaptureReader reader, const std::string& path);

    void play(TransferSink& sink);
    bool deliver(TransferSink& sink, const Transfer& transfer) const;

    CaptureReader reader_;
    SourceIdentity identity_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace gyrolog
