"""What of an LPC55S69 this project's image touches, but for USB: SYSCON, PMC and ANACTRL as far as clocks, power and reset go,
IOCON, GPIO, INPUTMUX, CTIMER0, Flexcomm 8, WWDT, RNG, the factory's numbers in flash. Addresses and bits are those of NXP's
device header, the functions of the pins those that NXP's pin tool and other projects for the board give; what a register
does when is from UM11126 as this project knows it, apart from the port. Both may be wrong together; only silicon can tell.

Not modelled: the boot ROM (the image begins as a plain one, with the core's clock from FRO_HF), TrustZone, voltages."""

import random
import struct

from capture_timer import CaptureTimer
from ip3511 import Ip3511
from machine import WAIT_FOR_OSCILLATOR_TICKS, Machine, Registers, Violation, field
from spi_master import FIFO_ENTRIES, SpiMaster
from watchdog import Watchdog

CORE_HZ = 96_000_000
CRYSTAL_HZ = 16_000_000
FRO_HF_HZ, FRO_12M_HZ, FRO_1M_HZ = 96_000_000, 12_000_000, 1_000_000
OSCILLATOR_TICKS = LOCK_TICKS = 25_000
CTIMER0, USB0 = 10, 28
# SRAM 0. Banks 1 to 4 are clocked by bits of AHBCLKCTRL0 that the image leaves alone.
RAM, RAM_BYTES = 0x20000000, 0x10000
FACTORY_PAGE, FACTORY = 0x9F000, 0x9FC00
SERIAL_NUMBER = struct.pack("<4I", 0xA1B2C3D4, 0x01020304, 0x55AA55AA, 0x0F1E2D3C)
AOREG1 = {"power on": 1 << 4, "pin": 1 << 5, "brown-out": 1 << 6, "software": 1 << 9, "watchdog": 1 << 8}
LEDS = {"red": 6, "green": 7, "blue": 4}  # of port 1
CHIP_SELECT = 1  # of port 1
ANALOG = {(0, n) for n in (9, 11, 12, 15, 18, 31)} | {(1, 0), (1, 9)}  # ASW 0 closes their analog switch
DATA_READY, VBUS = (0, 15), (0, 22)
SPI_PINS = {(0, 26): 9, (1, 2): 6, (1, 3): 6}
# Highest core clock with 0, 1, 2... wait states of the flash
FLASH_MHZ = (11, 22, 33, 44, 55, 66, 77, 88, 100, 115, 130, 150)
# (register, bit) of AHBCLKCTRL and PRESETCTRL
MUX, IOCON, GPIO1, WWDT = (0, 11), (0, 13), (0, 15), (0, 22)
USB0D, TIMER0 = (1, 25), (1, 26)
RNG, USB0_HOST, HS_LSPI = (2, 13), (2, 17), (2, 28)
# PDRUNCFG0: 1 is off
FRO_1M, FRO_192M, XTAL32M, PLL1, USB0_PHY, LDO_XO32M, TRNG = 4, 5, 8, 10, 11, 20, 22
DIVIDER_RESET, DIVIDER_HALT = 1 << 29, 1 << 30
NO_CLOCK = 7


