"""The protocol once more, from SPEC.md alone. Shares nothing with the C codec: where the two differ, one of them or the
specification is wrong."""

import struct

FORM_MAX = 1020
BODY_MIN = 12
BODY_MAX = 1016


def crc32(data):
    """Rule 3.1, bit by bit as a polynomial division: the reflections are done on the way in and out."""
    remainder = 0xFFFFFFFF
    for byte in data:
        remainder ^= int(f"{byte:08b}"[::-1], 2) << 24
        for _ in range(8):
            remainder <<= 1
            if remainder >> 32:
                remainder ^= 0x104C11DB7
    return int(f"{remainder:032b}"[::-1], 2) ^ 0xFFFFFFFF


def cobs(body):
    """Rules 2.1 and 2.2."""
    groups = []
    rest = body
    while True:
        end = rest.find(0)
        run = rest if end < 0 else rest[:end]
        if len(run) >= 254:
            groups.append(b"\xff" + rest[:254])
            rest = rest[254:]
            if not rest:
                break
        else:
            groups.append(bytes([len(run) + 1]) + run)
            if end < 0:
                break
            rest = rest[end + 1 :]
    return b"".join(groups)


def body(frame_type, payload=b"", sequence=0, flags=0, version=1):
    """Rule 1.4."""
    head = struct.pack("<BBHI", version, frame_type, flags, sequence) + payload
    return head + struct.pack("<I", crc32(head))


def form(*args, **kwargs):
    return cobs(body(*args, **kwargs))


def wire(*args, **kwargs):
    return b"\x00" + form(*args, **kwargs) + b"\x00"


def uncobs(encoded):
    """The body, or None where rule 2.3 refuses."""
    out = bytearray()
    at = 0
    previous = 0
    while at < len(encoded):
        code = encoded[at]
        group = encoded[at + 1 : at + code]
        if code == 0 or len(group) != code - 1 or 0 in group:
            return None
        at += code
        if previous == 0xFF and code == 1 and at == len(encoded):
            return None
        out += group
        if code != 0xFF and at < len(encoded):
            out.append(0)
        previous = code
    return bytes(out) if encoded else None


def judge(encoded):
    """Rule 1.7 as far as the frame goes: ("ok", (type, flags, sequence, payload)) or (reason, None)."""
    plain = uncobs(encoded)
    if plain is None:
        return "bad_cobs", None
    if not BODY_MIN <= len(plain) <= BODY_MAX:
        return "bad_length", None
    if struct.pack("<I", crc32(plain[:-4])) != plain[-4:]:
        return "bad_crc", None
    version, frame_type, flags, sequence = struct.unpack("<BBHI", plain[:8])
    if version != 1:
        return "bad_version", None
    return "ok", (frame_type, flags, sequence, plain[8:-4])


class Receiver:
    """Rules 9.1 and 9.3, one byte at a time."""

    def __init__(self):
        self.form = bytearray()
        self.overlong = False
        self.delimiter_waits = False
        self.frames = []
        self.in_frames = 0
        self.skipped = 0

    @property
    def waiting(self):
        return len(self.form) + self.delimiter_waits

    def _drop(self):
        self.skipped += self.waiting
        self.form.clear()
        self.delimiter_waits = False

    def take(self, data):
        for byte in data:
            if byte:
                self._other(byte)
            else:
                self._delimiter()

    def _other(self, byte):
        if self.overlong:
            self.skipped += 1
        elif len(self.form) == FORM_MAX:
            self._drop()
            self.skipped += 1
            self.overlong = True
        else:
            self.form.append(byte)

    def _delimiter(self):
        status, frame = judge(bytes(self.form)) if self.form else ("nothing", None)
        if frame and not self.overlong:
            self.frames.append(frame)
            self.in_frames += self.waiting + 1
            self.form.clear()
            self.delimiter_waits = False
        else:
            self._drop()
            self.delimiter_waits = True
            self.overlong = False
