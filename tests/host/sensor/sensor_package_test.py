#!/usr/bin/env python3
"""Installs the library as `cmake --install` does and builds a program in C with it, by pkg-config and by CMake.

    sensor_package_test.py CMAKE BUILD_FOLDER C_COMPILER
"""

import pathlib
import os
import subprocess
import sys
import tempfile

PROGRAM = r"""
#include <gyrolog_sensor.h>
#include <math.h>
#include <stdio.h>

int main(int argc, char **argv) {
    char why[8];
    gyrolog_sensor *sensor = gyrolog_sensor_open(argc > 1 ? argv[1] : NULL, 1, 0.0, why, sizeof why);
    if (sensor == NULL) {
        printf("%s|%s\n", why, gyrolog_sensor_version());
        return 3;
    }
    gyrolog_sensor_close(sensor);
    return 0;
}
"""
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C)
find_package(gyrolog-sensor 0.1 REQUIRED)
add_executable(user main.c)
target_link_libraries(user PRIVATE gyrolog::gyrolog-sensor)
"""


def output_of(*command, env=None, codes=(0,)):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, env=env)
    assert done.returncode in codes, f"{command}: {done.stdout}{done.stderr}"
    return done.stdout


def main():
    cmake, build, compiler = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        prefix, user = pathlib.Path(folder, "prefix"), pathlib.Path(folder, "user")
        output_of(cmake, "--install", build, "--prefix", prefix)
        libraries = next(path.parent for path in prefix.rglob("libgyrolog-sensor.so"))
        run = {**os.environ, "LD_LIBRARY_PATH": str(libraries)}
        user.mkdir()
        (user / "main.c").write_text(PROGRAM)
        (user / "CMakeLists.txt").write_text(PROJECT)

        search = {**os.environ, "PKG_CONFIG_PATH": str(libraries / "pkgconfig")}
        flags = output_of("pkg-config", "--cflags", "--libs", "gyrolog-sensor", env=search).split()
        output_of(compiler, "-std=c11", "-Wall", "-Wextra", "-Werror", "-pedantic", user / "main.c", "-o",
                  user / "by_pkg_config", *flags)
        # The reason is cut to the caller's room.
        said = output_of(user / "by_pkg_config", env=run, codes=(3,))
        assert said.startswith("no path|0."), said

        output_of(cmake, "-S", user, "-B", user / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
                  f"-DCMAKE_C_COMPILER={compiler}", "-DCMAKE_BUILD_TYPE=Release")
        output_of(cmake, "--build", user / "build")
        assert output_of(user / "build/user", env=run, codes=(3,)) == said


if __name__ == "__main__":
    main()
