#!/usr/bin/env python3
"""The source with the commit's name: what stands in it, and that it is only written when that changes.

    revision_test.py CMAKE SCRIPT
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

# Nobody's own settings, and no repository but those made here.
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
ENVIRONMENT |= {"GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_SYSTEM": "/dev/null", "GIT_AUTHOR_NAME": "a",
                "GIT_AUTHOR_EMAIL": "a@example.org", "GIT_COMMITTER_NAME": "a", "GIT_COMMITTER_EMAIL": "a@example.org"}


def main():
    cmake, script = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        tree = pathlib.Path(folder, "tree")
        tree.mkdir()
        output = pathlib.Path(folder, "program_revision.cpp")

        def git(*arguments):
            subprocess.run(["git", "-C", str(tree), *arguments], check=True, capture_output=True, env=ENVIRONMENT)

        def revision(source=tree):
            subprocess.run([cmake, f"-DSOURCE={source}", f"-DOUTPUT={output}", "-P", script], check=True,
                           env=ENVIRONMENT)
            return re.search(r'program_revision = "(.*)";', output.read_text()).group(1)

        def expect(form, source=tree):
            told = revision(source)
            assert re.fullmatch(form, told), f"'{told}' is not of the form {form}"

        expect("")  # an unpacked archive
        git("init")
        (tree / "inner").mkdir()
        (tree / "file").write_text("1")
        git("add", "file")
        git("commit", "-m", "one")
        expect("[0-9a-f]{7,40}")
        expect("", tree / "inner")  # an archive inside of another repository
        git("tag", "v0.1.0")
        git("tag", "nightly")
        expect(r"v0\.1\.0")
        git("commit", "--allow-empty", "-m", "two")
        expect(r"v0\.1\.0-1-g[0-9a-f]{7,40}")

        os.utime(output, ns=(1, 1))
        revision()
        assert output.stat().st_mtime_ns == 1, "the same answer was written again"
        (tree / "file").write_text("2")
        expect(r"v0\.1\.0-1-g[0-9a-f]{7,40}-dirty")
        assert output.stat().st_mtime_ns != 1


if __name__ == "__main__":
    main()
