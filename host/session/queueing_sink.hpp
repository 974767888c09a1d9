// Between a source's thread and the queue that the writer drains.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "host/session/transfer_queue.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

// The source's thread hands transfers over here; what finds no room is counted.
class QueueingSink final : public TransferSink {
public:
    QueueingSink(TransferQueue& queue, bool source_waits) : queue_(queue), source_waits_(source_waits) {}

    bool on_transfer(const Transfer& transfer) override {
        if (transfer.carries_stream() && !transfer.data.empty()) {
            data_transfers_.fetch_add(1, std::memory_order_relaxed);
        }
        if (queue_.push(transfer)) { return true; }
        if (!source_waits_) {
            ++transfers_dropped_;
            bytes_dropped_ += transfer.data.size();
        }
        return false;
    }

    void on_end(SourceEnd end, const std::optional<Error>& error) override {
        {
            const std::lock_guard lock(mutex_);
            end_ = end;
            error_ = error;
        }
        queue_.close();
    }

    void reopen() {
        const std::lock_guard lock(mutex_);
        end_.reset();
        error_.reset();
    }

    // No value while the source runs.
    std::optional<SourceEnd> end() const {
        const std::lock_guard lock(mutex_);
        return end_;
    }
    std::optional<Error> error() const {
        const std::lock_guard lock(mutex_);
        return error_;
    }
    bool source_waits() const { return source_waits_; }
    std::uint64_t data_transfers() const { return data_transfers_.load(std::memory_order_relaxed); }
    std::uint64_t transfers_dropped() const { return transfers_dropped_; }
    std::uint64_t bytes_dropped() const { return bytes_dropped_; }

private:
    TransferQueue& queue_;
    const bool source_waits_;
    std::atomic<std::uint64_t> data_transfers_{0};
    std::atomic<std::uint64_t> transfers_dropped_{0};
    std::atomic<std::uint64_t> bytes_dropped_{0};
    mutable std::mutex mutex_;
    std::optional<SourceEnd> end_;
    std::optional<Error> error_;
};

}  // namespace gyrolog
