"""The computer at the other end: enumerates, opens the port, reads. One transaction at a time, so that nothing is answered
sooner than the image has had time for."""

import struct

from usb_device import ACK, NAK, STALL

FRAME_TICKS = 100_000
FIRST_FRAME = 2000    # of 2048: the number wraps in every test
TRANSACTION_TICKS = 5_500  # a bulk packet of 64 bytes takes about 50 us of a full-speed bus
GET_DESCRIPTOR, SET_ADDRESS, SET_CONFIGURATION = 6, 5, 9
SET_LINE_CODING, GET_LINE_CODING, SET_CONTROL_LINE_STATE = 0x20, 0x21, 0x22
CONTROL_LIMIT_TICKS = 50_000_000  # USB 2.0, 9.2.6.4: 500 ms for a stage with data


class Stalled(Exception):
    pass


class UsbHost:
    def __init__(self, part):
        self.machine, self.device = part.machine, part.usb
        self.device.frame = FIRST_FRAME
        self.address = 0
        self.frame_at = None
        self.received = bytearray()

    def run(self, ticks):
        """Lets the part run, with a start of frame every millisecond."""
        end = self.machine.now + ticks
        while self.machine.now < end:
            if self.frame_at is not None and self.machine.now >= self.frame_at:
                self.frame_at += FRAME_TICKS
                self.device.start_of_frame()
            self.machine.step()

    def wait_for_device(self, limit_ticks):
        if not self.machine.run_until(self.device.attached, limit_ticks):
            raise TimeoutError("no pull-up at D+")
        self.reset()

    def reset(self):
        self.device.bus_reset()
        self.address = 0
        self.frame_at = self.machine.now + FRAME_TICKS
        self.run(10 * FRAME_TICKS)  # USB 2.0, 7.1.7.5: at least 10 ms

    def until(self, transaction):
        """Repeats it while it is answered NAK."""
        end = self.machine.now + CONTROL_LIMIT_TICKS
        while self.machine.now < end:
            answer = transaction()
            self.run(TRANSACTION_TICKS)
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
        got = b""
        while reads and len(got) < size:
            packet = self.until(lambda: self.device.take_in(self.address, 0))
            got += packet
            if len(packet) < 64:
                break
        for at in range(0, len(data), 64):
            self.until(lambda: self.device.out(self.address, 0, data[at:at + 64]))
        if reads:
            self.until(lambda: self.device.out(self.address, 0, b""))
        else:
            self.until(lambda: self.device.take_in(self.address, 0))
        return got

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
        self.run(2 * FRAME_TICKS)
        self.device_descriptor = self.descriptor(1, size=18)
        self.refused(lambda: self.descriptor(6, size=10))  # the qualifier of a device that knows high speed too
        size = struct.unpack_from("<H", self.descriptor(2, size=9), 2)[0]
        self.configuration = self.descriptor(2, size=size)
        self.product, self.serial = self.text(self.device_descriptor[15]), self.text(self.device_descriptor[16])
        self.control(0, SET_CONFIGURATION, 1, 0, b"")
        self.bulk = {entry[2] >> 7: entry[2] & 15 for entry in self.entries() if entry[1] == 5 and entry[3] & 3 == 2}

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

    def set_line(self, dtr):
        self.control(0x21, SET_CONTROL_LINE_STATE, dtr | dtr << 1, 0, b"")

    def write(self, data):
        for at in range(0, len(data), 64):
            if self.until(lambda: self.device.out(self.address, self.bulk[0], data[at:at + 64])) != ACK:
                raise IOError("OUT")

    def take(self):
        answer = self.device.take_in(self.address, self.bulk[1])
        if answer in (STALL, None):
            raise IOError(f"IN: {answer}")
        if answer != NAK:
            self.received += answer
        return answer != NAK

    def read_for(self, ticks):
        """Asks for packets all the time, as a driver with transfers under way does."""
        end = self.machine.now + ticks
        while self.machine.now < end:
            self.run(TRANSACTION_TICKS if self.take() else 2 * TRANSACTION_TICKS)

    def read_eagerly_for(self, ticks):
        """The host's token comes at the moment at which a packet is ready."""
        self.device.taken = self.take
        try:
            self.run(ticks)
        finally:
            self.device.taken = lambda: None
