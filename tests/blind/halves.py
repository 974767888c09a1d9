#!/usr/bin/env python3
"""How much of a real recording's gap does the diagnosis close on data that nothing was fitted to?

The first half of a recording at rest is diagnosed from a model with white noise and a bias only. The corrected model
then simulates recordings like the second half, and measures written apart from analysis/ tell how far those are from
the second half. The model that `analyze` fits to the first half is the rival.

The corrected model is taken twice: with the named causes alone, and with what was modelled without a name as well.

The measures, by family, for each axis: density in third-octave bands (dB), Allan deviation by octave (dB),
autocorrelation, tails, repeated samples, spread of the variance over time (dB), slow course (dB), and the correlation
between axes. A gap's square is the mean over the families that can see something of the mean over their measures of

    ((recording - mean of simulations)^2 - (1 + 1/n) variance of simulations) / unit^2

so that it is 0 on average for the true model. The unit is 1 dB, or 0.02 for a correlation or a share.

Usage: halves.py PROGRAM DATA OUT [--only NAME] [--simulations N]     DATA: the folder of real recordings
"""

import argparse
import csv
import io
import json
import lzma
import os
import subprocess
import sys

import numbers_or_skip  # noqa: F401
import numpy as np

# Folder/file, from which second, to which: parts at rest of a minute and more.
LSB_DPS = 1.0 / 131.0  # of those that have counts
RECORDINGS = [
    ("mpu6050_uncuyo/static_7min", 0.0, None),
    ("mpu6050_uncuyo/static_100s", 0.0, None),
    ("mpu6050_frdm/static_11min", 0.0, None),
    ("mpu6050_frdm/static_xup", 0.0, None),
    ("mpu6050_frdm/static_set1_xup", 0.0, None),
    ("px4_auav_bench/sample", 8.0, None),
]
CORRELATION_UNIT = 0.02
LAGS = 8
BLOCKS = 16


def halves_of(path, begin_s, end_s):
    """The header and the lines of both halves of the part."""
    with lzma.open(path, "rt") as file:
        header, *lines = file.read().splitlines()
    column = header.split(",").index("t_s")
    t_s = np.array([float(line.split(",")[column]) for line in lines])
    part = [line for line, t in zip(lines, t_s) if t - t_s[0] >= begin_s and (end_s is None or t - t_s[0] < end_s)]
    return header, part[: len(part) // 2], part[len(part) // 2 :]


def write_lines(path, header, lines):
    with open(path, "w") as file:
        file.write("\n".join([header, *lines, ""]))


def read_rates(path):
    """(rows, 3) in deg/s, as printed; the rate in Hz is that of all rows over the time."""
    with open(path) as file:
        text = [line for line in file if not line.startswith("#")]
    header = next(csv.reader(text[:1]))
    names = [next(n for n in header if n == f"g{a}" or n.startswith((f"g{a}_", f"g{a}1_"))) for a in "xyz"]
    table = np.loadtxt(io.StringIO("".join(text[1:])), delimiter=",", ndmin=2,
                       usecols=[header.index("t_s")] + [header.index(n) for n in names])
    to_dps = {"dps": 1.0, "rad_s": 180.0 / np.pi, "lsb": LSB_DPS}[names[0].split("_", 1)[1]]
    rate_hz = (len(table) - 1) / (table[-1, 0] - table[0, 0])
    return table[:, 1:] * to_dps, rate_hz


def allan_variance(x, m):
    total = np.concatenate([[0.0], np.cumsum(x - x.mean())])
    mean = (total[m:] - total[:-m]) / m
    difference = mean[m:] - mean[:-m]
    return 0.5 * np.mean(difference**2)


def db(x):
    return 10.0 * np.log10(np.maximum(x, 1e-30))


def density_db(x, rate_hz):
    """Third-octave bands with at least six bins of the periodogram under a Hann window."""
    window = np.hanning(len(x))
    power = np.abs(np.fft.rfft((x - x.mean()) * window)) ** 2 / (rate_hz * np.sum(window**2))
    f_hz = np.fft.rfftfreq(len(x), 1.0 / rate_hz)
    bands = np.floor(3.0 * np.log2(np.maximum(f_hz, 1e-12) / (0.5 * rate_hz)) + 1e-9).astype(int)
    bands[0] = bands[-1] = -10**6
    return {f"{band}": db(power[bands == band].mean()) for band in np.unique(bands[1:-1])
            if np.count_nonzero(bands == band) >= 6}


def measures(rates_dps, rate_hz):
    """{family: {name: number in its unit}}"""
    families = {name: {} for name in ("density", "allan", "autocorrelation", "tails", "repeats", "level", "course",
                                      "between_axes")}
    for axis, x in zip("xyz", rates_dps.T):
        families["density"].update({axis + k: v for k, v in density_db(x, rate_hz).items()})
        m = 1
        while 8 * m <= len(x):
            families["allan"][f"{axis}{m}"] = db(allan_variance(x, m))
            m *= 2
        y = x - x.mean()
        for lag in range(1, LAGS + 1):
            r = np.mean(y[lag:] * y[:-lag]) / np.mean(y * y)
            families["autocorrelation"][f"{axis}{lag}"] = r / CORRELATION_UNIT
        step = np.diff(x)
        sigma = 1.4826 * np.median(np.abs(step - np.median(step))) + 1e-12
        for limit in (2.0, 3.0, 4.0, 5.0):
            beyond = np.mean(np.abs(step) > limit * sigma)
            families["tails"][f"{axis}{limit:.0f}"] = db(beyond + 10.0 / len(x))
        families["repeats"][axis] = np.mean(step == 0.0) / CORRELATION_UNIT
        blocks = np.array_split(x, BLOCKS)
        variances = np.array([np.var(np.diff(b)) for b in blocks])
        families["level"][axis] = np.std(db(variances + 1e-30))
        families["course"][axis] = db(np.var([b.mean() for b in blocks]))
    for a, b in ((0, 1), (0, 2), (1, 2)):
        families["between_axes"][f"{a}{b}"] = np.corrcoef(rates_dps[:, a], rates_dps[:, b])[0, 1] / CORRELATION_UNIT
    return families


def gap_squares(recording, simulations):
    """{family: the gap's square}"""
    n = len(simulations)
    squares = {}
    for family, of_recording in recording.items():
        terms = []
        for name, value in of_recording.items():
            simulated = np.array([s[family].get(name, np.nan) for s in simulations])
            terms.append((value - simulated.mean()) ** 2 - (1.0 + 1.0 / n) * simulated.var(ddof=1))
        squares[family] = float(np.nanmean(terms))
    return squares


def total(squares):
    return float(np.mean(list(squares.values())))


def white_model(rates_dps, rate_hz):
    """What people begin with: the angle random walk read at 1 s, and the mean."""
    m = max(1, round(rate_hz))
    return {"schema": "gyrolog-model/1", "rate_hz": rate_hz, "axes": {
        axis: {"N": float(np.sqrt(allan_variance(x, m) * m / rate_hz)), "bias": float(x.mean())}
        for axis, x in zip("xyz", rates_dps.T)}}


def program_says(command, log):
    with open(log, "ab") as file:
        code = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT).returncode
    if code != 0:
        sys.exit(f"{' '.join(command)}: exit code {code}, see {log}")


