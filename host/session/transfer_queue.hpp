// Between the source's thread and the writer's: transfers in fixed memory, in order.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "host/base/bytes.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

// Invariants:
//   - what pop() returns is what push() accepted, in the same order, and nothing else;
//   - memory is 2 * capacity_bytes from the constructor on, whatever comes; what a stall has filled of it is
//     given back to the system afterwards;
//   - push() never waits for the consumer beyond the copy of its own transfer.
class TransferQueue {
public:
    explicit TransferQueue(std::size_t capacity_bytes);

    // False when the transfer finds no room. Whether that loses data is the caller's business
    // (ByteSource::can_wait).
    bool push(const Transfer& transfer);

    // No more will be pushed; pop() returns what is left and then nothing.
    void close();

    // Waits until something is there, the queue is closed, or `wait` is over, and takes all there is.
    // The batch is valid until the next pop().
    class Batch {
    public:
        bool empty() const { return bytes_.empty(); }
        // Hands each transfer of the batch to `visit(const Transfer&)`.
        template <typename Visit>
        void for_each(Visit&& visit) const {
            for (std::size_t at = 0; at < bytes_.size();) { visit(read(at)); }
        }

    private:
        friend class TransferQueue;
        explicit Batch(ByteView bytes) : bytes_(bytes) {}
        Transfer read(std::size_t& at) const;

        ByteView bytes_;
    };
    Batch pop(std::chrono::milliseconds wait);

    // Whether close() was called and everything pushed has been popped.
    bool finished() const;
    std::size_t high_water_bytes() const;

private:
    const std::size_t capacity_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable ready_;
    Bytes filling_;
    Bytes draining_;
    std::size_t high_water_bytes_ = 0;
    bool closed_ = false;
};

}  // namespace gyrolog
