"""The full-speed USB device controller IP3511 of the LPC55S69: registers, the endpoint command/status list in RAM, and the bus
side that a host's transactions come to. From what NXP's device header says of each register and UM11126 of the list, not
from the driver under test. Timing inside a packet is left out, and so are isochronous endpoints.

Of the control endpoint's entries DISABLED is no bit of the list. What is an assumption: a SETUP bit that is still set keeps all endpoints NAKing, not only the control endpoint; Active
of the control endpoint falls like that of any other; an empty OUT packet writes eight bytes, as is told of the high-speed
controller."""

from unicorn import UC_HOOK_MEM_WRITE

from machine import Registers, Violation, field
from usb_bus import ACK, DATA0, DATA1, NAK, PACKET_BYTES, STALL, Packet

ENDPOINTS = 10  # five numbers, OUT and IN
ENTRY_BYTES = 4
LIST_BYTES = 2 * ENDPOINTS * ENTRY_BYTES
LIST_ALIGNMENT = 256
BUFFER_SHIFT = 6
PAGE_MASK = 0xFFC00000  # DATABUFSTART
ACTIVE, DISABLED, STALLED, TOGGLE_RESET, TOGGLE_VALUE, ISOCHRONOUS = (1 << n for n in (31, 30, 29, 28, 27, 26))
BUFFER_AND_SIZE = 0x03FFFFFF
ENABLE, SETUP, CONNECT, SUSPENDED = (1 << n for n in (7, 8, 16, 17))  # DEVCMDSTAT
CONNECT_CHANGE, SUSPEND_CHANGE, RESET_CHANGE, VBUS = (1 << n for n in (24, 25, 26, 28))
CHANGES = CONNECT_CHANGE | SUSPEND_CHANGE | RESET_CHANGE
KEPT_AS_WRITTEN = 0x1FAFF  # address, enable, options, connect
FRAME_INTERRUPT, DEVICE_INTERRUPT = 1 << 30, 1 << 31
INTERRUPTS = FRAME_INTERRUPT | DEVICE_INTERRUPT | (1 << ENDPOINTS) - 1
REVISION = 0x02000000  # in INFO, beside the frame number and the last error
ERROR_NAK = 9 << 11
SKIP_S = 10e-6
VBUS_DEBOUNCE_S = 3e-3
IDLE_UNTIL_SUSPEND_S = 3e-3


