"""What a sample costs on a Cortex-M3 and a Cortex-M33, by tools/arm_load: within limits, and what the host gets is what
the sensor sampled. QEMU counts instructions, so a busy computer changes nothing.

usage: arm_load_test.py an385|an521 [TEST]... Exit code 77: QEMU, the ARM compiler or TinyUSB is not here."""

import importlib.machinery
import importlib.util
import os
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
_loader = importlib.machinery.SourceFileLoader("arm_load", os.environ["GYROLOG_SOURCE_DIR"] + "/tools/arm_load")
arm_load = importlib.util.module_from_spec(importlib.util.spec_from_loader("arm_load", _loader))
_loader.exec_module(arm_load)

# Instructions a sample, a twelfth above what GCC 12 makes of it (the table in firmware_protocol/ports/mps2/README.md).
MEAN_LIMIT = {(1000, 12): 910, (8000, 12): 845, (8000, 14): 945}
LARGEST_LIMIT = {(1000, 12): 995, (8000, 12): 895, (8000, 14): 995}
# The sensor's FIFO holds 36 samples of 14 bytes. The turn that makes a frame must be over in half that time, at two
# clocks an instruction.
TURN_LIMIT_S = 36 / 8000 / 2


class Load(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.image = arm_load.LoadImage(BOARD, cls.folder / "fast")
        cls.image.build()

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def measured(self, rate_hz, sample_bytes):
        measurement = self.image.run(rate_hz, sample_bytes, 2000)
        measurement.check_stream()
        self.assertGreaterEqual(measurement.samples, 1800)
        self.assertLess(measurement.mean, MEAN_LIMIT[rate_hz, sample_bytes])
        self.assertLess(measurement.largest, LARGEST_LIMIT[rate_hz, sample_bytes])
        self.assertLess(measurement.longest_turn * arm_load.SLOW_CLOCKS / self.image.clock_hz, TURN_LIMIT_S)
        return measurement

    def test_at_1_kHz_nearly_all_time_is_left(self):
        self.assertGreater(self.measured(1000, 12).headroom, 0.8)

    def test_at_8_kHz_it_keeps_pace_with_the_gyro_and_the_accelerometer(self):
        self.assertGreater(self.measured(8000, 12).headroom, 0.1)

    def test_at_8_kHz_it_keeps_pace_with_all_fields(self):
        self.assertGreater(self.measured(8000, 14).headroom, 0.0)

    def test_at_8_kHz_it_keeps_pace_when_an_instruction_takes_two_clocks(self):
        image = arm_load.LoadImage(BOARD, self.folder / "slow", arm_load.SLOW_CLOCKS)
        image.build()
        image.run(8000, 12, 2000).check_stream()

    def test_the_same_run_again_counts_the_same(self):
        turns = []
        for _ in range(2):
            self.image.run(8000, 12, 200)
            turns.append((self.image.folder / "turns.bin").read_bytes())
        self.assertEqual(*turns)


if __name__ == "__main__":
    BOARD = sys.argv.pop(1)
    unittest.main()
