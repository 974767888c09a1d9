#!/usr/bin/env python3
"""Wireshark with what the package brings for it: boards in its list of interfaces, captured and dissected live, and
the dissector on a capture that is still being written. Exit 77: tshark is absent.

    wireshark_test.py PROGRAM SOURCE_FOLDER
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from schemas import KeptFolder  # noqa: E402

SOON_S = 60  # on a busy machine


# $1 and $2 are seen in the place of $3 and $4, by this command alone.
AS_INSTALLED = 'mount --bind "$1" "$3" && mount --bind "$2" "$4" && shift 4 && exec "$@"'


def folder_of(tshark, name):
    folders = subprocess.run([tshark, "-G", "folders"], capture_output=True, text=True).stdout
    return re.search(rf"^{name}:\s+(\S+)", folders, re.MULTILINE).group(1)


def tshark_as_installed(tshark, folder, program, source):
    """The words before tshark's options, and an environment, in which it finds the script and the dissector where the
    package puts them, and nothing that the user has. Wireshark's own folders are taken from the disk otherwise."""
    extcap, plugins, programs = folder / "extcap", folder / "plugins", folder / "bin"
    for made in (extcap, plugins, programs):
        made.mkdir()
    shutil.copy(source / "tools/wireshark_extcap", extcap / "gyrolog")
    shutil.copy(source / "tools/gyrolog.lua", plugins)
    (programs / "gyrolog").symlink_to(program)
    environment = {**os.environ, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder / "config"),
                   "XDG_DATA_HOME": str(folder / "data"), "PATH": f"{programs}:{os.environ['PATH']}", "LC_ALL": "C"}
    as_root = [] if os.geteuid() == 0 else ["--map-root-user"]
    wrapped = ["unshare", *as_root, "--mount", "sh", "-c", AS_INSTALLED, "sh", extcap, plugins,
               folder_of(tshark, "Extcap path"), folder_of(tshark, "Global Lua Plugins")]
    tried = subprocess.run([*wrapped, "true"], capture_output=True, text=True)
    if tried.returncode != 0:
        print(f"skipped: needs a mount namespace: {tried.stderr.strip()}")
        sys.exit(77)
    return [*wrapped, tshark], environment


def said_by(command, environment, **more):
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=SOON_S, **more)
    assert done.returncode == 0, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done


def fields_of(text):
    """Of each packet that has frames: {type: [...], ...}, from `-T fields -E separator=;`."""
    rows = []
    for line in text.splitlines():
        types, sequence, rate, sensor = line.split(";")
        rows.append({"types": types.split(","), "sequence": [int(one) for one in sequence.split(",")], "rate": rate,
                     "sensor": sensor})
    return rows


FIELDS = ["-Y", "gyrolog.type", "-T", "fields", "-E", "separator=;", "-e", "gyrolog.type", "-e", "gyrolog.sequence", "-e",
          "gyrolog.config.rate_mHz", "-e", "gyrolog.hello.sensor"]
HELLO, CONFIG, SAMPLES = "0x01", "0x02", "0x03"


def lists_interfaces(tshark, environment):
    listed = said_by([*tshark, "-D"], environment).stdout
    assert "gyrolog-sim (gyrolog simulated board)" in listed, listed
    types = said_by([*tshark, "-i", "gyrolog-sim", "-L"], environment)
    assert "USB_LINUX_MMAPPED" in types.stdout + types.stderr, types


