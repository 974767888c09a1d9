"""The board's core as ARM code in QEMU, its UART behind a pseudo-terminal: it conforms, it is captured without a loss,
and it conforms again after a program that was killed left it streaming.

usage: emulated_board_test.py an385|an521 [TEST]... Exit code 77: QEMU or the ARM compiler is not installed."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import schemas  # noqa: E402

SOURCE = pathlib.Path(os.environ["GYROLOG_SOURCE_DIR"])
BUILD = pathlib.Path(os.environ["GYROLOG_BUILD_DIR"])
GYROLOG = BUILD / "gyrolog"
START_LIMIT_S = 60

# What a line without DTR and a healthy board do not show.
NOT_SHOWN = {"2.2", "8.1", "8.2", "8.7", "8.10", "8.11", "10.1", "10.2"}


class Board:
    """tools/arm_board from its start to its end."""

    def __init__(self, board, folder):
        self.process = subprocess.Popen([SOURCE / "tools/arm_board", "--board", board, folder], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.uri = self.process.stdout.readline().strip()
        if not self.uri:
            status = self.process.wait()
            message = self.process.stderr.read()
            if status == 77:
                print("skipped: " + message.strip().removeprefix("arm_board: "), file=sys.stderr)
                sys.exit(77)
            raise RuntimeError(f"arm_board: exit {status}: {message}")

    def end(self):
        self.process.terminate()
        self.process.wait(timeout=20)
        self.process.stdout.close()
        self.process.stderr.close()


class EmulatedBoard(unittest.TestCase):
    """One board for all, in this order: only the first test wants it fresh from its boot."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.board = Board(BOARD, cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.board.end()
        schemas.keep_in(cls.folder.name)
        cls.folder.cleanup()

    def conform(self):
        result = subprocess.run([GYROLOG, "conform", "--device", self.board.uri, "--json", "-"], capture_output=True,
                                text=True, timeout=60)
        self.assertIn(result.returncode, (0, 7), result.stderr)
        answer = json.loads(schemas.keep(result.stdout, "verdicts"))
        broken = [rule for rule in answer["rules"] if rule["verdict"] == "fail"]
        self.assertEqual(broken, [])
        self.assertEqual(answer["broken_off"], "")
        self.assertEqual(result.returncode, 0)
        return {rule["rule"] for rule in answer["rules"] if rule["verdict"] == "not_tested"}

    def test_1_fresh_from_its_boot_it_conforms(self):
        self.assertEqual(self.conform(), NOT_SHOWN)

    def test_2_its_stream_is_captured_whole(self):
        path = pathlib.Path(self.folder.name) / "arm.pcapng"
        subprocess.run([GYROLOG, "capture", "--device", self.board.uri, "-o", path, "--duration", "3s", "--rate", "200"],
                       check=True, capture_output=True, timeout=60)
        answer = json.loads(subprocess.run([GYROLOG, "check", path, "--json", "-"], check=True, capture_output=True,
                                           timeout=60).stdout)
        self.assertGreaterEqual(answer["samples"]["good"], 600)
        self.assertEqual(answer["samples"]["missing"], 0)
        self.assertEqual(answer["frames"]["corrupted"], 0)

    def test_3_left_streaming_by_a_killed_program_it_conforms(self):
        path = pathlib.Path(self.folder.name) / "killed.pcapng"
        capture = subprocess.Popen([GYROLOG, "capture", "--device", self.board.uri, "-o", path, "--rate", "500"],
                                   stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + START_LIMIT_S
        while not (path.exists() and path.stat().st_size > 20000):
            self.assertLess(time.monotonic(), deadline, "the capture does not grow")
            time.sleep(0.1)
        capture.send_signal(signal.SIGKILL)
        capture.wait()
        self.assertEqual(self.conform(), NOT_SHOWN | {"8.12"})  # it was set up since its boot


if __name__ == "__main__":
    BOARD = sys.argv.pop(1)
    unittest.main()
