"""JSON that the program writes, held against the schemas that the package ships (host/formats/schemas), as
tests/support/schema_check.hpp does for the tests in C++."""

import functools
import json
import os
import pathlib
import sys
import tempfile

try:
    import jsonschema
except ImportError:  # Debian's belongs to Debian's python, which need not come first
    _system = "/usr/bin/python3"
    if not os.path.exists(_system) or os.path.realpath(sys.executable) == os.path.realpath(_system):
        sys.exit("needs jsonschema: apt-get install python3-jsonschema")
    os.execv(_system, [_system, "-B"] + sys.argv)

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "host/formats/schemas"
PREFIX = "gyrolog-"


@functools.cache
def validator(name):
    """Of "gyrolog-model/1"; None where there is no such schema."""
    path = FOLDER / f"{name.replace('/', '-')}.schema.json"
    return jsonschema.Draft7Validator(json.loads(path.read_text())) if path.exists() else None


def schema_name(document):
    """Empty: no document of gyrolog's."""
    if not isinstance(document, dict):
        return ""
    name = document.get("schema")
    if isinstance(name, str):
        return name if name.startswith(PREFIX) else ""
    return "gyrolog-unanswered-line" if "file" in document and "error" in document else ""


def problems(document):
    """What of it is against the schema that it names, each with its place."""
    name = schema_name(document)
    if not name:
        return []
    schema = validator(name)
    if schema is None:
        return [f"no schema is shipped for '{name}'"]
    return [f"{name} at /{'/'.join(map(str, error.absolute_path))}: {error.message[:300]}"
            for error in schema.iter_errors(document)]


def parsed(text):
    try:
        return json.loads(text)
    except ValueError:
        return None


def documents(text):
    """One document, or those of the lines; what is no whole JSON is passed over."""
    whole = parsed(text)
    return [whole] if whole is not None else [parsed(line) for line in text.splitlines() if line.startswith("{")]


def keep(text, name):
    """Fails for each problem of a text that is one document or a line for each. The text is returned."""
    told = [f"{name}: {problem}" for document in documents(text) for problem in problems(document)]
    assert not told, "\n".join(told)
    return text


def keep_in(folder):
    """Likewise for the .json and .jsonl files of a folder; how many of them are documents of gyrolog's."""
    kept = 0
    for path in sorted(pathlib.Path(folder).rglob("*.json*")):
        if path.is_file() and path.suffix in (".json", ".jsonl"):
            text = keep(path.read_text(errors="replace"), path.name)
            kept += any(schema_name(document) for document in documents(text))
    return kept


class KeptFolder(tempfile.TemporaryDirectory):
    """A temporary folder whose documents are looked at when its test has passed."""

    def __exit__(self, kind, value, trace):
        try:
            if kind is None:
                keep_in(self.name)
        finally:
            super().__exit__(kind, value, trace)
