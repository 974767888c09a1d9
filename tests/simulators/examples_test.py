#!/usr/bin/env python3
"""Runs the examples as their README tells: installed, copied, line by line; and once more with a sensor that is not
the model's, which has to be seen.

    examples_test.py CMAKE BUILD_FOLDER C_COMPILER
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "blind"))
import numbers_or_skip  # noqa: E402, F401  it may start another interpreter
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from schemas import KeptFolder  # noqa: E402

# What `compare` says of an axis on which nothing differs: of a model, of a recording.
SAME = (re.compile(r"^[xyz]: the recording differs no more than simulations do among themselves$", re.M),
        re.compile(r"^[xyz]: the recordings differ no more than their uncertainty allows$", re.M))
GAZEBO = "A world for Gazebo"


def output_of(command, **more):
    done = subprocess.run(command, capture_output=True, text=True, **more)
    assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    return done.stdout


def sections(readme):
    """The lines to type below each heading."""
    return {title: block.splitlines()
            for title, block in re.findall(r"^## ([^\n]+)$.*?^```sh\n(.*?)^```$", readme, re.M | re.S)}


def environment(prefix, compiler, folder):
    """As where the tree is installed: program, library and module are found."""
    libraries = next(path.parent for path in prefix.rglob("libgyrolog-sensor.so"))
    module = next(path.parent for path in prefix.rglob("gyrolog_sensor.py"))
    (folder / "cc").symlink_to(shutil.which(compiler))
    (folder / "python3").symlink_to(sys.executable)
    return {**os.environ, "PATH": f"{folder}:{prefix}/bin:{os.environ['PATH']}", "LD_LIBRARY_PATH": str(libraries),
            "LIBRARY_PATH": str(libraries), "PKG_CONFIG_PATH": str(libraries / "pkgconfig"), "PYTHONPATH": str(module),
            "PYTHONDONTWRITEBYTECODE": "1"}


def noisier(path):
    """The model again, a fifth too noisy."""
    model = json.loads(path.read_text())
    for axis in model["axes"].values():
        axis["N"] *= 1.2
    other = path.with_name("noisier." + path.name)
    other.write_text(json.dumps(model))
    return other


def main():
    cmake, build, compiler = sys.argv[1:]
    with KeptFolder() as name:
        folder = pathlib.Path(name)
        prefix, work, tools = folder / "prefix", folder / "examples", folder / "tools"
        output_of([cmake, "--install", build, "--prefix", prefix])
        shutil.copytree(prefix / "share/doc/gyrolog/examples", work)
        tools.mkdir()
        settings = {"cwd": work, "env": environment(prefix, compiler, tools)}

        def typed(line):
            return output_of(line, shell=True, **settings)

        todo = sections((work / "README.md").read_text())
        assert len(todo) == 3 and all(len(lines) == 3 for lines in todo.values()), todo
        for title, lines in todo.items():
            if title == GAZEBO:  # read by simulator_sdformat_test
                typed(lines[0])
                continue
            if "mujoco" in lines[0] and not pathlib.Path("/usr/include/mujoco/mujoco.h").exists():
                print("skipped: needs libmujoco-dev")
                continue
            said = "".join(typed(line) for line in lines)
            alike = [len(pattern.findall(said)) for pattern in SAME]
            assert alike == ([3, 0] if "MuJoCo" in title else [3, 3]), f"{title}: {alike} in\n{said}"
            recording, model = ("tumbling.csv", "imu.model.json") if "MuJoCo" in title else (
                "flight.csv", "bench.model.json")
            said = output_of(["gyrolog", "compare", recording, noisier(work / model)], **settings)
            assert said.count("the simulation is too noisy by") >= 3, said
            print(f"{title}: the sensor of its model, and of no other")


if __name__ == "__main__":
    main()
