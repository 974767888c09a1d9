#include "tests/native_firmware/lpc17xx_usb.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace gyrolog {
namespace {

enum Offset : std::uint32_t {  // from 5000C200
    dev_int_st = 0x00,
    dev_int_en = 0x04,
    dev_int_clr = 0x08,
    dev_int_set = 0x0C,
    cmd_code = 0x10,
    cmd_data = 0x14,
    rx_data = 0x18,
    tx_data = 0x1C,
    rx_plen = 0x20,
    tx_plen = 0x24,
    ctrl = 0x28,
    ep_int_st = 0x30,
    ep_int_en = 0x34,
    ep_int_clr = 0x38,
    ep_int_set = 0x3C,
    ep_int_pri = 0x40,
    re_ep = 0x44,
    ep_ind = 0x48,
    max_psize = 0x4C,
    dmar_st = 0x50,
    dmar_clr = 0x54,
    dmar_set = 0x58,
    udcah = 0x80,
    ep_dma_st = 0x84,
    ep_dma_en = 0x88,
    ep_dma_dis = 0x8C,
    dma_int_st = 0x90,
    dma_int_en = 0x94,
    eot_int_st = 0xA0,
    eot_int_clr = 0xA4,
    nddr_int_st = 0xAC,
    nddr_int_clr = 0xB0,
    sys_err_int_clr = 0xBC,
    usb_clk_ctrl = 0xDF4,
    usb_clk_st = 0xDF8,
};

// DevIntSt
constexpr std::uint32_t frame_interrupt = bit(0);
constexpr std::uint32_t fast = bit(1);
constexpr std::uint32_t slow = bit(2);
constexpr std::uint32_t status_changed = bit(3);
constexpr std::uint32_t command_empty = bit(4);
constexpr std::uint32_t data_full = bit(5);
constexpr std::uint32_t realized = bit(8);

constexpr std::uint64_t command_ns = 1500;
constexpr std::uint64_t dma_ns = 2000;
constexpr std::uint32_t clocks = 0x12;
constexpr std::uint32_t packet_ready_and_valid = 0xC00;
constexpr std::uint32_t descriptors_alignment = 128;

namespace sie {
enum Command : std::uint8_t {
    set_address = 0xD0,
    configure_device = 0xD8,
    clear_buffer = 0xF2,
    set_mode = 0xF3,
    read_frame_number = 0xF5,
    validate_buffer = 0xFA,
    read_error_status = 0xFB,
    device_status = 0xFE,
};
}  // namespace sie
constexpr std::uint8_t endpoint_status_first = 0x40;
constexpr std::uint8_t endpoint_status_end = 0x60;

// Device status
constexpr std::uint8_t connected = 0x01;
constexpr std::uint8_t suspended = 0x04;
constexpr std::uint8_t suspend_changed = 0x08;
constexpr std::uint8_t reset_seen = 0x10;

// Status of a DMA descriptor
enum DmaStatus : unsigned { being_serviced = 1, normal = 2, underrun = 3, overrun = 4 };

// UM10360, 11.15.4: control word, buffer, state.
struct Descriptor {
    std::uint32_t next;
    std::uint32_t control;
    std::uint32_t buffer;
    std::uint32_t state;
};

template <typename T>
T* at(std::uintptr_t address) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the part's addresses are this program's
    return reinterpret_cast<T*>(address);
}

}  // namespace

Lpc17xxUsb::Lpc17xxUsb(Processor& processor, MemoryRange reach)
    : processor_(processor), reach_(reach), device_interrupts_(command_empty) {}

bool Lpc17xxUsb::asks() const {
    const std::uint32_t dma = (ends_of_transfer_ != 0 ? 1U : 0U) | (missing_descriptors_ != 0 ? 2U : 0U);
    return (device_interrupts_ & values_[dev_int_en / 4]) != 0 || (dma & values_[dma_int_en / 4]) != 0;
}

std::size_t Lpc17xxUsb::depth(unsigned index) { return index > 1 && index / 2 % 3 != 1 ? 2 : 1; }