class Syscon(Registers):
    names = {**{0x100 + 4 * n: f"PRESETCTRL{n}" for n in range(3)}, **{0x120 + 4 * n: f"PRESETCTRLSET{n}" for n in range(3)},
             **{0x140 + 4 * n: f"PRESETCTRLCLR{n}" for n in range(3)}, **{0x200 + 4 * n: f"AHBCLKCTRL{n}" for n in range(3)},
             **{0x220 + 4 * n: f"AHBCLKCTRLSET{n}" for n in range(3)},
             **{0x240 + 4 * n: f"AHBCLKCTRLCLR{n}" for n in range(3)}, 0x26C: "CTIMERCLKSEL0", 0x280: "MAINCLKSELA",
             0x284: "MAINCLKSELB", 0x294: "PLL1CLKSEL", 0x2A8: "USB0CLKSEL", 0x2D0: "HSLSPICLKSEL", 0x380: "AHBCLKDIV",
             0x38C: "WDTCLKDIV", 0x398: "USB0CLKDIV", 0x400: "FMCCR", 0x560: "PLL1CTRL", 0x564: "PLL1STAT",
             0x568: "PLL1NDEC", 0x56C: "PLL1MDEC", 0x570: "PLL1PDEC", 0xA18: "CLOCK_CTRL"}
    CLOCK_IN, CLOCK_1M = 5, 6  # CLOCK_CTRL

    def __init__(self, pmc, anactrl):
        super().__init__()
        self.pmc, self.anactrl = pmc, anactrl
        self.value = {0x26C: NO_CLOCK, 0x280: 3, 0x294: NO_CLOCK, 0x2A8: NO_CLOCK, 0x2D0: NO_CLOCK, 0x380: 1,
                      0x38C: DIVIDER_HALT, 0x398: DIVIDER_HALT, 0x400: 0x4000, 0xA18: 1 << self.CLOCK_1M}
        self.ratio = {"N": 0, "M": 0, "P": 0}
        self.to_reset = {}  # (register, bit): peripheral
        self.hz = {}  # what pll_hz and main_hz gave since clocks or power were changed last

    def read(self, offset):
        self.machine.wait(WAIT_FOR_OSCILLATOR_TICKS)
        if self.names.get(offset) == "PLL1STAT":
            return int(self.pll_locked())
        return super().read(offset)

    def write(self, offset, value):
        self.known(offset)
        name = self.names[offset]
        self.hz.clear()
        if name.startswith(("PRESETCTRLSET", "PRESETCTRLCLR", "AHBCLKCTRLSET", "AHBCLKCTRLCLR")):
            self.change_bits(offset, name, value)
        elif name in ("PLL1NDEC", "PLL1MDEC", "PLL1PDEC"):
            letter, request = {"PLL1NDEC": ("N", 8), "PLL1MDEC": ("M", 16), "PLL1PDEC": ("P", 5)}[name]
            super().write(offset, value)
            if value >> request & 1:
                self.ratio[letter] = field(value, 0, request)
        elif name.startswith(("PRESETCTRL", "AHBCLKCTRL")) or name == "PLL1STAT":
            raise Violation(f"SYSCON: {name} written")
        else:
            super().write(offset, value & ~DIVIDER_RESET if "DIV" in name else value)
        self.check_core()

    def change_bits(self, offset, name, value):
        target = offset - (0x20 if "SET" in name[9:] else 0x40)
        old = self.value.get(target, 0)
        self.value[target] = old | value if "SET" in name[9:] else old & ~value
        if name.startswith("PRESETCTRLSET"):
            for (register, bit), peripheral in self.to_reset.items():
                if register == int(name[-1]) and value >> bit & 1:
                    peripheral.reset()

    def running(self, gate, name):
        register, bit = gate
        if not self[f"AHBCLKCTRL{register}"] >> bit & 1:
            raise Violation(f"{name} touched without its clock")
        if self[f"PRESETCTRL{register}"] >> bit & 1:
            raise Violation(f"{name} touched while it is held in reset")

    # -------------------------------------------------------------------------------------------------------- clocks

    def crystal_hz(self):
        return CRYSTAL_HZ if self["CLOCK_CTRL"] >> self.CLOCK_IN & 1 and self.anactrl.crystal_out() else None

    def pll_input_hz(self):
        return {0: FRO_12M_HZ, 1: self.crystal_hz()}.get(self["PLL1CLKSEL"])

    def fcco_hz(self):
        source = self.pll_input_hz()
        if source is None or not all(self.ratio.values()):
            return None
        return source // self.ratio["N"] * self.ratio["M"]

    def pll_locked(self):
        since = self.pmc.on_since(PLL1)
        return (since is not None and self.fcco_hz() is not None and self.machine.now >= since + LOCK_TICKS and
                not self.anactrl.pll_never_locks)

    def pll_hz(self):
        """Complains where what comes out is no clock."""
        if "pll" not in self.hz:
            self.hz["pll"] = self.checked_pll_hz()
        return self.hz["pll"]

    def checked_pll_hz(self):
        if not self.pll_locked():
            raise Violation("PLL1 is used before it has locked")
        fcco, m, control = self.fcco_hz(), self.ratio["M"], self["PLL1CTRL"]
        if not 275_000_000 <= fcco <= 550_000_000:
            raise Violation(f"PLL1: Fcco is {fcco} Hz")
        if not control >> 21 & 1 or control & 0x198000:
            raise Violation(f"PLL1CTRL is {control:08x}: no output, or one past a divider")
        wanted = (2 * (m // 4) + 3, m // 4 + 1)
        if (field(control, 4, 6), field(control, 10, 5)) != wanted:
            raise Violation(f"PLL1: the bandwidth for M = {m} is SELI, SELP = {wanted}")
        return fcco // (2 * self.ratio["P"])

    def main_hz(self):
        if "main" not in self.hz:
            self.hz["main"] = self.selected_main_hz()
        return self.hz["main"]

    def selected_main_hz(self):
        source = self["MAINCLKSELB"]
        if source == 2:
            return self.pll_hz()
        if source == 0:
            return {0: FRO_12M_HZ, 1: self.crystal_hz(), 2: FRO_1M_HZ, 3: FRO_HF_HZ}[self["MAINCLKSELA"]]
        raise Violation(f"the main clock's source {source}")

    def check_core(self):
        core_hz = self.main_hz() // (field(self["AHBCLKDIV"], 0, 8) + 1)
        waits = min(field(self["FMCCR"], 12, 4), self.flash.wait_states)
        if core_hz > 1_000_000 * FLASH_MHZ[min(waits, len(FLASH_MHZ) - 1)]:
            raise Violation(f"core at {core_hz} Hz with {waits} wait states of the flash")
        return core_hz

    def selected_hz(self, register):
        """Of a peripheral whose selector's 0 is the main clock."""
        if self[register] != 0:
            raise Violation(f"{register} is {self[register]}")
        return self.main_hz()

    def divided(self, source_hz, register, bits):
        if self[register] & DIVIDER_HALT:
            raise Violation(f"{register} is halted")
        return source_hz // (field(self[register], 0, bits) + 1)

    def usb_hz(self):
        if self["USB0CLKSEL"] != 5:
            raise Violation(f"USB0CLKSEL is {self['USB0CLKSEL']}: not the crystal's PLL")
        return self.divided(self.pll_hz(), "USB0CLKDIV", 8)

    def watchdog_hz(self):
        if self.pmc.on_since(FRO_1M) is None or not self["CLOCK_CTRL"] >> self.CLOCK_1M & 1:
            raise Violation("the watchdog's oscillator is off")
        return self.divided(FRO_1M_HZ, "WDTCLKDIV", 6)


class Pmc(Registers):
    names = {0x10: "DCDC0", 0x14: "DCDC1", 0x1C: "LDOPMU", 0x84: "AOREG1", 0xB8: "PDRUNCFG0", 0xC0: "PDRUNCFGSET0",
             0xC8: "PDRUNCFGCLR0"}

    def __init__(self, cause):
        super().__init__()
        self.on_change = lambda: None
        self.value = {0x84: cause, 0xB8: 0x00DEFFC4}
        self.since = {bit: 0 for bit in range(32) if not self["PDRUNCFG0"] >> bit & 1}

    def write(self, offset, value):
        self.known(offset)
        name = self.names[offset]
        if name.startswith("PDRUNCFG"):
            old = self["PDRUNCFG0"]
            new = {"PDRUNCFGSET0": old | value, "PDRUNCFGCLR0": old & ~value}.get(name, value)
            self.value[0xB8] = new
            self.on_change()
            for bit in range(32):
                if new >> bit & 1:
                    self.since.pop(bit, None)
                elif old >> bit & 1:
                    self.since[bit] = self.machine.now
        else:
            super().write(offset, value)

    def on_since(self, bit):
        return self.since.get(bit)


class Anactrl(Registers):
    names = {0x10: "FRO192M_CTRL", 0x20: "XO32M_CTRL", 0x24: "XO32M_STATUS", 0xB0: "LDO_XO32M"}
    CLOCK_OUT = 24  # XO32M_CTRL

    def __init__(self, pmc):
        super().__init__()
        self.pmc = pmc
        self.on_change = lambda: None
        self.crystal_never_starts = self.pll_never_locks = False

    def crystal_runs(self):
        since = [self.pmc.on_since(bit) for bit in (XTAL32M, LDO_XO32M)]
        return (None not in since and self.machine.now >= max(since) + OSCILLATOR_TICKS and
                not self.crystal_never_starts)

    def crystal_out(self):
        return self.crystal_runs() and self["XO32M_CTRL"] >> self.CLOCK_OUT & 1

    def read(self, offset):
        self.machine.wait(WAIT_FOR_OSCILLATOR_TICKS)
        if self.names.get(offset) == "XO32M_STATUS":
            return int(self.crystal_runs())
        return super().read(offset)

    def write(self, offset, value):
        super().write(offset, value)
        self.on_change()


class FlashController(Registers):
    """Whose one command here sets the wait states that the array needs."""

    names = {0x00: "CMD", 0x80: "DATAW0", 0xFE0: "INT_STATUS", 0xFE8: "INT_CLR_STATUS"}
    SET_READ_MODE, DONE, PREFETCH = 2, 1 << 2, 5  # CMD, INT_STATUS, FMCCR

    def __init__(self, syscon):
        super().__init__()
        self.syscon = syscon
        self.wait_states = 4

    def write(self, offset, value):
        self.known(offset)
        name = self.names[offset]
        if name == "CMD":
            if value != self.SET_READ_MODE:
                raise Violation(f"flash command {value}")
            if self.syscon["FMCCR"] >> self.PREFETCH & 1:
                raise Violation("a flash command while prefetch is on")
            self.wait_states = field(self["DATAW0"], 0, 4)
            self.value[0xFE0] = self.DONE
        elif name == "INT_CLR_STATUS":
            self.value[0xFE0] = self["INT_STATUS"] & ~value
        else:
            super().write(offset, value)


class Iocon(Registers):
    names = {0x80 * port + 4 * pin: (port, pin) for port in range(2) for pin in range(32)}
    INVERTED, DIGITAL, ANALOG_SWITCH = 7, 8, 10

    def __init__(self, syscon):
        super().__init__()
        self.syscon = syscon

    def read(self, offset):
        self.syscon.running(IOCON, "IOCON")
        return super().read(offset)

    def write(self, offset, value):
        self.syscon.running(IOCON, "IOCON")
        super().write(offset, value)
        pin = self.names[offset]
        if value >> self.DIGITAL & 1 and value >> self.ANALOG_SWITCH & 1 != (pin in ANALOG):
            raise Violation(f"IOCON: the analog switch of digital pin P{pin[0]}_{pin[1]} is closed")

    def digital(self, pin, function):
        """Whether the pin does this and its input is a digital one, as it comes."""
        value = self[pin]
        return field(value, 0, 4) == function and bool(value >> self.DIGITAL & 1) and not value >> self.INVERTED & 1


class Gpio(Registers):
    names = {base + 4 * port: (name, port) for port in range(2) for base, name in
             ((0x2100, "PIN"), (0x2200, "SET"), (0x2280, "CLR"), (0x2380, "DIRSET"), (0x2400, "DIRCLR"))}
    size = 0x3000

    def __init__(self, syscon, iocon, sensor):
        super().__init__()
        self.syscon, self.iocon, self.sensor = syscon, iocon, sensor
        self.level, self.direction = [0, 0], [0, 0]

    def read(self, offset):
        raise Violation("GPIO read, which the image has no reason for")

    def write(self, offset, value):
        self.known(offset)
        name, port = self.names[offset]
        self.syscon.running((0, 14 + port), f"GPIO port {port}")
        if name == "SET":
            self.level[port] |= value
        elif name == "CLR":
            self.level[port] &= ~value
        elif name == "DIRSET":
            self.direction[port] |= value
        elif name == "DIRCLR":
            self.direction[port] &= ~value
        else:
            raise Violation(f"GPIO: {name} written")
        if port == 1 and name in ("SET", "CLR") and value >> CHIP_SELECT & 1 and self.out(1, CHIP_SELECT) is not None:
            self.sensor.select(not self.out(1, CHIP_SELECT))

    def out(self, port, pin):
        """What the pin drives, or None when it drives nothing."""
        if not self.direction[port] >> pin & 1 or field(self.iocon[(port, pin)], 0, 4):
            return None
        return self.level[port] >> pin & 1


class InputMux(Registers):
    names = {0x20: "TIMER0CAPTSEL0"}

    def __init__(self, syscon):
        super().__init__()
        self.syscon = syscon
        self.value = {0x20: 0x1F}

    def write(self, offset, value):
        self.syscon.running(MUX, "INPUTMUX")
        super().write(offset, value)


class Ctimer0(CaptureTimer):
    def __init__(self, syscon, iocon, mux, sensor):
        super().__init__(sensor)
        self.syscon, self.iocon, self.mux = syscon, iocon, mux

    def reset(self):
        self.value = {}

    def touched(self):
        self.syscon.running(TIMER0, "CTIMER0")

    def clock_hz(self):
        return self.syscon.selected_hz("CTIMERCLKSEL0")

    def line_connected(self):
        """CT_INP16."""
        return self.mux["TIMER0CAPTSEL0"] == 16 and self.iocon.digital(DATA_READY, 3)


class Spi8(SpiMaster):
    names = {0x400: "CFG", 0x404: "DLY", 0x408: "STAT", 0x424: "DIV", 0xE00: "FIFOCFG", 0xE04: "FIFOSTAT", 0xE20: "FIFOWR",
             0xE30: "FIFORD", 0xFF8: "PSELID"}
    PERIPHERAL_SPI = 2   # PSELID
    ENABLED_MODE_3 = 0x35  # CFG: enable, master, CPHA, CPOL; nothing else
    FRAME = 0x070F  # of FIFOWR above the data: eight bits, no select of the SPI's own, nothing ignored

    def __init__(self, syscon, iocon, gpio, sensor):
        super().__init__(sensor)
        self.syscon, self.iocon, self.gpio = syscon, iocon, gpio

    def reset(self):
        self.value = {}
        self.drop()

    def rate_hz(self):
        return self.syscon.selected_hz("HSLSPICLKSEL") // (field(self["DIV"], 0, 16) + 1)

    def connected(self):
        return all(self.iocon.digital(pin, function) for pin, function in SPI_PINS.items())

    def selected(self):
        return self.gpio.out(1, CHIP_SELECT) == 0

    def touched(self, offset):
        self.syscon.running(HS_LSPI, "Flexcomm 8")
        self.known(offset)
        if self.names[offset] != "PSELID" and field(self["PSELID"], 0, 3) != self.PERIPHERAL_SPI:
            raise Violation("SPI 8 touched while Flexcomm 8 is no SPI (PSELID)")

    def read(self, offset):
        self.touched(offset)
        name = self.names[offset]
        if name == "FIFOSTAT":
            self.polled()
            return ((not self.out) << 4 | (len(self.out) < FIFO_ENTRIES) << 5 | bool(self.received) << 6 |
                    (len(self.received) == FIFO_ENTRIES) << 7)
        if name == "FIFORD":
            return self.get()
        return super().read(offset)

    def write(self, offset, value):
        self.touched(offset)
        name = self.names[offset]
        if name == "FIFOWR":
            if field(self["CFG"], 0, 8) != self.ENABLED_MODE_3 or field(self["FIFOCFG"], 0, 2) != 3 or value >> 16 != self.FRAME:
                raise Violation(f"SPI 8 sends {value:08x} with CFG {self['CFG']:x}, FIFOCFG {self['FIFOCFG']:x}: not eight "
                                "bits in mode 3 by both FIFOs")
            self.put(value & 0xFF)
            return
        if self.out:
            raise Violation("SPI 8 set up while it sends")
        if name == "FIFOCFG":
            if value >> 16 & 1:
                self.out = []
            if value >> 17 & 1:
                self.received = []
            value &= 0xFFFF
        super().write(offset, value)


class Wwdt(Watchdog):
    names = {**Watchdog.names, 0x14: "WARNINT", 0x18: "WINDOW"}

    def __init__(self, syscon):
        super().__init__()
        self.syscon = syscon

    def write(self, offset, value):
        self.syscon.running(WWDT, "WWDT")
        super().write(offset, value)

    def clock_hz(self):
        return self.syscon.watchdog_hz()


class Rng(Registers):
    names = {0x00: "RANDOM_NUMBER", 0x08: "COUNTER_VAL"}

    def __init__(self, syscon, pmc, seed):
        super().__init__()
        self.syscon, self.pmc, self.random = syscon, pmc, random.Random(seed)

    def reset(self):
        """Keeps nothing."""

    def read(self, offset):
        self.syscon.running(RNG, "RNG")
        self.known(offset)
        if self.pmc.on_since(TRNG) is None:
            raise Violation("RNG read while its oscillators have no power: the numbers are always the same")
        return self.random.getrandbits(32) if self.names[offset] == "RANDOM_NUMBER" else 0x1F00


class UsbHostController(Registers):
    """Of which the image touches the owner of the port."""

    names = {0x5C: "PORTMODE"}
    DEVICE = 16

    def __init__(self, syscon):
        super().__init__()
        self.syscon = syscon

    def reset(self):
        self.value = {}

    def read(self, offset):
        self.syscon.running(USB0_HOST, "USB0's host controller")
        return super().read(offset)

    def write(self, offset, value):
        self.syscon.running(USB0_HOST, "USB0's host controller")
        super().write(offset, value)


class Lpc55s69:
    """The part with a sensor and a USB cable. `kept` is what an earlier one kept over its reset."""

    core_hz, serial_number = CORE_HZ, SERIAL_NUMBER

    def __init__(self, image, sensor, cause="power on", kept=None, seed=1):
        if struct.unpack_from("<2I", image, 0x20) != (0, 0):
            raise Violation("the boot ROM takes the words at 20 and 24 for an image that is not a plain one")
        self.pmc = Pmc(AOREG1[cause])
        self.system = Anactrl(self.pmc)
        self.syscon = Syscon(self.pmc, self.system)
        self.pmc.on_change = self.system.on_change = self.syscon.hz.clear
        self.syscon.flash = FlashController(self.syscon)
        self.iocon, self.mux = Iocon(self.syscon), InputMux(self.syscon)
        self.gpio = Gpio(self.syscon, self.iocon, sensor)
        self.spi = Spi8(self.syscon, self.iocon, self.gpio, sensor)
        self.timer = Ctimer0(self.syscon, self.iocon, self.mux, sensor)
        self.watchdog = Wwdt(self.syscon)
        self.boots = (kept or 0) + 1
        rng = Rng(self.syscon, self.pmc, f"{seed} {self.boots}")
        self.host_controller = UsbHostController(self.syscon)
        self.usb = Ip3511(self, range(RAM, RAM + RAM_BYTES))
        self.syscon.to_reset = {TIMER0: self.timer, HS_LSPI: self.spi, RNG: rng, USB0D: self.usb,
                                USB0_HOST: self.host_controller}
        peripherals = [(0x40000000, self.syscon), (0x40020000, self.pmc), (0x40013000, self.system),
                       (0x40001000, self.iocon), (0x4008C000, self.gpio), (0x40006000, self.mux), (0x40008000, self.timer),
                       (0x4009F000, self.spi), (0x4000C000, self.watchdog), (0x4003A000, rng), (0x40084000, self.usb),
                       (0x400A2000, self.host_controller), (0x40034000, self.syscon.flash)]
        memory = [(RAM, random.Random(seed).randbytes(RAM_BYTES)), (FACTORY_PAGE, self.factory_page())]
        self.machine = Machine(image, memory, peripherals, CORE_HZ, seed)
        self.machine.interrupts.lines = {CTIMER0: self.timer.asks, USB0: self.usb.asks}

    @staticmethod
    def factory_page():
        """Trims that are not valid, so that defaults are taken, and the unique number."""
        page = bytearray(0x1000)
        at = FACTORY - FACTORY_PAGE + 0x70
        page[at:at + len(SERIAL_NUMBER)] = SERIAL_NUMBER
        return bytes(page)

    def vbus_connected(self):
        return self.iocon.digital(VBUS, 7)

    def usb_powered(self):
        return self.pmc.on_since(USB0_PHY) is not None and bool(self.host_controller["PORTMODE"] >> 16 & 1)

    def usb_clocked(self):
        self.syscon.running(USB0D, "USB0")
        if self.syscon.usb_hz() != 48_000_000:
            raise Violation(f"the USB controller's clock is {self.syscon.usb_hz()} Hz")

    def kept(self):
        """Nothing but that another boot has other random numbers."""
        return self.boots

    def lit(self, led):
        """Low is on."""
        return self.gpio.out(1, LEDS[led]) == 0

    @staticmethod
    def endpoint_kinds(number):
        """Any endpoint may be of any kind."""
        return 1, 2, 3
