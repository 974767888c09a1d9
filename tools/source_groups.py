#!/usr/bin/env python3
"""Sources that can be compiled as one text, because no two of a group declare the same local name.

Headers take most of the time of compilers and checkers; sources that share them are quicker together.

usage: tools/source_groups.py DIRECTORY

DIRECTORY/targets.txt has a line for each target, with tabs between its name, the most lines of a group, and its sources
as whole paths.
Writes the texts below DIRECTORY/NAME, and prints likewise for each target its name and what to compile.
"""
import math
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
INCLUDE_FOLDERS = (Path("."), Path("firmware_protocol/include"))
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)

# What stands at the beginning of a line in this layout is declared in a namespace's own scope.
TYPE = r"^(?:struct|class|union|enum(?: class)?|using) (?:[\w:]+::)?(\w+)"
NAMED = r"^(?!return |template|using|struct|class|enum|TEST)[\w\[][\w:<>,&*\[\] ]*[ &*](\w+)"
TYPES_AND_VALUES = re.compile(TYPE + "|" + NAMED + r"(?: = |[{;\[])", re.MULTILINE)
ALIASES = re.compile(r"^using (?:[\w:]*::)?(\w+)([^;]*);", re.MULTILINE)
FUNCTIONS = re.compile(NAMED + r"\(([^()]*)", re.MULTILINE)
TESTS = re.compile(r"^TEST\w*\((\w+, \w+)\)", re.MULTILINE)
CLASS = re.compile(r"(?<![\w:])[A-Z]\w*")  # in this project's spelling
DEFINED_TYPES = re.compile(r"^(?:struct|class|union|enum(?: class)?) (\w+)[^;\n]*\{", re.MULTILINE)
LOCAL = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
FOR_OTHERS = re.compile(r"^(?:extern )?const [\w:<>,&*\[\] ]*[ &*](\w+)(?: = |[{\[])", re.MULTILINE)
ONCE_A_PROGRAM = ("int main(", "LLVMFuzzerTestOneInput(")


def names(pattern, text):
    return {name for found in pattern.findall(text) for name in found if name}


def tracked(*patterns):
    return subprocess.run(["git", "ls-files", "--", *patterns], capture_output=True, text=True, check=True,
                          cwd=ROOT).stdout.split()


class Tree:
    """The texts below a folder, each read once."""

    def __init__(self, root):
        self.root = root
        self.texts = {}
        self.direct = {}
        self.names_of_headers = {}

    def text(self, path):
        if path not in self.texts:
            self.texts[path] = (self.root / path).read_text()
        return self.texts[path]

    def included_by(self, path, folders):
        if (path, folders) not in self.direct:
            found = []
            for quote, name in INCLUDE.findall(self.text(path)):
                near = (path.parent,) if quote == '"' else ()
                places = (Path(os.path.normpath(folder / name)) for folder in near + folders)
                found += [place for place in places if (self.root / place).is_file()][:1]
            self.direct[path, folders] = found
        return self.direct[path, folders]

    def headers(self, path, folders=INCLUDE_FOLDERS, forced=()):
        """The headers below the root that a source includes, also through others, and those that an #if leaves out."""
        found = set(forced)
        to_read = [path, *forced]
        while to_read:
            new = set(self.included_by(to_read.pop(), folders)) - found
            found |= new
            to_read += new
        return found

    def names_of_header(self, path):
        """What a header declares, and which types it defines."""
        if path not in self.names_of_headers:
            text = self.text(path)
            self.names_of_headers[path] = (names(TYPES_AND_VALUES, text) | {name for name, _ in FUNCTIONS.findall(text)},
                                           set(DEFINED_TYPES.findall(text)))
        return self.names_of_headers[path]


def classes_of(parameters):
    """Of each parameter the class of this project, or None."""
    found = [CLASS.search(parameter) for parameter in parameters.split(",")]
    return tuple(name and name.group() for name in found)


