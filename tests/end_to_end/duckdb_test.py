#!/usr/bin/env python3
"""Reads the lines of many recordings with DuckDB, as a user would, and asks for the same numbers as `gyrolog table`
writes to CSV and to SQLite.

    duckdb_test.py GYROLOG FOLDER     DuckDB is installed in FOLDER, which is made

Skipped where npm or its registry is out of reach.
"""

import csv
import json
import pathlib
import sqlite3
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from npm_package import installed  # noqa: E402
from schemas import KeptFolder  # noqa: E402

PACKAGE, VERSION = "@duckdb/node-api", "1.4.4-r.1"
ROWS = pathlib.Path(__file__).resolve().with_name("duckdb_rows.mjs")
RECORDINGS = 4
# DuckDB's way to a column of the table, from a line and from `a`, its axis.
WAYS = {"rate_hz": "recording.rate_hz", "duration_s": "recording.duration_s", "samples": "recording.samples",
        "temperature_C": "recording.temperature_C", "bias": "a.bias.value", "N": "a.coefficients.N.value",
        "N_sd": "a.coefficients.N.sd", "seconds": "seconds"}


def run(*command, expect=0):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    assert done.returncode == expect, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def made_lines(program, folder):
    """Of a few simulated units and of a file that is not there."""
    paths = []
    for seed in range(1, RECORDINGS + 1):
        model = {"schema": "gyrolog-model/1", "rate_hz": 100,
                 "axes": {axis: {"N": 0.01 + 0.001 * seed, "bias": 0.1 * seed} for axis in "xyz"}}
        (folder / "model.json").write_text(json.dumps(model))
        paths.append(folder / f"unit {seed}.csv")
        run(program, "simulate", folder / "model.json", "-o", paths[-1], "--duration", "20s", "--seed", seed)
    lines = folder / "lines.jsonl"
    run(program, "analyze", *paths, folder / "none.csv", "--jsonl", lines, expect=1)
    return lines


def asked_of_duckdb(package, lines):
    """By file and axis: the columns of WAYS; the file without an answer has the axis None, and its error."""
    chosen = ", ".join(f"{way} as {name}" for name, way in WAYS.items())
    axes = " union all ".join(f"select *, '{axis}' as axis, axes.{axis} as a from lines where axes is not null"
                              for axis in "xyz")
    sql = (f"with lines as (select * from read_json_auto('{lines}')) "
           f"select file, axis, exit, error, {chosen} from ({axes} "
           "union all select *, null as axis, null as a from lines where axes is null)")
    return {(row["file"], row["axis"]): row for row in json.loads(run("node", ROWS, package, sql))}


def as_number(text):
    return float(text) if text not in ("", None) else None


def agree(rows, answers, of):
    assert len(rows) == len(answers) == 3 * RECORDINGS + 1, (len(rows), len(answers))
    for row in rows:
        answer = answers[row["file"], row["axis"] or None]
        assert (row["error"] or None) == answer["error"], (of, row, answer)
        for name in ("exit", *WAYS):
            told = answer[name] if name != "exit" else answer[name] or 0
            assert as_number(row[name]) == as_number(told), (of, row["file"], row["axis"], name, row[name], told)


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    package = installed(folder, PACKAGE, VERSION)
    with KeptFolder() as name:
        made = pathlib.Path(name)
        lines = made_lines(program, made)
        answers = asked_of_duckdb(package, lines)
        run(program, "table", lines, "-o", made / "fleet.csv")
        with open(made / "fleet.csv", newline="") as file:
            agree(list(csv.DictReader(file)), answers, "CSV")
        run(program, "table", lines, "-o", made / "fleet.sqlite")
        with sqlite3.connect(made / "fleet.sqlite") as base:
            base.row_factory = sqlite3.Row
            table, = [row[0] for row in base.execute("select name from sqlite_master where type = 'table'")]
            agree([dict(row) for row in base.execute(f"select * from {table}")], answers, "SQLite")
        numbers = [row for row in answers.values() if row["axis"] is not None]
        assert all(isinstance(row["N"], float) and row["N"] > 0 for row in numbers), "DuckDB read no numbers"
    print(f"DuckDB, CSV and SQLite agree on {len(answers)} rows and {len(WAYS)} columns")


if __name__ == "__main__":
    main()
