// The LPC55S69 around its USB controller: SYSCON's clock gates and resets, PMC's power switches, the owner of
// the port. Offsets and bits: NXP's device header (SYSCON_Type, PMC_Type, USBFSH_Type). The rest of these
// blocks is in the model that the image itself runs on (tests/firmware_image).
#include <array>
#include <functional>
#include <map>
#include <utility>

#include "tests/native_firmware/ip3511.hpp"
#include "tests/native_firmware/part.hpp"

extern "C" void on_usb();

namespace gyrolog {
namespace {

constexpr int usb0_interrupt = 28;
constexpr std::uint32_t syscon_base = 0x40000000;
constexpr std::uint32_t pmc_base = 0x40020000;
constexpr std::uint32_t usb0_base = 0x40084000;
constexpr std::uint32_t usbfsh_base = 0x400A2000;

constexpr unsigned gate_register = 1;                  // of AHBCLKCTRL and PRESETCTRL
constexpr std::uint32_t usb0_device = 1U << 25U;       // bit in both
constexpr std::uint32_t usb0_phy_off = 1U << 11U;      // PDRUNCFG0
constexpr std::uint32_t device_owns_port = 1U << 16U;  // PORTMODE

// Registers with an alias that sets bits and one that clears them.
class SetAndClear final : public Registers {
public:
    struct Aliases {
        std::uint32_t value;
        std::uint32_t set;
        std::uint32_t clear;
    };
    using OnSet = std::function<void(std::uint32_t offset, std::uint32_t bits)>;

    SetAndClear(Processor& processor, std::vector<Aliases> aliases, OnSet on_set)
        : processor_(processor), aliases_(std::move(aliases)), on_set_(std::move(on_set)) {}

    std::uint32_t& operator[](std::uint32_t offset) { return values_[offset]; }

    std::uint32_t read(std::uint32_t offset) override { return values_[offset]; }
    void write(std::uint32_t offset, std::uint32_t value) override {
        for (const Aliases& one : aliases_) {
            if (offset == one.set) {
                values_[one.value] |= value;
                on_set_(one.value, value);
                return;
            }
            if (offset == one.clear) {
                values_[one.value] &= ~value;
                return;
            }
        }
        processor_.complain(
            "a register of SYSCON or PMC is written that the USB driver has no business with");
    }

private:
    Processor& processor_;
    std::vector<Aliases> aliases_;
    OnSet on_set_;
    std::map<std::uint32_t, std::uint32_t> values_;
};

class Plain final : public Registers {
public:
    std::uint32_t read(std::uint32_t offset) override { return values_[offset]; }
    void write(std::uint32_t offset, std::uint32_t value) override { values_[offset] = value; }

private:
    std::map<std::uint32_t, std::uint32_t> values_;
};

constexpr std::uint32_t presetctrl = 0x100;
constexpr std::uint32_t ahbclkctrl = 0x200;
constexpr std::uint32_t pdruncfg0 = 0xB8;
constexpr std::uint32_t pdruncfg0_after_reset = 0x00DEFFC4;
constexpr std::uint32_t portmode = 0x5C;

class Lpc55s69 final : public Part {
public:
    Lpc55s69(Processor& processor, MemoryRange memory)
        : syscon_(processor, gates(),
                  [this](std::uint32_t offset, std::uint32_t bits) { on_set(offset, bits); }),
          pmc_(processor, {{pdruncfg0, 0xC0, 0xC8}}, [](std::uint32_t, std::uint32_t) {}),
          usb_(processor, {[this] { return clocked(); }, [this] { return powered(); }}, memory) {
        pmc_[pdruncfg0] = pdruncfg0_after_reset;
        processor.add_registers(syscon_base, 0x1000, syscon_);
        processor.add_registers(pmc_base, 0x1000, pmc_);
        processor.add_registers(usbfsh_base, 0x60, port_);
        processor.add_registers(usb0_base, 0x38, usb_);
        processor.add_surroundings(usb_);
        processor.add_interrupt({usb0_interrupt, [this] { return usb_.asks(); }, [] { on_usb(); }});
    }

    UsbDevice& usb() override { return usb_; }

private:
    static std::vector<SetAndClear::Aliases> gates() {
        std::vector<SetAndClear::Aliases> all;
        for (const std::uint32_t base : {presetctrl, ahbclkctrl}) {
            for (std::uint32_t i = 0; i < 3; ++i) {
                const std::uint32_t at = base + 4 * i;
                all.push_back({at, at + 0x20, at + 0x40});
            }
        }
        return all;
    }

    void on_set(std::uint32_t offset, std::uint32_t bits) {
        if (offset == presetctrl + 4 * gate_register && (bits & usb0_device) != 0) { usb_.reset_block(); }
    }

    bool clocked() {
        return (syscon_[ahbclkctrl + 4 * gate_register] & usb0_device) != 0 &&
               (syscon_[presetctrl + 4 * gate_register] & usb0_device) == 0;
    }

    bool powered() {
        return (pmc_[pdruncfg0] & usb0_phy_off) == 0 && (port_.read(portmode) & device_owns_port) != 0;
    }

    SetAndClear syscon_;
    SetAndClear pmc_;
    Plain port_;
    Ip3511 usb_;
};

}  // namespace

const std::uint64_t part_ticks_per_us = 96;
const bool part_sees_cable = true;

std::unique_ptr<Part> make_part(Processor& processor, MemoryRange memory) {
    return std::make_unique<Lpc55s69>(processor, memory);
}

}  // namespace gyrolog
