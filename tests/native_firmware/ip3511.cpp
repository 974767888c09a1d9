#include "tests/native_firmware/ip3511.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace gyrolog {
namespace {

enum Offset : std::uint32_t {
    devcmdstat = 0x00,
    info = 0x04,
    epliststart = 0x08,
    databufstart = 0x0C,
    lpm = 0x10,
    epskip = 0x14,
    epinuse = 0x18,
    epbufcfg = 0x1C,
    intstat = 0x20,
    inten = 0x24,
    intsetstat = 0x28,
    eptoggle = 0x34,
};

constexpr unsigned indices = 10;  // five endpoint numbers, OUT and IN
constexpr std::uint32_t list_bytes = indices * 2 * 4;
constexpr std::uint32_t list_alignment = 256;
constexpr std::uint32_t all_indices = bit(indices) - 1;

// DEVCMDSTAT
constexpr std::uint32_t address_mask = 0x7F;
constexpr std::uint32_t enable = bit(7);
constexpr std::uint32_t setup_received = bit(8);
constexpr std::uint32_t connect = bit(16);
constexpr std::uint32_t suspended = bit(17);
constexpr std::uint32_t connect_change = bit(24);
constexpr std::uint32_t suspend_change = bit(25);
constexpr std::uint32_t reset_change = bit(26);
constexpr std::uint32_t vbus_debounced = bit(28);
constexpr std::uint32_t cleared_by_1 = setup_received | connect_change | suspend_change | reset_change;
constexpr std::uint32_t kept_as_written = 0x1FAFF;  // address, enable, options, connect

constexpr std::uint32_t frame_interrupt = bit(30);
constexpr std::uint32_t device_interrupt = bit(31);
constexpr std::uint32_t revision = 0x02000000;  // in INFO
constexpr std::uint32_t error_nak = 9U << 11U;
constexpr std::uint32_t frame_mask = 0x7FF;
constexpr std::uint32_t data_page = 0xFFC00000;

// An entry of the list
constexpr std::uint32_t active = bit(31);
constexpr std::uint32_t disabled = bit(30);
constexpr std::uint32_t stalled = bit(29);
constexpr std::uint32_t toggle_reset = bit(28);
constexpr std::uint32_t toggle_value = bit(27);
constexpr std::uint32_t isochronous = bit(26);
constexpr std::uint32_t buffer_and_size = 0x03FFFFFF;
constexpr unsigned size_shift = 16;
constexpr unsigned buffer_shift = 6;
constexpr unsigned control_out = 0;
constexpr unsigned control_in = 1;

constexpr std::uint64_t skip_us = 10;
constexpr std::uint64_t debounce_us = 3000;
constexpr std::uint64_t idle_us = 3000;  // USB 2.0, 7.1.7.6

std::size_t size_of(std::uint32_t entry) { return entry >> size_shift & 0x3FFU; }

std::string hex(std::uint32_t value) {
    char text[9];
    std::snprintf(text, sizeof text, "%08x", value);
    return text;
}

}  // namespace

Ip3511::Ip3511(Processor& processor, Supply supply, MemoryRange reach)
    : processor_(processor), supply_(std::move(supply)), reach_(reach) {
    reset_block();
}

void Ip3511::reset_block() {
    status_ = list_start_ = data_start_ = skip_ = in_use_ = double_buffered_ = 0;
    interrupts_ = enabled_interrupts_ = link_power_ = error_ = toggles_ = 0;
    address_ = 0;
    under_reset_ = false;
    skip_ticks_ = vbus_gone_ticks_ = suspend_ticks_ = never_ticks;
    processor_.watch_stores(0, 0, {});
}

std::uint64_t Ip3511::later(std::uint64_t duration_us) const {
    return processor_.now_ticks() + duration_us * processor_.ticks_per_us();
}

// ---------------------------------------------------------------------------- the core's side

std::uint32_t Ip3511::read(std::uint32_t offset) {
    if (!supply_.clocked()) { processor_.complain("USB0 read without its clock"); }
    switch (offset) {
        case devcmdstat:
            return status_ | (vbus() ? vbus_debounced : 0);
        case info:
            return frame_ | error_ | revision;
        case epliststart:
            return list_start_;
        case databufstart:
            return data_start_;
        case lpm:
            return link_power_;
        case epskip:
            return skip_;
        case epinuse:
            return in_use_;
        case epbufcfg:
            return double_buffered_;
        case intstat:
        case intsetstat:
            return interrupts_;
        case inten:
            return enabled_interrupts_;
        case eptoggle:
            return toggles_;
        default:
            processor_.complain("USB0: register " + hex(offset) + " read, which is none");
            return 0;
    }
}

