#!/usr/bin/env python3
"""The small fixed panel, made, run and scored: fails when the diagnosis is broken, not by chance.

Each bound is where a diagnosis that is just good enough would fail once in a thousand panels.

Usage: panel_test.py PROGRAM [--seed N] [--jobs N]
"""

import argparse
import math
import os
import sys
import tempfile

import numbers_or_skip  # noqa: F401

import run
import score
from generate import panel

RISK = 1e-3
SIMULATIONS = 60


def least(of, share):
    """The largest number that so many tries of the given probability fall short of with less than RISK."""
    tail = 0.0
    for hits in range(of + 1):
        tail += math.comb(of, hits) * share**hits * (1.0 - share) ** (of - hits)
        if tail >= RISK:
            return hits
    return of


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as directory:
        cases = panel("small", None, arguments.seed, None, None)
        run.run(os.path.abspath(arguments.program), directory, cases, arguments.jobs, False, {"panel": "small"},
                SIMULATIONS)
        rows, figures = score.score(directory)
    print(score.as_text("Cases", ["id", "truth", "answer", "", "shrink"], [score.describe_case(r) for r in rows]))
    for table in score.tables(figures)[:2]:
        print(score.as_text(*table))
    failed = [f"{r['id']}: {'; '.join(r['problems'])}" for r in figures["invalid"]]

    def check(what, hits, of, share):
        bound = least(of, share)
        print(f"{what}: {hits} of {of}, at least {bound}")
        if hits < bound:
            failed.append(what)

    strong = [figures["by_class"][c] for c in ("moderate", "clear")]
    check("named", sum(c["named"]["hits"] for c in strong), sum(c["named"]["of"] for c in strong),
          score.TARGETS["named"]["moderate"])
    check("detected", sum(c["detected"]["hits"] for c in strong), sum(c["detected"]["of"] for c in strong),
          score.TARGETS["detected"]["moderate"])
    check("place", figures["place_fair"]["hits"], figures["place_fair"]["of"], score.TARGETS["place"])
    silent = figures["false_alarms"]
    check("silent where nothing is", silent["of"] - silent["hits"], silent["of"],
          1.0 - score.TARGETS["false_alarms_most"])
    wrong = figures["foreign_misnamed"]
    check("foreign not misnamed", wrong["of"] - wrong["hits"], wrong["of"],
          1.0 - score.TARGETS["foreign_misnamed_most"])
    pairs = figures["pairs"]["one"]
    check("one of two", pairs["hits"], pairs["of"], score.TARGETS["pairs"])
    if figures["shrink"]["of"] and figures["shrink"]["error"] > 3.0 * score.TARGETS["shrink_error_most"]:
        failed.append(f"shrink: mean error {figures['shrink']['error']:.3f}")
    for what in failed:
        print("failed:", what)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
