"""Unicorn, from the interpreter that has it: Debian's belongs to Debian's python, which need not come first."""

import os
import sys

SKIPPED = 77

try:
    import unicorn  # noqa: F401
except ImportError:
    _system = "/usr/bin/python3"
    if os.path.exists(_system) and os.path.realpath(sys.executable) != os.path.realpath(_system):
        os.execv(_system, [_system, "-B"] + sys.argv)
    print("skipped: needs Unicorn (Debian: python3-unicorn)")
    sys.exit(SKIPPED)