std::uint8_t Lpc17xxUsb::status_of(unsigned index) const {
    const Endpoint& one = endpoints_[index];
    const bool full = (index & 1U) != 0 ? one.buffers.size() >= depth(index) : !one.buffers.empty();
    return static_cast<std::uint8_t>((full ? 0x01U : 0U) | (one.stalled ? 0x02U : 0U) |
                                     (one.setup ? 0x04U : 0U) | (one.overwritten ? 0x08U : 0U) |
                                     (!one.buffers.empty() ? 0x20U : 0U) |
                                     (one.buffers.size() > 1 ? 0x40U : 0U));
}

// ---------------------------------------------------------------------------- the core's side

std::uint32_t Lpc17xxUsb::read(std::uint32_t offset) {
    switch (offset) {
        case dev_int_st:
            return device_interrupts_;
        case cmd_data:
            return command_data_;
        case rx_plen: {
            const bool reads = (values_[ctrl / 4] & 1U) != 0 && !endpoints_[0].buffers.empty();
            return reads ? static_cast<std::uint32_t>(endpoints_[0].buffers.front().size) |
                               packet_ready_and_valid
                         : 0;
        }
        case rx_data: {
            std::uint32_t word = 0;
            if (!endpoints_[0].buffers.empty() && control_read_ < usb_packet_bytes) {
                std::memcpy(&word, endpoints_[0].buffers.front().bytes.data() + control_read_, sizeof word);
            }
            control_read_ += sizeof word;
            return word;
        }
        case ep_int_st:
            return endpoint_interrupts_;
        case re_ep:
            return realized_;
        case dmar_st:
            return dma_requests_;
        case ep_dma_st:
            return dma_enabled_;
        case dma_int_st:
            return (ends_of_transfer_ != 0 ? 1U : 0U) | (missing_descriptors_ != 0 ? 2U : 0U);
        case eot_int_st:
            return ends_of_transfer_;
        case nddr_int_st:
            return missing_descriptors_;
        case usb_clk_st:
            return values_[usb_clk_ctrl / 4];
        case dev_int_en:
        case ep_int_en:
        case dma_int_en:
        case udcah:
        case ctrl:
            return values_[offset / 4];
        default:
            processor_.complain("USB: register " + std::to_string(offset) + " cannot be read");
            return 0;
    }
}

void Lpc17xxUsb::write(std::uint32_t offset, std::uint32_t value) {
    values_[offset / 4] = value;
    if (offset != usb_clk_ctrl && (values_[usb_clk_ctrl / 4] & clocks) != clocks) {
        processor_.complain("USB used without its clocks");
    }
    switch (offset) {
        case dev_int_clr:
            device_interrupts_ &= ~value;
            break;
        case dev_int_set:
            device_interrupts_ |= value;
            break;
        case cmd_code:
            command(value);
            break;
        case tx_plen:
            control_in_ = {};
            control_in_.size = std::min<std::size_t>(value, usb_packet_bytes);
            control_written_ = 0;
            break;
        case tx_data:
            if (control_written_ < usb_packet_bytes) {
                std::memcpy(control_in_.bytes.data() + control_written_, &value, sizeof value);
            }
            control_written_ += sizeof value;
            break;
        case ctrl:
            if ((value & 1U) != 0) { control_read_ = 0; }
            if ((value >> 2U & 15U) != 0) {
                processor_.complain("USB: only endpoint 0 is read by registers");
            }
            break;
        case ep_int_clr:
            clear_endpoint_interrupts(value);
            break;
        case ep_int_set:
            set_endpoint_interrupts(value);
            break;
        case re_ep:
            realized_ = value;
            break;
        case max_psize:
            endpoints_[values_[ep_ind / 4] % endpoint_count].packet_max = value;
            answer_later(realized, {}, false);
            break;
        case dmar_clr:
            dma_requests_ &= ~value;
            break;
        case dmar_set:
            dma_requests_ |= value;
            break;
        case udcah:
            if (value % descriptors_alignment != 0) {
                processor_.complain("USB: UDCAH is not a multiple of 128");
            }
            break;
        case ep_dma_en:
            dma_enabled_ |= value;
            break;
        case ep_dma_dis:
            dma_enabled_ &= ~value;
            break;
        case eot_int_clr:
            ends_of_transfer_ &= ~value;
            break;
        case nddr_int_clr:
            missing_descriptors_ &= ~value;
            break;
        case dev_int_en:
        case ep_int_en:
        case ep_int_pri:
        case ep_ind:
        case dma_int_en:
        case sys_err_int_clr:
        case usb_clk_ctrl:
            break;
        default:
            processor_.complain("USB: register " + std::to_string(offset) + " cannot be written");
            break;
    }
    plan_dma();
}

