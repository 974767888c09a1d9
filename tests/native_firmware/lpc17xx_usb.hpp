// The LPC17xx's USB device controller: serial interface engine (SIE) with its commands, endpoint buffers, DMA
// by descriptors, and the bus side.
//
// UM10360, chapter 11, as this project knows it (registers.h says from where); nothing here is from the
// driver under test. Where the manual leaves room, and what this model does there:
// - A command takes 1.5 us, and so does the answer that a write to USBEpIntClr brings into USBCmdData.
// - The DMA takes 2 us a packet.
// - Endpoints whose number is 2, 3, 5, 6 and so on have two buffers; the others have one.
// - An address that is written before the status stage of SET_ADDRESS has passed counts from behind that
// stage
//   on.
// - Clear Buffer leaves a SETUP packet alone that came meanwhile.
// - UDCA holds pointers of this machine's size: the driver's own array of them.
// Left out: isochronous endpoints, errors on the wire, the supply's pin, which this board does not wire.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tests/native_firmware/processor.hpp"
#include "tests/native_firmware/usb_device.hpp"

namespace gyrolog {

class Lpc17xxUsb final : public Registers, public UsbDevice, public Surroundings {
public:
    // `reach`: what its DMA reaches.
    Lpc17xxUsb(Processor& processor, MemoryRange reach);

    bool asks() const;

    // Offsets from the block's begin, 5000C200.
    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;

    std::uint64_t next_event_ticks() const override;
    void pass_event(std::uint64_t now_ticks) override;

    void plug(bool in) override;
    bool attached() const override { return (device_status_ & 1U) != 0; }
    void bus_reset() override;
    void suspend(bool on) override;
    void start_of_frame() override;
    Handshake setup(unsigned address, const UsbSetup& request) override;
    Handshake out(unsigned address, unsigned endpoint, const UsbPacket& packet) override;
    Handshake in(unsigned address, unsigned endpoint, UsbPacket& packet, bool acknowledged) override;

private:
    static constexpr unsigned endpoint_count = 32;

    struct Endpoint {
        std::deque<UsbPacket> buffers;  // OUT: from the host; IN: for it
        unsigned toggle = 0;
        unsigned packet_max = 0;
        bool stalled = false;
        bool setup = false;
        bool overwritten = false;
    };
    // What a command, or the clearing of an endpoint's interrupt, brings later.
    struct Answer {
        std::uint64_t ticks;
        std::uint32_t device_interrupts;
        std::optional<std::uint8_t> data;
        bool of_command;
    };

    static std::size_t depth(unsigned index);
    std::uint8_t status_of(unsigned index) const;
    void clear_endpoint_interrupts(std::uint32_t bits);
    void set_endpoint_interrupts(std::uint32_t bits);
    void answer_later(std::uint32_t device_interrupts, std::optional<std::uint8_t> data, bool of_command);
    void command(std::uint32_t value);
    void execute(std::uint8_t code);
    void execute_with(std::uint8_t data);
    void set_endpoint_status(unsigned index, std::uint8_t data);
    void event(unsigned index);
    std::uint32_t dma_asked() const { return dma_enabled_ & dma_requests_; }
    void plan_dma();
    void move_packet(unsigned index);
    bool reached(std::uintptr_t address, std::size_t bytes);
    Endpoint* endpoint_for(unsigned address, unsigned index);

    Processor& processor_;
    MemoryRange reach_;
    std::array<Endpoint, endpoint_count> endpoints_;
    std::array<std::uint32_t, 0x400> values_{};  // of registers that hold what was written

    std::uint32_t device_interrupts_;
    std::uint32_t endpoint_interrupts_ = 0;
    std::uint32_t dma_requests_ = 0;
    std::uint32_t dma_enabled_ = 0;
    std::uint32_t ends_of_transfer_ = 0;
    std::uint32_t missing_descriptors_ = 0;
    std::uint32_t realized_ = 3;

    unsigned address_ = 0;
    unsigned next_address_ = 0;
    bool enabled_ = false;
    bool configured_ = false;
    std::uint8_t device_status_ = 0;
    unsigned frame_ = 0;
    std::uint8_t command_ = 0;
    std::vector<std::uint8_t> to_read_;
    std::deque<Answer> answers_;
    std::uint8_t command_data_ = 0;
    unsigned selected_ = 0;
    std::size_t control_read_ = 0;  // bytes of the OUT packet that were read
    UsbPacket control_in_;
    std::size_t control_written_ = 0;
    std::uint64_t dma_ticks_ = never_ticks;
};

}  // namespace gyrolog
