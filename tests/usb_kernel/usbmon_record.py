"""Two independent accounts of the bytes on a USB bus, read by code that shares nothing with the program under test."""

import struct
from collections import namedtuple

# A completed bulk IN transfer: its device, status (0 or a negative errno), data and time.
BulkIn = namedtuple("BulkIn", "device status data time_s")

COMPLETION, BULK, IN = ord("C"), 3, 0x80


def _bulk_in(header):
    """The packet header of usbmon (kernel documentation, usbmon, struct usbmon_packet): id, type, xfer_type, epnum,
    devnum, busnum, flag_setup, flag_data, ts_sec, ts_usec, status, length, len_cap."""
    _, event, kind, endpoint, device, _, _, _, s, us, status, _, captured = struct.unpack_from("<QBBBBHbbqiiII", header)
    wanted = event == COMPLETION and kind == BULK and endpoint & IN
    return device if wanted else None, status, captured, s + 1e-6 * us


def from_usbmon(content):
    """What read() on /dev/usbmonN gave: headers of 48 bytes, each followed by its captured data."""
    at = 0
    while at + 48 <= len(content):
        device, status, captured, time_s = _bulk_in(content[at:at + 48])
        if device is not None:
            yield BulkIn(device, status, content[at + 48:at + 48 + captured], time_s)
        at += 48 + captured


def from_pcapng(content):
    """A capture of link type 220: enhanced packet blocks (type 6) whose packets begin with the 64-byte header."""
    at = 0
    while at + 12 <= len(content):
        kind, length = struct.unpack_from("<II", content, at)
        if kind == 6:
            (captured,) = struct.unpack_from("<I", content, at + 20)
            packet = content[at + 28:at + 28 + captured]
            device, status, _, time_s = _bulk_in(packet)
            if device is not None:
                yield BulkIn(device, status, packet[64:], time_s)
        at += length
