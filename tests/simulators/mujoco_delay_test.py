#!/usr/bin/env python3
"""What is written for MuJoCo from 3.5 on, by a MuJoCo that has delay and interval: npm's, which is MuJoCo itself as
WebAssembly. The gyro of the file as it is shows the true rate; the element that the file's comment has for newer
versions shows it late, and once a period.

    mujoco_delay_test.py GYROLOG FOLDER     the package is installed in FOLDER, which is made

Skipped where npm or its registry is out of reach.
"""

import json
import math
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from npm_package import installed  # noqa: E402
from schemas import KeptFolder  # noqa: E402

PACKAGE, VERSION = "@mujoco/mujoco", "3.14.0"
HERE = pathlib.Path(__file__).resolve().parent
RAMPS_RAD_S2 = (1.0, -2.0, 3.0)  # turned_gyro.mjs
STEP_S = 0.001
RATE_HZ = 100.0
LATENCY_S = 0.0234  # more than two periods
DURATION_S = 0.5


def exported(program, folder):
    model = {"schema": "gyrolog-model/1", "rate_hz": RATE_HZ, "full_scale_dps": 500.0, "latency_s": LATENCY_S,
             "axes": {axis: {"N": 0.01} for axis in "xyz"}}
    path, out = folder / "late.model.json", folder / "imu.xml"
    path.write_text(json.dumps(model))
    subprocess.run([program, "export", path, "-o", out, "--for", "mjcf"], check=True, capture_output=True)
    return out.read_text()


def shown(package, folder, text):
    """Times, and rates over the axis' ramp: the time that the gyro shows."""
    path = folder / "body.xml"
    path.write_text(text)
    done = subprocess.run(["node", HERE / "turned_gyro.mjs", package, path, str(DURATION_S)], capture_output=True,
                          text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    answer = json.loads(done.stdout.splitlines()[-1])
    assert answer["version"] == VERSION, answer["version"]
    return [(row[0], [value / ramp for value, ramp in zip(row[1:], RAMPS_RAD_S2)]) for row in answer["rows"]]


def for_newer_versions(text):
    """The file with the gyro of its comment, in a body of short steps."""
    late, = re.findall(r"^ *(<gyro .*\bdelay=.*/>)$", text[:text.index("<mujoco ")], re.M)
    head, body = text.split("<mujoco ", 1)
    body, gyros = re.subn(r"<gyro .*/>", late, body)
    body, options = re.subn(r'<option timestep="[^"]*"/>', f'<option timestep="{STEP_S}"/>', body)
    assert gyros == 1 and options == 1, text
    return head + "<mujoco " + body


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    package = installed(folder, PACKAGE, VERSION)
    with KeptFolder() as name:
        work = pathlib.Path(name)
        text = exported(program, work)
        rows = shown(package, work, text)
        assert len(rows) == round(DURATION_S * RATE_HZ), len(rows)
        for time_s, times_s in rows:
            assert all(math.isclose(one, time_s, abs_tol=1e-9) for one in times_s), (time_s, times_s)

        rows = shown(package, work, for_newer_versions(text))
        assert len(rows) == round(DURATION_S / STEP_S), len(rows)
        fresh = set()
        for time_s, times_s in rows:
            if time_s < 0.1:
                continue  # nothing was there to be shown late
            # The last sampling instant that is long enough ago.
            instant_s = math.floor((time_s - LATENCY_S) * RATE_HZ + 1e-6) / RATE_HZ
            assert all(math.isclose(one, instant_s, abs_tol=1e-9) for one in times_s), (time_s, instant_s, times_s)
            fresh.add(instant_s)
        assert len(fresh) >= round((DURATION_S - 0.1) * RATE_HZ), len(fresh)
        print(f"MuJoCo {VERSION}: {LATENCY_S * 1e3:g} ms late, {RATE_HZ:g} times a second")


if __name__ == "__main__":
    main()