void Ip3511::write(std::uint32_t offset, std::uint32_t value) {
    if (!supply_.clocked()) { processor_.complain("USB0 written without its clock"); }
    switch (offset) {
        case devcmdstat:
            write_command_status(value);
            break;
        case epliststart:
            write_list_start(value);
            break;
        case databufstart:
            data_start_ = value & data_page;
            break;
        case lpm:
            link_power_ = value;
            break;
        case epskip:
            skip_ |= value & all_indices;
            skip_ticks_ = later(skip_us);
            under_reset_ = false;
            break;
        case epinuse:
            in_use_ = value & all_indices & ~3U;
            break;
        case epbufcfg:
            double_buffered_ = value & all_indices & ~3U;
            break;
        case intstat:
            interrupts_ &= ~value;
            break;
        case inten:
            enabled_interrupts_ = value & (frame_interrupt | device_interrupt | all_indices);
            break;
        case intsetstat:
            raise(value & (frame_interrupt | device_interrupt | all_indices));
            break;
        default:
            processor_.complain("USB0: register " + hex(offset) + " written, which is none or cannot be");
            break;
    }
}

void Ip3511::write_command_status(std::uint32_t value) {
    if ((status_ & suspended) != 0 && (status_ & connect) != 0 && (value & suspended) == 0) {
        processor_.complain("USB0: a 0 in DSUS wakes the host up, which the descriptors do not announce");
    }
    const bool status_stage_waits = list_start_ != 0 && (*entry(control_in, 0).word & active) != 0;
    if (((value ^ status_) & address_mask) != 0 && !status_stage_waits) { address_ = value & address_mask; }
    status_ = (value & kept_as_written) | (status_ & suspended) | (status_ & ~value & cleared_by_1);
}

void Ip3511::write_list_start(std::uint32_t value) {
    if (value % list_alignment != 0) {
        processor_.complain("USB0: the list at " + hex(value) + " is not at a multiple of 256");
    }
    if (value < reach_.begin || value + list_bytes > reach_.end) {
        processor_.complain("USB0: the list at " + hex(value) + " is out of the controller's reach");
        return;
    }
    list_start_ = value;
    processor_.watch_stores(value, list_bytes,
                            [this](std::uint32_t address, std::uint32_t before, std::uint32_t after) {
                                list_written(address, before, after);
                            });
}

// Software must leave buffer and size of an active entry alone.
void Ip3511::list_written(std::uint32_t address, std::uint32_t before, std::uint32_t after) {
    if ((before & active) == 0 || ((before ^ after) & buffer_and_size) == 0 || under_reset_) { return; }
    processor_.complain("USB0: entry " + std::to_string((address - list_start_) / 8) + " changed from " +
                        hex(before) + " to " + hex(after) + " while it is active");
}

// ---------------------------------------------------------------------------- in between

void Ip3511::change(std::uint32_t bits) {
    status_ |= bits;
    raise(device_interrupt);
}

std::uint64_t Ip3511::next_event_ticks() const {
    return std::min({skip_ticks_, vbus_gone_ticks_, suspend_ticks_});
}

void Ip3511::pass_event(std::uint64_t now_ticks) {
    if (skip_ticks_ <= now_ticks) {
        skip_ticks_ = never_ticks;
        skip();
    }
    if (vbus_gone_ticks_ <= now_ticks) {
        vbus_gone_ticks_ = never_ticks;
        if ((status_ & connect) != 0) { change(connect_change); }
    }
    if (suspend_ticks_ <= now_ticks) {
        suspend_ticks_ = never_ticks;
        if ((status_ & suspended) == 0) { change(suspended | suspend_change); }
    }
}

void Ip3511::skip() {
    for (unsigned index = 0; index < indices; ++index) {
        const Entry one = entry_in_use(index);
        if ((skip_ & bit(index)) == 0 || (*one.word & active) == 0) { continue; }
        *one.word = *one.word & ~active;
        raise(bit(index));
    }
    skip_ = 0;
}

Ip3511::Entry Ip3511::entry(unsigned index, unsigned buffer) const {
    const std::uintptr_t address = list_start_ + std::uintptr_t{4} * (2 * index + buffer);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the part's addresses are this program's
    return {reinterpret_cast<volatile std::uint32_t*>(address), index};
}

Ip3511::Entry Ip3511::entry_in_use(unsigned index) const { return entry(index, in_use_ >> index & 1U); }

// Where the entry's packet lies; nothing where the controller does not reach it.
std::uint8_t* Ip3511::buffer(std::uint32_t entry, std::size_t bytes) {
    const std::uintptr_t address = data_start_ | (entry & 0xFFFFU) << buffer_shift;
    if (address < reach_.begin || address + bytes > reach_.end) {
        processor_.complain("USB0: the buffer at " + hex(static_cast<std::uint32_t>(address)) +
                            " is out of the controller's reach");
        return nullptr;
    }
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    return reinterpret_cast<std::uint8_t*>(address);
}

// A packet of so many bytes has passed.
void Ip3511::moved(const Entry& entry, std::size_t bytes, bool done) {
    std::uint32_t word = *entry.word - (static_cast<std::uint32_t>(bytes) << size_shift);
    word = (word & ~0xFFFFU) | ((word + static_cast<std::uint32_t>(bytes >> buffer_shift)) & 0xFFFFU);
    if (done) {
        word &= ~active;
        raise(bit(entry.index));
        if ((double_buffered_ & bit(entry.index)) != 0) { in_use_ ^= bit(entry.index); }
    }
    *entry.word = word;
    toggles_ ^= bit(entry.index);
}

