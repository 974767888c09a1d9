"""The watchdog timer that both parts have. A part says what it counts with."""

from machine import Registers, Violation

ENABLED, RESETS = 1, 2  # MOD
PRESCALER = 4
IDLE_S = 100e-6  # an idle main loop is let pass in steps of so much


class Watchdog(Registers):
    names = {0x00: "MOD", 0x04: "TC", 0x08: "FEED", 0x0C: "TV"}

    def __init__(self):
        super().__init__()
        self.half_fed = False
        self.bites_at = None
        self.feeds = 0

    def clock_hz(self):
        """Complains where it has none, or the one that it is to watch."""
        raise NotImplementedError

    def write(self, offset, value):
        if self.half_fed and not (self.names.get(offset) == "FEED" and value == 0x55):
            raise Violation("the watchdog's feed sequence is broken")
        super().write(offset, value)
        if self.names[offset] != "FEED":
            return
        if value == 0x55 and self.half_fed and self["MOD"] & ENABLED:
            self.bites_at = self.machine.now + self["TC"] * PRESCALER * self.machine.core_hz // self.clock_hz()
            self.feeds += 1
            self.machine.pass_time(round(IDLE_S * self.machine.core_hz))
        self.half_fed = value == 0xAA

    def next_event(self):
        return self.bites_at

    def has_bitten(self):
        return bool(self["MOD"] & RESETS) and self.bites_at is not None and self.machine.now >= self.bites_at
