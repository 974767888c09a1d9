"""The LPC1769's image, as it would be flashed, on a model of the part: it boots, a host enumerates it, and what it streams
is what the sensor sampled, with the ticks of the data-ready line's edges. A register that the model takes otherwise than
the image does is a violation, and fails whatever test comes upon it.

usage: lpc1769_test.py IMAGE.bin. Exit code 77: Unicorn or the image is not here."""

import pathlib
import struct
import sys
import unittest

import unicorn_or_skip

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/protocol_vectors"))

import codec  # noqa: E402
import lpc17xx  # noqa: E402
from lpc17xx import CORE_HZ, Lpc1769, SERIAL_NUMBER  # noqa: E402
from machine import Violation  # noqa: E402
from mpu9250 import Mpu9250  # noqa: E402
from usb_host import UsbHost  # noqa: E402

HELLO, CONFIG, SAMPLES, STATUS, EVENT, REPLY = range(1, 7)
GET_HELLO, CONFIGURE, GET_STATUS = 0x81, 0x82, 0x85
STARTED, STOPPED, SENSOR_FAULT = 1, 2, 6
RESET_POWER_ON, RESET_WATCHDOG = 1, 3
ISOCHRONOUS, BULK, INTERRUPT = 1, 2, 3
MS = CORE_HZ // 1000
BOOT_TICKS = 400 * MS
RED, GREEN, BLUE = (0, 22), (3, 25), (3, 26)


def value_of(index):
    """Accelerometer x y z, temperature, gyro x y z; each sample another."""
    return [index, -index, 4096 - index, 1000, 3 * index, -2 * index, index ^ 0x55]


class Bench:
    """A board with its sensor, plugged in and enumerated."""

    def __init__(self, sensor=None, enumerate=True, **part):
        self.sensor = sensor or Mpu9250(value_of)
        self.part = Lpc1769(IMAGE, self.sensor, **part)
        self.host = UsbHost(self.part)
        self.receiver = codec.Receiver()
        self.sequence = 0
        if enumerate:
            self.host.wait_for_device(BOOT_TICKS)
            self.host.enumerate()

    def frames(self):
        """All frames so far."""
        self.receiver.take(bytes(self.host.received))
        self.host.received.clear()
        return self.receiver.frames

    def of_type(self, wanted):
        return [payload for kind, _, _, payload in self.frames() if kind == wanted]

    def ask(self, kind, payload=b""):
        self.host.write(codec.wire(kind, payload, self.sequence))
        self.sequence += 1

    def command(self, kind, payload=b""):
        """The result that the REPLY tells."""
        known = len(self.of_type(REPLY))
        self.ask(kind, payload)
        self.host.read_for(30 * MS)
        return self.of_type(REPLY)[known][5]


def samples_of(payload):
    """first_ticks, first_index, lost_samples, and the samples as they are in the frame."""
    ticks, index = struct.unpack_from("<QQ", payload)
    lost, count = struct.unpack_from("<IB", payload, 20)
    values = struct.unpack_from(f"<{(len(payload) - 28) // 2}h", payload, 28)
    size = len(values) // count
    return ticks, index, lost, [values[at:at + size] for at in range(0, len(values), size)]


def as_sent(number):
    """Sample `number` in the order of SPEC 4.3.1, gyro first."""
    values = [(value + 2**15) % 2**16 - 2**15 for value in value_of(number)]
    return tuple(values[4:7] + values[0:3])