class Ip3511(Registers):
    names = {0x00: "DEVCMDSTAT", 0x04: "INFO", 0x08: "EPLISTSTART", 0x0C: "DATABUFSTART", 0x10: "LPM", 0x14: "EPSKIP",
             0x18: "EPINUSE", 0x1C: "EPBUFCFG", 0x20: "INTSTAT", 0x24: "INTEN", 0x28: "INTSETSTAT", 0x34: "EPTOGGLE"}

    def __init__(self, chip, reach):
        super().__init__()
        self.chip, self.reach = chip, reach
        self.cable = True
        self.frame = 0
        self.taken = None  # told when a packet for the host is ready; an eager one takes it at once
        self.list_hook = None
        self.reset()

    def reset(self):
        self.value = {}
        self.status = 0      # DEVCMDSTAT but for VBUS
        self.address = 0     # that it answers to
        self.toggle = [DATA0] * ENDPOINTS
        self.skip_at = None
        self.vbus_gone_at = None
        self.suspend_at = None
        self.error = 0
        self.under_reset = False  # until the image has dealt with the list

    # ------------------------------------------------------------------------------------------------ the core's side

    def vbus(self):
        return self.cable and self.chip.vbus_connected() or self.vbus_gone_at is not None

    def read(self, offset):
        self.chip.usb_clocked()
        self.known(offset)
        name = self.names[offset]
        if name == "DEVCMDSTAT":
            return self.status | (VBUS if self.vbus() else 0)
        if name == "INFO":
            return self.frame | self.error | REVISION
        if name == "INTSETSTAT":
            return self["INTSTAT"]
        if name == "EPTOGGLE":
            return sum(toggle << index for index, toggle in enumerate(self.toggle))
        return super().read(offset)

    def write(self, offset, value):
        self.chip.usb_clocked()
        self.known(offset)
        name = self.names[offset]
        if name in ("INFO", "EPTOGGLE"):
            raise Violation(f"USB: {name} cannot be written")
        action = getattr(self, "on_" + name, None)
        if action:
            action(value)
        else:
            super().write(offset, value)

    def on_DEVCMDSTAT(self, value):
        if self.status & SUSPENDED and self.status & CONNECT and not value & SUSPENDED:
            raise Violation("USB: a 0 in DSUS wakes the host up, which the descriptors do not announce")
        if field(value, 0, 7) != field(self.status, 0, 7) and not self.control_in_waits():
            self.address = field(value, 0, 7)  # else behind the status stage
        self.status = value & KEPT_AS_WRITTEN | self.status & SUSPENDED | self.status & ~value & (SETUP | CHANGES)

    def control_in_waits(self):
        return self["EPLISTSTART"] and self.entry(1)[1] & ACTIVE

    def on_EPLISTSTART(self, value):
        if value % LIST_ALIGNMENT:
            raise Violation(f"USB: the list at {value:08x} is not at a multiple of {LIST_ALIGNMENT}")
        self.reached(value, LIST_BYTES)
        self.value[0x08] = value
        if self.list_hook is not None:
            self.machine.uc.hook_del(self.list_hook)
        self.list_hook = self.machine.uc.hook_add(UC_HOOK_MEM_WRITE, self.on_list_written, None, value,
                                                  value + LIST_BYTES - 1)

    def on_list_written(self, uc, _, address, size, value, __):
        """Software must leave buffer and size of an active entry alone."""
        old = self.machine.word(address & ~3)
        shift, mask = 8 * (address & 3), (1 << 8 * size) - 1
        new = old & ~(mask << shift) | (value & mask) << shift
        if old & ACTIVE and (old ^ new) & BUFFER_AND_SIZE and not self.under_reset:
            index = (address - self["EPLISTSTART"]) // (2 * ENTRY_BYTES)
            self.machine.guarded(self.complain(f"USB: entry {index} changed from {old:08x} to {new:08x} while it is active"))

    @staticmethod
    def complain(what):
        def action():
            raise Violation(what)
        return action

    def on_DATABUFSTART(self, value):
        self.value[0x0C] = value & PAGE_MASK

    def on_EPSKIP(self, value):
        self.value[0x14] = self["EPSKIP"] | value & (1 << ENDPOINTS) - 1
        self.skip_at = self.machine.now + round(SKIP_S * self.machine.core_hz)
        self.under_reset = False

    def on_INTSTAT(self, value):
        self.value[0x20] = self["INTSTAT"] & ~value

    def on_INTSETSTAT(self, value):
        self.raise_interrupt(value & INTERRUPTS)

    def raise_interrupt(self, bits):
        self.value[0x20] = self["INTSTAT"] | bits

    def change(self, bits):
        self.status |= bits
        self.raise_interrupt(DEVICE_INTERRUPT)

    # ----------------------------------------------------------------------------------------------- the list in RAM

    def buffer_in_use(self, index):
        return field(self["EPINUSE"], index, 1) if index > 1 else 0

    def entry(self, index, buffer=None):
        """Address and content."""
        if buffer is None:
            buffer = self.buffer_in_use(index)
        address = self["EPLISTSTART"] + ENTRY_BYTES * (2 * index + buffer)
        return address, self.machine.word(address)

    def store(self, address, entry):
        self.machine.uc.mem_write(address, entry.to_bytes(4, "little"))

    def buffer(self, entry, size):
        return self.reached(self["DATABUFSTART"] | field(entry, 0, 16) << BUFFER_SHIFT, size)

    def reached(self, address, size):
        if address not in self.reach or size and address + size - 1 not in self.reach:
            raise Violation(f"the USB controller does not reach {address:08x}")
        return address

    def moved(self, index, address, entry, size, done):
        """A packet of so many bytes has passed."""
        entry = entry - (size << 16) & 0xFFFFFFFF
        entry = entry & ~0xFFFF | field(entry, 0, 16) + size // PACKET_BYTES
        if done:
            entry &= ~ACTIVE
            self.raise_interrupt(1 << index)
            if field(self["EPBUFCFG"], index, 1) and index > 1:
                self.value[0x18] = self["EPINUSE"] ^ 1 << index
        self.store(address, entry)
        self.toggle[index] ^= 1

    def toggle_reset(self, index, address, entry):
        if entry & TOGGLE_RESET and index > 1:
            self.toggle[index] = DATA1 if entry & TOGGLE_VALUE else DATA0
            entry &= ~TOGGLE_RESET
            self.store(address, entry)
        return entry

    # ------------------------------------------------------------------------------------------------- in between

    def advance(self):
        now = self.machine.now
        if self.skip_at is not None and now >= self.skip_at:
            self.skip_at = None
            self.skip()
        if self.vbus_gone_at is not None and now >= self.vbus_gone_at:
            self.vbus_gone_at = None
            if self.status & CONNECT:
                self.change(CONNECT_CHANGE)
        if self.suspend_at is not None and now >= self.suspend_at:
            self.suspend_at = None
            if not self.status & SUSPENDED:
                self.status |= SUSPENDED
                self.change(SUSPEND_CHANGE)
        if self.taken and any(self.entry(index)[1] & ACTIVE for index in range(3, ENDPOINTS, 2)):
            self.taken()

    def skip(self):
        for index in range(ENDPOINTS):
            address, entry = self.entry(index)
            if field(self["EPSKIP"], index, 1) and entry & ACTIVE:
                self.store(address, entry & ~ACTIVE)
                self.raise_interrupt(1 << index)
        self.value[0x14] = 0

    def next_event(self):
        events = [at for at in (self.skip_at, self.vbus_gone_at, self.suspend_at) if at is not None]
        return min(events) if events else None

    def asks(self):
        return bool(self["INTSTAT"] & self["INTEN"])

    # -------------------------------------------------------------------------------------------------- the bus side

    def attached(self):
        """The pull-up of D+."""
        return bool(self.status & CONNECT) and self.vbus() and self.chip.usb_powered()

    def activity(self):
        self.suspend_at = None
        if self.status & SUSPENDED:
            self.status &= ~SUSPENDED
            self.change(SUSPEND_CHANGE)

    def bus_reset(self):
        self.activity()
        self.status &= ~0x7F
        self.address = 0
        self.toggle = [DATA0] * ENDPOINTS
        self.under_reset = True
        self.change(RESET_CHANGE)

    def suspend(self, on):
        if on:
            self.suspend_at = self.machine.now + round(IDLE_UNTIL_SUSPEND_S * self.machine.core_hz)
        else:
            self.activity()

    def unplug(self):
        self.cable = False
        self.vbus_gone_at = self.machine.now + round(VBUS_DEBOUNCE_S * self.machine.core_hz)
        self.suspend(True)

    def plug(self):
        self.cable = True

    def start_of_frame(self):
        self.frame = self.frame + 1 & 0x7FF
        if self.attached():
            self.raise_interrupt(FRAME_INTERRUPT)

    def answers(self, address):
        return self.attached() and self.status & ENABLE and address == self.address

    def setup(self, address, request):
        if not self.answers(address):
            return None
        entry = self.entry(0, 1)[1]
        self.machine.uc.mem_write(self.buffer(entry, len(request)), request)
        self.toggle[0] = self.toggle[1] = DATA1
        self.status |= SETUP
        self.raise_interrupt(1)
        return ACK

    def not_ready(self, address, index):
        """What answers a token instead of data, if anything does, else its entry."""
        if not self.answers(address):
            return "nobody", None, None
        if self.status & SETUP:
            return self.nak(), None, None
        at, entry = self.entry(index)
        if entry & DISABLED and index > 1:
            return "nobody", None, None
        if entry & ISOCHRONOUS:
            raise Violation(f"USB: endpoint {index} is isochronous")
        if not entry & ACTIVE:
            return STALL if entry & STALLED else self.nak(), None, None
        return None, at, self.toggle_reset(index, at, entry)

    def nak(self):
        self.error = ERROR_NAK
        return NAK

    def out(self, address, number, packet):
        index = 2 * number
        answer, at, entry = self.not_ready(address, index)
        if answer:
            return None if answer == "nobody" else answer
        if packet.toggle != self.toggle[index]:
            return ACK  # seen already
        if len(packet) > field(entry, 16, 10):
            raise Violation(f"USB: {len(packet)} bytes for endpoint {number}, which has room for {field(entry, 16, 10)}")
        content = bytes(packet) or bytes(8)
        self.machine.uc.mem_write(self.buffer(entry, len(content)), content)
        self.moved(index, at, entry, len(packet),
                   len(packet) < PACKET_BYTES or len(packet) == field(entry, 16, 10))
        return ACK

    def take_in(self, address, number):
        """The packet, NAK, STALL or None."""
        index = 2 * number + 1
        answer, at, entry = self.not_ready(address, index)
        if answer:
            return None if answer == "nobody" else answer
        size = min(field(entry, 16, 10), PACKET_BYTES)
        packet = Packet(self.toggle[index], self.machine.uc.mem_read(self.buffer(entry, size), size) if size else b"")
        self.moved(index, at, entry, size, size == field(entry, 16, 10))
        if index == 1 and not packet:
            self.address = field(self.status, 0, 7)
        return packet
