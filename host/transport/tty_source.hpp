// A serial port, as a byte source: the kernel's cdc_acm driver, a UART bridge, or a pseudo-terminal.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/base/call_queue.hpp"
#include "host/transport/byte_source.hpp"
#include "host/transport/line_silence.hpp"
#include "host/transport/raw_port.hpp"

namespace gyrolog {

// Tells what cdc_acm would put on the wire for it, so that captures look alike: each read is a bulk IN
// transfer, each write a bulk OUT transfer, each change of DTR a SET_CONTROL_LINE_STATE request. The kernel
// has already taken the transfers apart, so their boundaries are those of the reads.
//
// Threads: everything, including write() and set_line_state(), is carried out by the thread that start()
// starts.
class TtySource final : public ByteSource {
public:
    // Errors: those of RawPort.
    static Result<std::unique_ptr<TtySource>> open(const std::string& path, TtySpeed speed = {});
    TtySource(const TtySource&) = delete;
    TtySource& operator=(const TtySource&) = delete;
    ~TtySource() override;

    const SourceIdentity& identity() const override { return identity_; }
    bool can_wait() const override { return false; }
    double tolerated_stall_s(double bytes_per_s, double bytes_per_frame) const override;

    Status start(TransferSink& sink) override;
    Status set_line_state(bool data_terminal_ready) override;
    Status write(ByteView bytes) override;
    void stop() override;
    // A port on USB may come back under another name: it is known by its serial number.
    Status reconnect() override;
    void let_go() override;

private:
    struct PendingWrite;
    // By which the transfers are told.
    struct Endpoints {
        std::uint8_t in = line_endpoint_in;
        std::uint8_t out = line_endpoint_out;
    };

    TtySource(RawPort port, const std::string& path, TtySpeed speed, int wake);
    void identify(const std::string& path);

    void run();
    void wait_for_events();
    void read_available(bool hung_up);
    void write_pending();
    void finish_write(int kernel_status, Status status);
    void tell_read_submission();
    void tell_read_completion(int status, ByteView data);
    Status change_line_state(bool data_terminal_ready);
    void lose(int error_number);
    void wake() const;

    std::optional<RawPort> port_;  // none between the loss of a port and its return
    std::string path_;
    const TtySpeed speed_;
    const int wake_;  // an eventfd: makes the thread look at its calls
    SourceIdentity identity_;
    Endpoints endpoints_;
    CallQueue calls_;
    std::thread thread_;
    std::atomic<bool> stop_asked_{false};

    // The thread's.
    TransferSink* sink_ = nullptr;
    std::vector<std::uint8_t> buffer_;
    std::uint64_t last_id_ = 0;
    std::uint64_t read_id_ = 0;
    LineSilence silence_;
    PendingWrite* pending_write_ = nullptr;
    bool lost_ = false;
    std::string lost_why_;
};

}  // namespace gyrolog