class Image(unittest.TestCase):
    def check_stream(self, bench, least):
        """Every frame's samples and time stamps against the sensor's own account; none is lost."""
        frames = [samples_of(payload) for payload in bench.of_type(SAMPLES)]
        self.assertGreaterEqual(sum(len(frame[3]) for frame in frames), least)
        edges = bench.part.timer.edges
        at = [tick for tick, _ in edges].index(frames[0][0])
        index = 0
        for ticks, first_index, lost, samples in frames:
            self.assertEqual((first_index, lost), (index, 0))
            for i, sample in enumerate(samples):
                tick, number = edges[at + index]
                if i == 0:
                    self.assertEqual(ticks, tick)
                self.assertEqual(sample, as_sent(number))
                index += 1
        self.assertEqual(bench.receiver.skipped, 0)

    def test_enumerated_it_is_the_device_of_the_specification(self):
        bench = Bench()
        host = bench.host
        self.assertEqual(struct.unpack_from("<HH", host.device_descriptor, 8), (0x1209, 0x6779))
        self.assertTrue(host.product.startswith("gyrolog"))
        endpoints = [(entry[2] & 15, entry[3] & 3) for entry in host.entries() if entry[1] == 5]
        self.assertEqual(len(endpoints), 3)
        for number, kind in endpoints:  # UM10360, chapter 11: the number fixes the kind
            self.assertEqual(kind, {0: ISOCHRONOUS, 1: INTERRUPT, 2: BULK}[number % 3], f"endpoint {number}")
        self.assertEqual(host.serial, SERIAL_NUMBER.hex().upper())
        coding = bytes((0x00, 0xC2, 0x01, 0x00, 0, 0, 8))
        host.control(0x21, 0x20, 0, 0, coding)
        self.assertEqual(host.control(0xA1, 0x21, 0, 0, 7), coding)
        self.assertTrue(bench.part.led(*GREEN))
        self.assertFalse(bench.part.led(*RED))
        host.read_for(50 * MS)
        self.assertEqual(bytes(host.received), b"")  # SPEC 10.5

    def test_what_it_streams_is_what_the_sensor_sampled_when_it_did(self):
        bench = Bench()
        bench.host.set_line(dtr=True)
        bench.host.read_for(400 * MS)
        self.assertTrue(bench.part.led(*BLUE))
        kinds = [kind for kind, _, _, _ in bench.frames()]
        self.assertEqual(kinds[:4], [HELLO, CONFIG, EVENT, SAMPLES])
        hello = bench.of_type(HELLO)[0]
        self.assertEqual(struct.unpack_from("<I", hello, 4)[0], CORE_HZ)
        self.assertEqual((hello[2], hello[12], hello[16:32]), (32, RESET_POWER_ON, SERIAL_NUMBER))
        self.check_stream(bench, 35)
        bench.host.set_line(dtr=False)
        bench.host.read_for(50 * MS)
        self.assertEqual(struct.unpack_from("<H", bench.of_type(EVENT)[-1], 16)[0], STOPPED)
        self.assertFalse(bench.part.led(*BLUE))

    def test_late_interrupts_and_a_fast_sensor_change_no_time_stamp(self):
        bench = Bench()
        self.assertEqual(bench.command(CONFIGURE, struct.pack("<IHHHBBI", 1_000_000, 0, 0, 0, 0, 0, 0)), 0)
        bench.part.machine.latency_ticks = 2000  # 20 us
        bench.host.set_line(dtr=True)
        bench.host.read_for(150 * MS)
        self.check_stream(bench, 100)

    def test_a_host_that_takes_each_packet_at_once_does_not_stop_the_link(self):
        bench = Bench()
        bench.host.set_line(dtr=True)
        bench.part.machine.latency_ticks = 1000  # the driver always comes too late
        bench.host.read_eagerly_for(400 * MS)
        self.check_stream(bench, 30)

    def test_commands_are_answered_and_frames_of_the_bus_are_counted(self):
        bench = Bench()
        counts = []
        for _ in range(2):
            self.assertEqual(bench.command(GET_STATUS), 0)
            counts.append(struct.unpack_from("<QQIIIII", bench.of_type(STATUS)[-1]))
        ticks, frames = (counts[1][i] - counts[0][i] for i in (0, 6))
        self.assertAlmostEqual(frames, ticks / MS, delta=1)

    def test_a_bus_reset_ends_the_stream_and_the_next_host_begins_anew(self):
        bench = Bench()
        bench.host.set_line(dtr=True)
        bench.host.read_for(100 * MS)
        bench.host.reset()
        bench.host.run(20 * MS)
        self.assertFalse(bench.part.led(*BLUE))
        bench.host.enumerate()
        bench.host.read_for(60 * MS)  # SPEC 9.5: what an earlier listener left
        bench.host.received.clear()
        bench.receiver = codec.Receiver()
        bench.host.set_line(dtr=True)
        bench.host.read_for(200 * MS)
        self.check_stream(bench, 10)

    def test_a_suspended_bus_ends_the_stream(self):
        bench = Bench()
        bench.host.set_line(dtr=True)
        bench.host.read_for(100 * MS)
        bench.part.usb.suspend(True)
        bench.host.frame_at = None
        bench.host.run(20 * MS)
        self.assertFalse(bench.part.led(*BLUE))

    def test_without_a_sensor_it_answers_and_says_which_register_is_wrong(self):
        sensor = Mpu9250(value_of)
        sensor.wired = False
        bench = Bench(sensor)
        self.assertTrue(bench.part.led(*RED))
        bench.host.set_line(dtr=True)
        bench.host.read_for(350 * MS)
        faults = [struct.unpack_from("<i", event, 20)[0] for event in bench.of_type(EVENT)
                  if struct.unpack_from("<H", event, 16)[0] == SENSOR_FAULT]
        self.assertEqual(faults[:1], [0x75FF])

    def test_a_pll_that_does_not_lock_ends_in_a_reset_that_hello_tells(self):
        stuck = Bench(enumerate=False)
        stuck.part.system.pll_never_locks = True
        self.assertTrue(stuck.part.machine.run_until(stuck.part.watchdog.has_bitten, 3 * CORE_HZ))
        after = Bench(cause=lpc17xx.WATCHDOG, ahb=stuck.part.second_memory())
        self.assertEqual(after.command(GET_HELLO), 0)
        self.assertEqual(after.of_type(HELLO)[0][12], RESET_WATCHDOG)

    def test_each_boot_has_another_number(self):
        first = Bench()
        again = Bench(cause=lpc17xx.PIN, ahb=first.part.second_memory())
        fresh = Bench(seed=2)
        numbers = set()
        for bench in (first, again, fresh):
            self.assertEqual(bench.command(GET_HELLO), 0)
            numbers.add(bench.of_type(HELLO)[0][8:12])
        self.assertEqual(len(numbers), 3)

    def test_a_wrong_checksum_of_the_vectors_keeps_it_in_the_boot_rom(self):
        with self.assertRaises(Violation):
            Lpc1769(IMAGE[:0x1C] + bytes(4) + IMAGE[0x20:], Mpu9250(value_of))


if __name__ == "__main__":
    path = pathlib.Path(sys.argv.pop(1))
    if not path.exists():
        print(f"skipped: needs the image {path.name}")
        sys.exit(unicorn_or_skip.SKIPPED)
    IMAGE = path.read_bytes()
    unittest.main(verbosity=2)
