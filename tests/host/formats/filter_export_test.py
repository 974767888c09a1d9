#!/usr/bin/env python3
"""Writes a model for each filter, reads the file with a reader of its own, puts the numbers into the filter's equations
(from its source, cited in the file's head), and holds the covariance that grows against the sensor's:

    variance of the angle N^2 t + K^2 t^3 / 3, of the bias K^2 t

and the same for velocity and the accelerometer. Then the model is simulated, and the recording exported.

    filter_export_test.py GYROLOG
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import types

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from schemas import KeptFolder  # noqa: E402

RATE_HZ = 50.0
DEG = math.pi / 180.0
G = 9.80665
# White noise and walk meet at 5 s: after 1 s the one counts, after 10 s the other.
MODEL = {"gyro": (0.02, 0.02 * math.sqrt(3.0) / 5.0), "accelerometer": (5e-4, 5e-4 * math.sqrt(3.0) / 5.0)}
UNIT = {"gyro": DEG, "accelerometer": G}
LESS = (("x", 0.7), ("y", 1.0), ("z", 0.8))  # y has most


def model_text(accelerometer=True, lsb_dps=0.0, effects=()):
    def axes(sensor):
        return {name: {"N": MODEL[sensor][0] * less, "K": MODEL[sensor][1] * less, "B": 1e-4 * MODEL[sensor][0]}
                for name, less in LESS}
    model = {"schema": "gyrolog-model/1", "rate_hz": RATE_HZ, "lsb_dps": lsb_dps, "axes": axes("gyro"),
             "effects": list(effects)}
    if accelerometer:
        model["accelerometer"] = {"axes": axes("accelerometer")}
    return json.dumps(model)


# Readers.

# What YAML 1.1 takes for a real number, and OpenCV's reader as well: with a point.
YAML_REAL = re.compile(r"[-+]?[0-9]+\.[0-9]*(?:[eE][-+][0-9]+)?$")


def yaml_values(text):
    """Keys with one real number, whatever they are in."""
    values = {}
    for line in text.splitlines():
        found = re.match(r"\s*([\w.]+): *([^#]*)", line.split(" #")[0])
        if line.startswith(("#", "%")) or not found or not found.group(2):
            continue
        key, word = found.group(1), found.group(2).strip()
        if re.match(r"[-+]?[.\d]", word):
            assert YAML_REAL.match(word), f"{key}: {word} is no real number in YAML 1.1"
            assert key not in values, key
            values[key] = float(word)
    try:
        import yaml
    except ImportError:
        return values
    if text.startswith("%YAML:1.0\n"):  # OpenCV's own spelling
        text = text[text.index("\n") + 1:]
    tree = yaml.safe_load(text)
    flat = tree.get("imu0", tree)
    for key, value in values.items():
        assert flat[key] == value and isinstance(flat[key], float), (key, flat[key])
    return values


def params_values(text):
    rows = [line.split("\t") for line in text.splitlines() if line and not line.startswith("#")]
    assert all(len(row) == 5 and row[4] == "9" for row in rows), rows
    return {row[2]: float(row[3]) for row in rows}


def parm_values(text):
    return {name: float(value) for name, value in (line.split() for line in text.splitlines()
                                                   if line and not line.startswith("#"))}


class Times:
    """n x n unit matrix or zeros, as far as a snippet needs them: a number times it."""

    def __init__(self, value):
        self.value = value

    def __rmul__(self, factor):
        return Times(factor * self.value)


def gtsam_values(text):
    values = {}

    class Params:
        def __getattr__(self, name):
            assert name.startswith("set"), name
            return lambda matrix: values.__setitem__(name[3:], matrix.value)
    modules = {"numpy": types.SimpleNamespace(eye=lambda n: Times(1.0), zeros=lambda shape: Times(0.0)),
               "gtsam": types.SimpleNamespace(PreintegrationCombinedParams=types.SimpleNamespace(
                   MakeSharedU=lambda g: Params()))}
    kept = {name: sys.modules.get(name) for name in modules}
    sys.modules.update(modules)
    try:
        exec(compile(text, "gtsam", "exec"), {})
    finally:
        for name, module in kept.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module
    return values


def diagonals(text):
    values = {}
    for key, row in re.findall(r"^(\w+_covariance): \[(.*)\]$", text, re.M):
        row = [float(word) for word in row.split(",")]
        assert len(row) == 9
        values[key] = (row[0], row[4], row[8])
        assert [one for i, one in enumerate(row) if i not in (0, 4, 8)] == [0.0] * 6
    return values


# Filters: of the numbers of one sensor, dt and what a step adds to the variances of the angle and of the bias, the
# bias in the unit in which the filter keeps it: that times `unit` moves the angle in a step.


def kalibr(values, sensor):
    name = {"gyro": "gyroscope", "accelerometer": "accelerometer"}[sensor]
    dt = 1.0 / values["update_rate"]
    of_sample = values[name + "_noise_density"] / math.sqrt(dt)
    return dt, (of_sample * dt)**2, values[name + "_random_walk"]**2 * dt, dt


def openvins(values, sensor):
    name = {"gyro": "gyroscope", "accelerometer": "accelerometer"}[sensor]
    dt = 1.0 / values["update_rate"]
    return (dt, dt * values[name + "_noise_density"]**2 / dt * dt, dt * values[name + "_random_walk"]**2 / dt * dt, dt)


def vins_fusion(values, sensor):
    name = {"gyro": "gyr", "accelerometer": "acc"}[sensor]
    dt = 1.0 / RATE_HZ
    halves = [0.5 * dt, 0.5 * dt]
    return dt, sum(half * values[name + "_n"]**2 * half for half in halves), (dt * values[name + "_w"])**2, dt


def orb_slam3(values, sensor):
    noise, walk = {"gyro": ("NoiseGyro", "GyroWalk"), "accelerometer": ("NoiseAcc", "AccWalk")}[sensor]
    dt = 1.0 / RATE_HZ
    root = math.sqrt(values["IMU.Frequency"])
    # The walk is not in the angle there.
    return dt, (dt * values["IMU." + noise] * root)**2, (values["IMU." + walk] / root)**2, 0.0


def gtsam(values, sensor):
    noise, bias = {"gyro": ("Gyroscope", "BiasOmega"), "accelerometer": ("Accelerometer", "BiasAcc")}[sensor]
    dt = 1.0 / RATE_HZ
    start = values["BiasAccOmegaInit"] / dt
    return dt, dt * (values[noise + "Covariance"] / dt + start) * dt, dt * values[bias + "Covariance"], dt


def px4_ekf2(values, sensor):
    name = {"gyro": "GYR", "accelerometer": "ACC"}[sensor]
    dt = 0.01
    return dt, (dt * min(values[f"EKF2_{name}_NOISE"], 1.0))**2, (dt * values[f"EKF2_{name}_B_NOISE"])**2, dt


def ardupilot_ek3(values, sensor):
    noise, bias = {"gyro": ("GYRO", "GBIAS"), "accelerometer": ("ACC", "ABIAS")}[sensor]
    dt = 0.0125
    # The bias is kept as what it turns in a step.
    return dt, (dt * values[f"EK3_{noise}_P_NSE"])**2, (dt * dt * values[f"EK3_{bias}_P_NSE"])**2, 1.0


FILTERS = {"kalibr": (yaml_values, kalibr), "openvins": (yaml_values, openvins),
           "vins-fusion": (yaml_values, vins_fusion), "orb-slam3": (yaml_values, orb_slam3),
           "gtsam": (gtsam_values, gtsam), "px4-ekf2": (params_values, px4_ekf2),
           "ardupilot-ek3": (parm_values, ardupilot_ek3)}
MESSAGES = ("sensor-msgs-imu", "robot-localization")


def grown(step, t_s):
    """P = F P F' + Q with F = [1 -unit; 0 1]."""
    dt, of_angle, of_bias, unit = step
    angle = cross = bias = 0.0
    for _ in range(round(t_s / dt)):
        angle += -2.0 * unit * cross + unit * unit * bias + of_angle
        cross -= unit * bias
        bias += of_bias
    in_a_second = dt if unit == 1.0 else 1.0  # of a bias that is kept as what it turns in a step
    return angle, bias / in_a_second**2


