// A queue of bulk IN transfers that is kept full from start to stop.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "host/base/result.hpp"
#include "host/transport/transfer.hpp"
#include "host/usb/usb_context.hpp"

struct libusb_device_handle;
struct libusb_transfer;

namespace gyrolog {

// How many transfers wait at once, and the size of each.
//
// While the reader stands still the kernel goes on filling what is queued, so the stall that costs nothing is
//   transfers * bytes_per_completion / bytes_per_s.
// A short packet completes its transfer: a board that sends each frame as a short packet fills one transfer a
// frame whatever the transfer's size, and only the number of transfers helps; one that streams full packets
// fills them to the brim, and large ones are cheaper. usbfs counts requested bytes against 16 MiB for the
// whole system.
struct BulkInPlan {
    std::uint32_t transfers;
    std::uint32_t transfer_bytes;  // a multiple of the endpoint's packet

    // Rides out 2 s at `completions_per_s`; a frame longer than 512 bytes takes two completions.
    static BulkInPlan for_short_packets(double completions_per_s);
    // Rides out `stall_s` of such a stream, in at most 4 MiB: in transfers that hold a frame each, or in
    // large ones when the bus has no time left for short packets.
    static BulkInPlan for_stream(double bytes_per_s, double bytes_per_frame, double stall_s);
    // Before anything is known of the stream: a frame each millisecond. That is 1 MB, which at 16 samples a
    // frame is also enough for 8 kHz.
    static BulkInPlan for_unknown_stream() { return for_short_packets(1000.0); }
};

// Hears of each transfer on the event thread, in the kernel's order. Must not call back into the source of
// the news.
class TransferObserver {
public:
    virtual ~TransferObserver() = default;
    virtual void on_usb_transfer(const Transfer& transfer) = 0;
};

// Lifetime rule: a transfer belongs to libusb from submit until its callback has run; cancelling only asks.
// stop() therefore cancels, waits for the last callback, and only then returns; the destructor stops. The
// context and the device handle must outlive this object. stop() must not be called from the observer or the
// end handler.
//
// What goes wrong on the bus:
//   - the device is gone: the stream ends, device_lost
//   - errors (bad packets, babble): the transfer goes back into the queue with whatever it brought; as many
//     errors in a row as there are transfers mean that the device is as good as gone
//   - a stall: all transfers are taken back, the halt is cleared, the queue is filled again; at most
//     stall_limit times in a row without data between
//   - nothing but empty packets, faster than any board has reason to: the stream ends rather than burn the
//     processor
//   - a transfer that the kernel will not take back for want of memory is done without, down to the last
class BulkInStream final : private EventFailureListener {
public:
    enum class End { stopped, device_lost, failed };
    // Called once for each successful start, on the event thread, after the last transfer has completed. The
    // error says why, unless the end is `stopped`.
    using EndHandler = std::function<void(End, const std::optional<Error>&)>;

    static constexpr unsigned stall_limit = 8;

    BulkInStream(UsbContext& usb, libusb_device_handle* device, std::uint8_t endpoint, BulkInPlan plan,
                 TransferObserver& observer);
    BulkInStream(const BulkInStream&) = delete;
    BulkInStream& operator=(const BulkInStream&) = delete;
    ~BulkInStream() override;

    // Queues the transfers, as many of the planned ones as the kernel has memory for. Fails when it takes
    // none.
    Status start(EndHandler on_end);
    // Returns after the end handler. Harmless when not running.
    void stop();
    // Waits until the stream has ended by itself, at most so long; true when it has.
    bool wait_for_end(std::int64_t timeout_ms);

    // Queues these transfers behind the present ones, each of which leaves the queue with the data it was
    // waiting for: the stream goes on without a gap. Where the kernel has not the memory for all of them,
    // those it took are queued in addition. Does nothing when not running.
    void deepen(BulkInPlan plan);
    // What the queue holds of a stream whose frames of so many bytes each end with a short packet. Before
    // start(): of what is planned.
    double capacity_bytes(double bytes_per_frame) const;

private:
    struct Slot {
        BulkInStream* stream = nullptr;
        libusb_transfer* transfer = nullptr;
        std::uint32_t bytes = 0;
        std::uint64_t id = 0;
        bool in_flight = false;
        bool retired = false;  // not queued again
    };
    enum class State { idle, running, clearing_halt, ending };

    Status allocate(BulkInPlan plan);
    int submit(Slot& slot);
    int submit_all();
    void cancel_all();
    void on_complete(Slot& slot);
    void tell_completion(const Slot& slot, int kernel_status, ByteView data);
    void on_event_failure(const Error& error) override;
    void judge(int status, std::size_t received_bytes);
    void count_empty();
    void begin_end(End end, std::optional<Error> error);
    void when_none_in_flight();
    void finish();

    UsbContext& usb_;
    libusb_device_handle* device_;
    std::uint8_t endpoint_;
    BulkInPlan plan_;
    TransferObserver& observer_;

    // The event thread's.
    std::deque<std::vector<std::uint8_t>> buffers_;
    std::deque<Slot> slots_;
    State state_ = State::idle;
    std::uint32_t in_flight_ = 0;
    unsigned errors_in_row_ = 0;
    unsigned stalls_in_row_ = 0;
    unsigned empty_in_row_ = 0;
    std::int64_t first_empty_ns_ = 0;
    End end_ = End::stopped;
    std::optional<Error> error_;
    EndHandler on_end_;

    std::mutex mutex_;
    std::condition_variable ended_changed_;
    bool ended_ = true;
};

}  // namespace gyrolog