def simulated(program, model, like, directory, count, log):
    path = os.path.join(directory, "simulated.csv")
    found = []
    for seed in range(1, count + 1):
        program_says([program, "simulate", model, "--like", like, "--seed", str(seed), "-o", path, "--force"], log)
        found.append(measures(*read_rates(path)))
    os.remove(path)
    return found


def held_against(program, directory, count, scale=(), diagnose=()):
    """(the diagnosis, {model: gap's squares by family}) of DIR/first.csv, diagnosed from DIR/white.json, and of the
    models' simulations held against DIR/second.csv. scale, diagnose: options of the program."""
    log = os.path.join(directory, "log.txt")
    first, second, white, fitted, corrected, modelled, answer = (
        os.path.join(directory, n) for n in ("first.csv", "second.csv", "white.json", "fitted.json", "corrected.json",
                                             "modelled.json", "diagnosis.json"))
    program_says([program, "analyze", first, "--model", fitted, *scale], log)
    program_says([program, "diagnose", first, "--model", white, "--json", answer, "--model-out", modelled, "--unnamed",
                  *scale, *diagnose], log)
    with open(modelled) as file:
        model = json.load(file)
    unnamed = model.pop("unnamed", None)
    with open(corrected, "w") as file:
        json.dump(model, file)
    real = measures(*read_rates(second))
    gaps = {"white": gap_squares(real, simulated(program, white, second, directory, count, log))}
    models = {"analyze": fitted, "named": corrected, **({"unnamed": modelled} if unnamed else {})}
    for model, path in models.items():
        gaps[model] = gap_squares(real, simulated(program, path, second, directory, count, log))
    # Without such forms it is the same model, of the same seeds.
    gaps.setdefault("unnamed", gaps["named"])
    with open(answer) as file:
        return json.load(file), gaps


def of_recording(program, data, out, name, begin_s, end_s, count):
    directory = os.path.join(out, name.replace("/", "_"))
    os.makedirs(directory, exist_ok=True)
    header, a, b = halves_of(os.path.join(data, name + ".csv.xz"), begin_s, end_s)
    first = os.path.join(directory, "first.csv")
    write_lines(first, header, a)
    write_lines(os.path.join(directory, "second.csv"), header, b)
    with open(os.path.join(directory, "white.json"), "w") as file:
        json.dump(white_model(*read_rates(first)), file)
    scale = ["--lsb-dps", repr(LSB_DPS)] if "_lsb" in header else []
    said, gaps = held_against(program, directory, count, scale)
    result = {"name": name, "gap_squares": gaps, "verdict": said["verdict"],
              "causes": [(c["effect"], c.get("axes") or c.get("where", {}).get("axes"), c.get("share")) for c in
                         said["causes"]] + [(f"no name: {u['form']}", u["axes"], u["share"]) for u in said["unnamed"]]}
    with open(os.path.join(directory, "result.json"), "w") as file:
        json.dump(result, file, indent=1)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("data")
    parser.add_argument("out")
    parser.add_argument("--only")
    parser.add_argument("--simulations", type=int, default=24)
    arguments = parser.parse_args()
    closed = {}
    for name, begin_s, end_s in RECORDINGS:
        if arguments.only and arguments.only not in name:
            continue
        result = of_recording(os.path.abspath(arguments.program), arguments.data, arguments.out, name, begin_s, end_s,
                              arguments.simulations)
        gaps = result["gap_squares"]
        before = total(gaps["white"])
        print(f"{name}: {result['verdict']}, gap {np.sqrt(max(before, 0.0)):.1f}")
        for cause in result["causes"]:
            print("   ", *cause)
        for model in [m for m in gaps if m != "white"]:
            closed.setdefault(model, []).append(1.0 - total(gaps[model]) / before)
            print(f"    {model:8} closes {100.0 * closed[model][-1]:4.0f} %")
        print("    families:", {f: [round(gaps[m][f], 1) for m in gaps] for f in gaps["white"]}, flush=True)
    for model, shares in closed.items():
        print(f"{model}: closed in the median {100.0 * np.median(shares):.0f} %, at worst {100.0 * min(shares):.0f} %")
    return 0


if __name__ == "__main__":
    sys.exit(main())