void Lpc17xxUsb::clear_endpoint_interrupts(std::uint32_t bits) {
    endpoint_interrupts_ &= ~bits;
    for (unsigned index = 0; index < endpoint_count; ++index) {
        if ((bits & bit(index)) == 0) { continue; }
        endpoints_[index].setup = false;
        answer_later(data_full, status_of(index), false);
    }
}

void Lpc17xxUsb::set_endpoint_interrupts(std::uint32_t bits) {
    endpoint_interrupts_ |= bits;
    if ((bits & values_[ep_int_pri / 4]) != 0) { device_interrupts_ |= fast; }
    if ((bits & ~values_[ep_int_pri / 4]) != 0) { device_interrupts_ |= slow; }
}

// ---------------------------------------------------------------------------- SIE commands

void Lpc17xxUsb::answer_later(std::uint32_t device_interrupts, std::optional<std::uint8_t> data,
                              bool of_command) {
    answers_.push_back({processor_.now_ticks() + command_ns * processor_.ticks_per_us() / 1000U,
                        device_interrupts, data, of_command});
}

void Lpc17xxUsb::command(std::uint32_t value) {
    enum Phase : std::uint8_t { write_phase = 1, read_phase = 2, command_phase = 5 };
    if (std::any_of(answers_.begin(), answers_.end(), [](const Answer& one) { return one.of_command; })) {
        processor_.complain("USB: a command while the last one is not done");
    }
    const auto code = static_cast<std::uint8_t>(value >> 16U);
    switch (value >> 8U & 0xFFU) {
        case command_phase:
            command_ = code;
            execute(code);
            answer_later(command_empty, {}, true);
            break;
        case write_phase:
            execute_with(code);
            answer_later(command_empty, {}, true);
            break;
        case read_phase:
            if (code != command_ || to_read_.empty()) {
                processor_.complain("USB: nothing to read from command " + std::to_string(code));
                break;
            }
            answer_later(data_full, to_read_.front(), true);
            to_read_.erase(to_read_.begin());
            break;
        default:
            processor_.complain("USB: no such phase of a command");
            break;
    }
}

void Lpc17xxUsb::execute(std::uint8_t code) {
    to_read_.clear();
    if (code < endpoint_count) {
        selected_ = code;
        to_read_ = {status_of(code)};
        return;
    }
    Endpoint& one = endpoints_[selected_];
    switch (code) {
        case sie::clear_buffer: {
            const bool kept = (selected_ & 1U) != 0 || (one.setup && selected_ == 0);
            if (!kept && !one.buffers.empty()) { one.buffers.pop_front(); }
            to_read_ = {static_cast<std::uint8_t>(kept ? 1 : 0)};
            break;
        }
        case sie::validate_buffer:
            if (selected_ != 1) { processor_.complain("USB: a buffer is validated that the DMA fills"); }
            one.buffers.push_back(control_in_);
            break;
        case sie::read_frame_number:
            to_read_ = {static_cast<std::uint8_t>(frame_), static_cast<std::uint8_t>(frame_ >> 8U)};
            break;
        case sie::device_status:
            to_read_ = {device_status_};
            device_status_ &= connected | suspended;
            break;
        case sie::read_error_status:
            to_read_ = {0};
            break;
        case sie::set_address:
        case sie::configure_device:
        case sie::set_mode:
            break;
        default:
            if (code < endpoint_status_first || code >= endpoint_status_end) {
                processor_.complain("USB: no such command: " + std::to_string(code));
            }
            break;
    }
}

void Lpc17xxUsb::execute_with(std::uint8_t data) {
    if (command_ == sie::set_address) {
        next_address_ = data & 0x7FU;
        enabled_ = (data & 0x80U) != 0;
        if (endpoints_[1].buffers.empty()) { address_ = next_address_; }  // else behind the status stage
    } else if (command_ == sie::configure_device) {
        configured_ = (data & 1U) != 0;
    } else if (command_ == sie::device_status) {
        device_status_ = static_cast<std::uint8_t>((device_status_ & ~connected) | (data & connected));
    } else if (command_ >= endpoint_status_first && command_ < endpoint_status_end) {
        set_endpoint_status(command_ - endpoint_status_first, data);
    } else if (command_ != sie::set_mode) {
        processor_.complain("USB: data for command " + std::to_string(command_));
    }
}

