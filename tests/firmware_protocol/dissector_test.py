#!/usr/bin/env python3
"""The Wireshark dissector names the frames of a capture that the second codec has made. Exit 77: tshark is absent."""

import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/protocol_vectors"))
from codec import wire  # noqa: E402
from make_vectors import CONFIG, EVENT, HELLO, SAMPLES, payload, samples_payload  # noqa: E402

# The board's id, and that of older firmware; each with other endpoints.
BOARDS = [(0x1209, 0x6779, 0x82), (0x1FC9, 0x0083, 0x81)]
GET_DEVICE_DESCRIPTOR = bytes.fromhex("8006000100001200")


class Capture:
    """Classic pcap of link type 220: the kernel's struct usbmon_packet of 64 bytes in front of each transfer."""

    def __init__(self):
        self.bytes = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 262144, 220)
        self.urb = 0x1000
        self.time_s = 0

    def record(self, event, kind, endpoint, setup, length, data, status):
        self.time_s += 1
        packet = struct.pack("<QBBBBHBBqiiII8siiII", self.urb, ord(event), kind, endpoint, 2, 1, 0 if setup else 45,
                             0 if data else 60, self.time_s, 0, status, length, len(data), setup or bytes(8), 0, 0, 0x204,
                             0) + data
        self.bytes += struct.pack("<IIII", self.time_s, 0, len(packet), len(packet)) + packet

    def descriptor(self, vendor_id, product_id):
        device = struct.pack("<BBHBBBBHHHBBBB", 18, 1, 0x0200, 2, 0, 0, 64, vendor_id, product_id, 0x0100, 1, 2, 3, 1)
        self.urb += 1
        self.record("S", 2, 0x80, GET_DEVICE_DESCRIPTOR, 18, b"", -115)
        self.record("C", 2, 0x80, None, 18, device, 0)

    def bulk_in(self, endpoint, data):
        self.urb += 1
        self.record("S", 3, endpoint, None, 512, b"", -115)
        self.record("C", 3, endpoint, None, len(data), data, 0)


def main():
    tshark = shutil.which("tshark")
    if not tshark:
        print("skipped: needs tshark")
        sys.exit(77)
    for board in BOARDS:
        dissect(tshark, *board)


def dissect(tshark, vendor_id, product_id, endpoint):
    torn = bytearray(wire(CONFIG, payload(CONFIG), 12))
    torn[20] ^= 4
    stream = (wire(HELLO, payload(HELLO), 10) + wire(CONFIG, payload(CONFIG), 11) + torn +
              wire(SAMPLES, samples_payload(4, 3), 13) +
              wire(EVENT, payload(EVENT, b"hello", code=7, text_bytes=5), 14))
    capture = Capture()
    capture.descriptor(vendor_id, product_id)
    for at in range(0, len(stream), 64):  # frames run across transfers
        capture.bulk_in(endpoint, stream[at : at + 64])

    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "board.pcap"
        path.write_bytes(capture.bytes)
        names = ["type", "sequence", "hello.sensor", "config.rate_mHz", "samples.first_index", "samples.count", "event.text"]
        command = [tshark, "-X", f"lua_script:{ROOT / 'tools/gyrolog.lua'}", "-r", path, "-T", "fields", "-E", "separator=/s",
                   "-E", "occurrence=a", "-Y", "gyrolog.type || gyrolog.refused"]
        for name in names + ["refused"]:
            command += ["-e", f"gyrolog.{name}"]
        two_passes = subprocess.run(command + ["-2"], capture_output=True, text=True)
        result = subprocess.run(command, capture_output=True, text=True)
    wanted = "0x01 10 0x02 11 0x03 13 0x05 14 MPU-9250 100000 4000 4 hello".split()
    seen = result.stdout.replace(",", " ").split()
    problems = [word for word in wanted if word not in seen]
    if "bad_crc" not in result.stdout:
        problems.append("bad_crc")
    if "12" in seen:
        problems.append("a frame that should have been refused")
    if two_passes.stdout != result.stdout:
        problems.append("two passes differ from one")
    if "rror" in result.stderr.replace("Running as user", ""):
        problems.append(result.stderr)
    if problems:
        sys.exit(f"{vendor_id:04x}:{product_id:04x}: missing: {problems}\n{result.stdout}\n{result.stderr}")


if __name__ == "__main__":
    main()
