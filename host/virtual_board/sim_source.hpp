// The virtual board as a source of bytes, like one on USB.
//
// Without real time the board runs as fast as the sink takes its data, and waits when the sink has no room:
// nothing is lost. Times of the transfers are then the host's time at start() plus simulated time. With real
// time the board keeps to the clock; a sink without room makes the board's own ring overflow, as on a real
// bus.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/simulate/sensor_model.hpp"
#include "host/transport/byte_source.hpp"
#include "host/virtual_board/sim_options.hpp"
#include "host/virtual_board/virtual_board.hpp"

namespace gyrolog {

// Where a run ends by itself, counted from the stream's start. Whichever comes first.
struct SimLimit {
    std::optional<std::uint64_t> samples;  // exactly so many sampling instants
    std::optional<double> duration_s;      // of device time
};

class SimSource final : public ByteSource {
public:
    // `model`: what options.model_path names, read by the caller.
    // Error `invalid_argument` when the board refuses the options or the model.
    static Result<std::unique_ptr<SimSource>> create(const SimOptions& options, const SensorModel& model,
                                                     const SimLimit& limit);
    ~SimSource() override;
    SimSource(const SimSource&) = delete;
    SimSource& operator=(const SimSource&) = delete;

    // Before start(), as the board is set up then.
    double stream_bytes_per_sample() const;

    const SourceIdentity& identity() const override { return identity_; }
    // In real time it goes on, as a board does.
    bool can_wait() const override { return !realtime_; }
    double tolerated_stall_s(double bytes_per_s, double bytes_per_frame) const override;
    void expect(double bytes_per_s, double bytes_per_frame) override;
    Status start(TransferSink& sink) override;
    Status set_line_state(bool data_terminal_ready) override;
    Status write(ByteView bytes) override;
    void stop() override;
    Status reconnect() override;

private:
    // A call of the host on its way to the source's thread.
    struct Call {
        std::optional<bool> line_state;  // or else the bytes
        Bytes bytes;
        std::size_t queued_bytes = 0;  // or else what the host queues from now on
    };

    SimSource(const SimOptions& options, const SimLimit& limit, std::unique_ptr<VirtualBoard> board);

    Status enqueue(Call call);
    void run();
    void run_as_fast_as_taken();
    void run_in_real_time();
    bool answer_calls();
    bool wait_for_call(std::int64_t time_ns);
    void make(const Call& call);
    bool finish_stream();
    bool let_time_pass();
    bool deliver_bytes(std::size_t at_least);
    bool deliver_packets();
    bool deliver_in(ByteView data, int status);
    void deliver_pair(TransferKind kind, std::uint8_t endpoint, const std::array<std::uint8_t, 8>& setup,
                      ByteView data);
    bool hand_over(Transfer& transfer);
    std::int64_t board_ns_of_now() const;  // in real time
    HostTime host_time() const;
    HostTime host_time_of(std::int64_t board_ns) const;
    bool stopping();

    SourceIdentity identity_;
    bool realtime_;
    std::unique_ptr<VirtualBoard> board_;  // once started the source's thread's
    std::size_t ring_bytes_;               // of the board
    Bytes buffer_;
    std::atomic<std::size_t> queued_bytes_;  // of the stream, by the host: real time

    // The source's thread's own.
    TransferSink* sink_ = nullptr;
    bool started_before_ = false;
    HostTime origin_;  // host time of board time origin_board_ns_
    std::int64_t origin_board_ns_ = 0;
    HostTime last_event_;
    std::uint64_t next_id_ = 1;
    std::optional<SourceEnd> end_;

    std::mutex mutex_;
    std::condition_variable called_;
    std::deque<Call> calls_;
    bool stop_wanted_ = false;
    bool ended_ = false;
    std::thread thread_;
};

}  // namespace gyrolog