void Lpc17xxUsb::set_endpoint_status(unsigned index, std::uint8_t data) {
    constexpr std::uint8_t stall = 0x01;
    constexpr std::uint8_t both_control_endpoints = 0x80;  // until the next SETUP
    Endpoint& one = endpoints_[index];
    if (index > 1 && (data & stall) == 0) {
        one.buffers.clear();
        one.toggle = 0;
    }
    one.stalled = (data & stall) != 0;
    if ((data & both_control_endpoints) != 0) { endpoints_[0].stalled = endpoints_[1].stalled = true; }
}

// ---------------------------------------------------------------------------- in between

// UM10360, USBEpIntEn: where it is 0, the endpoint's event asks the DMA instead.
void Lpc17xxUsb::event(unsigned index) {
    if ((values_[ep_int_en / 4] & bit(index)) != 0) {
        set_endpoint_interrupts(bit(index));
    } else if (index > 1) {
        dma_requests_ |= bit(index);
    }
    plan_dma();
}

void Lpc17xxUsb::plan_dma() {
    if (dma_asked() == 0) {
        dma_ticks_ = never_ticks;
    } else if (dma_ticks_ == never_ticks) {
        dma_ticks_ = processor_.now_ticks() + dma_ns * processor_.ticks_per_us() / 1000U;
    }
}

std::uint64_t Lpc17xxUsb::next_event_ticks() const {
    return std::min(dma_ticks_, answers_.empty() ? never_ticks : answers_.front().ticks);
}

void Lpc17xxUsb::pass_event(std::uint64_t now_ticks) {
    while (!answers_.empty() && answers_.front().ticks <= now_ticks) {
        device_interrupts_ |= answers_.front().device_interrupts;
        command_data_ = answers_.front().data.value_or(command_data_);
        answers_.pop_front();
    }
    if (dma_ticks_ > now_ticks) { return; }
    dma_ticks_ = never_ticks;
    const std::uint32_t asked = dma_asked();
    for (unsigned index = 2; index < endpoint_count; ++index) {
        if ((asked & bit(index)) != 0) { move_packet(index); }
    }
    plan_dma();
}

bool Lpc17xxUsb::reached(std::uintptr_t address, std::size_t bytes) {
    if (address >= reach_.begin && address + bytes <= reach_.end) { return true; }
    processor_.complain("the USB DMA does not reach " + std::to_string(address));
    return false;
}

void Lpc17xxUsb::move_packet(unsigned index) {
    Endpoint& one = endpoints_[index];
    const bool is_in = (index & 1U) != 0;
    const std::uintptr_t table = values_[udcah / 4];
    if (!reached(table, endpoint_count * sizeof(Descriptor*))) { return; }
    const auto place = reinterpret_cast<std::uintptr_t>(at<Descriptor*>(table)[index]);
    constexpr std::uint32_t retired = 1;
    if (place == 0 || !reached(place, sizeof(Descriptor)) || (at<Descriptor>(place)->state & retired) != 0) {
        missing_descriptors_ |= bit(index);
        dma_enabled_ &= ~bit(index);
        return;
    }
    if (is_in ? one.buffers.size() >= depth(index) : one.buffers.empty()) {
        dma_requests_ &= ~bit(index);
        return;
    }
    volatile Descriptor& descriptor = *at<volatile Descriptor>(place);
    const std::size_t length = descriptor.control >> 16U;
    const std::size_t packet_bytes = descriptor.control >> 5U & 0x7FFU;
    std::size_t present = descriptor.state >> 16U;
    const std::uintptr_t buffer = descriptor.buffer + present;
    unsigned done = 0;
    if (is_in) {
        UsbPacket packet;
        packet.size = std::min({packet_bytes, length - present, usb_packet_bytes});
        if (packet.size > 0 && reached(buffer, packet.size)) {
            std::copy_n(at<std::uint8_t>(buffer), packet.size, packet.bytes.begin());
        }
        one.buffers.push_back(packet);
        present += packet.size;
        done = present == length ? normal : 0U;
    } else {
        const UsbPacket packet = one.buffers.front();
        one.buffers.pop_front();
        const std::size_t kept = std::min(packet.size, length - present);
        if (kept > 0 && reached(buffer, kept)) {
            std::copy_n(packet.bytes.begin(), kept, at<std::uint8_t>(buffer));
        }
        present += kept;
        if (kept < packet.size) {
            done = overrun;
        } else if (present == length) {
            done = normal;
        } else if (packet.size < packet_bytes) {
            done = underrun;
        }
    }
    descriptor.state = static_cast<std::uint32_t>(present) << 16U |
                       (done != 0 ? done : being_serviced) << 1U | (done != 0 ? retired : 0U);
    if (done == 0) { return; }
    ends_of_transfer_ |= bit(index);
    if (is_in) { dma_requests_ &= ~bit(index); }
}

