#!/usr/bin/env python3
"""What the diagnosis finds in real recordings: a model fitted to one part or a sister, another diagnosed with it.

Usage: recordings.py PROGRAM DATA [--simulations N]    DATA: the folder with mpu6050_uncuyo, mpu6050_frdm, ...
"""

import argparse
import csv
import json
import lzma
import os
import subprocess
import sys
import tempfile

LSB = ["--lsb-dps", repr(1.0 / 131.0)]
BENCH = "px4_auav_bench/sample.csv.xz"
SLOW = "broad_ref_motion/05_undisturbed_slow_rotation_with_breaks_B.csv.xz"
PHONE = "broad_ref_motion/26_disturbed_phone_vibration_A.csv.xz"
# What is fitted and from where to where in seconds, what is diagnosed, options.
CASES = [
    (("mpu6050_uncuyo/static_100s.csv.xz", None), ("mpu6050_uncuyo/static_7min.csv.xz", None), LSB),
    (("mpu6050_uncuyo/static_7min.csv.xz", (0, 220)), ("mpu6050_uncuyo/static_7min.csv.xz", (220, 1e9)), LSB),
    (("mpu6050_uncuyo/static_7min.csv.xz", None), ("mpu6050_uncuyo/multipose.csv.xz", None), LSB),
    (("mpu6050_frdm/static_xup.csv.xz", None), ("mpu6050_frdm/static_11min.csv.xz", None), []),
    (("mpu6050_frdm/static_11min.csv.xz", (0, 330)), ("mpu6050_frdm/static_11min.csv.xz", (330, 1e9)), []),
    ((BENCH, (12, 40)), (BENCH, (40, 1e9)), []),
    ((SLOW, (0, 25)), (SLOW, None), []),
    ((SLOW, (0, 25)), (PHONE, None), []),
]


def part_of(path, span, folder):
    """The rows of a span of time, as a file of its own."""
    if span is None:
        return path
    name = os.path.join(folder, f"{os.path.basename(path).split('.')[0]}_{span[0]:g}.csv")
    with lzma.open(path, "rt", newline="") as source, open(name, "w", newline="") as target:
        rows = csv.reader(source)
        writer = csv.writer(target)
        writer.writerow(next(rows))
        writer.writerows(row for row in rows if span[0] <= float(row[0]) < span[1])
    return name


def described(recording):
    path, span = recording
    name = os.path.basename(path).split(".")[0]
    return name if span is None else f"{name} {span[0]:g} s to " + ("its end" if span[1] > 1e6 else f"{span[1]:g} s")


def place(where):
    parts = ["".join(where.get("axes", []))]
    for key, unit in (("freq_hz", "Hz"), ("tau_s", "s averaged"), ("time_s", "s"), ("rate_dps", "deg/s")):
        if key in where:
            low, high = where[key]
            parts.append(f"{low:.4g} {unit}" if f"{low:.4g}" == f"{high:.4g}" else f"{low:.4g} to {high:.4g} {unit}")
    if "structure" in where:
        parts.append(where["structure"].replace("_", " "))
    return " ".join(parts)


def cause(one):
    axes = one.get("params_by_axis") or {"".join(one["axes"]): one["params"]}
    text = []
    for axis, params in axes.items():
        text.append(axis + " " + ", ".join(f"{key} {value:.4g}" for key, value in params.items() if key != "phase_rad"))
    return f"{one['effect']} ({'; '.join(text)}; {one['evidence_nats']:.0f} nats)"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("data")
    parser.add_argument("--simulations", type=int, default=200)
    arguments = parser.parse_args()
    if not os.path.isdir(arguments.data):
        sys.exit(f"{arguments.data} is not there")
    print("| recording | model from | verdict | causes | left |\n| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        model = os.path.join(folder, "model.json")
        answer = os.path.join(folder, "answer.json")
        for fitted, judged, options in CASES:
            calibration, recording = (part_of(os.path.join(arguments.data, path), span, folder)
                                      for path, span in (fitted, judged))
            for command in (["analyze", calibration, "--model", model],
                            ["diagnose", recording, "--model", model, "--json", answer, "--simulations",
                             str(arguments.simulations)]):
                done = subprocess.run([arguments.program] + command + options, capture_output=True, text=True)
                if done.returncode != 0 and "without a reference" not in done.stderr:
                    sys.exit(f"{' '.join(command)}: exit {done.returncode}\n{done.stderr}")
            if done.returncode != 0:
                print(f"| {described(judged)} | {described(fitted)} | refused | none | turned, without a reference |",
                      flush=True)
                continue
            with open(answer) as file:
                found = json.load(file)
            causes = "; ".join(cause(one) for one in found["causes"]) or "none"
            print(f"| {described(judged)} | {described(fitted)} | {found['verdict']} | {causes} | "
                  f"{place(found['left'][0]['where'] if found.get('left') else {})} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
