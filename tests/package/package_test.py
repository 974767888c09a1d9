#!/usr/bin/env python3
"""Makes the Debian package of a build and looks at it: what lintian says, what it asks for, what is in it.

    package_test.py CPACK CONFIG PROGRAM VERSION
"""

import gzip
import pathlib
import re
import subprocess
import sys
import tempfile

FILES = {
    "usr/bin/gyrolog": "-rwxr-xr-x",
    "usr/include/gyrolog_sensor.h": "-rw-r--r--",
    "usr/lib/cmake/gyrolog-sensor/gyrolog-sensor-config-version.cmake": "-rw-r--r--",
    "usr/lib/cmake/gyrolog-sensor/gyrolog-sensor-config.cmake": "-rw-r--r--",
    "usr/lib/cmake/gyrolog-sensor/gyrolog-sensor-config-release.cmake": "-rw-r--r--",
    "usr/lib/libgyrolog-sensor.so": "lrwxrwxrwx",
    "usr/lib/libgyrolog-sensor.so.0": "lrwxrwxrwx",
    "usr/lib/libgyrolog-sensor.so.VERSION": "-rw-r--r--",
    "usr/lib/pkgconfig/gyrolog-sensor.pc": "-rw-r--r--",
    "usr/lib/python3/dist-packages/gyrolog_sensor.py": "-rw-r--r--",
    "usr/lib/udev/rules.d/60-gyrolog.rules": "-rw-r--r--",
    "usr/share/lintian/overrides/gyrolog": "-rw-r--r--",
    "usr/lib/MULTIARCH/wireshark/extcap/gyrolog": "-rwxr-xr-x",
    "usr/lib/MULTIARCH/wireshark/plugins/gyrolog.lua": "-rw-r--r--",
    **{f"usr/share/gyrolog/schemas/gyrolog-{name}.schema.json": "-rw-r--r--" for name in (
        "analysis-1", "calibration-1", "capture-1", "check-1", "checkpoint-1", "compare-1", "conform-1",
        "datasheet-1", "denoise-1", "diagnosis-2", "doctor-1", "effect-1", "effects-1", "filter-tuning-1",
        "gyroparams-1", "info-1", "list-1", "mark-1", "model-1", "population-1", "recover-1", "simulate-1", "unanswered-line")},
    "usr/share/bash-completion/completions/gyrolog": "-rw-r--r--",
    "usr/share/zsh/vendor-completions/_gyrolog": "-rw-r--r--",
    "usr/share/fish/vendor_completions.d/gyrolog.fish": "-rw-r--r--",
    "usr/share/man/man1/gyrolog.1.gz": "-rw-r--r--",
    **{f"usr/share/man/man1/gyrolog-{name}.1.gz": "-rw-r--r--" for name in (
        "analyze", "calibrate", "capture", "check", "compare", "completion", "conform", "denoise", "diagnose", "doctor",
        "export", "extcap", "info", "list", "manual", "recover", "report", "simulate", "table")},
    "usr/share/doc/gyrolog/README.md": "-rw-r--r--",
    "usr/share/doc/gyrolog/tools/readme.png": "-rw-r--r--",
    **{f"usr/share/doc/gyrolog/{name}.md": "-rw-r--r--" for name in (
        "analysis/METHODS", "firmware_protocol/DESIGN", "firmware_protocol/README", "firmware_protocol/SPEC",
        "firmware_protocol/USB_ID", "host/DESIGN", "host/capture/FORMAT", "host/formats/MODEL", "tools/fleet/README")},
    "usr/share/doc/gyrolog/host/formats/schemas": "lrwxrwxrwx",
    "usr/share/doc/gyrolog/host/sensor/examples": "lrwxrwxrwx",
    "usr/share/doc/gyrolog/tools/fleet/gyrolog.condor": "-rw-r--r--",
    "usr/share/doc/gyrolog/tools/fleet/kubernetes_job.yaml": "-rw-r--r--",
    **{f"usr/share/doc/gyrolog/tools/fleet/{name}": "-rwxr-xr-x" for name in (
        "cost", "over_hosts", "prepare", "slurm_collect", "slurm_submit", "slurm_task")},
    "usr/share/doc/gyrolog/examples/README.md": "-rw-r--r--",
    "usr/share/doc/gyrolog/examples/gyro_world.sdf": "-rw-r--r--",
    "usr/share/doc/gyrolog/examples/imu.model.json": "-rw-r--r--",
    "usr/share/doc/gyrolog/examples/made_up_flight.py": "-rw-r--r--",
    "usr/share/doc/gyrolog/examples/mujoco_gyro.c": "-rw-r--r--",
    "usr/share/doc/gyrolog/examples/tumbling_body.xml": "-rw-r--r--",
    "usr/share/doc/gyrolog/changelog.Debian.gz": "-rw-r--r--",
    "usr/share/doc/gyrolog/copyright": "-rw-r--r--",
}


