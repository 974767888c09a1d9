"""The 32-bit timer that both parts have: timer 2 of the LPC1769, CTIMER0 of the LPC55S69. Of its functions the model knows
free running and the capture of input 0, at which the sensor's data-ready line is. A part says how it is clocked and which
pin leads to it."""

from machine import WAIT_FOR_TIME_TICKS, Registers

CAPTURE_RISING, CAPTURE_INTERRUPT = 1, 4  # CCR
CAPTURED = 0x10                           # IR


class CaptureTimer(Registers):
    names = {0x00: "IR", 0x04: "TCR", 0x08: "TC", 0x0C: "PR", 0x14: "MCR", 0x28: "CCR", 0x2C: "CR0", 0x70: "CTCR"}

    def __init__(self, sensor):
        super().__init__()
        self.sensor = sensor
        self.started_at = 0
        self.sample_at = None
        self.edges = []  # of the data-ready line: (what TC was, number of the sample)
        self.edges_to_lose = 0

    def touched(self):
        """Complains where the part keeps the timer off."""
        raise NotImplementedError

    def clock_hz(self):
        raise NotImplementedError

    def line_connected(self):
        """Whether the data-ready line reaches capture input 0."""
        raise NotImplementedError

    def count(self, at):
        if self["TCR"] != 1 or self["PR"] or self["CTCR"]:
            return 0
        divider = self.machine.core_hz // self.clock_hz()
        return (at - self.started_at) // divider & 0xFFFFFFFF

    def advance(self):
        period = self.sensor.period_s()
        if period is None:
            self.sample_at = None
            return
        period_ticks = round(period * self.machine.core_hz)
        if self.sample_at is None:
            self.sample_at = self.machine.now + period_ticks
        while self.sample_at is not None and self.machine.now >= self.sample_at:
            if self.sensor.sample():
                self.edge(self.sample_at)
            self.sample_at += period_ticks

    def edge(self, at):
        if self.edges_to_lose:
            self.edges_to_lose -= 1
            return
        if self["CCR"] & CAPTURE_RISING and self.line_connected():
            self.value[0x2C] = self.count(at)
            self.edges.append((self.value[0x2C], self.sensor.samples - 1))
            if self["CCR"] & CAPTURE_INTERRUPT:
                self.value[0x00] = self["IR"] | CAPTURED

    def read(self, offset):
        self.touched()
        if offset == 0x08:
            self.machine.wait(WAIT_FOR_TIME_TICKS)
            return self.count(self.machine.now)
        return super().read(offset)

    def write(self, offset, value):
        self.touched()
        if offset == 0x00:
            value = self["IR"] & ~value
        elif offset == 0x04 and value == 1:
            self.started_at = self.machine.now
        super().write(offset, value)

    def next_event(self):
        return self.sample_at

    def asks(self):
        return bool(self["IR"] & CAPTURED)
