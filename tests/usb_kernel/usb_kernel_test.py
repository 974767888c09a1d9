#!/usr/bin/env python3
"""The program against the Linux kernel's own USB stack: boots one guest, runs every scenario of guest/scenarios in it,
then checks and analyses the captures here and judges what came back. See README.md.

Environment: GYROLOG_BUILD_DIR (programs under test), GYROLOG_GUEST_DIR (kernel and results),
SCENARIOS (optional: only those whose names match one of these shell patterns, separated by spaces).
Exit status: 0, 1, or 77 when there is nothing to boot.
"""

import errno
import fnmatch
import json
import os
import shutil
import signal
import subprocess
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "guest"))
sys.path.insert(0, str(HERE.parent))

import guest  # noqa: E402
import schemas  # noqa: E402
import usbmon_record  # noqa: E402
from kernel_package import Unavailable  # noqa: E402

BUILD = Path(os.environ["GYROLOG_BUILD_DIR"]).resolve()
WORK = Path(os.environ["GYROLOG_GUEST_DIR"]).resolve()
SHARE = WORK / "share"
PROGRAMS = [BUILD / name for name in ("gyrolog", "vhci_board", "gadget_board")]
# A port's firmware, native: there where its third-party sources are.
PORTS = ("lpcxpresso55s69", "lpc1769")
BUILT_PORTS = [port for port in PORTS if (BUILD / f"native_{port}_on_vhci").exists()]
PROGRAMS += [BUILD / f"native_{port}_on_vhci" for port in BUILT_PORTS]

OK, NO_DEVICE, DEVICE_LOST, DATA_LOST = 0, 3, 4, 5