// ---------------------------------------------------------------------------- the bus side

// The board does not wire the supply's pin: it sees a bus without activity.
void Lpc17xxUsb::plug(bool in) {
    if (!in) { suspend(true); }
}

void Lpc17xxUsb::bus_reset() {
    address_ = next_address_ = 0;
    enabled_ = true;
    configured_ = false;
    realized_ = 3;
    for (Endpoint& one : endpoints_) {
        const unsigned packet_max = one.packet_max;
        one = {};
        one.packet_max = packet_max;
    }
    device_status_ = static_cast<std::uint8_t>((device_status_ & ~suspended) | reset_seen);
    device_interrupts_ |= status_changed;
}

void Lpc17xxUsb::suspend(bool on) {
    device_status_ =
        static_cast<std::uint8_t>((device_status_ & ~suspended) | (on ? suspended : 0) | suspend_changed);
    device_interrupts_ |= status_changed;
}

void Lpc17xxUsb::start_of_frame() {
    frame_ = (frame_ + 1) & 0x7FFU;
    device_interrupts_ |= frame_interrupt;
}

Lpc17xxUsb::Endpoint* Lpc17xxUsb::endpoint_for(unsigned address, unsigned index) {
    const bool answers = attached() && enabled_ && address == address_ && (realized_ & bit(index)) != 0;
    return answers && (index < 2 || configured_) ? &endpoints_[index] : nullptr;
}

Handshake Lpc17xxUsb::setup(unsigned address, const UsbSetup& request) {
    Endpoint* const one = endpoint_for(address, 0);
    if (one == nullptr) { return Handshake::none; }
    UsbPacket packet;
    packet.size = request.size();
    std::copy(request.begin(), request.end(), packet.bytes.begin());
    one->overwritten = !one->buffers.empty();
    one->buffers = {packet};
    one->setup = true;
    one->stalled = endpoints_[1].stalled = false;
    endpoints_[1].buffers.clear();
    one->toggle = endpoints_[1].toggle = 1;
    event(0);
    return Handshake::ack;
}

Handshake Lpc17xxUsb::out(unsigned address, unsigned endpoint, const UsbPacket& packet) {
    const unsigned index = 2 * endpoint;
    Endpoint* const one = endpoint_for(address, index);
    if (one == nullptr) { return Handshake::none; }
    if (one->stalled) { return Handshake::stall; }
    if (packet.size > one->packet_max) {
        processor_.complain("USB: endpoint " + std::to_string(endpoint) +
                            " was realized for shorter packets");
        return Handshake::none;
    }
    if (one->buffers.size() >= depth(index)) { return Handshake::nak; }
    if (packet.toggle != one->toggle) { return Handshake::ack; }  // seen already
    one->toggle ^= 1U;
    one->buffers.push_back(packet);
    event(index);
    return Handshake::ack;
}

Handshake Lpc17xxUsb::in(unsigned address, unsigned endpoint, UsbPacket& packet, bool acknowledged) {
    const unsigned index = 2 * endpoint + 1;
    Endpoint* const one = endpoint_for(address, index);
    if (one == nullptr) { return Handshake::none; }
    if (one->stalled) { return Handshake::stall; }
    if (one->buffers.empty()) { return Handshake::nak; }
    packet = one->buffers.front();
    packet.toggle = one->toggle;
    if (packet.size > one->packet_max) {
        processor_.complain("USB: endpoint " + std::to_string(endpoint) +
                            " sends longer packets than it was realized for");
    }
    if (!acknowledged) { return Handshake::ack; }
    one->buffers.pop_front();
    one->toggle ^= 1U;
    event(index);
    if (index == 1 && packet.size == 0) { address_ = next_address_; }
    return Handshake::ack;
}

}  // namespace gyrolog
