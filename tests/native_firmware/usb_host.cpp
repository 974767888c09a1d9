#include "tests/native_firmware/usb_host.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

namespace gyrolog {
namespace {

constexpr std::uint64_t frame_us = 1000;
constexpr std::uint64_t reset_us = 10'000;         // USB 2.0, 7.1.7.5: at least 10 ms
constexpr std::uint64_t set_address_us = 2000;     // USB 2.0, 9.2.6.3: recovery
constexpr std::uint64_t notification_us = 16'000;  // bInterval of the descriptor
constexpr std::uint64_t retry_us = 20;      // after NAK: a controller asks as often as the wire is free
constexpr std::size_t overhead_bytes = 13;  // USB 2.0, 5.8.4: of a bulk transaction
constexpr std::uint64_t wire_bytes_per_12_us = 18;  // 12 Mbit/s
constexpr unsigned tries = 3;                       // USB 2.0, 8.7
constexpr std::uint8_t direction_in = 0x80;
enum Request : std::uint8_t { clear_feature = 1, set_address = 5, set_configuration = 9 };

}  // namespace

UsbHost::UsbHost(Processor& processor, UsbDevice& device, std::uint8_t notification)
    : processor_(processor), device_(device), notification_(notification) {}

void UsbHost::plug(bool in) {
    device_.plug(in);
    frame_ticks_ = never_ticks;
    if (!in) { fail_all(-ESHUTDOWN); }
}

void UsbHost::reset() {
    fail_all(-EPROTO);
    address_ = 0;
    configured_ = false;
    pipes_.clear();
    device_.bus_reset();
    free_ticks_ = processor_.now_ticks() + us(reset_us);
    frame_ticks_ = free_ticks_;
}

void UsbHost::suspend(bool on) {
    device_.suspend(on);
    frame_ticks_ = on ? never_ticks : processor_.now_ticks() + us(frame_us);
}

void UsbHost::submit(UsbTransfer transfer) {
    const std::uint8_t endpoint = (transfer.endpoint & 0x0FU) == 0 ? std::uint8_t{0} : transfer.endpoint;
    pipes_[endpoint].waiting.push_back(std::move(transfer));
}

bool UsbHost::give_up(std::uint32_t id) {
    for (auto& [endpoint, pipe] : pipes_) {
        const auto found = std::find_if(pipe.waiting.begin(), pipe.waiting.end(),
                                        [id](const UsbTransfer& one) { return one.id == id; });
        if (found == pipe.waiting.end()) { continue; }
        if (found == pipe.waiting.begin()) {
            // The device has seen these packets acknowledged, and will not send them again.
            if (endpoint != 0 && !pipe.in_data.empty()) {
                end_front(pipe, 0);
                return false;
            }
            pipe.in_data.clear();
            pipe.out_bytes = 0;
            pipe.stage = Stage::setup;
        }
        pipe.waiting.erase(found);
        return true;
    }
    return false;
}

void UsbHost::fail_all(int status) {
    for (auto& [endpoint, pipe] : pipes_) {
        while (!pipe.waiting.empty()) { end_front(pipe, status); }
    }
}

void UsbHost::end_front(Pipe& pipe, int status) {
    ended_.push_back({pipe.waiting.front().id, status, std::exchange(pipe.in_data, {}), pipe.out_bytes});
    pipe.waiting.pop_front();
    pipe.out_bytes = 0;
    pipe.stage = Stage::setup;
    pipe.failures = 0;
}

// ---------------------------------------------------------------------------- time on the wire

// A driver of the kernel's finds no endpoint but 0 before the configuration is set: a packet taken between
// the device's end of that request and the host's would have its toggle forgotten.
bool UsbHost::may_serve(std::uint8_t endpoint, const Pipe& pipe) const {
    return (endpoint == 0 || configured_) && !pipe.waiting.empty();
}

std::uint64_t UsbHost::next_event_ticks() const {
    if (frame_ticks_ == never_ticks) { return never_ticks; }
    std::uint64_t next = frame_ticks_;
    for (const auto& [endpoint, pipe] : pipes_) {
        if (may_serve(endpoint, pipe)) { next = std::min(next, std::max(free_ticks_, pipe.retry_ticks)); }
    }
    return next;
}

void UsbHost::pass_event(std::uint64_t now_ticks) {
    if (frame_ticks_ <= now_ticks) {
        frame_ticks_ += us(frame_us);
        ++accounts_.frames;
        device_.start_of_frame();
    }
    if (free_ticks_ > now_ticks) { return; }
    // Round robin, endpoint 0 among the others.
    auto next = pipes_.upper_bound(last_served_);
    for (std::size_t i = 0; i < pipes_.size(); ++i, ++next) {
        if (next == pipes_.end()) { next = pipes_.begin(); }
        if (!may_serve(next->first, next->second) || next->second.retry_ticks > now_ticks) { continue; }
        last_served_ = next->first;
        transact(next->first, next->second);
        return;
    }
}

void UsbHost::spend(std::size_t packet_bytes) {
    const std::uint64_t wire_bytes = packet_bytes + overhead_bytes;
    free_ticks_ = processor_.now_ticks() + us(12) * wire_bytes / wire_bytes_per_12_us;
}

// ---------------------------------------------------------------------------- transactions

// Whether the transaction carried something; else it is tried again, or the transfer has failed.
bool UsbHost::answered(std::uint8_t endpoint, Pipe& pipe, Handshake handshake) {
    switch (handshake) {
        case Handshake::ack:
            ++accounts_.packets;
            pipe.failures = 0;
            return true;
        case Handshake::nak:
            ++accounts_.naks;
            pipe.retry_ticks =
                processor_.now_ticks() + us(endpoint == notification_ ? notification_us : retry_us);
            return false;
        case Handshake::stall:
            end_front(pipe, -EPIPE);
            return false;
        case Handshake::none:
            if (++pipe.failures == tries) { end_front(pipe, -EPROTO); }
            return false;
    }
    return false;
}

void UsbHost::transact(std::uint8_t endpoint, Pipe& pipe) {
    if (endpoint == 0) {
        control(pipe);
    } else if ((endpoint & direction_in) != 0) {
        in(endpoint, pipe);
    } else {
        out(endpoint, pipe);
    }
}

bool UsbHost::in_packet(std::uint8_t endpoint, Pipe& pipe, UsbPacket& packet) {
    const bool heard = handshakes_to_lose_ == 0 || endpoint == 0;
    const Handshake handshake = device_.in(address_, endpoint & 0x0FU, packet, heard);
    spend(handshake == Handshake::ack ? packet.size : 0);
    if (!answered(endpoint, pipe, handshake)) { return false; }
    if (!heard) { --handshakes_to_lose_; }
    if (packet.toggle != pipe.toggle) {
        ++accounts_.repeated;
        return false;
    }
    pipe.toggle ^= 1U;
    return true;
}

void UsbHost::in(std::uint8_t endpoint, Pipe& pipe) {
    UsbPacket packet;
    if (!in_packet(endpoint, pipe, packet)) { return; }
    const std::size_t asked = pipe.waiting.front().in_bytes;
    const bool fits = pipe.in_data.size() + packet.size <= asked;
    if (fits) { pipe.in_data.insert(pipe.in_data.end(), packet.content().begin(), packet.content().end()); }
    if (!fits) {
        end_front(pipe, -EOVERFLOW);
    } else if (packet.size < usb_packet_bytes || pipe.in_data.size() == asked) {
        end_front(pipe, 0);
    }
}

// True when the packet was taken.
bool UsbHost::out_packet(std::uint8_t endpoint, Pipe& pipe) {
    const Bytes& data = pipe.waiting.front().out_data;
    UsbPacket packet;
    packet.toggle = pipe.toggle;
    packet.size = std::min(data.size() - pipe.out_bytes, usb_packet_bytes);
    std::copy_n(data.begin() + static_cast<std::ptrdiff_t>(pipe.out_bytes), packet.size,
                packet.bytes.begin());
    const Handshake handshake = device_.out(address_, endpoint & 0x0FU, packet);
    spend(packet.size);
    if (!answered(endpoint, pipe, handshake)) { return false; }
    pipe.toggle ^= 1U;
    pipe.out_bytes += packet.size;
    return true;
}

void UsbHost::out(std::uint8_t endpoint, Pipe& pipe) {
    if (out_packet(endpoint, pipe) && pipe.out_bytes == pipe.waiting.front().out_data.size()) {
        end_front(pipe, 0);
    }
}

// USB 2.0, 8.5.3: setup, data that alternate from DATA1 on, an empty DATA1 the other way.
void UsbHost::control(Pipe& pipe) {
    const UsbTransfer& transfer = pipe.waiting.front();
    const bool reads = (transfer.setup[0] & direction_in) != 0;
    const bool has_data = reads ? transfer.in_bytes > 0 : !transfer.out_data.empty();
    if (pipe.stage == Stage::setup) {
        const Handshake handshake = device_.setup(address_, transfer.setup);
        spend(transfer.setup.size());
        if (!answered(0, pipe, handshake)) { return; }
        pipe.stage = has_data ? Stage::data : Stage::status;
        pipe.toggle = 1;
    } else if (pipe.stage == Stage::data && reads) {
        UsbPacket packet;
        if (!in_packet(0, pipe, packet)) { return; }
        pipe.in_data.insert(pipe.in_data.end(), packet.content().begin(), packet.content().end());
        if (pipe.in_data.size() > transfer.in_bytes) {
            end_front(pipe, -EOVERFLOW);
        } else if (packet.size < usb_packet_bytes || pipe.in_data.size() == transfer.in_bytes) {
            pipe.stage = Stage::status;
            pipe.toggle = 1;
        }
    } else if (pipe.stage == Stage::data) {
        if (out_packet(0, pipe) && pipe.out_bytes == transfer.out_data.size()) {
            pipe.stage = Stage::status;
            pipe.toggle = 1;
        }
    } else if (reads && has_data) {
        UsbPacket empty;
        empty.toggle = 1;
        const Handshake handshake = device_.out(address_, 0, empty);
        spend(0);
        if (answered(0, pipe, handshake)) { control_done(pipe); }
    } else {
        UsbPacket packet;
        if (!in_packet(0, pipe, packet)) { return; }
        if (packet.size != 0) {
            end_front(pipe, -EOVERFLOW);
        } else {
            control_done(pipe);
        }
    }
}

// What the request changes on the host's side.
void UsbHost::control_done(Pipe& pipe) {
    const UsbSetup setup = pipe.waiting.front().setup;
    if (setup[0] == 0x00 && setup[1] == set_address) {
        address_ = setup[2];
        free_ticks_ += us(set_address_us);
    } else if (setup[0] == 0x00 && setup[1] == set_configuration) {
        for (auto& [endpoint, other] : pipes_) { other.toggle = 0; }
        configured_ = true;
    } else if (setup[0] == 0x02 && setup[1] == clear_feature && pipes_.count(setup[4]) != 0) {
        pipes_[setup[4]].toggle = 0;
    }
    end_front(pipe, 0);
}

}  // namespace gyrolog
