"""Packages of npm's registry that tests use, for what Debian does not have."""

import json
import shutil
import subprocess
import sys

INSTALL_S = 120
SKIPPED = 77


def skip(reason):
    """Ends a test of ctest's as skipped."""
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def installed(folder, package, version):
    """The package's folder below `folder`: from the registry once, then as it is. No script of it is run. Where npm or its
    registry is out of reach, the test ends as skipped."""
    place = folder / "node_modules" / package
    description = place / "package.json"
    if description.exists() and json.loads(description.read_text())["version"] == version:
        return place
    if shutil.which("npm") is None or shutil.which("node") is None:
        skip("needs npm")
    folder.mkdir(parents=True, exist_ok=True)
    try:
        done = subprocess.run(["npm", "install", "--prefix", folder, "--no-audit", "--no-fund", "--ignore-scripts",
                               "--no-save", "--fetch-retries=1", f"{package}@{version}"], capture_output=True,
                              text=True, timeout=INSTALL_S, check=False)
    except subprocess.TimeoutExpired:
        skip("needs npm's registry, which does not answer")
    if done.returncode != 0:
        print(done.stderr)
        skip("needs npm's registry")
    return place
