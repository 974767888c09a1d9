#!/usr/bin/env python3
"""What the udev rule gives, and to which devices: a small udev reads it. All that name the board's id name the same.

    udev_rules_test.py SOURCE
"""

import fnmatch
import pathlib
import re
import sys

TERM = re.compile(r'(\w+)(?:\{(\w+)\})?(==|!=|\+=|:=|=)"([^"]*)"')


def rules_of(text):
    """The rules as lists of (key, attribute, operator, value). What is no rule is an error."""
    rules = []
    for line in text.splitlines():
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        parts = [part.strip() for part in line.split(",")]
        terms = [TERM.fullmatch(part) for part in parts]
        assert all(terms), f"no rule: {line}"
        rules.append([term.groups() for term in terms])
    return rules


def holds(term, devices):
    """`devices`: the device itself and those above it."""
    key, attribute, operator, value = term
    own = devices[0]
    if key == "ATTRS":
        raise AssertionError("ATTRS must match on one device together")
    found = {"ACTION": own.get("action"), "SUBSYSTEM": own.get("subsystem"),
             "ENV": own.get("env", {}).get(attribute), "ATTR": own.get("attributes", {}).get(attribute)}[key]
    matches = found is not None and fnmatch.fnmatchcase(found, value)
    return matches if operator == "==" else not matches


def applied(rules, devices):
    """What the rules give the first of the devices."""
    given = {"tags": set(), "env": {}}
    skip_to = None
    for rule in rules:
        labels = [value for key, _, operator, value in rule if key == "LABEL" and operator == "="]
        if skip_to:
            if skip_to not in labels:
                continue
            skip_to = None
        matches = [term for term in rule if term[2] in ("==", "!=")]
        above = [term for term in matches if term[0] == "ATTRS"]
        if not all(holds(term, devices) for term in matches if term[0] != "ATTRS"):
            continue
        # udev: all ATTRS of a rule are those of one device.
        if above and not any(all(fnmatch.fnmatchcase(one.get("attributes", {}).get(name, ""), value)
                                 for _, name, _, value in above) for one in devices):
            continue
        for key, name, operator, value in rule:
            if key == "GOTO":
                skip_to = value
            elif key == "TAG" and operator == "+=":
                given["tags"].add(value)
            elif key == "ENV" and operator == "=":
                given["env"][name] = value
            elif key in ("GROUP", "MODE") and operator == "=":
                given[key] = value
            else:
                assert operator in ("==", "!=") or key == "LABEL", f"not understood: {key}{operator}"
    return given


def usb(vendor, product, name, action="add"):
    attributes = {"idVendor": vendor, "idProduct": product}
    if name is not None:
        attributes["product"] = name
    return {"action": action, "subsystem": "usb", "env": {"DEVTYPE": "usb_device"}, "attributes": attributes}


def port_of(device):
    return [{"action": device["action"], "subsystem": "tty"}, {"subsystem": "usb"}, device]


def check_access(rules, ids):
    nothing = {"tags": set(), "env": {}}
    for vendor, product in ids:
        board = usb(vendor, product, "gyrolog MPU-9250")
        for devices, group in (([board], "plugdev"), (port_of(board), "dialout")):
            given = applied(rules, devices)
            assert given == {"tags": {"uaccess"}, "env": {"ID_MM_DEVICE_IGNORE": "1"}, "GROUP": group,
                             "MODE": "0660"}, (devices[0], given)
        for stranger in (usb(vendor, product, "LPC VCOM"), usb(vendor, product, None),
                         usb("0483", "5740", "gyrolog MPU-9250"), usb(vendor, product, "gyrolog", "remove")):
            for devices in ([stranger], port_of(stranger)):
                assert applied(rules, devices) == nothing, devices
        # An id on one device and the name on the one above it are no board.
        split = [usb(vendor, product, "LPC VCOM"), usb("1d6b", "0002", "gyrolog")]
        assert applied(rules, [{"action": "add", "subsystem": "tty"}] + split) == nothing
    interface = usb(*ids[0], "gyrolog")
    interface["env"]["DEVTYPE"] = "usb_interface"
    assert applied(rules, [interface]) == nothing


def main():
    source = pathlib.Path(sys.argv[1])
    header = (source / "firmware_protocol/include/gyrolog_protocol/usb_identity.h").read_text()
    numbers = dict(re.findall(r"#define GLP_USB_(\w+_ID) 0x([0-9A-F]{4})U", header))
    own = (numbers["VENDOR_ID"].lower(), numbers["PRODUCT_ID"].lower())
    former = (numbers["FORMER_VENDOR_ID"].lower(), numbers["FORMER_PRODUCT_ID"].lower())
    assert own != former

    text = (source / "tools/60-gyrolog.rules").read_text()
    rules = rules_of(text)
    check_access(rules, [own, former])
    named = {(v, p) for v, p in re.findall(r'idVendor\}=="(\w+)", ATTRS?\{idProduct\}=="(\w+)"', text)}
    assert named == {own, former}, named
    assert re.search(r"plug the board in again", text)
    # Tags are turned into access lists by 73-seat-late.rules.
    assert (source / "tools/60-gyrolog.rules").name < "73-seat-late.rules"

    spec = (source / "firmware_protocol/SPEC.md").read_text()
    identity = re.search(r"^10\.1 .*\n\n>.*$", spec, re.MULTILINE).group(0)
    assert re.findall(r"\b[0-9A-F]{4}:[0-9A-F]{4}\b", identity) == [
        ":".join(own).upper(), ":".join(own).upper(), ":".join(former).upper()], identity
    lua = (source / "tools/gyrolog.lua").read_text()
    assert re.findall(r"0x([0-9a-f]{8})\b", re.search(r"in ipairs\(\{ (0x\w+, 0x\w+) \}\)", lua).group(1)) == [
        "".join(own), "".join(former)]
    application = (source / "firmware_protocol/USB_ID.md").read_text()
    assert f"`{'/'.join(own)}/index.md`" in application and f"**{own[1]} is not granted yet" in application
    gadget = (source / "tests/usb_kernel/guest/boards.sh").read_text()
    assert f"0x{own[0]} > $gadget/idVendor" in gadget and f"0x{own[1]} > $gadget/idProduct" in gadget


if __name__ == "__main__":
    main()
