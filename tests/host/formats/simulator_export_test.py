#!/usr/bin/env python3
"""Writes a model for each simulator, reads the file again, makes the noise by the formula of the simulator's source
(cited in the file's head), and holds its Allan deviation against the model's: the largest error is the stated one.

    simulator_export_test.py GYROLOG [MODELS HORIZON_S...]
    simulator_export_test.py GYROLOG play

No random numbers: a simulator's noise is linear in its draws, so that its response to one draw of each kind gives
the expected Allan variance exactly. With `play` the formulas are run with random numbers all the same, many sensors
at once, and what `gyrolog simulate` and `gyrolog analyze` give for the model is held beside them.
"""

import ast
import json
import math
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "blind"))
import numbers_or_skip  # noqa: E402, F401  it may start another interpreter

import numpy as np  # noqa: E402
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from schemas import KeptFolder  # noqa: E402

RATE_HZ = 50.0
DT = 1.0 / RATE_HZ
TOLERANCE_DB = 0.2
# With `play`: 20 averaging times and 12 simulators of three axes each are 720 chances for five standard errors, 4e-4
# in all.
STANDARD_ERRORS = 5.0
PLAYED_HORIZON_S = 10.0
PLAYED_SENSORS = 6000
PLAYED_AT_ONCE = 3000
DEG = math.pi / 180.0


def models():
    """Deg/s. Each axis differs, so that a mix-up of axes shows."""
    def model(N, B, K, gauss_markov=(), **more):
        axes = {name: {"N": N * scale, "B": B * scale, "K": K * scale, "bias": bias}
                for name, scale, bias in (("x", 1.0, 0.31), ("y", 1.3, -0.12), ("z", 0.8, 0.08))}
        effects = [{"effect": "gauss_markov", "axes": ["x", "y", "z"], "params": {"sigma_dps": s, "tau_s": t}}
                   for s, t in gauss_markov]
        rest = {"full_scale_dps": 500.0, "saturation_dps": 500.0, "lsb_dps": 0.0, "M": np.eye(3).tolist(),
                "latency_s": 0.0, "timestamp_jitter_s": 0.0, "sd_rel": {}, "sd_abs": {}, "ref_noise_dps": 0.0,
                "acc_noise_g": 0.0, "temp_noise_C": 0.0}
        return {"schema": "gyrolog-model/1", "rate_hz": RATE_HZ, "axes": axes, "effects": effects, **rest, **more}
    yield "typical", model(0.005, 0.002, 1e-4, lsb_dps=1 / 65.5)
    yield "flicker", model(0.002, 0.01, 0.0)
    yield "walk", model(0.005, 0.0, 1e-3)
    yield "white", model(0.005, 0.0, 0.0)
    yield "gauss_markov", model(0.005, 0.0, 0.0, [(0.004, 30.0)])
    yield "two_gauss_markov", model(0.005, 0.0, 0.0, [(0.01, 1.0), (0.01, 100.0)])
    yield "flicker_and_walk", model(0.001, 0.003, 5e-4)
    yield "all", model(0.003, 0.004, 3e-4, [(0.005, 20.0)])
    yield "little_white", model(1e-4, 0.003, 0.0)
    yield "fast_gauss_markov", model(0.001, 0.001, 1e-5, [(0.02, 0.5)])


def model_variance(model, axis, m, rounds):
    """Gauss-Markov noise is sampled, as `simulate` has it: at a few samples that is more than its average."""
    tau = np.array(m) * DT
    one = {key: value * DEG for key, value in model["axes"][axis].items()}
    lsb = 0.0 if rounds else model["lsb_dps"] * DEG
    variance = (one["N"]**2 + lsb**2 / 12.0 / RATE_HZ) / tau
    variance += 2.0 * math.log(2.0) / math.pi * one["B"]**2 + one["K"]**2 * tau / 3.0
    for effect in model["effects"]:
        keep = math.exp(-DT / effect["params"]["tau_s"])
        drive = effect["params"]["sigma_dps"] * DEG * math.sqrt(1.0 - keep**2)
        variance += simulated_variance(lambda draw: 0.0, lambda b, draw, k=keep, d=drive: k * b + d * draw, m)
    return variance


