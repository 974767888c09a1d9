#!/usr/bin/env python3
"""Writes the conformance vectors and the fuzzers' first inputs. With --check it only compares them with what is there."""

import pathlib
import re
import random
import struct
import sys

from codec import Receiver, body, cobs, crc32, form, judge, wire

ROOT = pathlib.Path(__file__).resolve().parents[2]
VECTORS = ROOT / "firmware_protocol/vectors"
CORPUS = ROOT / "tests/fuzz/corpus"
FOUND_BY_FUZZER = re.compile("[0-9a-f]{40}")  # the name that libFuzzer gives an input

HELLO, CONFIG, SAMPLES, STATUS, EVENT, REPLY = 1, 2, 3, 4, 5, 6
GET_HELLO, CONFIGURE, START, STOP, GET_STATUS = 0x81, 0x82, 0x83, 0x84, 0x85
UNKNOWN = 0x7E

# Each message: name, struct format (x: reserved), field names. SPEC.md section 4.
LAYOUTS = {
    HELLO: ("hello", "<BBBBIIB3x16s24s16s",
            "protocol_major protocol_minor tick_bits who_am_i tick_hz boot_id reset_cause uid firmware sensor"),
    CONFIG: ("config", "<HBBIHHHHIIIi8s",
             "generation layout samples_per_frame rate_mHz gyro_full_scale_dps accel_full_scale_g dlpf_hz decimation "
             "gyro_ndps_per_lsb accel_pg_per_lsb temp_nC_per_lsb temp_offset_mC registers"),
    SAMPLES: ("samples", "<QQHhIBB2x",
              "first_ticks first_index config_generation temperature lost_samples count layout"),
    STATUS: ("status", "<QQIIIIIIIhBB",
             "ticks next_index lost_samples lost_frames ring_bytes ring_high_water_bytes usb_frame_number "
             "fifo_overflows bus_errors temperature streaming reset_cause"),
    EVENT: ("event", "<QQHBxi", "ticks index code text_bytes value"),
    REPLY: ("reply", "<IBB2x", "command_sequence command_type result"),
    CONFIGURE: ("configure", "<IHHHBB4x",
                "rate_mHz gyro_full_scale_dps accel_full_scale_g dlpf_hz layout samples_per_frame"),
}

HELLO_FIELDS = dict(protocol_major=1, protocol_minor=0, tick_bits=64, who_am_i=0x71, tick_hz=1000000,
                    boot_id=0x01020304, reset_cause=1, uid=bytes(range(0x10, 0x20)), firmware=b"gyrolog 1.0",
                    sensor=b"MPU-9250")
CONFIG_FIELDS = dict(generation=3, layout=3, samples_per_frame=4, rate_mHz=100000, gyro_full_scale_dps=500,
                     accel_full_scale_g=8, dlpf_hz=41, decimation=1, gyro_ndps_per_lsb=15267176,
                     accel_pg_per_lsb=244140625, temp_nC_per_lsb=2995178, temp_offset_mC=21000,
                     registers=bytes([9, 0x43, 8, 0x10, 3, 0x78, 1, 0x50]))
SAMPLES_FIELDS = dict(first_ticks=123456789012, first_index=4000, config_generation=3, temperature=-1200,
                      lost_samples=7, count=4, layout=3)
STATUS_FIELDS = dict(ticks=2**63, next_index=4004, lost_samples=7, lost_frames=2, ring_bytes=4096,
                     ring_high_water_bytes=512, usb_frame_number=5000, fifo_overflows=1, bus_errors=9,
                     temperature=-1, streaming=1, reset_cause=3)
EVENT_FIELDS = dict(ticks=99, index=4000, code=5, text_bytes=0, value=-2)
REPLY_FIELDS = dict(command_sequence=0xFFFFFFFF, command_type=CONFIGURE, result=3)
CONFIGURE_FIELDS = dict(rate_mHz=1000000, gyro_full_scale_dps=2000, accel_full_scale_g=16, dlpf_hz=0xFFFF, layout=7,
                        samples_per_frame=40)
DEFAULTS = {HELLO: HELLO_FIELDS, CONFIG: CONFIG_FIELDS, SAMPLES: SAMPLES_FIELDS, STATUS: STATUS_FIELDS,
            EVENT: EVENT_FIELDS, REPLY: REPLY_FIELDS, CONFIGURE: CONFIGURE_FIELDS}


def sample_bytes(layout):
    return 6 * (layout & 1) + 6 * (layout >> 1 & 1) + 2 * (layout >> 2 & 1)


