#include "host/session/transfer_queue.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <sys/mman.h>

namespace gyrolog {
namespace {

// How a transfer lies in the queue: this record, then its data, padded so that the next record is aligned.
struct Record {
    Transfer::Event event;
    TransferKind kind;
    std::uint8_t endpoint;
    int status;
    std::uint64_t id;
    std::uint32_t requested_bytes;
    std::uint32_t data_bytes;
    std::array<std::uint8_t, 8> setup;
    HostTime time;
};

constexpr std::size_t padded(std::size_t bytes) { return (bytes + 7U) & ~std::size_t{7}; }

// A stall fills pages that no ordinary batch needs: the memory of a long capture would be that of its worst
// second. The contents are not needed any more; the room is.
void give_back_after_stall(Bytes& buffer) {
    constexpr std::size_t ordinary_bytes = std::size_t{256} << 10U;
    constexpr std::uintptr_t page = 4096;
    if (buffer.size() <= ordinary_bytes) { return; }
    const auto address = reinterpret_cast<std::uintptr_t>(buffer.data());
    const std::uintptr_t begin = (address + page - 1) / page * page;
    const std::uintptr_t end = (address + buffer.size()) / page * page;
    // Without it, nothing is lost but the memory.
    static_cast<void>(madvise(buffer.data() + (begin - address), end - begin, MADV_DONTNEED));
}

}  // namespace

TransferQueue::TransferQueue(std::size_t capacity_bytes) : capacity_bytes_(capacity_bytes) {
    filling_.reserve(capacity_bytes);
    draining_.reserve(capacity_bytes);
}

bool TransferQueue::push(const Transfer& transfer) {
    const Record record{transfer.event,
                        transfer.kind,
                        transfer.endpoint,
                        transfer.status,
                        transfer.id,
                        transfer.requested_bytes,
                        static_cast<std::uint32_t>(transfer.data.size()),
                        transfer.setup,
                        transfer.time};
    const std::size_t size = sizeof record + padded(transfer.data.size());
    bool was_empty = false;
    {
        const std::lock_guard lock(mutex_);
        if (closed_ || filling_.size() + size > capacity_bytes_) { return false; }
        was_empty = filling_.empty();
        const std::size_t at = filling_.size();
        filling_.resize(at + size);
        std::memcpy(filling_.data() + at, &record, sizeof record);
        if (!transfer.data.empty()) {
            std::memcpy(filling_.data() + at + sizeof record, transfer.data.data(), transfer.data.size());
        }
        high_water_bytes_ = std::max(high_water_bytes_, filling_.size());
    }
    if (was_empty) { ready_.notify_one(); }
    return true;
}

void TransferQueue::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    ready_.notify_one();
}

TransferQueue::Batch TransferQueue::pop(std::chrono::milliseconds wait) {
    std::unique_lock lock(mutex_);
    give_back_after_stall(draining_);
    draining_.clear();
    ready_.wait_for(lock, wait, [&] { return closed_ || !filling_.empty(); });
    std::swap(filling_, draining_);
    return Batch(draining_);
}

bool TransferQueue::finished() const {
    const std::lock_guard lock(mutex_);
    return closed_ && filling_.empty();
}

std::size_t TransferQueue::high_water_bytes() const {
    const std::lock_guard lock(mutex_);
    return high_water_bytes_;
}

Transfer TransferQueue::Batch::read(std::size_t& at) const {
    Record record;
    std::memcpy(&record, bytes_.data() + at, sizeof record);
    Transfer transfer;
    transfer.event = record.event;
    transfer.kind = record.kind;
    transfer.endpoint = record.endpoint;
    transfer.status = record.status;
    transfer.id = record.id;
    transfer.requested_bytes = record.requested_bytes;
    transfer.setup = record.setup;
    transfer.time = record.time;
    transfer.data = bytes_.subspan(at + sizeof record, record.data_bytes);
    at += sizeof record + padded(record.data_bytes);
    return transfer;
}

}  // namespace gyrolog
