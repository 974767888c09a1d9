#!/usr/bin/env python3
"""Tells what a program was built without, of what makes a bug in it harder to use.

    hardening_test.py PROGRAM
    hardening_test.py --self-test COMPILER    programs that lack one thing each are found out

Exit code 0: nothing is missing; 1: what is missing on standard output.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile


def missing_from(program):
    read = subprocess.run(["readelf", "--wide", "--file-header", "--segments", "--dynamic", "--dyn-syms", program],
                          capture_output=True, text=True, check=True, env={**os.environ, "LC_ALL": "C"}).stdout
    stack = re.search(r"^ +GNU_STACK .* (\S+) +\S+$", read, re.MULTILINE)
    has = {
        "position independent": re.search(r"^ +Type: +DYN", read, re.MULTILINE)
        and re.search(r"\(FLAGS_1\).*\bPIE\b", read),
        "GNU_RELRO": re.search(r"^ +GNU_RELRO ", read, re.MULTILINE),
        "all symbols bound at the start": re.search(r"\(BIND_NOW\)|\(FLAGS\).*\bBIND_NOW\b|\(FLAGS_1\).*\bNOW\b", read),
        "stack protector": re.search(r" UND __stack_chk_fail\b", read),
        "fortified functions": re.search(r" UND __(?!stack)\w+_chk\b", read),
        "no RPATH or RUNPATH": not re.search(r"\((RPATH|RUNPATH)\)", read),
        "stack without code": stack and "E" not in stack.group(1),
    }
    return [name for name, there in has.items() if not there]


SOURCE = """
#include <stdio.h>
#include <string.h>
int main(int argc, char** argv) {
    char name[16];
    strcpy(name, argv[argc - 1]);
    return puts(name);
}
"""
HARDENED = ["-O1", "-fPIE", "-pie", "-fstack-protector-strong", "-U_FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=2",
            "-Wl,-z,relro,-z,now,-z,noexecstack"]
LACKING = {
    "position independent": ["-fno-pie", "-no-pie"],
    "GNU_RELRO": ["-Wl,-z,norelro"],
    "all symbols bound at the start": ["-Wl,-z,lazy"],
    "stack protector": ["-fno-stack-protector"],
    "fortified functions": ["-U_FORTIFY_SOURCE"],
    "no RPATH or RUNPATH": ["-Wl,--enable-new-dtags,-rpath,/opt/lib"],
    "stack without code": ["-Wl,-z,execstack"],
}


def self_test(compiler):
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder, "main.c")
        source.write_text(SOURCE)
        program = str(pathlib.Path(folder, "main"))

        def built_with(flags):
            subprocess.run([compiler, *HARDENED, *flags, "-o", program, str(source)], check=True, capture_output=True)
            return missing_from(program)

        assert not built_with([]), built_with([])
        for lacking, flags in LACKING.items():
            assert built_with(flags) == [lacking], (flags, missing_from(program))
        old_path = ["-Wl,--disable-new-dtags,-rpath,/opt/lib"]
        assert built_with(old_path) == ["no RPATH or RUNPATH"], missing_from(program)


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--self-test":
        self_test(sys.argv[2])
        return
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    missing = missing_from(sys.argv[1])
    for name in missing:
        print(f"{sys.argv[1]}: missing: {name}")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
