// The full-speed USB device controller IP3511 of the LPC55S69: registers, the endpoint command/status list in
// the firmware's memory, and the bus side.
//
// Registers' names, offsets and bits: NXP's device header (USB_Type). What the controller does when: UM11126,
// chapter "USB0 full-speed device controller", as this project knows it, not the driver under test. Where the
// manual leaves room, and what this model does there:
// - A pending SETUP keeps every endpoint answering NAK, not only the control endpoint.
// - Active of the control endpoint falls like that of any other.
// - An empty OUT writes eight bytes into the buffer, as errata sheet ES_LPC55S6x, USB.5, tells of the
//   high-speed controller.
// - An address that is written before the status stage of SET_ADDRESS has passed counts from behind that
// stage
//   on.
// - EPSKIP takes 10 us. VBUS is debounced for 3 ms. 3 ms without traffic are a suspend.
// Left out: isochronous endpoints, LPM, remote wake-up, the double buffer's second half beyond EPINUSE.
#pragma once

#include <cstdint>
#include <string>

#include "tests/native_firmware/processor.hpp"
#include "tests/native_firmware/usb_device.hpp"

namespace gyrolog {

class Ip3511 final : public Registers, public UsbDevice, public Surroundings {
public:
    // What the part around it must supply.
    struct Supply {
        std::function<bool()> clocked;
        std::function<bool()> powered;  // the transceiver has power and the port is the device controller's
    };
    // `reach`: what its DMA reaches, the firmware's variables.
    Ip3511(Processor& processor, Supply supply, MemoryRange reach);

    // By SYSCON's reset line.
    void reset_block();
    bool asks() const { return (interrupts_ & enabled_interrupts_) != 0; }

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;

    std::uint64_t next_event_ticks() const override;
    void pass_event(std::uint64_t now_ticks) override;

    void plug(bool in) override;
    bool attached() const override;
    void bus_reset() override;
    void suspend(bool on) override;
    void start_of_frame() override;
    Handshake setup(unsigned address, const UsbSetup& request) override;
    Handshake out(unsigned address, unsigned endpoint, const UsbPacket& packet) override;
    Handshake in(unsigned address, unsigned endpoint, UsbPacket& packet, bool acknowledged) override;

private:
    struct Entry {
        volatile std::uint32_t* word = nullptr;
        unsigned index = 0;  // 2 * endpoint, + 1 for IN
    };

    bool vbus() const { return cable_ || vbus_gone_ticks_ != never_ticks; }
    std::uint64_t later(std::uint64_t duration_us) const;
    void write_command_status(std::uint32_t value);
    void write_list_start(std::uint32_t value);
    void list_written(std::uint32_t address, std::uint32_t before, std::uint32_t after);
    void raise(std::uint32_t interrupts) { interrupts_ |= interrupts; }
    void change(std::uint32_t bits);
    void skip();
    void wake();
    Entry entry(unsigned index, unsigned buffer) const;
    Entry entry_in_use(unsigned index) const;
    std::uint8_t* buffer(std::uint32_t entry, std::size_t bytes);
    bool answers(unsigned address) const;
    Handshake ready(unsigned address, const Entry& entry);
    void reset_toggle(const Entry& entry);
    void moved(const Entry& entry, std::size_t bytes, bool done);

    Processor& processor_;
    Supply supply_;
    MemoryRange reach_;
    bool cable_ = false;
    unsigned frame_ = 0;

    std::uint32_t status_ = 0;  // DEVCMDSTAT but for VBUS
    std::uint32_t list_start_ = 0;
    std::uint32_t data_start_ = 0;
    std::uint32_t skip_ = 0;
    std::uint32_t in_use_ = 0;
    std::uint32_t double_buffered_ = 0;
    std::uint32_t interrupts_ = 0;
    std::uint32_t enabled_interrupts_ = 0;
    std::uint32_t link_power_ = 0;
    std::uint32_t error_ = 0;
    std::uint32_t toggles_ = 0;  // a bit each index
    unsigned address_ = 0;       // that it answers to
    bool under_reset_ = false;   // until the firmware has dealt with the list
    std::uint64_t skip_ticks_ = never_ticks;
    std::uint64_t vbus_gone_ticks_ = never_ticks;
    std::uint64_t suspend_ticks_ = never_ticks;
};

}  // namespace gyrolog
