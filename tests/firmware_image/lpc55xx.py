"""What of an LPC55S69 this project's image touches, but for USB and for clocks, power and resets (lpc55xx_system.py):
IOCON, GPIO, INPUTMUX, CTIMER0, Flexcomm 8, WWDT, RNG, the factory's numbers in flash. Addresses and bits are those of NXP's
device header, the functions of the pins those that NXP's pin tool and other projects for the board give; what a register
does when is from UM11126 as this project knows it, apart from the port. Both may be wrong together; only silicon can tell.

Not modelled: the boot ROM (the image begins as a plain one, with the core's clock from FRO_HF), TrustZone, voltages."""

import random
import struct

from capture_timer import CaptureTimer
from ip3511 import Ip3511
from lpc55xx_system import TRNG, USB0_PHY, Anactrl, FlashController, Pmc, Syscon
from machine import Machine, Registers, Violation, field
from spi_master import FIFO_ENTRIES, SpiMaster
from watchdog import Watchdog

CORE_HZ = 96_000_000
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
# (register, bit) of AHBCLKCTRL and PRESETCTRL
MUX, IOCON, WWDT = (0, 11), (0, 13), (0, 22)
USB0D, TIMER0 = (1, 25), (1, 26)
RNG, USB0_HOST, HS_LSPI = (2, 13), (2, 17), (2, 28)


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
