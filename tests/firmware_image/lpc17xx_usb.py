"""The LPC17xx's USB device controller: serial interface engine with its commands, endpoint buffers, DMA by descriptors
(UM10360, chapter 11), and the bus side that a host's transactions come to. Timing inside a packet is left out."""

import struct

from machine import Registers, Violation
from usb_bus import ACK, DATA0, DATA1, NAK, STALL, Packet

DEV_FRAME, DEV_FAST, DEV_SLOW, DEV_STATUS, DEV_CCEMPTY, DEV_CDFULL, DEV_REALIZED = (1 << n for n in (0, 1, 2, 3, 4, 5, 8))
COMMAND_TICKS = 150  # 1.5 us
DMA_TICKS = 200      # a packet between memory and buffer
DD_NORMAL, DD_UNDERRUN, DD_OVERRUN = 2, 3, 4

NAMES = {0x200: "DevIntSt", 0x204: "DevIntEn", 0x208: "DevIntClr", 0x20C: "DevIntSet", 0x210: "CmdCode", 0x214: "CmdData",
         0x218: "RxData", 0x21C: "TxData", 0x220: "RxPLen", 0x224: "TxPLen", 0x228: "Ctrl", 0x22C: "DevIntPri",
         0x230: "EpIntSt", 0x234: "EpIntEn", 0x238: "EpIntClr", 0x23C: "EpIntSet", 0x240: "EpIntPri", 0x244: "ReEp",
         0x248: "EpInd", 0x24C: "MaxPSize", 0x250: "DMARSt", 0x254: "DMARClr", 0x258: "DMARSet", 0x280: "UDCAH",
         0x284: "EpDMASt", 0x288: "EpDMAEn", 0x28C: "EpDMADis", 0x290: "DMAIntSt", 0x294: "DMAIntEn", 0x2A0: "EoTIntSt",
         0x2A4: "EoTIntClr", 0x2A8: "EoTIntSet", 0x2AC: "NDDRIntSt", 0x2B0: "NDDRIntClr", 0x2B8: "SysErrIntSt",
         0x2BC: "SysErrIntClr", 0xFF4: "USBClkCtrl", 0xFF8: "USBClkSt"}
READ_ONLY = {"DevIntSt", "CmdData", "RxData", "RxPLen", "EpIntSt", "DMARSt", "EpDMASt", "DMAIntSt", "EoTIntSt", "NDDRIntSt",
             "SysErrIntSt", "USBClkSt"}
STATUS_NAMES = {"DevInt": "dev", "EpInt": "ep", "DMAR": "dma_request", "EoTInt": "eot", "NDDRInt": "nddr", "SysErrInt": "syserr"}


class Endpoint:
    def __init__(self, index):
        self.index = index
        self.is_in = index & 1
        # The number fixes the kind: bulk and isochronous ones have two buffers.
        self.depth = 2 if index // 2 % 3 in (0, 2) and index > 1 else 1
        self.max_bytes = 0
        self.clear()

    def clear(self):
        self.buffers = []  # OUT: packets from the host; IN: packets for it
        self.toggle = DATA0
        self.stalled = False
        self.setup = False
        self.overwritten = False

    def status(self):
        full = len(self.buffers) >= self.depth if self.is_in else bool(self.buffers)
        return (full | self.stalled << 1 | self.setup << 2 | self.overwritten << 3 |
                (len(self.buffers) > 0) << 5 | (len(self.buffers) > 1) << 6)


