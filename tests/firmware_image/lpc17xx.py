"""What of an LPC1769 this project's image touches, but for USB: clocks, pins, SSP1, timer 2, watchdog, the ROM's serial
number. From the part's description (UM10360) as this project knows it, apart from the port's registers.h: where the two
differ, one is wrong. Both may be wrong together; only silicon can tell."""

import random
import struct

from unicorn import arm_const as arm

from capture_timer import CaptureTimer
from lpc17xx_usb import UsbDevice
from machine import WAIT_FOR_OSCILLATOR_TICKS, Machine, Registers, Violation, field
from spi_master import SpiMaster
from watchdog import Watchdog

CORE_HZ = 100_000_000
CRYSTAL_HZ = 12_000_000
INTERNAL_HZ = 4_000_000
OSCILLATOR_TICKS = LOCK_TICKS = 50_000
TIMER2, USB = 3, 24
IAP = 0x1FFF1FF0
IAP_PAGE = 0x1FFF1000
RAM, RAM_BYTES = 0x10000000, 0x8000
AHB, AHB_BYTES = 0x2007C000, 0x8000
SERIAL_NUMBER = struct.pack("<4I", 0x0A0B0C0D, 0x11223344, 0x55667788, 0x99AABBCC)
RSID = {"power on": 1, "pin": 2, "watchdog": 4, "brown-out": 8}
LEDS = {"red": (0, 22), "green": (3, 25), "blue": (3, 26)}
ISOCHRONOUS, BULK, INTERRUPT = 1, 2, 3


class Pll:
    def __init__(self, name, multiplied, least_hz, most_hz):
        self.name, self.multiplied, self.least_hz, self.most_hz = name, multiplied, least_hz, most_hz
        self.wanted = {"con": 0, "cfg": 0}
        self.con = self.cfg = 0
        self.fed = None
        self.lock_at = None

    def feed(self, system, value):
        if value == 0xAA:
            self.fed = system.accesses
        elif value == 0x55 and self.fed is not None and system.accesses == self.fed + 1:
            self.apply(system)
            self.fed = None

    def apply(self, system):
        starts = self.wanted["con"] & 1 and not self.con & 1
        if self.con & 1 and self.wanted["cfg"] != self.cfg:
            raise Violation(f"{self.name}CFG changed while it runs")
        self.con, self.cfg = self.wanted["con"], self.wanted["cfg"]
        if starts:
            if not system.oscillator_runs():
                raise Violation(f"{self.name} started without the crystal")
            fcco, _ = self.multiplied(self.cfg)
            if not self.least_hz <= fcco <= self.most_hz:
                raise Violation(f"{self.name}: Fcco is {fcco} Hz")
            self.lock_at = system.machine.now + LOCK_TICKS
        if not self.con & 1:
            self.lock_at = None
        if self.con & 2 and not self.locked(system):
            raise Violation(f"{self.name} connected before it has locked")

    def locked(self, system):
        return self.lock_at is not None and system.machine.now >= self.lock_at and not system.pll_never_locks

    def output_hz(self):
        return self.multiplied(self.cfg)[1] if self.con & 2 else None


def pll0(cfg):
    fcco = 2 * (field(cfg, 0, 15) + 1) * CRYSTAL_HZ // (field(cfg, 16, 8) + 1)
    return fcco, fcco


def pll1(cfg):
    output = (field(cfg, 0, 5) + 1) * CRYSTAL_HZ
    return output * 2 * (1 << field(cfg, 5, 2)), output


