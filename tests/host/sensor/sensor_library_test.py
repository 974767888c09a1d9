#!/usr/bin/env python3
"""The library as Python sees it: the samples of `gyrolog simulate`, its symbols, its errors.

    sensor_library_test.py GYROLOG LIBRARY MODULE_FOLDER
"""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "blind"))
import numbers_or_skip  # noqa: E402, F401  it may start another interpreter

import numpy as np  # noqa: E402
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from schemas import KeptFolder  # noqa: E402

RATE_HZ = 100.0
COUNT = 2500


def model():
    axes = {axis: {"N": 0.005, "B": 0.002, "K": 1e-4, "bias": bias}
            for axis, bias in (("x", 0.31), ("y", -0.12), ("z", 0.08))}
    effects = [{"effect": "lowpass", "axes": [], "params": {"fc_hz": 20.0, "order": 2}},
               {"effect": "warmup", "axes": ["x"], "params": {"a_dps": 0.5, "tau_s": 20.0}},
               {"effect": "stale", "axes": [], "params": {"eps": 0.1}},
               {"effect": "dropped", "axes": [], "params": {"per_hour": 3600.0, "longest": 4.0}}]
    return {"schema": "gyrolog-model/1", "rate_hz": RATE_HZ, "full_scale_dps": 500.0, "saturation_dps": 500.0,
            "lsb_dps": 1 / 65.5, "axes": axes, "M": np.eye(3).tolist(), "latency_s": 0.003,
            "timestamp_jitter_s": 2e-5, "sd_rel": {}, "sd_abs": {}, "ref_noise_dps": 0.0, "acc_noise_g": 0.0,
            "temp_noise_C": 0.03, "effects": effects}


def fails_with(words, function, *arguments, **named):
    try:
        function(*arguments, **named)
    except ValueError as error:
        assert words in str(error), error
        return
    raise AssertionError(f"no error about {words!r}")


def check_symbols(library):
    listed = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    names = {line.split()[2].split("@")[0] for line in listed.splitlines()}
    header = pathlib.Path(sys.argv[3], "gyrolog_sensor.h").read_text()
    declared = set(re.findall(r"\b(gyrolog_sensor_\w+)\(", header.split('extern "C"', 1)[1]))
    versions = {name for name in names if name.startswith("GYROLOG_SENSOR_")}
    assert names - versions == declared, names ^ declared
    dynamic = subprocess.run(["readelf", "-d", library], check=True, capture_output=True, text=True).stdout
    assert "[libgyrolog-sensor.so.0]" in dynamic, dynamic
    for heavy in ("opencv", "libusb", "matio"):
        assert heavy not in dynamic, dynamic


def main():
    program, library, folder = sys.argv[1:]
    check_symbols(library)
    os.environ["GYROLOG_SENSOR_LIBRARY"] = library
    sys.path.insert(0, folder)
    import gyrolog_sensor

    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
    assert gyrolog_sensor.version() in version, version
    with KeptFolder() as work:
        path, out = pathlib.Path(work, "model.json"), pathlib.Path(work, "out.csv")
        path.write_text(json.dumps(model()))
        subprocess.run([program, "simulate", path, "-o", out, "--duration", f"{COUNT / RATE_HZ:g}s", "--seed", "7"],
                       check=True, capture_output=True)
        rows = list(csv.DictReader(line for line in out.read_text().splitlines() if not line.startswith("#")))
        assert COUNT - 400 < len(rows) < COUNT, len(rows)

        with gyrolog_sensor.Sensor(path, seed=7) as gyro:
            assert gyro.rate_hz == RATE_HZ
            # Three steps of the simulator to a sample of the sensor.
            samples = gyro.run(np.arange(3 * COUNT - 2) / (3.0 * RATE_HZ))
        assert len(samples) == len(rows), (len(samples), len(rows))
        dps = samples["rate_rad_s"] * 180.0 / np.pi
        for axis, name in enumerate("xyz"):
            if f"g{name}_lsb" in rows[0]:
                written = np.array([int(row[f"g{name}_lsb"]) for row in rows])
            else:
                written = np.rint([float(row[f"g{name}_dps"]) * 65.5 for row in rows]).astype(int)
            assert np.array_equal(samples["counts"][:, axis], written), name
            assert np.allclose(samples["counts"][:, axis] / 65.5, dps[:, axis], rtol=1e-12)
        stamps = np.array([float(row["t_s"]) for row in rows])
        assert np.max(np.abs(samples["time_s"] - stamps)) < 1e-9
        other = gyrolog_sensor.Sensor(path, seed=8).run(np.arange(100) / RATE_HZ)
        assert not np.array_equal(other["counts"], samples["counts"][:len(other)])

        # One slow step of many samples, more than the module has room for at once.
        with gyrolog_sensor.Sensor(path, seed=7, rate_hz=1000.0) as gyro:
            assert gyro.rate_hz == 1000.0
            first = gyro.step(5.0)
            rest = gyro.step(6.0, rate_rad_s=(0.0, 0.0, 1.0))
            assert len(first) == 1 and 900 < len(rest) <= 1000, (len(first), len(rest))
            assert rest["rate_rad_s"][-20:, 2].mean() > 0.9 and abs(rest["rate_rad_s"][:20, 2].mean()) < 0.1
            fails_with("later", gyro.step, 6.0)
            fails_with("finite", gyro.step, 7.0, rate_rad_s=(np.inf, 0.0, 0.0))
            fails_with("temperature", gyro.step, 7.0, temperature_C=20.0)
        fails_with("closed", gyro.step, 8.0)
        without_rate = {key: value for key, value in model().items() if key != "rate_hz"}
        path.write_text(json.dumps(without_rate))
        fails_with("rate_hz is missing", gyrolog_sensor.Sensor, path)
        assert gyrolog_sensor.Sensor(path, rate_hz=50.0).rate_hz == 50.0
        path.write_text("{}")
        fails_with("schema", gyrolog_sensor.Sensor, path)
        fails_with("absent.json", gyrolog_sensor.Sensor, "absent.json")


if __name__ == "__main__":
    main()