def are_overloads(some, others):
    """Whether no call can mean one of these functions as well as one of those: two classes stand in the same place."""
    return all(any(a and b and a != b for a, b in zip(one, other)) for one in some for other in others)


class Joined:
    """Sources that go together, or a single one, with what must differ between those that do."""

    def __init__(self, tree, source):
        text = tree.text(source)
        local = "".join(LOCAL.findall(text))
        self.sources = [source]
        self.lines = text.count("\n")
        self.aliases = dict(ALIASES.findall(local))
        self.values = names(TYPES_AND_VALUES, local)
        self.own = set(TESTS.findall(local)) | {once for once in ONCE_A_PROGRAM if once in text}
        self.own |= names(FOR_OTHERS, LOCAL.sub("", text))  # two that define one are of two programs
        self.functions = {}  # with the classes of their parameters
        for name, parameters in FUNCTIONS.findall(local):
            self.functions.setdefault(name, set()).add(classes_of(parameters))
        self.of_headers = set()
        self.types = {}  # with the header that defines each
        for header in tree.headers(source):
            declared, types = tree.names_of_header(header)
            self.of_headers |= declared
            self.types.update(dict.fromkeys(types, header))

    def fits(self, other):
        return not (self.own & other.own
                    or any(name not in self.aliases or self.aliases[name] != other.aliases.get(name)
                           for name in self.values & other.values)
                    or self.values & other.functions.keys() or self.functions.keys() & other.values
                    or any(not are_overloads(self.functions[name], other.functions[name])
                           for name in self.functions.keys() & other.functions.keys())
                    or self.values & other.of_headers or self.of_headers & other.values
                    or any(other.types.get(name, header) != header for name, header in self.types.items()))

    def add(self, other):
        self.sources += other.sources
        self.lines += other.lines
        self.aliases.update(other.aliases)
        self.values |= other.values
        self.own |= other.own
        for name, parameters in other.functions.items():
            self.functions.setdefault(name, set()).update(parameters)
        self.of_headers |= other.of_headers
        self.types.update(other.types)


def groups_of(sources, lines_most, tree=None):
    """Groups of C++ sources in which no local name is there twice or declared by a header that one of them includes.

    Of a length, where names permit: a short last group would read the headers for little, and a long one be waited for.
    """
    tree = tree or Tree(ROOT)
    each = [Joined(tree, source) for source in sources]
    lines = sum(one.lines for one in each)
    equal_lines = lines / max(1, math.ceil(lines / lines_most))
    # A group that has no room for the longest source is full: as many groups as it must be are enough.
    lines_most = min(lines_most, equal_lines + max((one.lines for one in each), default=0))
    groups = []
    for one in each:
        group = next((group for group in groups if group.lines + one.lines <= lines_most and group.fits(one)), None)
        if group:
            group.add(one)
        else:
            groups.append(one)
    return [group.sources for group in groups]


def write_group(directory, group):
    """The text that includes the sources of a group."""
    joined = Path(directory) / f"{'_'.join(Path(group[0]).with_suffix('').parts[-3:])}_and_{len(group) - 1}_more.cpp"
    text = "".join(f'#include "{source}"\n' for source in group)  # the same text in every clone
    if not joined.exists() or joined.read_text() != text:
        joined.write_text(text)
    return joined


def what_to_compile(directory, tree, sources, lines_most):
    directory.mkdir(parents=True, exist_ok=True)
    groups = groups_of([source for source in sources if source.suffix == ".cpp"], lines_most, tree)
    compiled = [write_group(directory, group) if len(group) > 1 else ROOT / group[0] for group in groups]
    return compiled + [ROOT / source for source in sources if source.suffix != ".cpp"]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = Path(sys.argv[1])
    tree = Tree(ROOT)
    for target in (directory / "targets.txt").read_text().splitlines():
        name, lines, *sources = target.split("\t")
        sources = [Path(source).relative_to(ROOT) for source in sources]
        print(name, *what_to_compile(directory / name, tree, sources, int(lines)), sep="\t")


if __name__ == "__main__":
    main()