def output_of(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    return done.stdout


def main():
    cpack, config, program, version = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        output_of(cpack, "--config", config, "-B", folder)
        package, = pathlib.Path(folder).glob("*.deb")
        print(output_of("lintian", "--allow-root", "--fail-on", "error,warning", str(package)), end="")

        def field(name):
            return output_of("dpkg-deb", "--field", str(package), name).strip()

        architecture = output_of("dpkg", "--print-architecture").strip()
        assert package.name == f"gyrolog_{field('Version')}_{architecture}.deb", package.name
        assert field("Package") == "gyrolog" and field("Architecture") == architecture
        assert field("Version").startswith(f"{version}-"), field("Version")
        assert field("Section") == "science" and field("Priority") == "optional"
        assert re.fullmatch(r".+ <\S+@\S+>", field("Maintainer")), field("Maintainer")
        assert len(field("Description").splitlines()) > 3, field("Description")
        needed = {re.split(r"[ (]", one)[0] for one in field("Depends").split(", ")}
        for name in ("fonts-dejavu-core", "libc6", "libstdc++6", "libusb-1.0-0"):
            assert name in needed, f"{name} is not in {sorted(needed)}"
        assert not any(name.endswith("-dev") for name in needed), sorted(needed)

        listed = (line.split() for line in output_of("dpkg-deb", "--contents", str(package)).splitlines())
        found = {entry[5].removeprefix("./"): (entry[0], entry[1]) for entry in listed if not entry[0].startswith("d")}
        multiarch = output_of("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()
        expected = {path.replace("VERSION", version).replace("MULTIARCH", multiarch): (mode, "root/root")
                    for path, mode in FILES.items()}
        assert found == expected, found

        tree = pathlib.Path(folder, "tree")
        output_of("dpkg-deb", "--extract", str(package), str(tree))
        installed = tree / "usr/bin/gyrolog"
        assert output_of(str(installed), "--version") == output_of(program, "--version")
        assert ".symtab" not in output_of("readelf", "--wide", "--sections", str(installed)), "not stripped"

        commands = re.search(r"Subcommands:\n(.*)", output_of(program, "--help"), re.DOTALL).group(1)
        names = re.findall(r"^  ([a-z]+) ", commands, re.MULTILINE)
        assert "capture" in names, commands
        manual = gzip.decompress((tree / "usr/share/man/man1/gyrolog.1.gz").read_bytes()).decode()
        described = re.findall(r"^\.TP\n\.B ([a-z]+)$", manual, re.MULTILINE)
        assert described == names, f"the manual page has {described}, the program {names}"

        documents = tree / "usr/share/doc/gyrolog"
        linked = re.findall(r"\]\(([^)#:]+)[^)]*\)", (documents / "README.md").read_text())
        assert len(linked) > 8, linked
        lacking = sorted({one for one in linked if not (documents / one).exists()})
        assert not lacking, f"README.md refers to {lacking}, which are not beside it"

        # That they do there what they are for: wireshark_test.py.
        folders = output_of("tshark", "-G", "folders")
        for name, inside in (("Global Lua Plugins", "plugins"), ("Extcap path", "extcap")):
            looked_in = re.search(rf"^{name}:\s+(\S+)", folders, re.MULTILINE).group(1)
            assert looked_in == f"/usr/lib/{multiarch}/wireshark/{inside}", f"{name}: {looked_in}"


if __name__ == "__main__":
    main()