class UsbDevice(Registers):
    names = NAMES

    def __init__(self, system, pins, reach):
        super().__init__()
        self.system, self.pins, self.reach = system, pins, reach
        self.endpoints = [Endpoint(index) for index in range(32)]
        self.status = dict.fromkeys(STATUS_NAMES.values(), 0)
        self.status["dev"] = DEV_CCEMPTY
        self.realized = 3
        self.dma_enabled = 0
        self.address = 0
        self.enabled = self.configured = False
        self.device_status = 0
        self.frame = 0
        self.command = None
        self.answer = []
        self.later = []  # (tick, bits of DevIntSt, CmdData or None)
        self.command_data = 0
        self.selected = 0
        self.control_out = b""
        self.control_in = bytearray()
        self.control_in_bytes = None
        self.dma_at = None
        self.taken = lambda: None  # told when a packet for the host is ready; an eager one takes it at once

    # ------------------------------------------------------------------------------------------------ the core's side

    def clocked(self):
        self.system.powered(31, "USB")
        clock = self.system.plls[1].output_hz()
        if clock != 48_000_000:
            raise Violation(f"the USB controller's clock is {clock} Hz")

    def read(self, offset):
        self.known(offset)
        name = NAMES[offset]
        if name == "USBClkSt":
            self.system.powered(31, "USB")
            return self["USBClkCtrl"]
        self.clocked()
        for prefix, status in STATUS_NAMES.items():
            if name == prefix + "St":
                return self.status[status]
        if name == "CmdData":
            return self.command_data
        if name == "RxPLen":
            return len(self.control_out) | 0xC00 if self["Ctrl"] & 1 and self.endpoints[0].buffers else 0
        if name == "RxData":
            word, self.control_out = self.control_out[:4], self.control_out[4:]
            return int.from_bytes(word, "little")
        if name == "EpDMASt":
            return self.dma_enabled
        if name == "DMAIntSt":
            return bool(self.status["eot"]) | bool(self.status["nddr"]) << 1 | bool(self.status["syserr"]) << 2
        if name == "ReEp":
            return self.realized
        if name in ("DevIntEn", "EpIntEn", "DMAIntEn", "UDCAH", "MaxPSize", "Ctrl", "USBClkCtrl"):
            return self[name]
        raise Violation(f"USB: {name} cannot be read")

    def write(self, offset, value):
        self.known(offset)
        name = NAMES[offset]
        if name in READ_ONLY:
            raise Violation(f"USB: {name} cannot be written")
        if name != "USBClkCtrl":
            self.clocked()
            if self["USBClkCtrl"] & 0x12 != 0x12:
                raise Violation("USB used without its clocks")
        self.value[offset] = value
        for prefix, status in STATUS_NAMES.items():
            if name == prefix + "Clr":
                self.clear_status(status, value)
                return
            if name == prefix + "Set":
                self.set_status(status, value)
                return
        action = getattr(self, "on_" + name, None)
        if action:
            action(value)

    def clear_status(self, status, value):
        self.status[status] &= ~value
        if status == "ep":
            for index in range(32):
                if value >> index & 1:
                    self.endpoints[index].setup = False
                    self.after_command(DEV_CDFULL, self.endpoints[index].status())

    def set_status(self, status, value):
        self.status[status] |= value
        if status == "ep":
            for index in range(32):
                if value >> index & 1:
                    self.status["dev"] |= DEV_FAST if self["EpIntPri"] >> index & 1 else DEV_SLOW

    def on_EpDMAEn(self, value):
        self.dma_enabled |= value

    def on_EpDMADis(self, value):
        self.dma_enabled &= ~value

    def on_ReEp(self, value):
        self.realized = value

    def on_MaxPSize(self, value):
        self.endpoints[self["EpInd"]].max_bytes = value
        self.after_command(DEV_REALIZED, None)

    def on_Ctrl(self, value):
        if value & 1:
            if value >> 2 & 15:
                raise Violation("only endpoint 0 is read by registers")
            self.control_out = self.endpoints[0].buffers[0] if self.endpoints[0].buffers else b""

    def on_TxPLen(self, value):
        self.control_in_bytes, self.control_in = value, bytearray()

    def on_TxData(self, value):
        self.control_in += value.to_bytes(4, "little")

    def on_UDCAH(self, value):
        if value & 127:
            raise Violation("UDCAH is not a multiple of 128")

    def on_CmdCode(self, value):
        if self.later and any(bits & (DEV_CCEMPTY | DEV_CDFULL) and not by_clear for _, bits, _, by_clear in self.later):
            raise Violation("a command while the last one is not done")
        phase, code = value >> 8 & 0xFF, value >> 16 & 0xFF
        if phase == 5:
            self.command, self.answer = code, self.execute(code)
            self.after_command(DEV_CCEMPTY, None, False)
        elif phase == 1:
            self.execute_with(code)
            self.after_command(DEV_CCEMPTY, None, False)
        elif phase == 2:
            if code != self.command or not self.answer:
                raise Violation(f"nothing to read from command {code:02x}")
            self.after_command(DEV_CDFULL, self.answer.pop(0), False)
        else:
            raise Violation(f"command phase {phase}")

    def after_command(self, bits, data, by_clear=True):
        self.later.append((self.machine.now + COMMAND_TICKS, bits, data, by_clear))

    def execute(self, code):
        """What may be read after the command."""
        if code < 0x20:
            self.selected = code
            return [self.endpoints[code].status()]
        if code == 0xF2:
            endpoint = self.endpoints[self.selected]
            if endpoint.is_in or endpoint.setup and self.selected == 0:
                # A SETUP packet that came meanwhile is not to be thrown away with the one before it.
                return [1]
            endpoint.buffers = endpoint.buffers[1:]
            return [0]
        if code == 0xFA:
            self.endpoints[self.selected].buffers.append(bytes(self.control_in[:self.control_in_bytes]))
            return []
        if code == 0xF5:
            return [self.frame & 0xFF, self.frame >> 8]
        if code == 0xFE:
            status, self.device_status = self.device_status, self.device_status & 0x05
            return [status]
        if code == 0xFB:
            return [0]
        if 0x40 <= code < 0x60 or code in (0xD0, 0xD8, 0xF3):
            return []
        raise Violation(f"command {code:02x}")

    def execute_with(self, data):
        if self.command == 0xD0:
            self.next_address, self.enabled = data & 0x7F, bool(data & 0x80)
            # The new address holds behind the status stage.
            if not self.endpoints[1].buffers:
                self.address = self.next_address
        elif self.command == 0xD8:
            self.configured = bool(data & 1)
        elif self.command == 0xFE:
            self.device_status = self.device_status & ~1 | data & 1
        elif 0x40 <= self.command < 0x60:
            endpoint = self.endpoints[self.command - 0x40]
            if endpoint.index > 1 and not data & 1:
                endpoint.buffers = []
                endpoint.toggle = DATA0
            endpoint.stalled = bool(data & 0x01)
            if data & 0x80:  # both control endpoints, until the next SETUP
                self.endpoints[0].stalled = self.endpoints[1].stalled = True
        elif self.command != 0xF3:
            raise Violation(f"data for command {self.command:02x}")

    # ------------------------------------------------------------------------------------------------- in between

    def event(self, index):
        """UM10360, USBEpIntEn: where it is 0, the endpoint's event asks the DMA instead."""
        if self["EpIntEn"] >> index & 1:
            self.set_status("ep", 1 << index)
        elif index > 1:
            self.status["dma_request"] |= 1 << index

    def advance(self):
        while self.later and self.later[0][0] <= self.machine.now:
            _, bits, data, _ = self.later.pop(0)
            self.status["dev"] |= bits
            if data is not None:
                self.command_data = data
        self.run_dma()

    def run_dma(self):
        asked = self.dma_enabled & self.status["dma_request"]
        if not asked:
            self.dma_at = None
        elif self.dma_at is None:
            self.dma_at = self.machine.now + DMA_TICKS
        elif self.machine.now >= self.dma_at:
            self.dma_at = None
            for index in range(2, 32):
                if asked >> index & 1:
                    self.move_packet(self.endpoints[index])

    def reached(self, address, size):
        if address not in self.reach or size and address + size - 1 not in self.reach:
            raise Violation(f"the USB DMA does not reach {address:08x}")
        return address

    def move_packet(self, endpoint):
        bit = 1 << endpoint.index
        uc = self.machine.uc
        descriptor = self.machine.word(self.reached(self["UDCAH"], 128) + 4 * endpoint.index)
        if descriptor == 0 or uc.mem_read(self.reached(descriptor, 16) + 12, 1)[0] & 1:
            self.status["nddr"] |= bit
            self.dma_enabled &= ~bit
            return
        _, control, buffer, state = struct.unpack("<4I", uc.mem_read(descriptor, 16))
        length, packet_bytes, present = control >> 16, control >> 5 & 0x7FF, state >> 16
        done = 0
        if endpoint.is_in:
            if len(endpoint.buffers) >= endpoint.depth:
                self.status["dma_request"] &= ~bit
                return
            size = min(packet_bytes, length - present)
            endpoint.buffers.append(bytes(uc.mem_read(self.reached(buffer + present, size), size)) if size else b"")
            present += size
            done = DD_NORMAL if present == length else 0
        else:
            if not endpoint.buffers:
                self.status["dma_request"] &= ~bit
                return
            packet = endpoint.buffers.pop(0)
            kept = packet[:length - present]
            if kept:
                uc.mem_write(self.reached(buffer + present, len(kept)), kept)
            present += len(kept)
            if len(kept) < len(packet):
                done = DD_OVERRUN
            elif present == length:
                done = DD_NORMAL
            elif len(packet) < packet_bytes:
                done = DD_UNDERRUN
        uc.mem_write(descriptor + 12, struct.pack("<I", present << 16 | (done or 1) << 1 | bool(done)))
        if done:
            self.status["eot"] |= bit
            # The DMA goes on when it finds another descriptor: this one is retired.
            if endpoint.is_in:
                self.status["dma_request"] &= ~bit
        if endpoint.is_in:
            self.taken()

    def next_event(self):
        events = [later[0] for later in self.later] + ([self.dma_at] if self.dma_at is not None else [])
        return min(events) if events else None

    def asks(self):
        return bool(self.status["dev"] & self["DevIntEn"] or
                    (bool(self.status["eot"]) | bool(self.status["nddr"]) << 1) & self["DMAIntEn"])

    # -------------------------------------------------------------------------------------------------- the bus side

    def attached(self):
        """The pull-up of D+, switched by USB_CONNECT, and both lines at their pins."""
        return bool(self.device_status & 1) and all(self.pins.function(*pin) == 1 for pin in ((0, 29), (0, 30), (2, 9)))

    def bus_reset(self):
        self.address, self.enabled, self.configured = 0, True, False
        self.realized = 3
        for endpoint in self.endpoints:
            endpoint.clear()
        self.device_status = self.device_status | 0x10
        self.status["dev"] |= DEV_STATUS

    def suspend(self, on):
        self.device_status = self.device_status & ~0x04 | on << 2 | 0x08
        self.status["dev"] |= DEV_STATUS

    def unplug(self):
        """The board does not wire the supply's pin: it sees a bus without activity."""
        self.suspend(True)

    def plug(self):
        """Nothing before the host's reset."""

    def start_of_frame(self):
        self.frame = self.frame + 1 & 0x7FF
        self.status["dev"] |= DEV_FRAME

    def endpoint_for(self, address, index):
        """None where nobody answers."""
        if not self.enabled or address != self.address or not self.realized >> index & 1:
            return None
        return self.endpoints[index] if index < 2 or self.configured else None

    def setup(self, address, request):
        endpoint = self.endpoint_for(address, 0)
        if endpoint is None:
            return None
        endpoint.overwritten = bool(endpoint.buffers)
        endpoint.buffers, endpoint.setup = [request], True
        endpoint.stalled = self.endpoints[1].stalled = False
        self.endpoints[1].buffers = []
        endpoint.toggle = self.endpoints[1].toggle = DATA1
        self.event(0)
        return ACK

    def out(self, address, number, packet):
        endpoint = self.endpoint_for(address, 2 * number)
        if endpoint is None:
            return None
        if endpoint.stalled:
            return STALL
        if len(packet) > endpoint.max_bytes:
            raise Violation(f"endpoint {number} was realized for {endpoint.max_bytes} bytes")
        if len(endpoint.buffers) >= endpoint.depth:
            return NAK
        if packet.toggle != endpoint.toggle:
            return ACK  # seen already
        endpoint.toggle ^= 1
        endpoint.buffers.append(packet)
        self.event(endpoint.index)
        return ACK

    def take_in(self, address, number):
        """The packet, NAK, STALL or None."""
        endpoint = self.endpoint_for(address, 2 * number + 1)
        if endpoint is None:
            return None
        if endpoint.stalled:
            return STALL
        if not endpoint.buffers:
            return NAK
        packet = endpoint.buffers.pop(0)
        if len(packet) > endpoint.max_bytes:
            raise Violation(f"endpoint {number} sends {len(packet)} bytes and was realized for {endpoint.max_bytes}")
        self.event(endpoint.index)
        if endpoint.index == 1 and getattr(self, "next_address", 0) != self.address and not packet:
            self.address = self.next_address
        endpoint.toggle ^= 1
        return Packet(endpoint.toggle ^ 1, packet)
