#!/usr/bin/env python3
"""Holds the recording of a sensor with flicker, a line and stale samples against a plain SDF, and reads the SDF that
comes back with another reader: it has what SDF can hold, and says what it cannot.

    simulator_diagnosis_test.py GYROLOG [with-slow-bias]

With a second word the SDF has a slow bias, too, as small as a user's who filled in something.
"""

import json
import math
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from schemas import KeptFolder  # noqa: E402

DEG = math.pi / 180.0
RATE_HZ = 100.0
N, B = 0.005, 0.004  # deg/s

PLAIN = """<?xml version="1.0"?>
<!-- The robot of our lab. -->
<sdf version="1.9">
  <model name="robot">
    <link name="base">
      <sensor name="lidar" type="gpu_lidar"><update_rate>10</update_rate></sensor>
      <sensor name="imu" type="imu">
        <update_rate>100</update_rate>  <!-- as the flight controller wants it -->
        <imu>
          <angular_velocity>
{axes}          </angular_velocity>
        </imu>
      </sensor>
    </link>
  </model>
</sdf>
"""
AXIS = """            <{axis}><noise type="gaussian"><mean>0</mean><stddev>{sd:.9g}</stddev>{slow}</noise></{axis}>
"""
# Too small to be seen.
SLOW = ("<dynamic_bias_stddev>1e-9</dynamic_bias_stddev>"
        "<dynamic_bias_correlation_time>300</dynamic_bias_correlation_time>")


def run(*arguments, code=0):
    done = subprocess.run([str(argument) for argument in arguments], capture_output=True, text=True)
    assert done.returncode == code, (arguments, done.returncode, done.stdout, done.stderr)
    return done


def plain_sdf(slow):
    axes = "".join(AXIS.format(axis=axis, sd=N * DEG * math.sqrt(RATE_HZ), slow=slow) for axis in "xyz")
    return PLAIN.format(axes=axes)


def real_sensor():
    axes = {axis: {"N": N, "B": B, "bias": bias} for axis, bias in (("x", 0.31), ("y", -0.12), ("z", 0.08))}
    return {"schema": "gyrolog-model/1", "rate_hz": RATE_HZ, "full_scale_dps": 500.0, "lsb_dps": 1 / 65.5, "axes": axes,
            "effects": [
                {"effect": "tone", "axes": ["y"], "params": {"f_hz": 17.3, "amplitude_dps": 0.02, "phase_rad": 0.4}},
                {"effect": "stale", "axes": ["x", "y", "z"], "params": {"eps": 0.1}}]}


def noise_of(path, axis):
    noise = ElementTree.parse(path).find(f".//sensor[@name='imu']/imu/angular_velocity/{axis}/noise")
    return noise.get("type"), {child.tag: float(child.text) for child in noise}


def gauss_markov_allan(sigma, T, tau):
    return 2 * sigma**2 * T / tau * (1 - T / (2 * tau) * (3 - 4 * math.exp(-tau / T) + math.exp(-2 * tau / T)))


def check_written(path, told):
    text = path.read_text()
    head = text[:text.index("<sdf")]
    for kept in ("<!-- The robot of our lab. -->", "<!-- as the flight controller wants it -->",
                 '<sensor name="lidar" type="gpu_lidar"><update_rate>10</update_rate></sensor>'):
        assert kept in text, kept
    for missing in ("bias instability B", "effect stale", "effect tone"):
        assert missing in head, (missing, head)
        assert missing in told, (missing, told)
    assert "Largest error of the Allan deviation" in told, told
    for axis, bias in (("x", 0.31), ("y", -0.12)):
        kind, noise = noise_of(path, axis)
        assert kind == "gaussian_quantized", kind
        assert math.isclose(noise["precision"], DEG / 65.5, rel_tol=1e-5)  # of counts in print, noise
        # Flicker of B has the Allan deviation 0.664 B: nearest to it, between 1 s and 100 s.
        T = noise["dynamic_bias_correlation_time"]
        sigma = noise["dynamic_bias_stddev"] * math.sqrt(T / 2)
        density = noise["stddev"] / math.sqrt(RATE_HZ)
        for tau in (1.0, 10.0, 100.0):
            written = math.sqrt(density**2 / tau + gauss_markov_allan(sigma, T, tau))
            wanted = math.sqrt((N * DEG)**2 / tau + 2 * math.log(2) / math.pi * (B * DEG)**2)
            assert abs(20 * math.log10(written / wanted)) < 3.0, (axis, tau, written / wanted, noise)


def check(gyrolog, folder, slow):
    plain, real, night = folder / "robot.sdf", folder / "real.json", folder / "night.csv"
    plain.write_text(plain_sdf(slow))
    real.write_text(json.dumps(real_sensor()))
    run(gyrolog, "simulate", real, "-o", night, "--duration", "10m", "--seed", "7")
    better, answer = folder / "better.sdf", folder / "d.json"
    done = run(gyrolog, "diagnose", night, "--model", plain, "--model-out", better, "--json", answer,
               "--simulations", "30")
    causes = {(cause["effect"], axis) for cause in json.loads(answer.read_text())["causes"] for axis in cause["axes"]}
    named = {effect for effect, _ in causes}
    assert named >= {"flicker_missing", "stale", "tone"}, causes
    assert named <= {"flicker_missing", "stale", "tone"}, causes
    assert ("tone", "y") in causes and ("stale", "x") in causes, causes
    assert "the model is taken from an imu sensor of SDF 'robot::base::imu'" in done.stdout, done.stdout
    check_written(better, done.stderr)
    return plain, better


def check_commands(gyrolog, folder, plain, better):
    """What was written is read like any other model, wherever one is."""
    night, whole = folder / "minute.csv", folder / "whole.json"
    run(gyrolog, "simulate", better, "-o", night, "--duration", "60s")
    run(gyrolog, "diagnose", night, "--model", plain, "--model-out", whole, "--simulations", "20")
    assert json.loads(whole.read_text())["schema"] == "gyrolog-model/1"
    assert "model is taken from an imu sensor of SDF" in run(gyrolog, "compare", night, better, "--simulations",
                                                             "20").stdout
    run(gyrolog, "simulate", better, "-o", folder / "s.pcapng", "--duration", "10s")
    run(gyrolog, "capture", "--device", f"sim:model={better}", "--duration", "2s", "-o", folder / "c.pcapng")
    run(gyrolog, "export", better, "-o", folder / "x.xml", "--for", "mjcf")
    run(gyrolog, "report", night, "--model", better, "-o", folder / "r.html", "--simulations", "20")
    done = run(gyrolog, "denoise", night, "--model", better, "-o", folder / "d.csv")
    assert "better.sdf: the model is taken from an imu sensor of SDF" in done.stdout + done.stderr, done
    for name, said in (("better.xyz", "write the same"), ("better.mjcf", "write the same"), ("better.yaml", "write the same")):
        assert said in run(gyrolog, "diagnose", night, "--model", plain, "--model-out", folder / name, code=2).stderr
    assert "are the same file" in run(gyrolog, "diagnose", night, "--model", f"{plain}#imu", "--model-out", plain,
                                      code=2).stderr
    assert "gyrolog export" in run(gyrolog, "diagnose", night, "--auto", "--model-out", folder / "auto.sdf",
                                   code=2).stderr


def main():
    gyrolog = pathlib.Path(sys.argv[1]).resolve()
    with KeptFolder() as name:
        folder = pathlib.Path(name)
        if len(sys.argv) > 2:
            check(gyrolog, folder, SLOW)
        else:
            check_commands(gyrolog, folder, *check(gyrolog, folder, ""))


if __name__ == "__main__":
    main()
