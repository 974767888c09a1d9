"""What the parts' SPIs have in common: two FIFOs of eight bytes, a byte on the wires after the other, the sensor at the end."""

from machine import Registers, Violation

FIFO_ENTRIES = 8
WAITING_READS = 1  # of the status with nothing to do: the image waits for the byte under way


class SpiMaster(Registers):
    def __init__(self, sensor):
        super().__init__()
        self.sensor = sensor
        self.stuck = False  # a byte under way never ends
        self.drop()

    def drop(self):
        """Empties the FIFOs and ends the byte under way."""
        self.out, self.received = [], []
        self.busy_until = None
        self.polls = 0

    def polled(self):
        """The status is read."""
        self.polls += 1
        if self.polls > WAITING_READS and self.out:
            self.machine.pass_time(self.byte_ticks())
            self.machine.advance()

    def rate_hz(self):
        raise NotImplementedError

    def connected(self):
        """Whether clock and both data lines are at their pins."""
        raise NotImplementedError

    def selected(self):
        """Whether the pin at the sensor's chip select is low."""
        raise NotImplementedError

    def byte_ticks(self):
        return 8 * self.machine.core_hz // self.rate_hz()

    def advance(self):
        while self.busy_until is not None and self.machine.now >= self.busy_until and not self.stuck:
            sent = self.out.pop(0)
            if not self.selected():
                raise Violation("a byte is sent while the sensor is not selected")
            self.received.append(self.sensor.exchange(sent, self.rate_hz()) if self.connected() else 0xFF)
            if len(self.received) > FIFO_ENTRIES:
                raise Violation("SPI: receive FIFO overrun")
            self.busy_until = self.busy_until + self.byte_ticks() if self.out else None

    def put(self, byte):
        if len(self.out) >= FIFO_ENTRIES:
            raise Violation("SPI: transmit FIFO overrun")
        self.polls = 0
        self.out.append(byte)
        if self.busy_until is None:
            self.busy_until = self.machine.now + self.byte_ticks()

    def get(self):
        if not self.received:
            raise Violation("SPI: read from an empty FIFO")
        self.polls = 0
        return self.received.pop(0)

    def next_event(self):
        return None if self.stuck else self.busy_until