class Scenario(unittest.TestCase):
    """One scenario's results. A test that needs what the scenario failed to leave shows the scenario's log."""

    name = ""

    def setUp(self):
        self.folder = SHARE / self.name
        self.assertTrue(self.folder.exists(), f"the guest did not come to {self.name}")

    def file(self, name):
        path = self.folder / name
        if not path.exists():
            log = self.folder / "log"
            self.fail(f"{self.name} left no {name}:\n{log.read_text(errors='replace') if log.exists() else ''}")
        return path

    def text(self, name):
        return self.file(name).read_text(errors="replace")

    def json(self, name):
        text = self.text(name)
        # What a board of the tests reports of itself is no document of the program's.
        return json.loads(text if name.startswith("board-") else schemas.keep(text, name))

    def assert_exit(self, command, expected):
        status = int(self.text(f"{command}.exit"))
        self.assertEqual(status, expected, self.text(f"{command}.err"))

    def assert_nothing_missing(self, capture):
        self.assert_exit(f"{capture}.check", OK)
        check = self.json(f"{capture}.check.out")
        self.assertEqual(check["end"], "clean")
        self.assertEqual(check["frames"]["missing"], 0)
        self.assertEqual(check["frames"]["corrupted"], 0)
        self.assertEqual(check["samples"]["missing"], 0)
        self.assert_bytes_balance(check)
        return check

    def assert_bytes_balance(self, check):
        total = check["bytes"]
        self.assertEqual(total["total"], total["in_frames"] + total["skipped"] + total["buffered"])

    def assert_every_sample_of(self, capture, board, session=-1):
        """The file holds exactly what the board says it produced between DTR on and DTR off."""
        check = self.assert_nothing_missing(capture)
        produced = self.json(f"board-{board}.json")["sessions"][session]
        self.assertEqual(produced["samples_lost"], 0)
        self.assertEqual(produced["frames_lost"], 0)
        self.assertEqual(check["samples"]["good"], produced["samples"])

    def assert_replays(self, capture, samples):
        """umockdev serves the file to the program here on the host, and the stream is the same to the bit."""
        if shutil.which("umockdev-run") is None:
            self.skipTest("needs umockdev-run")
        again = self.folder / "again.pcapng"
        again.unlink(missing_ok=True)
        replayed = subprocess.run(
            [HERE.parents[1] / "tools" / "umockdev_replay", self.file(capture), BUILD / "gyrolog", "capture",
             "--device", "usb:", "--rate", "1000", "--samples", str(samples), "-o", again],
            capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(replayed.returncode, OK, replayed.stderr[-2000:])
        ours, theirs = (b"".join(transfer.data for transfer in usbmon_record.from_pcapng(path.read_bytes()))
                        for path in (self.file(capture), again))
        self.assertGreater(len(theirs), 0.99 * len(ours))
        self.assertEqual(theirs, ours[:len(theirs)])

    def assert_lasts(self, capture, rate_hz, duration_s):
        """The clock of the sensor may be 1 % off, and the first and last frame are not sharp."""
        samples = self.json(f"{capture}.check.out")["samples"]["good"]
        self.assertAlmostEqual(samples, rate_hz * duration_s, delta=0.02 * rate_hz * duration_s + 0.5 * rate_hz)


class CaptureFromVhciBoard(Scenario):
    name = "10_capture_vhci"

    def test_the_board_is_listed_as_ready(self):
        self.assert_exit("list", OK)
        device = self.json("list.out")["devices"][0]
        self.assertEqual((device["uri"], device["serial"], device["state"]), ("usb:VHCI10", "VHCI10", "ready"))

    def test_a_capture_ends_well(self):
        self.assert_exit("capture", OK)

    def test_it_holds_every_sample_the_board_produced(self):
        self.assert_every_sample_of("capture", "VHCI10")
        self.assert_lasts("capture", 1000, 30)

    def test_it_holds_the_transfers_that_usbmon_saw(self):
        ours = usbmon_record.from_pcapng(self.file("capture.pcapng").read_bytes())
        kernels = usbmon_record.from_usbmon(self.file("usbmon.out").read_bytes())
        ours, kernels = ([transfer[:3] for transfer in record if transfer.data] for record in (ours, kernels))
        self.assertGreater(len(ours), 1000)
        self.assertEqual(ours, kernels)

    def test_cdc_acm_gets_its_terminal_back(self):
        self.assertEqual(self.text("ttyACM0.state").strip(), "back")

    def test_it_can_be_analysed(self):
        self.assert_exit("capture.analyze", OK)

    def test_umockdev_replays_it_to_the_program(self):
        self.assert_replays("capture.pcapng", 30000)

    def test_wireshark_opens_it(self):
        tshark = shutil.which("tshark")
        if tshark is None:
            self.skipTest("needs tshark")
        ours = list(usbmon_record.from_pcapng(self.file("capture.pcapng").read_bytes()))
        answer = subprocess.run(
            [tshark, "-r", self.file("capture.pcapng"), "-Y",
             "usb.transfer_type == 3 && usb.endpoint_address.direction == 1 && usb.urb_type == 'C'",
             "-T", "fields", "-e", "usb.data_len"], capture_output=True, text=True, check=False)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual([int(line) for line in answer.stdout.split()], [len(transfer.data) for transfer in ours])


class FastCapture(Scenario):
    name = "11_fast"

    def test_eight_thousand_samples_a_second_arrive_whole(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "VHCI11")
        self.assert_lasts("capture", 8000, 5)


class CaptureFromAcmGadget(Scenario):
    name = "20_capture_acm_gadget"

    def test_umockdev_replays_it_to_the_program(self):
        self.assert_replays("capture.pcapng", 30000)

    def test_a_capture_ends_well(self):
        self.assert_exit("capture", OK)

    def test_it_holds_every_sample_the_board_produced(self):
        self.assert_every_sample_of("capture", "GADGET20")
        self.assert_lasts("capture", 1000, 30)

    def test_cdc_acm_gets_its_terminal_back(self):
        self.assertEqual(self.text("ttyACM0.state").strip(), "back")


class UnplugVhciBoard(Scenario):
    name = "30_unplug_vhci"

    def test_the_exit_code_says_that_the_device_is_lost(self):
        self.assert_exit("capture", DEVICE_LOST)

    def test_what_came_before_is_a_clean_file(self):
        self.assertEqual(self.json("capture.check.out")["end"], "clean")
        self.assert_bytes_balance(self.json("capture.check.out"))
        self.assert_lasts("capture", 1000, 6)

    def test_it_can_be_analysed(self):
        self.assert_exit("capture.analyze", OK)


class UnplugAcmGadget(UnplugVhciBoard):
    name = "31_unplug_acm_gadget"

    def test_what_came_before_is_a_clean_file(self):
        check = self.json("capture.check.out")
        self.assertEqual(check["end"], "clean")
        self.assert_bytes_balance(check)
        self.assertGreater(check["samples"]["good"], 2000)


class ReplugVhciBoard(Scenario):
    name = "32_replug_vhci"

    def test_the_board_is_waited_for_and_taken_up_again(self):
        self.assert_exit("capture", DATA_LOST)
        self.assertIn("waiting for the board", self.text("capture.err"))
        self.assertIn("the board is back", self.text("capture.err"))

    def test_the_join_is_one_recording_with_a_pause_of_the_true_length(self):
        self.assert_exit("capture.check", DATA_LOST)
        check = self.json("capture.check.out")
        self.assertEqual(check["end"], "clean")
        self.assertEqual(len(check["files"]), 2)
        self.assertEqual([dropout["cause"] for dropout in check["dropouts"]], ["reset"])
        # Three seconds without a cable, and what the kernel and the program take to find the board again.
        self.assertGreater(check["dropouts"][0]["samples"], 3000)
        self.assertLess(check["dropouts"][0]["samples"], 8000)
        self.assert_bytes_balance(check)

    def test_it_can_be_analysed(self):
        self.assert_exit("capture.analyze", OK)


class FailingTransfers(Scenario):
    name = "40_faults"

    def test_stall_babble_and_checksum_error_cost_no_sample(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "VHCI40")

    def test_they_are_in_the_file_as_the_kernel_reported_them(self):
        ours = usbmon_record.from_pcapng(self.file("capture.pcapng").read_bytes())
        self.assertLessEqual({-32, -75, -71}, {transfer.status for transfer in ours})


class TerminalLine(Scenario):
    name = "50_cdc_acm_tty"

    def test_it_holds_every_sample_of_the_stream_that_it_started(self):
        """Opening a terminal raises DTR, and until it is made raw the kernel edits and echoes what comes: the board
        streams for a moment, and these first bytes are damaged. They precede the start and nothing is missed."""
        self.assert_exit("capture", OK)
        check = self.json("capture.check.out")
        self.assertEqual((check["end"], check["frames"]["missing"], check["samples"]["missing"]), ("clean", 0, 0))
        self.assert_bytes_balance(check)
        sessions = [session["samples"] for session in self.json("board-VHCI50.json")["sessions"]]
        self.assertGreaterEqual(check["samples"]["good"], sessions[-1])
        self.assertLessEqual(check["samples"]["good"], sum(sessions))
        self.assert_lasts("capture", 1000, 10)


class Interrupted(Scenario):
    name = "60_interrupt"

    def test_a_signal_closes_the_capture_and_says_that_it_was_cut_short(self):
        self.assert_exit("capture", 128 + signal.SIGTERM)
        self.assert_every_sample_of("capture", "VHCI60")

    def test_a_second_program_is_told_that_the_board_is_in_use(self):
        self.assert_exit("second", NO_DEVICE)
        self.assertNotEqual(self.text("second.err").strip(), "")

    def test_cdc_acm_gets_its_terminal_back(self):
        self.assertEqual(self.text("ttyACM0.state").strip(), "back")


class Killed(Scenario):
    name = "61_killed"

    def test_what_was_written_is_intact(self):
        check = self.json("killed.check.out")
        self.assertIn(check["end"], ("clean", "torn_tail"))
        self.assertEqual(check["samples"]["missing"], 0)
        self.assertGreater(check["samples"]["good"], 1500)

    def test_the_board_can_be_captured_again(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "VHCI61")


class ReaderStopped(Scenario):
    name = "70_reader_stopped"

    def test_two_seconds_without_the_reader_cost_no_sample(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "VHCI70")


class ReaderStoppedFast(Scenario):
    name = "71_reader_stopped_fast"

    def test_two_seconds_without_the_reader_cost_no_sample_at_8_kHz(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "VHCI71")


class SeveralBoards(Scenario):
    name = "80_several_boards"

    def test_each_is_listed(self):
        serials = {device["serial"] for device in self.json("list.out")["devices"]}
        self.assertEqual(serials, {"VHCI80", "VHCI81", "VHCI82"})

    def test_each_has_its_own_file_with_every_sample(self):
        self.assert_exit("capture", OK)
        for board in ("VHCI80", "VHCI81", "VHCI82"):
            self.assert_every_sample_of(f"night-{board}", board)
            self.assert_lasts(f"night-{board}", 8000, 8)


class SeveralKilled(Scenario):
    name = "81_several_killed"
    FLUSH_INTERVAL_S = 0.25
    PACE_S = 0.05  # of the scenario's loop
    THREADS_ON_THE_WAY = 3  # the one that takes the data from the kernel, the one that writes, and the one that kills

    def promised_s(self):
        """Writes take no time in memory; what a thread waits for the emulated processor, a loop beside it has seen."""
        ticks = [float(line.split()[0]) for line in self.text("pace.out").splitlines()]
        wait_s = max(after - before for before, after in zip(ticks, ticks[1:])) - self.PACE_S
        return self.FLUSH_INTERVAL_S + self.THREADS_ON_THE_WAY * wait_s

    def test_each_file_is_whole_up_to_what_a_kill_may_cost(self):
        bus = list(usbmon_record.from_usbmon(self.file("usbmon.out").read_bytes()))
        # The kernel takes back what the dead program had queued, request by request, and until it comes to a board's
        # last one data still arrive for nobody.
        killed_s = min(transfer.time_s for transfer in bus if transfer.status == -errno.ESHUTDOWN)
        arrived = {}
        for transfer in bus:
            if transfer.data and transfer.time_s <= killed_s:
                arrived.setdefault(transfer.device, []).append(transfer)
        devices = set()
        for board in ("VHCI83", "VHCI84", "VHCI85"):
            check = self.json(f"night-{board}.check.out")
            self.assertIn(check["end"], ("clean", "torn_tail"))
            self.assertEqual(check["samples"]["missing"], 0)
            self.assertGreater(check["samples"]["good"], 8000)
            stored = [transfer for transfer in
                      usbmon_record.from_pcapng(self.file(f"night-{board}.pcapng").read_bytes()) if transfer.data]
            device = stored[0].device
            devices.add(device)
            self.assertEqual([one.data for one in stored], [one.data for one in arrived[device][:len(stored)]])
            missing = arrived[device][len(stored):]
            missing_s = missing[-1].time_s - missing[0].time_s if missing else 0.0
            print(f"{board}: {len(missing)} of {len(arrived[device])} transfers missing, {1e3 * missing_s:.0f} ms of "
                  f"{1e3 * self.promised_s():.0f} ms")
            self.assertLessEqual(missing_s, self.promised_s())
        self.assertEqual(len(devices), 3)


class NoPermission(Scenario):
    name = "90_no_permission"

    def test_no_device_is_said_so(self):
        self.assert_exit("none", NO_DEVICE)

    def test_a_device_that_may_not_be_opened_is_said_so_with_the_mend(self):
        self.assert_exit("denied", NO_DEVICE)
        self.assertIn("gyrolog.rules", self.text("denied.err"))
        self.assertEqual(self.json("list.out")["devices"][0]["state"], "no_permission")


class NativeFirmware(Scenario):
    """The firmware of a port on the model of its part's USB controller, with the kernel for a host: each scenario is there
    once for each port."""

    scenario = port = ""

    def setUp(self):
        if self.port not in BUILT_PORTS:
            self.skipTest(f"needs the third-party sources of {self.port}: tools/firmware --fetch {self.port}")
        super().setUp()
        self.assert_exit("board-native", OK)  # else the part forbids what the driver did

    def assert_all_but_what_was_under_way(self, check, most=200):
        """In the last two streams, of which nobody took the first one's last frames while no token came."""
        sessions = self.json("board-native.json")["sessions"][-2:]
        self.assertEqual([session["samples_lost"] for session in sessions], [0, 0])
        self.assertGreater(min(session["samples"] for session in sessions), 0)
        produced = sum(session["samples"] for session in sessions)
        self.assertLessEqual(check["samples"]["good"], produced)
        self.assertGreater(check["samples"]["good"], produced - most)


class NativeCapture(NativeFirmware):
    scenario = "a0_native_capture"

    def test_the_kernel_enumerates_it_and_it_is_listed_as_ready(self):
        self.assert_exit("list", OK)
        device = self.json("list.out")["devices"][0]
        self.assertEqual((device["serial"], device["state"]), (self.json("board-native.json")["serial"], "ready"))

    def test_half_a_minute_holds_every_sample(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "native")
        self.assert_lasts("capture", 1000, 30)

    def test_cdc_acm_gets_its_terminal_back(self):
        self.assertEqual(self.text("terminal.state").strip(), "back")


class NativeFast(NativeFirmware):
    scenario = "a1_native_fast"

    def test_half_a_minute_at_8_kHz_holds_every_sample(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "native")
        self.assert_lasts("capture", 8000, 30)


class NativeConform(NativeFirmware):
    scenario = "a2_native_conform"

    def test_it_keeps_every_rule_over_usb(self):
        self.assertEqual(int(self.text("conform.exit")), OK, self.text("conform.out"))


class NativeReplug(NativeFirmware):
    scenario = "a3_native_replug"

    def test_the_board_is_waited_for_and_taken_up_again(self):
        self.assertIn("the board is back", self.text("capture.err"))
        check = self.json("capture.check.out")
        self.assertEqual((check["end"], len(check["files"]), check["boots"]), ("clean", 2, 1))
        self.assert_bytes_balance(check)

    def test_nothing_is_missing_but_what_was_under_way_and_the_pause_is_told(self):
        """Where the stream's last frames outlive the cable, the pause is a stop, and no sample is missing."""
        check = self.json("capture.check.out")
        self.assert_exit("capture", DATA_LOST if check["samples"]["missing"] + check["frames"]["missing"] else OK)
        self.assertGreater(sum(stop["s"] for stop in check["stops"]) + 1e-3 * check["samples"]["missing"], 1.5)
        self.assert_all_but_what_was_under_way(check)


class NativeReaderStopped(NativeFirmware):
    scenario = "a4_native_reader_stopped"

    def test_two_seconds_without_the_reader_cost_no_sample(self):
        self.assert_exit("capture", OK)
        self.assert_every_sample_of("capture", "native")
        self.assert_lasts("capture", 1000, 5)


class NativeSuspend(NativeFirmware):
    scenario = "a5_native_suspend"

    def test_a_bus_that_idles_is_a_stop_in_one_recording_and_costs_no_sample(self):
        self.assert_exit("capture", OK)
        check = self.assert_nothing_missing("capture")
        self.assertEqual([round(stop["s"]) for stop in check["stops"]], [1])
        self.assert_all_but_what_was_under_way(check)


class NativeReset(NativeFirmware):
    """The kernel does not hear of the reset, and the board takes it for a falling DTR: only opening it again helps."""

    scenario = "a6_native_reset"

    def test_the_silent_board_is_opened_again_and_what_is_missing_is_told(self):
        self.assert_exit("capture", DATA_LOST)
        self.assertIn("the board is back", self.text("capture.err"))
        check = self.json("capture.check.out")
        self.assertEqual((check["end"], len(check["files"]), check["boots"], check["runs"]), ("clean", 2, 1, 2))
        self.assertLessEqual(check["frames"]["corrupted"], 1)  # the one that the reset cut
        self.assertEqual([dropout["cause"] for dropout in check["dropouts"]][-1], "unplugged")
        self.assert_bytes_balance(check)
        self.assert_all_but_what_was_under_way(check, most=300)


def is_asked_for(scenario):
    return any(fnmatch.fnmatchcase(scenario, pattern) for pattern in os.environ.get("SCENARIOS", "*").split())


def scenario_files():
    """name: file of each scenario that is asked for; one of the native boards, once for each port that is built."""
    files = {}
    for path in sorted((HERE / "guest/scenarios").glob("*.sh")):
        names = [f"{path.stem}_{port}" for port in BUILT_PORTS] if "_native_" in path.stem else [path.stem]
        files |= {name: path for name in names if is_asked_for(name)}
    return files


def with_ports(scenario):
    """The class itself, or that of the native boards once for each port."""
    if not getattr(scenario, "scenario", ""):
        return [scenario]
    return [type(f"{scenario.__name__}_{port}", (scenario,), {"name": f"{scenario.scenario}_{port}", "port": port})
            for port in PORTS]


def load_tests(loader, _standard, _pattern):
    """unittest's protocol: tests of scenarios that nobody asked for are not there."""
    classes = [member for member in globals().values() if isinstance(member, type) and issubclass(member, Scenario)]
    return unittest.TestSuite(loader.loadTestsFromTestCase(one) for member in classes for one in with_ports(member)
                              if one.name and is_asked_for(one.name))


def answer(folder):
    """Carries out what a scenario asked of the program on the host; the answers lie beside the scenario's own results."""
    asked = folder / "asked"
    for line in asked.read_text().splitlines() if asked.exists() else []:
        command, capture = line.split()
        options = ["--json", "-"] if command == "check" else []
        done = subprocess.run([BUILD / "gyrolog", command, capture, *options], cwd=folder, capture_output=True, text=True,
                              timeout=120, check=False)
        name = f"{Path(capture).stem}.{command}"
        for suffix, text in (("out", done.stdout), ("err", done.stderr), ("exit", f"{done.returncode}\n")):
            (folder / f"{name}.{suffix}").write_text(text)


def main():
    try:
        status = guest.run(PROGRAMS, WORK, HERE / "guest" / "run_scenarios.sh", timeout_s=1800, scenarios=scenario_files())
    except Unavailable as reason:
        print(f"skipped: needs a kernel to boot: {reason}", file=sys.stderr)
        return 77
    log = SHARE / "script.log"
    print(log.read_text(errors="replace") if log.exists() else "the guest never reached the scenarios", flush=True)
    for folder in sorted(SHARE.iterdir()):
        if folder.is_dir():
            answer(folder)
    result = unittest.main(exit=False, verbosity=2).result
    return 0 if status == 0 and result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