def captures_live(tshark, environment):
    """A simulated board, with settings of the dialogue, through Wireshark's pipe."""
    began = time.monotonic()
    done = said_by([*tshark, "-l", "-i", "gyrolog-sim", "-o", "extcap.gyrolog_sim.rate:500", "-o",
                    "extcap.gyrolog_sim.sim:seed=3", "-a", "duration:3", *FIELDS], environment)
    rows = fields_of(done.stdout)
    types = [kind for row in rows for kind in row["types"]]
    assert HELLO in types and CONFIG in types and types.count(SAMPLES) > 20, (done.stdout[-2000:], done.stderr)
    assert "500000" in {row["rate"] for row in rows}, "the rate that was asked for is not the board's"
    assert any(row["sensor"] == "MPU-9250" for row in rows), rows
    assert "gyrolog extcap:" not in done.stderr, done.stderr
    print(f"live: {types.count(SAMPLES)} frames of samples in {time.monotonic() - began:.1f} s")


def running(word):
    """Whether a process has this word on its command line."""
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if word.encode() in (process / "cmdline").read_bytes():
                return True
        except OSError:
            pass  # gone meanwhile
    return False


def ends_with_its_reader(program, folder):
    """The capturing program leaves when the pipe's reader does, and when it is told to, without a word."""
    for how in ("reader", "signal"):
        pipe = folder / f"pipe of {how}"
        os.mkfifo(pipe)
        writer = subprocess.Popen([program, "extcap", "--capture", "--extcap-interface", "gyrolog-sim", "--fifo", pipe],
                                  stderr=subprocess.PIPE)
        with open(pipe, "rb") as reader:
            head = reader.read(4096)
            assert head[:4] == b"\x0a\x0d\x0d\x0a", head[:16]
            if how == "signal":
                writer.send_signal(signal.SIGTERM)
                rest = reader.read()
                assert rest, "what had waited did not come"
        said = writer.communicate(timeout=SOON_S)[1]
        assert writer.returncode == 0 and said == b"", (how, writer.returncode, said)
        assert not running(str(pipe))


def dissects_a_growing_file(tshark, program, environment, folder):
    capture = folder / "growing.pcapng"
    writer = subprocess.Popen([program, "capture", "--device", "sim:rate=200,realtime=1", "-o", capture], env=environment,
                              stderr=subprocess.DEVNULL)
    try:
        def last_sequence():
            rows = fields_of(said_by([*tshark, "-r", capture, *FIELDS], environment).stdout)
            return rows[-1]["sequence"][-1] if rows else -1

        seen = [-1]
        end = time.monotonic() + SOON_S
        while len(seen) < 4 and time.monotonic() < end:
            if capture.exists() and capture.stat().st_size > 4096:
                now = last_sequence()
                assert now >= seen[-1], "what was there is gone"
                if now > seen[-1]:
                    seen.append(now)
            time.sleep(0.2)
        assert len(seen) == 4 and writer.poll() is None, f"the file does not grow for tshark: {seen}"

        # As `tail -f capture | wireshark -k -i -` shows it, from the beginning on.
        tail = subprocess.Popen(["tail", "-c", "+1", "-f", capture], stdout=subprocess.PIPE)
        followed = said_by([*tshark, "-l", "-i", "-", "-a", "duration:3", *FIELDS], environment, stdin=tail.stdout)
        tail.kill()
        tail.wait()
        rows = fields_of(followed.stdout)
        sequence = [number for row in rows for number in row["sequence"]]
        assert rows[0]["types"][0] == HELLO and sequence[-1] > seen[-1], (seen, sequence[-5:])
    finally:
        writer.send_signal(signal.SIGINT)
        writer.wait(timeout=SOON_S)
    print(f"growing: frames up to {seen[1:]}, then followed up to {sequence[-1]}")


def main():
    program, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    tshark = shutil.which("tshark")
    if tshark is None or shutil.which("dumpcap") is None:
        print("skipped: needs tshark and dumpcap")
        sys.exit(77)
    with KeptFolder() as name:
        folder = pathlib.Path(name)
        tshark, environment = tshark_as_installed(tshark, folder, program, source)
        lists_interfaces(tshark, environment)
        captures_live(tshark, environment)
        ends_with_its_reader(program, folder)
        dissects_a_growing_file(tshark, program, environment, folder)


if __name__ == "__main__":
    main()
