// The part that a port is written for, as far as its USB driver meets it: link one of lpc55s69_part.cpp, ...
#pragma once

#include <cstdint>
#include <memory>

#include "tests/native_firmware/processor.hpp"
#include "tests/native_firmware/usb_device.hpp"

namespace gyrolog {

// The port's CORE_HZ.
extern const std::uint64_t part_ticks_per_us;
// Whether it has a pin for the cable's supply: else a cable that is out is a bus that idles.
extern const bool part_sees_cable;

class Part {
public:
    virtual ~Part() = default;
    virtual UsbDevice& usb() = 0;
};

// With its registers and its USB interrupt in the processor. `memory` is where the firmware's variables lie.
std::unique_ptr<Part> make_part(Processor& processor, MemoryRange memory);

}  // namespace gyrolog