# The simulators' formulas: white(draw) of a sample, and bias(bias, draw) of the next.


def maybeck(density, walk, T):
    """gz-sensors, the plugins of Gazebo classic, Pegasus."""
    sd = math.sqrt(-walk * walk * T / 2.0 * (math.exp(-2.0 * DT / T) - 1.0)) if walk > 0.0 else 0.0
    phi = math.exp(-DT / T)
    return (lambda draw: density / math.sqrt(DT) * draw), (lambda bias, draw: phi * bias + sd * draw)


def read_sdf(text):
    for axis in "xyz":
        noise = ElementTree.fromstring(text).find(f".//angular_velocity/{axis}/noise")
        values = {child.tag: float(child.text) for child in noise}
        walk, T = values.get("dynamic_bias_stddev", 0.0), values.get("dynamic_bias_correlation_time", 1.0)
        yield values["mean"], *maybeck(values["stddev"] * math.sqrt(DT), walk, T)


def read_plugin(text):
    root = ElementTree.fromstring(text)
    values = [float(root.find("gyroscope" + name).text) for name in ("NoiseDensity", "RandomWalk",
                                                                     "BiasCorrelationTime")]
    return [(None, *maybeck(*values))] * 3


def assigned(text, name, names=None):
    """The value that Python text gives a name."""
    scope = dict(names or {})
    exec(text, scope)
    return scope[name]


def read_pegasus(text):
    config = assigned(text, "imu_config")
    gyro = config["gyroscope"]
    # The gyro's correlation time is not read there.
    T = config["accelerometer"]["bias_correlation_time"]
    return [(None, *maybeck(gyro["noise_density"], gyro["random_walk"], T))] * 3


def per_step(sd, walk):
    return (lambda draw: sd * draw), (lambda bias, draw: bias + walk * draw)


def python_call(text, function):
    """The named arguments of the one call of a function."""
    call, = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)
             and ast.unparse(node.func).endswith(function))
    return {one.arg: one.value for one in call.keywords}


def read_isaaclab(text):
    given = python_call(text, "GaussianNoiseCfg")
    mean, std = (ast.literal_eval(given[name].args[0]) for name in ("mean", "std"))
    return [(mean[i], *per_step(std[i], 0.0)) for i in range(3)]


def read_genesis(text):
    given = python_call(text, "sensors.IMU")
    noise, walk, bias = (ast.literal_eval(given["gyro_" + name]) for name in ("noise", "random_walk", "bias"))
    return [(bias[i], *per_step(noise[i], walk[i])) for i in range(3)]


def read_carla(text):
    class Blueprint(dict):
        def set_attribute(self, name, value):
            assert isinstance(value, str)
            self[name] = float(value)
    blueprint = Blueprint()
    assigned(text, "set_imu")(blueprint)
    assert math.isclose(blueprint["sensor_tick"], DT, rel_tol=1e-8)
    return [(blueprint["noise_gyro_bias_" + axis], *per_step(blueprint["noise_gyro_stddev_" + axis], 0.0))
            for axis in "xyz"]


def read_jmavsim(text):
    sd = float(re.search(r"setNoise_Gyo\((.*)f\);", text).group(1))
    return [(None, *per_step(sd, 0.0))] * 3


def read_airsim(text):
    imu = json.loads(text)["DefaultSensors"]["Imu"]
    density = imu["AngularRandomWalk"] / math.sqrt(3600.0) * DEG
    walk = imu["GyroBiasStability"] / 3600.0 * DEG / math.sqrt(imu["GyroBiasStabilityTau"])
    step = math.sqrt(max(DT, 1e-3))
    return [(None, *per_step(density / step, walk * step))] * 3


def read_gnss_ins_sim(text):
    numbers = text[text.index("imu_err = "):text.index("imu = ")]
    error = assigned(numbers, "imu_err", {"np": np})
    for i in range(3):
        sd, T = error["gyro_b_stability"][i] * DEG / 3600.0, error["gyro_b_corr"][i]
        a, b = 1.0 - DT / T, sd * math.sqrt(1.0 - math.exp(-2.0 * DT / T))
        arw = error["gyro_arw"][i] * DEG / 60.0
        yield (error["gyro_b"][i] * DEG / 3600.0, lambda draw, arw=arw: arw / math.sqrt(DT) * draw,
               lambda bias, draw, a=a, b=b: a * bias + b * draw)


