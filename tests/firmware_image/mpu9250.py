"""The MPU-9250 at the end of an SPI: registers, FIFO, a 50 us pulse at each sample. From the register map
RM-MPU-9250A-00 and the product specification PS-MPU-9250A-01, not from the driver under test."""

from machine import Violation

WHO_AM_I, PWR_MGMT_1, USER_CTRL, FIFO_EN, INT_ENABLE, INT_STATUS = 0x75, 0x6B, 0x6A, 0x23, 0x38, 0x3A
FIFO_COUNT_H, FIFO_R_W, CONFIG, SMPLRT_DIV, ACCEL_XOUT_H, TEMP_OUT_H, GYRO_XOUT_H = 0x72, 0x74, 0x1A, 0x19, 0x3B, 0x41, 0x43
FIFO_BYTES = 512
SLOW_HZ = 1_000_000  # all registers
FAST_HZ = 20_000_000  # reading those from INT_STATUS to GYRO_ZOUT_L
FAST = range(INT_STATUS, 0x49)
PULSE_S = 50e-6


class Mpu9250:
    """`value_of(index)` is a sample's seven numbers: accelerometer, temperature, gyro."""

    def __init__(self, value_of, who_am_i=0x71):
        self.value_of = value_of
        self.who_am_i = who_am_i
        self.wired = True
        self.samples = 0
        self.reset()

    def reset(self):
        self.register = bytearray(128)
        self.register[WHO_AM_I] = self.who_am_i
        self.register[PWR_MGMT_1] = 1
        self.fifo = bytearray()
        self.fifo_count = bytes(2)
        self.address = None

    def period_s(self):
        """Between two samples, or None while it does not sample."""
        if not (self.register[INT_ENABLE] & 1 or self.register[USER_CTRL] & 0x40):
            return None
        if self.register[CONFIG] & 7 in (0, 7):
            return 1 / 8000
        return (1 + self.register[SMPLRT_DIV]) / 1000

    def sample(self):
        """Takes one; whether the data-ready line pulses."""
        values = self.value_of(self.samples)
        self.samples += 1
        for i, value in enumerate(values):
            self.register[ACCEL_XOUT_H + 2 * i:ACCEL_XOUT_H + 2 * i + 2] = (value & 0xFFFF).to_bytes(2, "big")
        if self.register[USER_CTRL] & 0x40:
            self.store()
        return bool(self.register[INT_ENABLE] & 1)

    def store(self):
        enabled = self.register[FIFO_EN]
        parts = [(0x08, ACCEL_XOUT_H, 6), (0x80, TEMP_OUT_H, 2), (0x70, GYRO_XOUT_H, 6)]
        new = b"".join(self.register[at:at + size] for bits, at, size in parts if enabled & bits)
        if len(self.fifo) + len(new) > FIFO_BYTES:
            self.register[INT_STATUS] |= 0x10
        else:
            self.fifo += new

    def select(self, selected):
        self.address = None
        self.selected = selected

    def exchange(self, byte, rate_hz):
        """The byte that the sensor sends while it takes `byte`."""
        if not self.wired:
            return 0xFF
        if self.address is None:
            self.address, self.reads = byte & 0x7F, bool(byte & 0x80)
            self.first = True
            self.rate_hz = rate_hz
            return 0
        fast = self.reads and self.address in FAST
        if self.rate_hz > (FAST_HZ if fast else SLOW_HZ) or rate_hz > (FAST_HZ if fast else SLOW_HZ):
            raise Violation(f"register {self.address:02x} of the sensor at {rate_hz} Hz")
        if not self.reads:
            self.write(self.address, byte)
            answer = 0
        else:
            answer = self.read(self.address)
        if self.address != FIFO_R_W:
            self.address += 1
        return answer

    def write(self, address, value):
        if address == PWR_MGMT_1 and value & 0x80:
            self.reset()
            self.address = address
            return
        if address == USER_CTRL and value & 0x04:
            self.fifo.clear()
            value &= ~0x04
        self.register[address] = value

    def read(self, address):
        if address == FIFO_R_W:
            return self.fifo.pop(0) if self.fifo else 0xFF
        if address == FIFO_COUNT_H:  # register map, register 114: reading it latches both bytes
            self.fifo_count = len(self.fifo).to_bytes(2, "big")
        if address in (FIFO_COUNT_H, FIFO_COUNT_H + 1):
            return self.fifo_count[address - FIFO_COUNT_H]
        value = self.register[address]
        if address == INT_STATUS:
            self.register[INT_STATUS] = 0
        return value
