"""Debian's stock kernel, taken out of its package without installing it."""

import os
import re
import shutil
import subprocess
from pathlib import Path


class Unavailable(Exception):
    """Something the tests need cannot be had on this machine; the message says what and how to get it."""


def tool(name):
    """The path of a program; the administrator's folders are searched too, for users who do not have them in PATH."""
    path = shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
    if path is None:
        raise Unavailable(f"{name} is not installed")
    return path


def _package_name():
    """The package that Debian's linux-image-amd64 stands for today, such as linux-image-6.1.0-56-amd64."""
    answer = subprocess.run([tool("apt-cache"), "depends", "linux-image-amd64"], capture_output=True, text=True, check=False)
    match = re.search(r"Depends: (linux-image-\S+-amd64)\s*$", answer.stdout, re.MULTILINE)
    if match is None:
        raise Unavailable("apt knows no linux-image-amd64 (run apt-get update, or set GYROLOG_KERNEL_PACKAGE)")
    return match.group(1)


def _package_file(cache):
    """GYROLOG_KERNEL_PACKAGE, or a package already in the cache, or one downloaded into it."""
    given = os.environ.get("GYROLOG_KERNEL_PACKAGE")
    if given:
        if not Path(given).is_file():
            raise Unavailable(f"GYROLOG_KERNEL_PACKAGE: no such file: {given}")
        return Path(given).resolve()
    cached = sorted(cache.glob("linux-image-*.deb"))
    if cached:
        return cached[-1]
    name = _package_name()
    download = subprocess.run([tool("apt-get"), "download", "--quiet", name], cwd=cache, capture_output=True, text=True,
                              check=False)
    cached = sorted(cache.glob("linux-image-*.deb"))
    if download.returncode != 0 or not cached:
        raise Unavailable(f"cannot download {name}: {download.stderr.strip()}")
    return cached[-1]


class Kernel:
    """An unpacked kernel package: the image to boot and the modules that go with it."""

    def __init__(self, tree):
        self.image = next(tree.glob("boot/vmlinuz-*"))
        self.modules = next(tree.glob("lib/modules/*"))
        self.release = self.modules.name

    def module_files(self, names):
        """Each named module and all it depends on, dependencies first, relative to `modules`. Built-in ones have no
        file and are left out."""
        files = {}
        for line in (self.modules / "modules.dep").read_text().splitlines():
            file, _, needs = line.partition(":")
            files[_module_name(file)] = [file] + needs.split()
        builtin = {_module_name(line) for line in (self.modules / "modules.builtin").read_text().splitlines()}
        ordered = []
        for name in names:
            if name in builtin:
                continue
            if name not in files:
                raise Unavailable(f"kernel {self.release} has no module {name}")
            # modules.dep names a module's dependencies nearest first; loading goes the other way round.
            ordered += [file for file in reversed(files[name]) if file not in ordered]
        return ordered


def _module_name(file):
    return Path(file).name.split(".")[0].replace("-", "_")


def obtain(cache):
    """Unpacks the kernel into `cache` unless that was done before."""
    cache.mkdir(parents=True, exist_ok=True)
    package = _package_file(cache)
    tree = cache / package.stem
    if not (tree / "complete").exists():
        shutil.rmtree(tree, ignore_errors=True)
        subprocess.run([tool("dpkg-deb"), "-x", package, tree], check=True)
        release = next(tree.glob("lib/modules/*")).name
        subprocess.run([tool("depmod"), "-b", tree, release], check=True)
        (tree / "complete").touch()
    return Kernel(tree)