def read_navego(text):
    def row(name):
        return [float(number) for number in re.search(rf"^{name} = \[(.*?)\];", text, re.M).group(1).split()]
    assert row("imu.gb_dyn") == [0.0] * 3
    return [(bias, *per_step(sd, walk * DT))
            for bias, sd, walk in zip(row("gyro_bias"), row("imu.g_std"), row("imu.arrw"))]


def mjcf_snippet(text):
    snippet = re.search(r"^(  import numpy.*?)-->", text, re.M | re.S).group(1)
    return "\n".join(line[2:] for line in snippet.splitlines())


def read_mjcf(text):
    root = ElementTree.fromstring(text)
    gyro = root.find("sensor/gyro")
    assert math.isclose(float(root.find("option").get("timestep")), DT, rel_tol=1e-8)
    snippet = mjcf_snippet(text)
    compile(snippet, "snippet", "exec")
    keep, drive, bias, sd = (ast.literal_eval(found) for found in re.findall(r"np\.array\((\[.*?\])\)", snippet))
    assert math.isclose(float(gyro.get("noise")), max(sd), rel_tol=1e-8)
    return [(bias[i], lambda draw, i=i: sd[i] * draw,
             lambda b, draw, i=i: keep[i] * b + drive[i] * draw) for i in range(3)]


READERS = {"sdf": read_sdf, "px4-classic": read_plugin, "rotors": read_plugin, "pegasus": read_pegasus,
           "isaaclab": read_isaaclab, "mjcf": read_mjcf, "airsim": read_airsim, "genesis": read_genesis,
           "carla": read_carla, "jmavsim": read_jmavsim, "gnss-ins-sim": read_gnss_ins_sim, "navego": read_navego}
ROUNDING = {"sdf", "genesis"}


def simulated_variance(white, bias, m):
    """Allan variances at m samples each, from the responses to one draw."""
    n = 2 * max(m)
    response = np.empty(n)
    state = 0.0
    for k in range(n):
        state = bias(state, 1.0 if k == 0 else 0.0)
        response[k] = state
    kept = response[1] / response[0] if response[0] != 0.0 else 0.0
    variances = []
    for one in m:
        weights = np.concatenate([np.full(one, -1.0), np.full(one, 1.0)]) / one
        h = response[:2 * one]
        size = 1 << (4 * one).bit_length()
        # Draw j acts on the samples from j on: a correlation.
        spectrum = np.fft.rfft(weights, size) * np.conj(np.fft.rfft(h, size))
        of_draws = np.fft.irfft(spectrum, size)[:2 * one]
        variance = np.sum(of_draws**2)
        if 0.0 < kept < 1.0:  # of all draws before; those of a walk cancel
            variance += of_draws[0]**2 * kept**2 / (1.0 - kept**2)
        variances.append(0.5 * (variance + white(1.0)**2 * 2.0 / one))
    return np.array(variances)


