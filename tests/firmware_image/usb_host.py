"""The computer at the other end: enumerates, opens the port, reads. One transaction at a time, so that nothing is answered
sooner than the image has had time for."""

import struct

from usb_bus import ACK, DATA0, DATA1, NAK, PACKET_BYTES, STALL, Packet

FRAME_S = 1e-3
FIRST_FRAME = 2000    # of 2048: the number wraps in every test
TRANSACTION_S = 55e-6  # a bulk packet of 64 bytes takes about 50 us of a full-speed bus
CLEAR_FEATURE, SET_ADDRESS, GET_DESCRIPTOR, SET_CONFIGURATION = 1, 5, 6, 9
ENDPOINT_HALT = 0
SET_LINE_CODING, GET_LINE_CODING, SET_CONTROL_LINE_STATE = 0x20, 0x21, 0x22
CONTROL_LIMIT_S = 0.5  # USB 2.0, 9.2.6.4: 500 ms for a stage with data


class Stalled(Exception):
    pass


class UsbHost:
    def __init__(self, part):
        self.machine, self.device = part.machine, part.usb
        self.frame_ticks, self.transaction_ticks, self.control_limit_ticks = (
            round(duration_s * part.core_hz) for duration_s in (FRAME_S, TRANSACTION_S, CONTROL_LIMIT_S))
        self.device.frame = FIRST_FRAME
        self.frames = 0
        self.address = 0
        self.frame_at = None
        self.received = bytearray()
        self.toggles = {}     # of the bulk endpoints, by address
        self.repetitions = 0  # packets with the toggle of the one before: a host throws them away

    def run(self, ticks):
        """Lets the part run, with a start of frame every millisecond."""
        end = self.machine.now + ticks
        while self.machine.now < end:
            if self.frame_at is not None and self.machine.now >= self.frame_at:
                self.frame_at += self.frame_ticks
                self.frames += 1
                self.device.start_of_frame()
            self.machine.step()

    def wait_for_device(self, limit_ticks):
        if not self.machine.run_until(self.device.attached, limit_ticks):
            raise TimeoutError("no pull-up at D+")
        self.reset()

    def reset(self):
        self.device.bus_reset()
        self.address = 0
        self.toggles.clear()
        self.frame_at = self.machine.now + self.frame_ticks
        self.run(10 * self.frame_ticks)  # USB 2.0, 7.1.7.5: at least 10 ms

    def suspend(self):
        self.frame_at = None
        self.device.suspend(True)

    def resume(self):
        self.device.suspend(False)
        self.frame_at = self.machine.now + self.frame_ticks

    def unplug(self):
        self.frame_at = None
        self.device.unplug()

    def until(self, transaction):
        """Repeats it while it is answered NAK."""
        end = self.machine.now + self.control_limit_ticks
        while self.machine.now < end:
            answer = transaction()
            self.run(self.transaction_ticks)
            if answer == STALL:
                raise Stalled
            if answer is not None and answer != NAK:
                return answer
        raise TimeoutError("no answer on the bus")

    def control(self, kind, request, value, index, size_or_data):
        """USB 2.0, 8.5.3; the data that came for a request that reads."""
        reads = bool(kind & 0x80)
        data = b"" if reads else size_or_data
        size = size_or_data if reads else len(data)
        setup = struct.pack("<BBHHH", kind, request, value, index, size)
        self.until(lambda: self.device.setup(self.address, setup))
        got, toggle = b"", DATA1
        while reads and len(got) < size:
            packet = self.until(lambda: self.device.take_in(self.address, 0))
            self.expect(packet, toggle)
            got += packet
            toggle ^= 1
            if len(packet) < PACKET_BYTES:
                break
        for at in range(0, len(data), PACKET_BYTES):
            packet = Packet(toggle, data[at:at + PACKET_BYTES])
            self.until(lambda: self.device.out(self.address, 0, packet))
            toggle ^= 1
        if reads:
            self.until(lambda: self.device.out(self.address, 0, Packet(DATA1, b"")))
        else:
            self.expect(self.until(lambda: self.device.take_in(self.address, 0)), DATA1)
        return got

    @staticmethod
    def expect(packet, toggle):
        if packet.toggle != toggle:
            raise IOError(f"DATA{packet.toggle} where DATA{toggle} is due")

    def descriptor(self, kind, index=0, size=255, language=0):
        return self.control(0x80, GET_DESCRIPTOR, kind << 8 | index, language, size)

    def text(self, index):
        answer = self.descriptor(3, index, language=0x0409)
        return answer[2:answer[0]].decode("utf-16-le")

    def enumerate(self):
        """As Linux does: a short look, a second reset, an address, everything."""
        self.descriptor(1, size=64)
        self.reset()
        self.control(0, SET_ADDRESS, 7, 0, b"")
        self.address = 7
        self.run(2 * self.frame_ticks)
        self.device_descriptor = self.descriptor(1, size=18)
        self.refused(lambda: self.descriptor(6, size=10))  # the qualifier of a device that knows high speed too
        size = struct.unpack_from("<H", self.descriptor(2, size=9), 2)[0]
        self.configuration = self.descriptor(2, size=size)
        self.product, self.serial = self.text(self.device_descriptor[15]), self.text(self.device_descriptor[16])
        self.control(0, SET_CONFIGURATION, 1, 0, b"")
        self.bulk = {entry[2] >> 7: entry[2] & 15 for entry in self.entries() if entry[1] == 5 and entry[3] & 3 == 2}
        self.toggles = {0: DATA0, 1: DATA0}

    @staticmethod
    def refused(request):
        try:
            request()
        except Stalled:
            return
        raise IOError("what a full-speed device does not have was answered")

    def entries(self):
        """The descriptors of which the configuration consists."""
        at = 0
        while at < len(self.configuration):
            yield self.configuration[at:at + self.configuration[at]]
            at += self.configuration[at]

    def clear_halt(self, direction):
        """Of a bulk endpoint: 1 is IN."""
        self.control(0x02, CLEAR_FEATURE, ENDPOINT_HALT, self.bulk[direction] | direction << 7, b"")
        self.toggles[direction] = DATA0

    def set_line(self, dtr):
        self.control(0x21, SET_CONTROL_LINE_STATE, dtr | dtr << 1, 0, b"")

    def write(self, data):
        for at in range(0, len(data), PACKET_BYTES):
            packet = Packet(self.toggles[0], data[at:at + PACKET_BYTES])
            if self.until(lambda: self.device.out(self.address, self.bulk[0], packet)) != ACK:
                raise IOError("OUT")
            self.toggles[0] ^= 1

    def take(self):
        answer = self.device.take_in(self.address, self.bulk[1])
        if answer in (STALL, None):
            raise IOError(f"IN: {answer}")
        if answer == NAK:
            return False
        if answer.toggle == self.toggles[1]:
            self.toggles[1] ^= 1
            self.received += answer
        else:
            self.repetitions += 1
        return True

    def read_for(self, ticks):
        """Asks for packets all the time, as a driver with transfers under way does."""
        end = self.machine.now + ticks
        while self.machine.now < end:
            self.run(self.transaction_ticks if self.take() else 2 * self.transaction_ticks)

    def read_eagerly_for(self, ticks):
        """The host's token comes at the moment at which a packet is ready."""
        before, self.device.taken = self.device.taken, self.take
        try:
            self.run(ticks)
        finally:
            self.device.taken = before
