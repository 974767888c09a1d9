"""A board's image, as it would be flashed, on a model of the part: it boots, a host enumerates it, and what it streams is what
the sensor sampled, with the ticks of the data-ready line's edges. A register that the model takes otherwise than the image
does is a violation, and fails whatever test comes upon it.

usage: image_test.py BOARD IMAGE.bin [Everyday|Trouble|CLASS.TEST]... Exit code 77: Unicorn or the image is not here."""

import pathlib
import struct
import sys
import unittest

import unicorn_or_skip

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/protocol_vectors"))

import codec  # noqa: E402
from lpc17xx import Lpc1769  # noqa: E402
from lpc55xx import Lpc55s69  # noqa: E402
from machine import Violation  # noqa: E402
from mpu9250 import Mpu9250  # noqa: E402
from usb_bus import NAK  # noqa: E402
from usb_host import UsbHost  # noqa: E402

PARTS = {"lpc1769": Lpc1769, "lpcxpresso55s69": Lpc55s69}
HELLO, CONFIG, SAMPLES, STATUS, EVENT, REPLY = range(1, 7)
GET_HELLO, CONFIGURE, GET_STATUS = 0x81, 0x82, 0x85
STARTED, STOPPED, FIFO_OVERFLOW, BUS_ERROR, RING_OVERFLOW, SENSOR_FAULT, TEXT = range(1, 8)
FIFO_OVERFLOW_FLAG, BUS_ERROR_FLAG, RING_OVERFLOW_FLAG, _, TIME_FLAG = (1 << n for n in range(5))
RESET_POWER_ON, RESET_PIN, RESET_WATCHDOG, RESET_BROWN_OUT = range(1, 5)
BOOT_MS = 400
WATCHDOG_MS = 2000


def value_of(index):
    """Accelerometer x y z, temperature, gyro x y z; each sample another."""
    return [index, -index, 4096 - index, 1000, 3 * index, -2 * index, index ^ 0x55]


class Bench:
    """A board with its sensor, plugged in and enumerated. Times are in milliseconds."""

    def __init__(self, sensor=None, enumerate=True, **part):
        self.sensor = sensor or Mpu9250(value_of)
        self.part = PARTS[BOARD](IMAGE, self.sensor, **part)
        self.host = UsbHost(self.part)
        self.receiver = codec.Receiver()
        self.sequence = 0
        if enumerate:
            self.host.wait_for_device(self.ticks(BOOT_MS))
            self.host.enumerate()

    def ticks(self, duration_ms):
        return round(duration_ms * self.part.core_hz / 1000)

    def run(self, duration_ms):
        self.host.run(self.ticks(duration_ms))

    def read_for(self, duration_ms):
        self.host.read_for(self.ticks(duration_ms))

    def stream_for(self, duration_ms):
        self.host.set_line(dtr=True)
        self.read_for(duration_ms)

    def begin_anew(self):
        """What an earlier listener left is thrown away (SPEC 9.5)."""
        self.read_for(60)
        self.host.received.clear()
        self.receiver = codec.Receiver()

    def frames(self):
        """All frames so far."""
        self.receiver.take(bytes(self.host.received))
        self.host.received.clear()
        return self.receiver.frames

    def of_type(self, wanted):
        return [payload for kind, _, _, payload in self.frames() if kind == wanted]

    def events(self):
        """(code, value) of each."""
        return [(struct.unpack_from("<H", event, 16)[0], struct.unpack_from("<i", event, 20)[0])
                for event in self.of_type(EVENT)]

    def ask(self, kind, payload=b""):
        self.host.write(codec.wire(kind, payload, self.sequence))
        self.sequence += 1

    def command(self, kind, payload=b""):
        """The result that the REPLY tells."""
        known = len(self.of_type(REPLY))
        self.ask(kind, payload)
        self.read_for(30)
        replies = self.of_type(REPLY)[known:]
        if not replies:
            raise IOError(f"command {kind:02x} was not answered")
        return replies[0][5]

    def configure(self, rate_hz, dlpf_hz=0):
        """Gyro and accelerometer."""
        return self.command(CONFIGURE, struct.pack("<IHHHBBI", rate_hz * 1000, 0, 0, dlpf_hz, 0, 0, 0))

    def hello(self):
        """What a new boot tells first."""
        if self.command(GET_HELLO) != 0:
            raise IOError("GET_HELLO is refused")
        return self.of_type(HELLO)[0]


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