def played_variance(white, bias, m, random):
    """The same by running the formula: variances and their standard errors, over many sensors at once."""
    length = 3 * max(m)
    kept, driven = bias(1.0, 0.0), bias(0.0, 1.0)
    settled = driven / math.sqrt(1.0 - kept**2) if kept < 1.0 else 0.0
    found = np.empty((PLAYED_SENSORS, len(m)))
    for first in range(0, PLAYED_SENSORS, PLAYED_AT_ONCE):
        angle = np.zeros((length + 1, PLAYED_AT_ONCE))
        state = settled * random.standard_normal(PLAYED_AT_ONCE)
        for k in range(length):
            state = bias(state, random.standard_normal(PLAYED_AT_ONCE))
            angle[k + 1] = angle[k] + state + white(random.standard_normal(PLAYED_AT_ONCE))
        for i, one in enumerate(m):
            starts = np.arange(0, length - 2 * one + 1, max(1, one // 4))
            second = angle[starts + 2 * one] - 2.0 * angle[starts + one] + angle[starts]
            found[first:first + PLAYED_AT_ONCE, i] = np.mean(second**2, axis=0) / (2.0 * one**2)
    return found.mean(axis=0), found.std(axis=0, ddof=1) / math.sqrt(PLAYED_SENSORS)


def stated_errors(text):
    head = text if not text.startswith("{") else " ".join(json.loads(text)["_gyrolog"])

    def said(words):
        return 0.0 if words.startswith("none") else float(words.split()[0])
    each = re.search(r"x (none|[\d.]+ dB)[^,]*, y (none|[\d.]+ dB)[^,]*, z (none|[\d.]+ dB)", head)
    if each:
        return [said(words) for words in each.groups()]
    return [said(re.search(r"Allan deviation:\s+(?:#|//|%)?\s*(none|[\d.]+ dB)", head).group(1))]


def check(name, simulator, model, horizon_s, text):
    m = sorted({max(1, round(RATE_HZ * horizon_s * 2.0**(-k / 2.0))) for k in range(60)})
    worst = []
    for axis, (bias, white, drift) in zip("xyz", READERS[simulator](text)):
        if bias is not None:
            assert math.isclose(bias, model["axes"][axis]["bias"] * DEG, rel_tol=1e-6), (simulator, bias)
        ratio = simulated_variance(white, drift, m) / model_variance(model, axis, m, simulator in ROUNDING)
        worst.append(np.max(np.abs(dB(ratio))))
    stated = stated_errors(text)
    true = worst if len(stated) == 3 else [max(worst)]
    for said, found in zip(stated, true):
        assert abs(said - found) < TOLERANCE_DB, f"{simulator}, {name}, {horizon_s} s: {said} dB stated, {found:.2f} true"
    return max(true)


def dB(ratio):
    """Of variances; of their square roots the same number."""
    return 10.0 * np.log10(ratio)


def gyrologs_curve(program, folder, path, m):
    """Allan variances that `gyrolog analyze` finds in what `gyrolog simulate` makes, and their standard errors."""
    recording, found = folder / "simulated.csv", folder / "found.json"
    subprocess.run([program, "simulate", path, "-o", recording, "--duration", "4h", "--seed", "5"], check=True,
                   capture_output=True)
    subprocess.run([program, "analyze", recording, "--sensor", "gyro", "--json", found, "--m",
                    ",".join(str(one) for one in m), "--confidence", "0.683"], check=True, capture_output=True)
    for axis in json.loads(found.read_text())["axes"].values():
        points = {point["m"]: point for point in axis["allan"]}
        assert set(m) <= set(points), sorted(points)
        deviation, low, high = (np.array([points[one][key] for one in m]) * DEG for key in ("value", "lo", "hi"))
        yield deviation**2, deviation * (high - low)


def play_snippet(program, folder):
    """The lines of Python in MuJoCo's file, in a body at rest: a sensor that they can be is the model to `compare`."""
    class Body:
        data = np.zeros(3)

        def sensor(self, name):
            assert name == "gyro"
            return self
    path, out, recording = folder / "b.model.json", folder / "body.xml", folder / "snippet.csv"
    path.write_text(json.dumps(dict(models())["gauss_markov"]))
    subprocess.run([program, "export", path, "-o", out, "--for", "mjcf", "--horizon", "100s"], check=True,
                   capture_output=True)
    gyro = assigned(mjcf_snippet(out.read_text()), "gyro")
    rates = [gyro(Body()) for _ in range(60000)]
    np.savetxt(recording, np.column_stack([np.arange(len(rates)) * DT, rates]), fmt="%.12g", delimiter=",",
               header="t_s,gx_rad_s,gy_rad_s,gz_rad_s", comments="")
    said = subprocess.run([program, "compare", recording, path], check=True, capture_output=True, text=True).stdout
    assert said.count("differs no more than simulations do among themselves") == 3, said


def play(program):
    """Each simulator's noise as it comes, of one model that has every term that is projected."""
    model = dict(models())["all"]
    longest = round(RATE_HZ * PLAYED_HORIZON_S)
    m = sorted({max(1, round(longest * 2.0**(-k / 2.0))) for k in range(20)})
    random = np.random.default_rng(12)
    with KeptFolder() as name:
        folder = pathlib.Path(name)
        path, out = folder / "a.model.json", folder / "out"
        path.write_text(json.dumps(model))
        play_snippet(program, folder)
        ours = list(gyrologs_curve(program, folder, path, m))
        for axis, (variance, error) in zip("xyz", ours):
            off = np.abs(variance - model_variance(model, axis, m, False)) / error
            assert np.max(off) < STANDARD_ERRORS, f"gyrolog, {axis}: {off.round(1)} standard errors"
        for simulator, read in READERS.items():
            subprocess.run([program, "export", path, "-o", out, "--for", simulator, "--horizon",
                            f"{PLAYED_HORIZON_S:g}s"], check=True, capture_output=True)
            text = out.read_text()
            stated = stated_errors(text)
            worst, played = [], {}  # some have one formula for all axes
            for axis, (_, white, drift), (variance, error) in zip("xyz", read(text), ours):
                if drift not in played:
                    played[drift] = played_variance(white, drift, m, random)
                found, found_error = played[drift]
                off = np.abs(found - simulated_variance(white, drift, m)) / found_error
                assert np.max(off) < STANDARD_ERRORS, f"{simulator}, {axis}: {off.round(1)} standard errors"
                assert np.max(found_error / found) < 0.015, "too few sensors: 0.065 dB are wanted"
                worst.append(np.max(np.abs(dB(found / model_variance(model, axis, m, simulator in ROUNDING)))))
                # gyrolog's own curve, which chance has moved.
                limit = max(stated) + TOLERANCE_DB + dB(1.0 + STANDARD_ERRORS * error / variance)
                beside = np.abs(dB(found / variance))
                assert np.all(beside < limit), f"{simulator}, {axis}: {beside.round(2)} dB of {limit.round(2)}"
            true = worst if len(stated) == 3 else [max(worst)]
            assert all(abs(said - one) < TOLERANCE_DB for said, one in zip(stated, true)), (simulator, stated, true)
            print(f"{simulator:13} stated {stated} dB, played {np.round(true, 2)} dB")


def check_webots(text, model):
    lsb = float(re.search(r"^  resolution (\S+)", text, re.M).group(1))
    assert math.isclose(lsb, model["lsb_dps"] * DEG, rel_tol=1e-8)
    ends = [float(number) for number in re.search(r"lookupTable \[ (.*) \]", text).group(1).replace(",", "").split()]
    full = model["full_scale_dps"] * DEG
    assert np.allclose(ends, [-full, -full, 0.0, full, full, 0.0], rtol=1e-8)
    assert "no noise" in text


def main():
    program = sys.argv[1]
    if sys.argv[2:] == ["play"]:
        play(program)
        return
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    horizons = [float(one) for one in sys.argv[3:]] or [100.0]
    done = 0
    with KeptFolder() as folder:
        path, out = pathlib.Path(folder, "a--model.json"), pathlib.Path(folder, "out")
        for name, model in list(models())[:count]:
            path.write_text(json.dumps(model))
            for horizon_s in horizons:
                for simulator in [*READERS, "webots"]:
                    if simulator == "webots" and model["lsb_dps"] == 0.0:
                        continue
                    subprocess.run([program, "export", path, "-o", out, "--for", simulator, "--horizon",
                                    f"{horizon_s:g}s"], check=True, capture_output=True)
                    text = out.read_text()
                    if simulator == "webots":
                        check_webots(text, model)
                    else:
                        worst = check(name, simulator, model, horizon_s, text)
                        print(f"{name:18} {horizon_s:6g} s {simulator:13} {worst:6.2f} dB")
                    done += 1
        refused = subprocess.run([program, "export", path, "-o", out, "--for", "nothing"], capture_output=True,
                                 text=True)
        assert refused.returncode == 2 or refused.returncode == 1, refused
        assert "gnss-ins-sim" in refused.stderr, refused.stderr
    assert done >= len(READERS) + 1, done


if __name__ == "__main__":
    main()
