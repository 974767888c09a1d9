#include "host/virtual_board/in_endpoint.hpp"

#include <algorithm>

namespace gyrolog {

std::size_t InEndpoint::write(ByteView bytes) {
    const std::size_t held = pending_bytes();
    const std::size_t accepted = std::min(bytes.size(), capacity_bytes_ > held ? capacity_bytes_ - held : 0);
    const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(accepted);
    bytes_.insert(bytes_.end(), bytes.begin(), end);
    return accepted;
}

void InEndpoint::flush() {
    const std::uint64_t position = taken_ + pending_bytes();
    if (position == packet_start_) { return; }  // nothing since the flush before
    packet_start_ = position;
    flushes_.push_back(position);
}

std::size_t InEndpoint::take(std::span<std::uint8_t> buffer, std::size_t size) {
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_), size, buffer.begin());
    begin_ += size;
    taken_ += size;
    if (begin_ >= bytes_.size() / 2) {
        bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
        begin_ = 0;
    }
    return size;
}

std::optional<std::size_t> InEndpoint::take_transfer(std::span<std::uint8_t> buffer) {
    // Packets are counted from the flush before, so a transfer that begins there and has the size of whole
    // packets ends with one.
    if (!flushes_.empty() && flushes_.front() - taken_ < buffer.size()) {
        const auto size = static_cast<std::size_t>(flushes_.front() - taken_);
        flushes_.pop_front();
        return take(buffer, size);
    }
    if (pending_bytes() < buffer.size()) { return std::nullopt; }
    const std::size_t size = take(buffer, buffer.size());
    // Full to the brim with the flush right behind: the packet before was full, so a ZLP follows as a
    // transfer of its own. It stays in the queue.
    return size;
}

std::size_t InEndpoint::take_bytes(std::span<std::uint8_t> buffer) {
    const std::size_t size = take(buffer, std::min(buffer.size(), pending_bytes()));
    while (!flushes_.empty() && flushes_.front() <= taken_) { flushes_.pop_front(); }
    return size;
}

void InEndpoint::clear() {
    taken_ += pending_bytes();
    packet_start_ = taken_;
    bytes_.clear();
    begin_ = 0;
    flushes_.clear();
}

}  // namespace gyrolog