class Case(unittest.TestCase):
    def check_stream(self, bench, least):
        """Every frame's samples and time stamps against the sensor's own account; none is lost."""
        self.assertEqual(self.check_accounts(bench, least), 0)

    def check_accounts(self, bench, least):
        """The same where samples were lost: each is counted (SPEC 5.3), and what came is in its place. How many were lost."""
        frames = [samples_of(payload) for payload in bench.of_type(SAMPLES)]
        self.assertGreaterEqual(sum(len(frame[3]) for frame in frames), least)
        number_at = dict(bench.part.timer.edges)
        first = number_at[frames[0][0]]
        received = lost = 0
        for ticks, index, lost, samples in frames:
            self.assertEqual(received + lost, index)
            self.assertEqual(number_at[ticks], first + index)
            for i, sample in enumerate(samples):
                self.assertEqual(sample, as_sent(first + index + i))
            received += len(samples)
        self.assertEqual((bench.receiver.skipped, bench.host.repetitions), (0, 0))
        return lost

    def flags(self, bench):
        """Of all SAMPLES frames."""
        gathered = 0
        for kind, flags, _, _ in bench.frames():
            gathered |= flags if kind == SAMPLES else 0
        return gathered


class Everyday(Case):
    """A host and a sensor like any other."""

    def test_enumerated_it_is_the_device_of_the_specification(self):
        bench = Bench()
        host = bench.host
        self.assertEqual(struct.unpack_from("<HH", host.device_descriptor, 8), (0x1209, 0x6779))
        self.assertTrue(host.product.startswith("gyrolog"))
        endpoints = [(entry[2] & 15, entry[3] & 3) for entry in host.entries() if entry[1] == 5]
        self.assertEqual(len(endpoints), 3)
        for number, kind in endpoints:
            self.assertIn(kind, bench.part.endpoint_kinds(number), f"endpoint {number}")
        self.assertEqual(host.serial, bench.part.serial_number.hex().upper())
        coding = bytes((0x00, 0xC2, 0x01, 0x00, 0, 0, 8))
        host.control(0x21, 0x20, 0, 0, coding)
        self.assertEqual(host.control(0xA1, 0x21, 0, 0, 7), coding)
        self.assertTrue(bench.part.lit("green"))
        self.assertFalse(bench.part.lit("red"))
        bench.read_for(50)
        self.assertEqual(bytes(host.received), b"")  # SPEC 10.5

    def test_what_it_streams_is_what_the_sensor_sampled_when_it_did(self):
        bench = Bench()
        bench.stream_for(400)
        self.assertTrue(bench.part.lit("blue"))
        kinds = [kind for kind, _, _, _ in bench.frames()]
        self.assertEqual(kinds[:4], [HELLO, CONFIG, EVENT, SAMPLES])
        hello = bench.of_type(HELLO)[0]
        self.assertEqual(struct.unpack_from("<I", hello, 4)[0], bench.part.core_hz)
        self.assertEqual((hello[2], hello[12], hello[16:32]), (32, RESET_POWER_ON, bench.part.serial_number))
        self.check_stream(bench, 35)
        bench.host.set_line(dtr=False)
        bench.read_for(50)
        self.assertEqual(bench.events()[-1][0], STOPPED)
        self.assertFalse(bench.part.lit("blue"))

    def test_a_thousand_samples_a_second_all_arrive(self):
        bench = Bench()
        self.assertEqual(bench.configure(1000), 0)
        bench.stream_for(250)
        self.check_stream(bench, 200)

    def test_late_interrupts_and_a_fast_sensor_change_no_time_stamp(self):
        bench = Bench()
        self.assertEqual(bench.configure(1000), 0)
        bench.part.machine.latency_ticks = 2000  # 20 us
        bench.stream_for(150)
        self.check_stream(bench, 100)

    def test_a_host_that_takes_each_packet_at_once_does_not_stop_the_link(self):
        bench = Bench()
        bench.host.set_line(dtr=True)
        bench.part.machine.latency_ticks = 1000  # the driver always comes too late
        bench.host.read_eagerly_for(bench.ticks(250))
        self.check_stream(bench, 15)

    def test_commands_are_answered_and_frames_of_the_bus_are_counted(self):
        bench = Bench()
        counts = []
        for number in (2030, None):
            bench.part.usb.frame = number or bench.part.usb.frame
            self.assertEqual(bench.command(GET_STATUS), 0)
            counts.append(struct.unpack_from("<QQIIIII", bench.of_type(STATUS)[-1]))
        self.assertLess(bench.part.usb.frame, 2030)  # it wrapped in between
        ticks, frames = (counts[1][i] - counts[0][i] for i in (0, 6))
        self.assertAlmostEqual(frames, ticks / bench.ticks(1), delta=1)

    def test_a_request_that_it_does_not_know_is_refused_and_the_next_one_answered(self):
        bench = Bench()
        host = bench.host
        for kind, request, data in ((0xC0, 0x33, 8), (0x40, 0x33, b""), (0xA1, 0x77, 8), (0x41, 0x22, b"")):
            host.refused(lambda: host.control(kind, request, 0, 0, data))
            self.assertEqual(host.descriptor(1, size=18), host.device_descriptor)
        host.refused(lambda: host.text(9))
        bench.stream_for(200)
        self.check_stream(bench, 10)

    def test_a_request_that_the_host_gives_up_does_not_disturb_the_next(self):
        bench = Bench()
        host = bench.host
        setup = struct.pack("<BBHHH", 0x80, 6, 0x0200, 0, 255)  # more than one packet
        for packets in (0, 1, 2):
            host.until(lambda: host.device.setup(host.address, setup))
            for _ in range(packets):
                host.until(lambda: host.device.take_in(host.address, 0))
            self.assertEqual(host.descriptor(1, size=18), host.device_descriptor)
        host.device.setup(host.address, setup)  # the next one at once
        self.assertEqual(host.descriptor(1, size=18), host.device_descriptor)
        host.until(lambda: host.device.setup(host.address, setup))
        while host.device.take_in(host.address, 0) == NAK:
            host.run(host.transaction_ticks)
        self.assertEqual(host.descriptor(1, size=18), host.device_descriptor)  # before a packet's end is served

    def test_a_clear_halt_begins_with_data0_and_loses_nothing(self):
        bench = Bench()
        bench.host.clear_halt(0)
        bench.host.clear_halt(1)
        self.assertEqual(bench.configure(1000), 0)
        bench.host.clear_halt(0)
        bench.host.clear_halt(1)
        bench.stream_for(150)
        self.assertEqual(bench.command(GET_STATUS), 0)
        self.check_stream(bench, 100)