def counts(number):
    """A few that wander through both signs and hold zero bytes."""
    return b"".join(struct.pack("<h", (k * 0x0101 * 7) % 65536 - 32768) for k in range(number))


def payload(frame_type, tail=b"", **changes):
    fields = {**DEFAULTS[frame_type], **changes}
    _, layout, names = LAYOUTS[frame_type]
    return struct.pack(layout, *(fields[name] for name in names.split())) + tail


def samples_payload(count, layout, **changes):
    return payload(SAMPLES, counts(count * sample_bytes(layout) // 2), count=count, layout=layout, **changes)


def shown(value):
    if isinstance(value, bytes):
        return value.hex()
    return str(value)


def fields_of(encoded):
    """The lines that follow `expect: ok`."""
    status, frame = judge(encoded)
    assert status == "ok", status
    frame_type, flags, sequence, data = frame
    yield f"type: {frame_type}"
    yield f"flags: {flags}"
    yield f"sequence: {sequence}"
    yield f"payload_bytes: {len(data)}"
    if frame_type not in LAYOUTS:
        return
    name, layout, names = LAYOUTS[frame_type]
    values = struct.unpack(layout, data[: struct.calcsize(layout)])
    for field, value in zip(names.split(), values):
        if field in ("firmware", "sensor"):
            value = value.split(b"\0")[0].decode()
        yield f"{name}.{field}: {shown(value)}"
    tail = data[struct.calcsize(layout) :]
    if frame_type == SAMPLES:
        words = struct.unpack(f"<{len(tail) // 2}h", tail)
        yield f"samples.first_count: {words[0]}"
        yield f"samples.last_count: {words[-1]}"
        yield f"samples.sum_of_counts: {sum(words)}"
    if frame_type == EVENT:
        yield f"event.text: {tail[: values[3]].decode()}"


class Folder:
    def __init__(self):
        self.files = {}

    def accept(self, name, spec, what, encoded):
        lines = [f"# {what}", f"spec: {spec}", f"bytes: {encoded.hex()}", "expect: ok", *fields_of(encoded)]
        self.files[VECTORS / "accept" / f"{name}.txt"] = "\n".join(lines) + "\n"

    def reject(self, name, spec, what, encoded, reason):
        judged, frame = judge(encoded)
        assert frame or judged == reason, (name, judged)  # the payload's rules are the C codec's part
        lines = [f"# {what}", f"spec: {spec}", f"bytes: {encoded.hex()}", f"expect: {reason}"]
        self.files[VECTORS / "reject" / f"{name}.txt"] = "\n".join(lines) + "\n"

    def stream(self, name, spec, what, data):
        receiver = Receiver()
        receiver.take(data)
        frames = " ".join(f"{frame[0]}:{frame[2]}" for frame in receiver.frames)
        lines = [f"# {what}", f"spec: {spec}", f"stream: {data.hex()}", f"frames: {frames}".rstrip(),
                 f"in_frames: {receiver.in_frames}", f"skipped: {receiver.skipped}", f"waiting: {receiver.waiting}"]
        side = "accept" if receiver.frames else "reject"
        self.files[VECTORS / side / f"stream-{name}.txt"] = "\n".join(lines) + "\n"
        self.corpus("fuzz_frame_stream", name, data)

    def corpus(self, target, name, data):
        self.files[CORPUS / target / name] = data


def without_zero(size):
    """A body of `size` bytes without a 00, checksum included."""
    for start in range(1, 256):
        data = bytes((start + k) % 255 + 1 for k in range(size - 12))
        whole = body(UNKNOWN, data, 0x01010101, 0x0101)
        if 0 not in whole:
            return whole
    raise AssertionError("no checksum without a zero byte")


def accepted(folder):
    add = folder.accept
    add("hello", "4.4", "HELLO.", form(HELLO, payload(HELLO), 1))
    add("hello-full-text", "4.4", "Text that fills its field has no 00 behind it.",
        form(HELLO, payload(HELLO, firmware=b"f" * 24, sensor=b"s" * 16), 2))
    add("hello-ticks-32-bits", "4.4", "The narrowest tick counter.", form(HELLO, payload(HELLO, tick_bits=32), 3))
    add("hello-unknown-reset-cause", "7.2", "A reset cause of a later minor version.",
        form(HELLO, payload(HELLO, reset_cause=200), 4))
    add("config", "4.5", "CONFIG.", form(CONFIG, payload(CONFIG), 5))
    add("config-filter-bypassed", "4.5.2", "Each 320th sample of 32 kHz.",
        form(CONFIG, payload(CONFIG, dlpf_hz=0, decimation=320), 6))
    add("status", "4.6", "STATUS.", form(STATUS, payload(STATUS), 7))
    add("status-standing-still", "4.6", "A board that stands still.", form(STATUS, payload(STATUS, streaming=0), 8))
    add("event", "4.7", "EVENT without text.", form(EVENT, payload(EVENT), 9))
    add("event-text-96", "4.7.1", "The longest text.",
        form(EVENT, payload(EVENT, b"t" * 96, code=7, text_bytes=96), 10))
    add("event-unknown-code", "7.2", "An event of a later minor version.", form(EVENT, payload(EVENT, code=999), 11))
    add("event-text-shorter-than-payload", "4.2", "What follows the text is ignored.",
        form(EVENT, payload(EVENT, b"abcXYZ", code=7, text_bytes=3), 12))
    add("reply", "4.8", "REPLY.", form(REPLY, payload(REPLY), 13))
    add("reply-unknown-result", "4.8", "A result of a later minor version.", form(REPLY, payload(REPLY, result=77), 14))
    add("configure", "4.9", "CONFIGURE.", form(CONFIGURE, payload(CONFIGURE), 15))
    add("configure-nothing", "4.9", "CONFIGURE that leaves all as it is.",
        form(CONFIGURE, bytes(16), 16))
    for name, kind in (("get-hello", GET_HELLO), ("start", START), ("stop", STOP), ("get-status", GET_STATUS)):
        add(name, "4.1", f"{name} has no payload.", form(kind, b"", 17))
    for layout in range(1, 8):
        fit = min(255, (1004 - 28) // sample_bytes(layout))
        add(f"samples-layout-{layout}-one", "4.3.1", "One sample.",
            form(SAMPLES, samples_payload(1, layout), 20 + layout, 0x0008))
        add(f"samples-layout-{layout}-full", "4.3.2", "As many samples as fit.",
            form(SAMPLES, samples_payload(fit, layout), 30 + layout))
    add("samples-unknown-flags", "4.3.5", "Flag bits of a later minor version.",
        form(SAMPLES, samples_payload(4, 3), 40, 0xFFC0))
    add("samples-last-index", "5.2", "The largest values of every counter.",
        form(SAMPLES, samples_payload(1, 1, first_ticks=2**64 - 1, first_index=2**64 - 1, config_generation=2**16 - 1,
                                      lost_samples=2**32 - 1), 2**32 - 1))
    for kind in (HELLO, CONFIG, STATUS, REPLY, CONFIGURE):
        add(f"{LAYOUTS[kind][0]}-longer", "4.2", "A payload with the appendix of a later minor version.",
            form(kind, payload(kind, b"\x01\x00\x02"), 50 + kind))
    add("get-hello-longer", "4.2", "A command with the appendix of a later minor version.", form(GET_HELLO, b"\xaa", 60))
    add("unknown-type", "7.3", "A type of a later minor version.", form(UNKNOWN, b"abc", 61))
    add("body-shortest", "1.5", "12 bytes.", form(UNKNOWN, b"", 62))
    add("body-longest", "1.5", "1016 bytes.", form(UNKNOWN, bytes(k % 251 for k in range(1004)), 63))
    add("body-longest-without-zero", "2.2", "1016 bytes in 1020: the last full group has no group behind it.",
        cobs(without_zero(1016)))
    for size in (253, 254, 255, 508, 509):
        add(f"cobs-body-{size}-without-zero", "2.1", f"A body of {size} bytes without a 00.", cobs(without_zero(size)))
        add(f"cobs-run-{size}", "2.1", f"{size} bytes between two zeros.",
            form(UNKNOWN, b"\x00" + b"\x55" * size + b"\x00", 64))
        add(f"cobs-zeros-{size}", "2.1", f"{size} zeros.", form(UNKNOWN, bytes(size), 65))


def rejected(folder):
    add = folder.reject
    good = form(CONFIG, payload(CONFIG), 5)
    whole = body(CONFIG, payload(CONFIG), 5)
    add("crc-one-bit", "3.2", "One bit of the payload has flipped.", cobs(whole[:20] + bytes([whole[20] ^ 4]) + whole[21:]),
        "bad_crc")
    add("crc-bytes-swapped", "3.1", "The checksum in big endian.", cobs(whole[:-4] + whole[:-5:-1]), "bad_crc")
    add("crc-without-final-xor", "3.1", "The checksum before its final xor.",
        cobs(whole[:-4] + bytes(byte ^ 0xFF for byte in whole[-4:])), "bad_crc")
    add("crc-of-header-left-out", "3.1", "The checksum of the payload alone.",
        cobs(whole[:-4] + struct.pack("<I", crc32(whole[8:-4]))), "bad_crc")
    add("version-2", "7.1", "A major version to come.", form(CONFIG, payload(CONFIG), 5, version=2), "bad_version")
    add("version-0", "7.1", "No version at all.", form(CONFIG, payload(CONFIG), 5, version=0), "bad_version")
    add("version-2-damaged", "1.7", "Another version and a wrong checksum: the checksum is judged first.",
        cobs(b"\x02" + whole[1:]), "bad_crc")
    add("cobs-code-past-end", "2.3", "The last code byte claims one byte more than there is.",
        cobs(b"\x00" + whole)[:-1], "bad_cobs")
    add("cobs-lone-code", "2.3", "A code byte and nothing behind it.", b"\x05", "bad_cobs")
    add("cobs-empty-group-after-full", "2.3", "Bytes as some encoders write them: 01 behind the last full group.",
        cobs(without_zero(254)) + b"\x01", "bad_cobs")
    add("cobs-zero-inside", "1.2", "A 00 inside the form.", good[:10] + b"\x00" + good[11:], "bad_cobs")
    add("body-11-bytes", "1.5", "Shorter than header and checksum.", cobs(body(UNKNOWN)[:11]), "bad_length")
    add("body-empty", "1.5", "The form of no bytes.", b"\x01", "bad_length")
    add("body-1017-bytes", "1.5", "One byte more than a frame may have, its checksum right.",
        cobs(body(UNKNOWN, bytes(1005), 1)), "bad_length")
    for kind in (HELLO, CONFIG, STATUS, EVENT, REPLY, CONFIGURE):
        add(f"{LAYOUTS[kind][0]}-short", "4.2", "One byte less than its table.", form(kind, payload(kind)[:-1], 5),
            "bad_length")
        add(f"{LAYOUTS[kind][0]}-empty", "4.2", "No payload.", form(kind, b"", 5), "bad_length")
    add("samples-short-header", "4.2", "SAMPLES of 27 bytes.", form(SAMPLES, payload(SAMPLES)[:27]), "bad_length")
    add("samples-one-byte-less", "4.3.2", "A sample misses its last byte.", form(SAMPLES, samples_payload(4, 3)[:-1]),
        "bad_length")
    add("samples-one-byte-more", "4.3.2", "SAMPLES has no appendix.", form(SAMPLES, samples_payload(4, 3) + b"\x00"),
        "bad_length")
    add("samples-one-sample-less", "4.3.2", "count says 4, there are 3.",
        form(SAMPLES, samples_payload(4, 3)[:-12]), "bad_length")
    add("samples-none", "4.3.1", "count 0.", form(SAMPLES, samples_payload(0, 3)), "bad_value")
    for layout in (0, 8, 0x0B, 0xFF):
        add(f"samples-layout-{layout}", "4.3.1", "A layout that this version does not know.",
            form(SAMPLES, payload(SAMPLES, counts(24), layout=layout)), "bad_value")
    for kind, spec, changes in (
            (HELLO, "4.4", dict(tick_bits=31)), (HELLO, "4.4", dict(tick_bits=65)), (HELLO, "4.4", dict(tick_hz=0)),
            (HELLO, "4.4", dict(protocol_major=0)),
            (CONFIG, "4.5", dict(layout=0)), (CONFIG, "4.5", dict(layout=8)), (CONFIG, "4.5", dict(rate_mHz=0)),
            (CONFIG, "4.5", dict(samples_per_frame=0)), (CONFIG, "4.5", dict(samples_per_frame=82)),
            (CONFIG, "4.5", dict(decimation=0)), (CONFIG, "4.5", dict(gyro_ndps_per_lsb=0)),
            (CONFIG, "4.5", dict(accel_pg_per_lsb=0)), (CONFIG, "4.5", dict(temp_nC_per_lsb=0)),
            (STATUS, "4.6", dict(streaming=2)),
            (CONFIGURE, "4.9", dict(layout=8))):
        (field, value), = changes.items()
        add(f"{LAYOUTS[kind][0]}-{field}-{value}", spec, f"{field} {value}.", form(kind, payload(kind, **changes), 5),
            "bad_value")
    add("event-text-97", "4.7.1", "More text than an event may have.",
        form(EVENT, payload(EVENT, b"t" * 97, code=7, text_bytes=97), 5), "bad_value")
    add("event-text-beyond-payload", "4.7.1", "text_bytes says 4, there are 3.",
        form(EVENT, payload(EVENT, b"abc", code=7, text_bytes=4), 5), "bad_length")


def streams(folder):
    add = folder.stream
    one = wire(HELLO, payload(HELLO), 1)
    two = wire(CONFIG, payload(CONFIG), 2)
    three = wire(SAMPLES, samples_payload(4, 3), 3)
    add("three-frames", "1.3", "Each frame with both delimiters.", one + two + three)
    add("shared-delimiters", "1.3", "Frames that share their delimiters.", one + two[1:] + three[1:])
    add("no-first-delimiter", "1.3", "The stream begins with the first byte of a frame.", one[1:] + two)
    add("delimiters-only", "1.3", "Nothing but delimiters.", bytes(10))
    add("delimiters-between", "1.3", "Many delimiters between two frames.", one + bytes(7) + two)
    add("joined-inside-a-frame", "9.4", "The tail of a frame, then a whole one.", one[30:] + two)
    add("byte-lost", "9.4", "A frame without one of its bytes, then a whole one.", one[:20] + one[21:] + two)
    add("delimiters-lost", "9.4", "Both delimiters between two frames are gone: both frames with them.",
        one[:-1] + two[1:] + three)
    add("delimiter-inside", "9.4", "A byte of a frame became 00.", one[:40] + b"\x00" + one[41:] + two)
    add("block-lost", "9.4", "64 bytes are gone, from the middle of one frame to the middle of the next.",
        (one + two + three)[:60] + (one + two + three)[124:])
    add("block-doubled", "9.4", "64 bytes came twice.", (one + two + three)[:128] + (one + two + three)[64:])
    add("block-of-zeros", "9.4", "64 bytes became 00.",
        (one + two + three)[:64] + bytes(64) + (one + two + three)[128:] + two)
    add("overlong-then-frame", "9.1", "1021 bytes without a delimiter, then a frame.", b"\x55" * 1021 + one)
    add("longest-candidate-then-frame", "9.1", "1020 bytes without a delimiter are judged, and refused.",
        b"\x55" * 1020 + one)
    add("longest-frame", "1.6", "The longest form there is.", b"\x00" + cobs(without_zero(1016)) + b"\x00" + two)
    add("frame-not-finished", "9.3", "A frame and the beginning of another.", one + two[:25])
    add("overlong-not-finished", "9.3", "2000 bytes without a delimiter.", b"\x00" + b"\x33" * 2000)
    add("other-version-between", "7.1", "A frame of another major version between two of this one.",
        one + wire(CONFIG, payload(CONFIG), 7, version=2) + two)
    add("unknown-type-between", "7.3", "A frame of unknown type comes out like any other.",
        one + wire(UNKNOWN, b"\x01\x02", 9) + two)
    add("noise", "9.3", "Noise with a frame in it.",
        random.Random(1).randbytes(300) + one + random.Random(2).randbytes(300))


def payload_corpus(folder):
    for kind in LAYOUTS:
        folder.corpus("fuzz_frame_payloads", LAYOUTS[kind][0], bytes([kind]) +
                      (samples_payload(4, 3) if kind == SAMPLES else payload(kind)))
    commands = b"".join(wire(kind, payload(kind) if kind == CONFIGURE else b"", n)
                        for n, kind in enumerate((GET_HELLO, START, GET_STATUS, CONFIGURE, STOP, START)))
    folder.corpus("fuzz_board_commands", "every-command", commands)
    folder.corpus("fuzz_board_commands", "configure-while-streaming",
                  wire(START) + wire(CONFIGURE, payload(CONFIGURE, dlpf_hz=41, layout=1)) + wire(GET_STATUS))


def main():
    folder = Folder()
    accepted(folder)
    rejected(folder)
    streams(folder)
    payload_corpus(folder)
    wanted = {path: data if isinstance(data, bytes) else data.encode() for path, data in folder.files.items()}
    ours = [VECTORS / "accept", VECTORS / "reject", *sorted({path.parent for path in wanted if CORPUS in path.parents})]
    present = {path for directory in ours if directory.is_dir() for path in directory.iterdir()
               if not FOUND_BY_FUZZER.fullmatch(path.name)}
    if sys.argv[1:] == ["--check"]:
        wrong = sorted(str(path.relative_to(ROOT)) for path in present | set(wanted)
                       if path not in wanted or not path.exists() or path.read_bytes() != wanted[path])
        if wrong:
            sys.exit("differ from what SPEC.md's second implementation makes:\n  " + "\n  ".join(wrong))
        return
    for path in present - set(wanted):
        path.unlink()
    for path, data in wanted.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    print(f"{len(wanted)} files")


if __name__ == "__main__":
    main()
