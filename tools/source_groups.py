#!/usr/bin/env python3
"""Sources that can be compiled as one text, because no two of a group declare the same local name.

Headers take most of the time of compilers and checkers; sources that share them are quicker together.

usage: tools/source_groups.py DIRECTORY SOURCE...     writes the texts there; prints what to compile, ;-separated
"""
import re
import subprocess
import sys
from pathlib import Path

SOURCES_A_GROUP = 12
ROOT = Path(__file__).resolve().parent.parent

# What stands at the beginning of a line in this layout is declared in a namespace's own scope.
TYPE = r"^(?:struct|class|union|enum(?: class)?|using) (?:[\w:]+::)?(\w+)"
NAMED = r"^(?!return |template|using|struct|class|enum|TEST)[\w\[][\w:<>,&*\[\] ]*[ &*](\w+)"
TYPES_AND_VALUES = re.compile(TYPE + "|" + NAMED + "(?: = |[{;])", re.MULTILINE)
FUNCTIONS_AND_TESTS = re.compile(NAMED + r"\(|^TEST\w*\((\w+, \w+)\)", re.MULTILINE)
LOCAL = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
ONCE_A_PROGRAM = ("int main(", "LLVMFuzzerTestOneInput(")


def names(pattern, text):
    return {name for found in pattern.findall(text) for name in found if name}


def tracked(*patterns):
    return subprocess.run(["git", "ls-files", "--", *patterns], capture_output=True, text=True, check=True,
                          cwd=ROOT).stdout.split()


def groups_of(sources):
    """Groups of C++ sources; one whose local types or values have a name that a header declares is alone."""
    headers = "\n".join((ROOT / header).read_text() for header in tracked("*.hpp", "*.h"))
    of_headers = names(TYPES_AND_VALUES, headers) | names(FUNCTIONS_AND_TESTS, headers)
    groups = []  # with their names
    alone = []
    for source in sources:
        text = (ROOT / source).read_text()
        local = "".join(LOCAL.findall(text))
        values = names(TYPES_AND_VALUES, local)
        own = values | names(FUNCTIONS_AND_TESTS, local) | {once for once in ONCE_A_PROGRAM if once in text}
        if values & of_headers:
            alone.append([source])
            continue
        group = next((group for group in groups if len(group[0]) < SOURCES_A_GROUP and not group[1] & own), None)
        if group is None:
            group = ([], set())
            groups.append(group)
        group[0].append(source)
        group[1].update(own)
    return [group for group, _ in groups] + alone


def write_group(directory, group):
    """The text that includes the sources of a group."""
    joined = Path(directory) / f"{'_'.join(Path(group[0]).with_suffix('').parts[-3:])}_and_{len(group) - 1}_more.cpp"
    text = "".join(f'#include "{ROOT / source}"\n' for source in group)
    if not joined.exists() or joined.read_text() != text:
        joined.write_text(text)
    return joined


def main():
    directory = Path(sys.argv[1])
    directory.mkdir(parents=True, exist_ok=True)
    sources = [Path(name).relative_to(ROOT) for name in sys.argv[2:]]
    groups = groups_of([source for source in sources if source.suffix == ".cpp"])
    compiled = [write_group(directory, group) if len(group) > 1 else ROOT / group[0] for group in groups]
    compiled += [ROOT / source for source in sources if source.suffix != ".cpp"]
    print(";".join(str(file) for file in compiled), end="")


if __name__ == "__main__":
    main()
