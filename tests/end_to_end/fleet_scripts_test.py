#!/usr/bin/env python3
"""Runs tools/fleet on a handful of simulated recordings: over_hosts with GNU parallel, the Slurm scripts with a
stand-in for sbatch.

    fleet_scripts_test.py PROGRAM SOURCE_FOLDER
"""

import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from schemas import KeptFolder  # noqa: E402

MODEL = {"schema": "gyrolog-model/1", "rate_hz": 100, "axes": {axis: {"N": 0.01, "bias": 0.1} for axis in "xyz"}}

# Runs each task of an array at once; the first one is killed on its way and queued again.
SBATCH = """#!/bin/bash
array= script=
while [ $# -gt 0 ]; do
    case $1 in
        --array=1-*) array=${1#--array=1-} ;;
        --dependency=*) [ "$1" = --dependency=afterany:77 ] || exit 9 ;;
        --*) ;;
        *) break ;;
    esac
    shift
done
echo 77
if [ -z "$array" ]; then exec "$@" >&2; fi
for task in $(seq "$array"); do
    if [ "$task" = 1 ]; then : >"$2/lines/1.jsonl.part"; echo half >"$2/lines/1.jsonl.part"; fi
    SLURM_ARRAY_TASK_ID=$task "$@" >&2
done
"""


def run(*command, expect=0, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    assert done.returncode == expect, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done


def rows_of(table):
    with open(table, newline="") as file:
        return list(csv.DictReader(file))


def timeless(rows):
    return [{name: value for name, value in row.items() if "seconds" not in name} for row in rows]


def main():
    program, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    if shutil.which("parallel") is None:
        print("skipped: GNU parallel is not installed")
        sys.exit(77)
    with KeptFolder() as name:
        folder = pathlib.Path(name)
        environment = {**os.environ, "GYROLOG": str(program), "HOME": name}
        model = folder / "model.json"
        model.write_text(json.dumps(MODEL))

        def simulate(recording, seed):
            run(program, "simulate", model, "-o", recording, "--duration", "30s", "--seed", seed)

        recordings = [folder / f"unit {number}.csv" for number in range(1, 6)]
        for seed, recording in enumerate(recordings[:4], 1):
            simulate(recording, seed)
        listed = folder / "list.txt"
        listed.write_text("".join(f"{recording}\n" for recording in recordings))

        # One is not there; when it is, a second call does that one alone.
        out = folder / "out"
        over_hosts = [source / "tools/fleet/over_hosts", "-j", "2", out, listed, "analyze"]
        run(*over_hosts, expect=1, env=environment)
        rows = rows_of(out / "table.csv")
        assert len(rows) == 4 * 3 + 1, rows
        failed, = [row for row in rows if row["error"]]
        assert failed["file"] == str(recordings[4]) and failed["exit"] == "1", failed
        with open(out / "lines.jsonl", "a") as lines:
            lines.write('{"file": "torn')
        simulate(recordings[4], 5)
        run(*over_hosts, env=environment)
        rows = rows_of(out / "table.csv")
        assert len(rows) == 5 * 3 and not any(row["error"] for row in rows), rows
        lines = (out / "lines.jsonl").read_text().splitlines()
        assert len(lines) == 6, f"{len(lines)} lines: five answers and one error, and nothing done twice"

        compared = folder / "compared"
        run(source / "tools/fleet/over_hosts", compared, listed, "compare", "{}", model, "--simulations", "12",
            env=environment)
        assert all(row["comparison"] for row in rows_of(compared / "table.csv"))

        stand_in = folder / "bin"
        stand_in.mkdir()
        (stand_in / "sbatch").write_text(SBATCH)
        (stand_in / "sbatch").chmod(0o755)
        environment["PATH"] = f"{stand_in}:{environment['PATH']}"
        recordings[1].unlink()
        slurm = folder / "slurm"
        run(source / "tools/fleet/slurm_submit", slurm, listed, 2, "analyze", env=environment)
        assert sorted(path.name for path in (slurm / "lines").glob("*.jsonl*")) == ["1.jsonl", "2.jsonl", "3.jsonl"]
        rows = rows_of(slurm / "table.csv")
        assert len(rows) == 4 * 3 + 1, rows
        assert [row["file"] for row in rows if row["error"]] == [str(recordings[1])], rows
        assert len((slurm / "lines.jsonl").read_text().splitlines()) == 5

        # A task whose lines are lost: a second call does that one, and the table holds all.
        (slurm / "lines/3.jsonl").unlink()
        run(source / "tools/fleet/slurm_collect", slurm, env=environment)
        lost, = [row for row in rows_of(slurm / "table.csv") if row["error"] == "no answer"]
        assert lost["file"] == str(recordings[4]), lost
        run(source / "tools/fleet/slurm_submit", slurm, listed, 2, "analyze", env=environment)
        assert len(rows_of(slurm / "table.csv")) == 4 * 3 + 1

        # Tasks that something else starts: it says which one each is. The answers are those of the array.
        other = folder / "other"
        printed = run(source / "tools/fleet/prepare", other, listed, 2, "analyze", env=environment).stdout
        assert printed == "3\n", printed
        for task in (3, 1, 2, 2):
            run(source / "tools/fleet/slurm_task", other, 2, task, env=environment)
        run(source / "tools/fleet/slurm_collect", other, env=environment)
        assert timeless(rows_of(other / "table.csv")) == timeless(rows_of(slurm / "table.csv"))
        run(source / "tools/fleet/slurm_task", other, 2, expect=2, env=environment)

        # The command in each container or slot.
        job = (source / "tools/fleet/kubernetes_job.yaml").read_text()
        command = re.search(r'command: \[sh, -c, "exec (.*)"\]', job).group(1)
        command = command.replace("/fleet/", f"{source}/tools/fleet/").replace("/shared/out 20", f"'{other}' 2")
        (other / "lines/2.jsonl").unlink()
        run("sh", "-c", f"exec {command}", env={**environment, "JOB_COMPLETION_INDEX": "1"})
        assert (other / "lines/2.jsonl").exists()

        cost = run(source / "tools/fleet/cost", recordings[0], "analyze", env=environment).stdout
        assert re.fullmatch(r"analyze +[0-9.]+ s +[0-9.]+ s CPU +[0-9]+ MB\n", cost), cost
        run(source / "tools/fleet/cost", recordings[0], "compare", "{}", model, "--simulations", "12", env=environment)
        run(source / "tools/fleet/cost", "absent.csv", "analyze", expect=1, env=environment)
    print("tools/fleet: as it says")


if __name__ == "__main__":
    main()
