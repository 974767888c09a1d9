// The LPC1769 around its USB controller.
#include "tests/native_firmware/lpc17xx_usb.hpp"
#include "tests/native_firmware/part.hpp"

extern "C" void on_usb();

namespace gyrolog {
namespace {

constexpr int usb_interrupt = 24;
constexpr std::uint32_t usb_base = 0x5000C200;
constexpr std::uint32_t usb_bytes = 0xE00;

class Lpc1769 final : public Part {
public:
    Lpc1769(Processor& processor, MemoryRange memory) : usb_(processor, memory) {
        processor.add_registers(usb_base, usb_bytes, usb_);
        processor.add_surroundings(usb_);
        InterruptLine line;
        line.number = usb_interrupt;
        line.asks = [this] { return usb_.asks(); };
        line.handler = on_usb;
        processor.add_interrupt(std::move(line));
    }

    UsbDevice& usb() override { return usb_; }

private:
    Lpc17xxUsb usb_;
};

}  // namespace

const std::uint64_t part_ticks_per_us = 100;
const bool part_sees_cable = false;

std::unique_ptr<Part> make_part(Processor& processor, MemoryRange memory) {
    return std::make_unique<Lpc1769>(processor, memory);
}

}  // namespace gyrolog