def close(found, wanted, tolerance, what):
    assert abs(found / wanted - 1.0) < tolerance, f"{what}: {found:.6g} instead of {wanted:.6g}"


def check(name, text, of_noise, of_walk, factor=1.0):
    reader, equations = FILTERS[name]
    values = reader(text)
    for sensor, (N, K) in MODEL.items():
        N, K = N * UNIT[sensor] * factor, K * UNIT[sensor] * factor
        step = equations(values, sensor)
        for t_s in (1.0, 10.0):
            walked = 0.0 if name == "orb-slam3" else K * K * t_s**3 / 3.0
            angle, bias = grown(step, t_s)
            tolerance = of_noise if t_s == 1.0 else of_walk
            close(angle, N * N * t_s + walked, tolerance, f"{name}, {sensor} after {t_s:g} s")
            close(bias, K * K * t_s, of_walk, f"{name}, bias of {sensor} after {t_s:g} s")


def check_messages(name, text, tolerance):
    values = diagonals(text)
    assert values["orientation_covariance"] == (-1.0, 0.0, 0.0)
    for key, sensor in (("angular_velocity_covariance", "gyro"), ("linear_acceleration_covariance", "accelerometer")):
        for (axis, less), found in zip(LESS, values[key]):
            N = MODEL[sensor][0] * UNIT[sensor] * less
            # Messages of one second are integrated.
            close(found / RATE_HZ**2 * RATE_HZ, N * N, tolerance, f"{name}, {sensor} {axis}")