class System(Registers):
    names = {0x000: "FLASHCFG", 0x080: "PLL0CON", 0x084: "PLL0CFG", 0x088: "PLL0STAT", 0x08C: "PLL0FEED", 0x0A0: "PLL1CON",
             0x0A4: "PLL1CFG", 0x0A8: "PLL1STAT", 0x0AC: "PLL1FEED", 0x0C4: "PCONP", 0x104: "CCLKCFG", 0x10C: "CLKSRCSEL",
             0x180: "RSID", 0x1A0: "SCS", 0x1A8: "PCLKSEL0", 0x1AC: "PCLKSEL1"}

    def __init__(self, cause):
        super().__init__()
        self.value = {0x000: 0x303A, 0x0C4: 0x042887DE, 0x180: cause}
        self.plls = [Pll("PLL0", pll0, 275_000_000, 550_000_000), Pll("PLL1", pll1, 156_000_000, 320_000_000)]
        self.accesses = 0
        self.oscillator_at = None
        self.crystal_never_starts = self.pll_never_locks = False

    def oscillator_runs(self):
        return (self.oscillator_at is not None and self.machine.now >= self.oscillator_at and
                not self.crystal_never_starts)

    def read(self, offset):
        self.accesses += 1
        self.known(offset)
        name = self.names[offset]
        self.machine.wait(WAIT_FOR_OSCILLATOR_TICKS)
        if name in ("PLL0STAT", "PLL1STAT"):
            pll = self.plls[name == "PLL1STAT"]
            low = 24 if name == "PLL0STAT" else 8
            return pll.cfg | pll.con << low | pll.locked(self) << low + 2
        if name == "SCS":
            return self["SCS"] & ~0x40 | (0x40 if self.oscillator_runs() else 0)
        return super().read(offset)

    def write(self, offset, value):
        self.accesses += 1
        self.known(offset)
        name = self.names[offset]
        if name[:3] == "PLL":
            pll = self.plls[int(name[3])]
            if name[4:] == "FEED":
                pll.feed(self, value)
                self.check_core()
            elif name[4:] != "STAT":
                pll.wanted[name[4:].lower()] = value
        if name.startswith("PCLKSEL") and self.plls[0].con & 2:
            raise Violation(f"{name} written behind the connection of PLL0 (errata sheet)")
        if name == "SCS" and value & 0x20 and self.oscillator_at is None:
            if value & 0x10:
                raise Violation("OSCRANGE is not that of 12 MHz")
            self.oscillator_at = self.machine.now + OSCILLATOR_TICKS
        self.value[offset] = self["RSID"] & ~value if name == "RSID" else value
        self.check_core()

    def core_hz(self):
        hz = self.plls[0].output_hz() or (CRYSTAL_HZ if self["CLKSRCSEL"] == 1 else INTERNAL_HZ)
        return hz // (field(self["CCLKCFG"], 0, 8) + 1)

    def check_core(self):
        clocks = field(self["FLASHCFG"], 12, 4) + 1
        if self.core_hz() > (120_000_000 if clocks >= 5 else 20_000_000 * clocks):
            raise Violation(f"core at {self.core_hz()} Hz with {clocks} clocks for the flash")

    def peripheral_hz(self, register, low):
        return self.core_hz() // (4, 1, 2, 8)[field(self[register], low, 2)]

    def powered(self, bit, name):
        if not self["PCONP"] >> bit & 1:
            raise Violation(f"{name} touched while PCONP keeps it off")


class Pins(Registers):
    names = {**{4 * n: f"PINSEL{n}" for n in range(11)}, **{0x40 + 4 * n: f"PINMODE{n}" for n in range(10)}}

    def function(self, port, pin):
        return field(self[f"PINSEL{2 * port + pin // 16}"], 2 * (pin % 16), 2)

    def mode(self, port, pin):
        return field(self[f"PINMODE{2 * port + pin // 16}"], 2 * (pin % 16), 2)


class Gpio(Registers):
    names = {0x20 * port + offset: (port, name) for port in range(5)
             for offset, name in ((0, "DIR"), (0x14, "PIN"), (0x18, "SET"), (0x1C, "CLR"))}

    def __init__(self, pins, sensor):
        super().__init__()
        self.pins, self.sensor = pins, sensor
        self.level = [0] * 5

    def write(self, offset, value):
        super().write(offset, value)
        port, name = self.names[offset]
        if name == "SET":
            self.level[port] |= value
        elif name == "CLR":
            self.level[port] &= ~value
        if port == 0 and name in ("SET", "CLR") and value >> 6 & 1 and self.out(0, 6) is not None:
            self.sensor.select(not self.out(0, 6))

    def out(self, port, pin):
        """What the pin drives, or None when it drives nothing."""
        if not self[(port, "DIR")] >> pin & 1 or self.pins.function(port, pin):
            return None
        return self.level[port] >> pin & 1