void Ip3511::reset_toggle(const Entry& entry) {
    const std::uint32_t word = *entry.word;
    if ((word & toggle_reset) == 0 || entry.index <= control_in) { return; }
    toggles_ = (toggles_ & ~bit(entry.index)) | ((word & toggle_value) != 0 ? bit(entry.index) : 0);
    *entry.word = word & ~toggle_reset;
}

// ---------------------------------------------------------------------------- the bus side

void Ip3511::plug(bool in) {
    cable_ = in;
    if (in) { return; }
    vbus_gone_ticks_ = later(debounce_us);
    suspend_ticks_ = later(idle_us);
}

bool Ip3511::attached() const { return (status_ & connect) != 0 && vbus() && supply_.powered(); }

void Ip3511::wake() {
    suspend_ticks_ = never_ticks;
    if ((status_ & suspended) == 0) { return; }
    status_ &= ~suspended;
    change(suspend_change);
}

void Ip3511::bus_reset() {
    wake();
    status_ &= ~address_mask;
    address_ = 0;
    toggles_ = 0;
    under_reset_ = true;
    change(reset_change);
}

void Ip3511::suspend(bool on) {
    if (on) {
        suspend_ticks_ = later(idle_us);
    } else {
        wake();
    }
}

void Ip3511::start_of_frame() {
    frame_ = (frame_ + 1) & frame_mask;
    if (attached()) { raise(frame_interrupt); }
}

bool Ip3511::answers(unsigned address) const {
    return attached() && (status_ & enable) != 0 && address == address_;
}

Handshake Ip3511::setup(unsigned address, const UsbSetup& request) {
    if (!answers(address)) { return Handshake::none; }
    std::uint8_t* const place = buffer(*entry(control_out, 1).word, request.size());
    if (place == nullptr) { return Handshake::none; }
    std::copy(request.begin(), request.end(), place);
    toggles_ |= bit(control_out) | bit(control_in);
    status_ |= setup_received;
    raise(bit(control_out));
    return Handshake::ack;
}

// ack: the entry may be used.
Handshake Ip3511::ready(unsigned address, const Entry& entry) {
    if (!answers(address)) { return Handshake::none; }
    if ((status_ & setup_received) != 0) {
        error_ = error_nak;
        return Handshake::nak;
    }
    const std::uint32_t word = *entry.word;
    if ((word & disabled) != 0 && entry.index > control_in) { return Handshake::none; }
    if ((word & isochronous) != 0) {
        processor_.complain("USB0: index " + std::to_string(entry.index) + " is isochronous");
        return Handshake::none;
    }
    if ((word & active) != 0) { return Handshake::ack; }
    if ((word & stalled) != 0) { return Handshake::stall; }
    error_ = error_nak;
    return Handshake::nak;
}

Handshake Ip3511::out(unsigned address, unsigned endpoint, const UsbPacket& packet) {
    const Entry one = entry_in_use(2 * endpoint);
    const Handshake handshake = ready(address, one);
    if (handshake != Handshake::ack) { return handshake; }
    reset_toggle(one);
    if (packet.toggle != (toggles_ >> one.index & 1U)) { return Handshake::ack; }  // seen already
    constexpr std::size_t written_for_nothing = 8;
    const std::size_t room = size_of(*one.word);
    if (packet.size > room) {
        processor_.complain("USB0: " + std::to_string(packet.size) + " bytes for endpoint " +
                            std::to_string(endpoint) + ", which has room for " + std::to_string(room));
        return Handshake::none;
    }
    const std::size_t written = packet.size == 0 ? written_for_nothing : packet.size;
    std::uint8_t* const place = buffer(*one.word, written);
    if (place == nullptr) { return Handshake::none; }
    std::copy_n(packet.bytes.begin(), written, place);
    moved(one, packet.size, packet.size < usb_packet_bytes || packet.size == room);
    return Handshake::ack;
}

Handshake Ip3511::in(unsigned address, unsigned endpoint, UsbPacket& packet, bool acknowledged) {
    const Entry one = entry_in_use(2 * endpoint + 1);
    const Handshake handshake = ready(address, one);
    if (handshake != Handshake::ack) { return handshake; }
    reset_toggle(one);
    const std::size_t left = size_of(*one.word);
    packet.size = std::min(left, usb_packet_bytes);
    packet.toggle = toggles_ >> one.index & 1U;
    if (packet.size > 0) {
        const std::uint8_t* const place = buffer(*one.word, packet.size);
        if (place == nullptr) { return Handshake::none; }
        std::copy_n(place, packet.size, packet.bytes.begin());
    }
    if (!acknowledged) { return Handshake::ack; }
    moved(one, packet.size, packet.size == left);
    if (one.index == control_in && packet.size == 0) { address_ = status_ & address_mask; }
    return Handshake::ack;
}

}  // namespace gyrolog
