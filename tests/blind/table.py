#!/usr/bin/env python3
"""A panel's table in one command: makes the panel, runs the program on it, then opens the truths.

It can be stopped and started again; DIR keeps what was answered. The table goes to DIR/table.md and DIR/table.json.

Usage: table.py PROGRAM DIR [--panel full|many|none] [--count N] [--none 200] [--minutes 120] [--motion-minutes 18]
                [--simulations 200] [--seed 1] [--jobs 2]
"""

import argparse
import os
import sys

import numbers_or_skip  # noqa: F401

import run
import score

COUNTS = {"full": 8, "many": 40, "none": 200}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("directory")
    parser.add_argument("--panel", default="full", choices=list(COUNTS))
    parser.add_argument("--count", type=int, help="cases of each effect and class (full: 8), or of all (40, 200)")
    parser.add_argument("--none", type=int, default=200, help="cases without a gap (full)")
    parser.add_argument("--minutes", type=float, default=120.0, help="of a recording at rest")
    parser.add_argument("--motion-minutes", type=float, default=18.0)
    parser.add_argument("--simulations", type=int, help="in place of the program's own number")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    directory = arguments.directory
    arguments.count = arguments.count or COUNTS[arguments.panel]
    sys.argv = ["run.py", arguments.program, directory]
    for name in ("panel", "count", "none", "minutes", "motion_minutes", "simulations", "seed", "jobs"):
        value = getattr(arguments, name)
        if value is not None:
            sys.argv += ["--" + name.replace("_", "-"), str(value)]
    run.main()
    sys.argv = ["score.py", directory, "--json", os.path.join(directory, "table.json"), "--markdown",
                os.path.join(directory, "table.md")]
    return score.main()


if __name__ == "__main__":
    sys.exit(main())