class Trouble(Case):
    """What takes longer to run: full speed, and a bus, a sensor, a clock that fail."""

    def test_eight_thousand_samples_a_second_all_arrive(self):
        bench = Bench()
        self.assertEqual(bench.configure(8000, dlpf_hz=3600), 0)
        bench.stream_for(200)
        self.check_stream(bench, 1200)

    def test_a_bus_reset_within_a_frame_ends_the_stream_and_the_next_host_begins_anew(self):
        bench = Bench()
        self.assertEqual(bench.configure(1000), 0)
        bench.frames()
        bench.stream_for(50)
        while bench.host.received[-1] == 0:  # the delimiter (SPEC 1.2)
            bench.read_for(0.1)
        bench.host.reset()
        bench.run(20)
        self.assertFalse(bench.part.lit("blue"))
        bench.host.enumerate()
        bench.begin_anew()
        bench.stream_for(100)
        self.check_stream(bench, 40)

    def test_a_suspended_bus_ends_the_stream_and_a_resumed_one_begins_it_anew(self):
        bench = Bench()
        bench.stream_for(100)
        bench.host.suspend()
        bench.run(20)
        self.assertFalse(bench.part.lit("blue"))
        bench.host.resume()
        bench.begin_anew()
        self.assertTrue(bench.part.lit("blue"))  # DTR has not fallen for the host
        bench.host.set_line(dtr=False)
        bench.begin_anew()
        bench.stream_for(200)
        self.check_stream(bench, 10)

    def test_unplugged_it_stops_and_plugged_in_again_it_begins_anew(self):
        bench = Bench()
        bench.stream_for(100)
        bench.host.unplug()
        bench.run(20)
        self.assertFalse(bench.part.lit("blue"))
        bench.part.usb.plug()
        bench.host.wait_for_device(bench.ticks(20))
        bench.host.enumerate()
        bench.begin_anew()
        bench.stream_for(200)
        self.check_stream(bench, 10)

    def test_a_host_that_does_not_read_is_told_how_much_it_missed(self):
        bench = Bench()
        self.assertEqual(bench.configure(8000, dlpf_hz=3600), 0)
        bench.stream_for(20)
        bench.run(220)
        bench.read_for(150)
        lost = self.check_accounts(bench, 1000)
        self.assertGreater(lost, 100)
        self.assertTrue(self.flags(bench) & RING_OVERFLOW_FLAG)
        self.assertIn(RING_OVERFLOW, [code for code, _ in bench.events()])

    def test_lost_interrupts_are_counted_and_told(self):
        bench = Bench()
        self.assertEqual(bench.configure(1000), 0)
        bench.stream_for(100)
        bench.part.timer.edges_to_lose = 1
        bench.read_for(300)
        lost = self.check_accounts(bench, 300)
        self.assertGreaterEqual(lost, 1)
        self.assertTrue(self.flags(bench) & TIME_FLAG)
        self.assertEqual([value for code, value in bench.events() if code == TEXT], [lost])

    def test_a_stuck_bus_and_the_overflow_behind_it_are_told(self):
        bench = Bench()
        self.assertEqual(bench.configure(1000), 0)
        bench.stream_for(100)
        bench.part.spi.stuck = True
        bench.read_for(70)  # more than the sensor's FIFO holds, less than the queue of instants
        bench.part.spi.stuck = False
        bench.read_for(300)
        lost = self.check_accounts(bench, 250)
        self.assertGreaterEqual(lost, 60)
        events = bench.events()
        self.assertTrue({BUS_ERROR, FIFO_OVERFLOW} & {code for code, _ in events})
        self.assertEqual(sum(value for code, value in events if code in (BUS_ERROR, FIFO_OVERFLOW, TEXT)), lost)
        self.assertTrue(self.flags(bench) & (BUS_ERROR_FLAG | FIFO_OVERFLOW_FLAG))
        self.assertEqual(bench.command(GET_STATUS), 0)
        self.assertGreater(struct.unpack_from("<I", bench.of_type(STATUS)[-1], 40)[0], 0)  # bus_errors

    def test_without_a_sensor_it_answers_and_says_which_register_is_wrong(self):
        sensor = Mpu9250(value_of)
        sensor.wired = False
        bench = Bench(sensor)
        self.assertTrue(bench.part.lit("red"))
        bench.stream_for(350)
        faults = [value for code, value in bench.events() if code == SENSOR_FAULT]
        self.assertEqual(faults[:1], [0x75FF])

    def check_watchdog(self, stuck):
        """It bites when it is due, and HELLO of the next boot says so."""
        machine = stuck.part.machine
        self.assertTrue(machine.run_until(stuck.part.watchdog.has_bitten, stuck.ticks(1.1 * WATCHDOG_MS)))
        self.assertGreater(machine.now, stuck.ticks(0.9 * WATCHDOG_MS))
        after = Bench(cause="watchdog", kept=stuck.part.kept())
        self.assertEqual(after.hello()[12], RESET_WATCHDOG)

    def test_a_pll_that_does_not_lock_ends_in_a_reset_that_hello_tells(self):
        stuck = Bench(enumerate=False)
        stuck.part.system.pll_never_locks = True
        self.check_watchdog(stuck)

    def test_a_crystal_that_does_not_start_ends_in_a_reset_that_hello_tells(self):
        stuck = Bench(enumerate=False)
        stuck.part.system.crystal_never_starts = True
        self.check_watchdog(stuck)

    def test_each_boot_has_another_number_and_its_own_cause(self):
        first = Bench()
        again = Bench(cause="pin", kept=first.part.kept())
        fresh = Bench(cause="brown-out", seed=2)
        hellos = [bench.hello() for bench in (first, again, fresh)]
        self.assertEqual(len({hello[8:12] for hello in hellos}), 3)
        self.assertEqual([hello[12] for hello in hellos], [RESET_POWER_ON, RESET_PIN, RESET_BROWN_OUT])

    def test_an_image_that_the_boot_rom_would_refuse_does_not_run(self):
        with self.assertRaises(Violation):
            PARTS[BOARD](IMAGE[:0x1C] + bytes(4) + IMAGE[0x20:0x24] + b"\1" + IMAGE[0x25:], Mpu9250(value_of))


if __name__ == "__main__":
    BOARD, path = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1))
    if not path.exists():
        print(f"skipped: needs the image {path.name}")
        sys.exit(unicorn_or_skip.SKIPPED)
    IMAGE = path.read_bytes()
    unittest.main(verbosity=2)
