#!/usr/bin/env python3
"""Boots Debian's stock kernel in QEMU and runs one shell script in it.

Used by usb_kernel_test.py, and by hand:
    guest.py --work FOLDER --script FILE [--timeout S] [PROGRAM...]
Results come back in FOLDER/share: what the script left there, its output (script.log) and its exit status (status);
FOLDER/console.log holds the kernel's messages.
"""

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

import initramfs
import kernel_package
from kernel_package import Unavailable, tool

HERE = Path(__file__).resolve().parent


def boot(work, kernel, archive, share, timeout_s):
    """Runs the guest until it powers off. The processor is emulated: the tests must run where no other way exists, and
    hardware acceleration inside a virtual machine is not to be relied on. Its clock counts instructions, 2 ns each, and
    leaps where it is idle: a busy host costs the guest no data."""
    command = [
        tool("qemu-system-x86_64"), "-accel", "tcg,thread=single", "-icount", "shift=1,sleep=off", "-rtc", "clock=vm",
        "-m", "1024", "-nodefaults", "-display", "none", "-serial", "stdio", "-no-reboot",
        "-kernel", kernel.image, "-initrd", archive,
        "-append", "console=ttyS0 quiet panic=-1 mitigations=off",
        "-virtfs", f"local,path={share},mount_tag=share,security_model=none,id=share",
    ]
    with open(work / "console.log", "wb") as console:
        try:
            subprocess.run(command, stdin=subprocess.DEVNULL, stdout=console, stderr=subprocess.STDOUT,
                           timeout=timeout_s, check=False)
        except subprocess.TimeoutExpired:
            with open(share / "script.log", "a", encoding="utf-8") as log:
                log.write(f"\nguest stopped after {timeout_s} s\n")


def run(programs, work, script, timeout_s, scenarios=None):
    """Boots a guest with `programs` in /bin and `scenarios` (a name: its file) in /test/scenarios, runs `script` and
    returns its exit status; None when the guest did not come to its end. Raises Unavailable when there is nothing to
    boot."""
    tool("qemu-system-x86_64")
    kernel = kernel_package.obtain(work / "kernel")
    share = work / "share"
    shutil.rmtree(share, ignore_errors=True)
    share.mkdir(parents=True)
    files = {"/test/script.sh": script}
    files |= {f"/test/{path.name}": path for path in HERE.glob("*.sh")}
    files |= {f"/test/scenarios/{name}.sh": path for name, path in (scenarios or {}).items()}
    initramfs.write(work / "initramfs.cpio", kernel, HERE / "init", programs, files)
    boot(work, kernel, work / "initramfs.cpio", share, timeout_s)
    status = share / "status"
    return int(status.read_text()) if status.exists() else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=Path, required=True, help="folder for the kernel, the archive and the results")
    parser.add_argument("--script", type=Path, required=True, help="shell script to run in the guest")
    parser.add_argument("--timeout", type=float, default=300, help="seconds")
    parser.add_argument("programs", type=Path, nargs="*", metavar="PROGRAM", help="goes to /bin with its libraries")
    arguments = parser.parse_args()
    try:
        status = run(arguments.programs, arguments.work.resolve(), arguments.script.resolve(), arguments.timeout)
    except Unavailable as reason:
        print(f"skipped: {reason}", file=sys.stderr)
        return 77
    log = arguments.work / "share" / "script.log"
    print(log.read_text(encoding="utf-8", errors="replace") if log.exists() else "the guest never reached the script")
    return 1 if status is None else status


if __name__ == "__main__":
    sys.exit(main())