def main():
    program = sys.argv[1]

    def export(*arguments, code=0):
        done = subprocess.run([program, "export", *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == code, (arguments, done)
        return done.stderr

    with KeptFolder() as folder:
        model, gyro_only, coarse = (pathlib.Path(folder, name) for name in ("m.json", "gyro.json", "coarse.json"))
        out, recording = pathlib.Path(folder, "out"), pathlib.Path(folder, "night.csv")
        model.write_text(model_text(effects=[{"effect": "gauss_markov", "axes": ["y"],
                                              "params": {"sigma_dps": 1e-4, "tau_s": 10.0}}]))
        gyro_only.write_text(model_text(accelerometer=False))
        coarse.write_text(model_text(lsb_dps=0.5))
        # K enters as a sum over steps: (1 - 1/n)(1 - 1/(2n)) of t^3 / 3.
        for name in FILTERS:
            said = export(model, "-o", out, "--for", name)
            assert "\nwritten" in said and "warning" not in said, said
            text = out.read_text()
            check(name, text, 0.01, 0.03)
            assert "INFLATED" not in text
            assert "Not in the numbers: The model has the effect gauss_markov of the gyro" in text, text
            assert re.search("Discrete at|Continuous-time", text), name
            export(model, "-o", out, "--for", name, "--inflate", 3)
            check(name, out.read_text(), 0.01, 0.03, 3.0)
            assert "INFLATED: all deviations and densities are 3 times" in out.read_text()
        for name in MESSAGES:
            export(model, "-o", out, "--for", name)
            check_messages(name, out.read_text(), 1e-6)
        # The ending of Kalibr is told by itself.
        export(model, "-o", pathlib.Path(folder, "imu.yaml"))
        check("kalibr", pathlib.Path(folder, "imu.yaml").read_text(), 0.01, 0.03)
        # The converter's error is in N.
        export(coarse, "-o", out, "--for", "sensor-msgs-imu")
        sample = (MODEL["gyro"][0] * DEG)**2 * RATE_HZ + (0.5 * DEG)**2 / 12.0
        close(diagonals(out.read_text())["angular_velocity_covariance"][1], sample, 1e-6, "with the converter's step")
        assert "converter's step" in out.read_text()
        # What is not there is missed aloud, and no filter runs on a default.
        for name, (reader, _) in FILTERS.items():
            said = export(gyro_only, "-o", out, "--for", name)
            assert said.count("warning: left out: ") == 2 and "not measured" in said, said
            assert "There is no accelerometer in the source" in out.read_text()
            if name == "gtsam":
                assert out.read_text().startswith("# -*- coding: utf-8 -*-\n"), "Python asks the first two lines"
                try:
                    reader(out.read_text())
                except ValueError as stopped:
                    assert "AccelerometerCovariance is missing" in str(stopped)
                else:
                    raise AssertionError("GTSAM would take a default of 1")
                continue
            assert not [key for key in reader(out.read_text()) if re.search("acc", key, re.I)], out.read_text()
        assert "--inflate is for filters" in export(model, "-o", out, "--for", "sdf", "--inflate", 2, code=2)
        assert "--inflate is for filters" in export(model, "-o", pathlib.Path(folder, "a.m"), "--inflate", 2, code=2)
        assert "--horizon is for simulators" in export(model, "-o", out, "--for", "gtsam", "--horizon", "9m", code=2)
        assert "orb-slam3" in export(model, "-o", out, "--for", "nothing", code=2)
        # Simulated, and analysed back.
        subprocess.run([program, "simulate", model, "-o", recording, "--duration", "40m", "--seed", "5"], check=True,
                       capture_output=True)
        for name in FILTERS:
            export(recording, "-o", out, "--for", name)
            check(name, out.read_text(), 0.05, 0.25)
        for name in MESSAGES:
            export(recording, "-o", out, "--for", name)
            check_messages(name, out.read_text(), 0.05)


if __name__ == "__main__":
    main()
