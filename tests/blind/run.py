#!/usr/bin/env python3
"""Makes a panel, has the program diagnose every case, and keeps its answers. It does not look at the truths.

DIR/cases/ID        recording and model (the recordings of a panel made here are removed after use without --keep)
DIR/sealed/ID.json  the truth
DIR/answers/ID.json, ID.model.json, ID.log   what the program said
DIR/answers/of.txt  of which panel and program, to take up a run that was stopped
DIR/run.json        the panel's options, the program's version, seconds for each case

Usage: run.py PROGRAM DIR [--existing] [--jobs N] [--keep] [options of generate.py]
"""

import argparse
import hashlib
import json
import multiprocessing
import os
import subprocess
import sys
import time

import numbers_or_skip  # noqa: F401
from generate import panel_arguments, panel_from, write_case

LIMIT_S = 1800


def diagnose(program, options, directory, case_id):
    """Seconds, and the exit code or what stopped it."""
    case = os.path.join(directory, "cases", case_id)
    answer = os.path.join(directory, "answers", case_id)
    command = [program, "diagnose", os.path.join(case, "recording.csv"), "--model", os.path.join(case, "model.json"),
               "--json", answer + ".json", "--model-out", answer + ".model.json", "--seed", "1"] + options
    begin = time.monotonic()
    with open(answer + ".log", "wb") as log:
        try:
            code = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, timeout=LIMIT_S).returncode
        except subprocess.TimeoutExpired:
            code = "timeout"
    return round(time.monotonic() - begin, 2), code


def one(work):
    program, options, directory, case_id, case_spec, keep = work
    done = os.path.join(directory, "answers", case_id + ".done")
    if os.path.exists(done):
        with open(done) as file:
            return case_id, json.load(file)
    if case_spec is not None:
        write_case(case_id, case_spec, directory, os.path.join(directory, "sealed"))
    seconds, code = diagnose(program, options, directory, case_id)
    if case_spec is not None and not keep:
        os.remove(os.path.join(directory, "cases", case_id, "recording.csv"))
    outcome = {"seconds": seconds, "code": code}
    with open(done, "w") as file:
        json.dump(outcome, file)
    return case_id, outcome


def output_of(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=60).stdout
    except (OSError, subprocess.TimeoutExpired):
        return ""


def keep_to(program, directory, about):
    """What is there already is taken up only if it is of the same, by this very program."""
    with open(program, "rb") as file:
        same = json.dumps({**about, "program": hashlib.sha256(file.read()).hexdigest()}, sort_keys=True)
    os.makedirs(directory, exist_ok=True)
    mark = os.path.join(directory, "of.txt")
    if os.path.exists(mark):
        with open(mark) as file:
            if file.read() != same:
                sys.exit(f"{directory} holds what is of another panel or of another program: remove it first")
    with open(mark, "w") as file:
        file.write(same)


def run(program, directory, cases, jobs, keep, about, simulations=None):
    """cases: ID to specification, or to None for one that is there."""
    about = {**about, "simulations": simulations}
    answers = os.path.join(directory, "answers")
    keep_to(program, answers, about)
    options = ["--simulations", str(simulations)] if simulations else []
    options += ["--threads", "1"] if "--threads" in output_of([program, "diagnose", "--help"]) else []
    work = [(program, options, directory, case_id, case_spec, keep) for case_id, case_spec in cases.items()]
    outcomes = {}
    with multiprocessing.Pool(jobs) as pool:
        for number, (case_id, outcome) in enumerate(pool.imap_unordered(one, work), 1):
            outcomes[case_id] = outcome
            print(f"\r{number}/{len(work)}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    about = {**about, "program": output_of([program, "--version"]).strip(), "date": time.strftime("%Y-%m-%d"),
             "outcomes": dict(sorted(outcomes.items()))}
    with open(os.path.join(directory, "run.json"), "w") as file:
        json.dump(about, file, indent=1)
    return outcomes


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("directory")
    parser.add_argument("--existing", action="store_true", help="take the cases that are in DIR/cases")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", action="store_true", help="keep the recordings")
    parser.add_argument("--simulations", type=int, help="in place of the program's own number")
    panel_arguments(parser)
    arguments = parser.parse_args()
    if arguments.existing:
        cases = {name: None for name in sorted(os.listdir(os.path.join(arguments.directory, "cases")))}
        about = {"panel": "existing"}
    else:
        cases = panel_from(arguments)
        about = {"panel": arguments.panel, "seed": arguments.seed, "count": arguments.count, "none": arguments.none,
                 "minutes": arguments.minutes, "motion_minutes": arguments.motion_minutes,
                 "effect": arguments.effect, "class": arguments.classes}
    run(os.path.abspath(arguments.program), arguments.directory, cases, arguments.jobs, arguments.keep, about,
        arguments.simulations)
    return 0


if __name__ == "__main__":
    sys.exit(main())