class Ssp(SpiMaster):
    names = {0x00: "CR0", 0x04: "CR1", 0x08: "DR", 0x0C: "SR", 0x10: "CPSR"}

    def __init__(self, system, pins, gpio, sensor):
        super().__init__(sensor)
        self.system, self.pins, self.gpio = system, pins, gpio

    def rate_hz(self):
        if self["CPSR"] < 2 or self["CPSR"] % 2:
            raise Violation(f"CPSR is {self['CPSR']}")
        return self.system.peripheral_hz("PCLKSEL0", 20) // (self["CPSR"] * (field(self["CR0"], 8, 8) + 1))

    def connected(self):
        return all(self.pins.function(0, pin) == 2 for pin in (7, 8, 9))

    def selected(self):
        return self.gpio.out(0, 6) == 0

    def read(self, offset):
        self.system.powered(10, "SSP1")
        self.known(offset)
        name = self.names[offset]
        if name == "SR":
            self.polled()
            return (not self.out) | (len(self.out) < 8) << 1 | bool(self.received) << 2 | bool(self.out) << 4
        if name == "DR":
            return self.get()
        return super().read(offset)

    def write(self, offset, value):
        self.system.powered(10, "SSP1")
        self.known(offset)
        name = self.names[offset]
        if name == "CR1" and not value & 2:
            self.drop()
        if name != "DR":
            if self.out:
                raise Violation("SSP set up while it sends")
            super().write(offset, value)
            return
        if not self["CR1"] & 2 or self["CR0"] & 0xFF != 0xC7:
            raise Violation(f"SSP sends with CR0 {self['CR0']:04x}, CR1 {self['CR1']:x}: not eight bits in mode 3")
        self.put(value & 0xFF)


class Timer2(CaptureTimer):
    def __init__(self, system, pins, sensor):
        super().__init__(sensor)
        self.system, self.pins = system, pins

    def touched(self):
        self.system.powered(22, "timer 2")

    def clock_hz(self):
        return self.system.peripheral_hz("PCLKSEL1", 12)

    def line_connected(self):
        return self.pins.function(0, 4) == 3


class InternalWatchdog(Watchdog):
    names = {**Watchdog.names, 0x10: "WDCLKSEL"}

    def clock_hz(self):
        if self["WDCLKSEL"] != 0:
            raise Violation("the watchdog runs on the clock that it watches")
        return INTERNAL_HZ


class Lpc1769:
    """The part with a sensor and a USB cable. `kept` is what an earlier one kept over its reset."""

    core_hz, serial_number = CORE_HZ, SERIAL_NUMBER

    def __init__(self, image, sensor, cause="power on", kept=None, seed=1):
        if sum(struct.unpack_from("<8I", image)) % 2**32:
            raise Violation("the boot ROM does not start an image whose first eight words do not add up to 0")
        self.system, self.pins = System(RSID[cause]), Pins()
        self.gpio = Gpio(self.pins, sensor)
        self.spi = Ssp(self.system, self.pins, self.gpio, sensor)
        self.timer = Timer2(self.system, self.pins, sensor)
        self.watchdog = InternalWatchdog()
        self.usb = UsbDevice(self.system, self.pins, range(AHB, AHB + AHB_BYTES))
        peripherals = [(0x400FC000, self.system), (0x4002C000, self.pins), (0x2009C000, self.gpio), (0x40030000, self.spi),
                       (0x40090000, self.timer), (0x40000000, self.watchdog), (0x5000C000, self.usb)]
        noise = random.Random(seed).randbytes(RAM_BYTES + AHB_BYTES)
        memory = [(RAM, noise[:RAM_BYTES]), (AHB, kept or noise[RAM_BYTES:]), (IAP_PAGE, bytes(0x1000))]
        self.machine = Machine(image, memory, peripherals, CORE_HZ, seed)
        self.machine.interrupts.lines = {TIMER2: self.timer.asks, USB: self.usb.asks}
        self.machine.call_at(IAP, self.in_application_programming)

    def in_application_programming(self):
        command, result = (self.machine.uc.reg_read(register) for register in (arm.UC_ARM_REG_R0, arm.UC_ARM_REG_R1))
        if self.machine.word(command) != 58:
            raise Violation(f"IAP command {self.machine.word(command)}")
        self.machine.uc.mem_write(result, bytes(4) + SERIAL_NUMBER)
        self.machine.uc.mem_write(RAM + RAM_BYTES - 32, b"\xee" * 32)  # the ROM's own

    def kept(self):
        """The second memory."""
        return bytes(self.machine.uc.mem_read(AHB, AHB_BYTES))

    def lit(self, led):
        """Low is on."""
        return self.gpio.out(*LEDS[led]) == 0

    @staticmethod
    def endpoint_kinds(number):
        """UM10360, chapter 11: the number fixes the kind."""
        return ({0: ISOCHRONOUS, 1: INTERRUPT, 2: BULK}[number % 3],)
