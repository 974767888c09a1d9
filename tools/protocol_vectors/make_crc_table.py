#!/usr/bin/env python3
"""Writes firmware_protocol/src/crc_table.h from the polynomial; --check only compares."""

import pathlib
import sys

POLYNOMIAL = 0xEDB88320  # 0x04C11DB7, bits reversed
TARGET = pathlib.Path(__file__).resolve().parents[2] / "firmware_protocol/src/crc_table.h"

HEAD = """/// CRC-32 tables for eight bytes a step; written by tools/protocol_vectors/make_crc_table.py.
#ifndef GYROLOG_PROTOCOL_SRC_CRC_TABLE_H
#define GYROLOG_PROTOCOL_SRC_CRC_TABLE_H

#include <stdint.h>

// clang-format off
static const uint32_t table[8][256] = {
"""
TAIL = """};
// clang-format on

#endif
"""


def shift_byte(remainder):
    for _ in range(8):
        remainder = (remainder >> 1) ^ (POLYNOMIAL if remainder & 1 else 0)
    return remainder


def tables():
    table = [shift_byte(byte) for byte in range(256)]
    for _ in range(8):
        yield table
        table = [shift_byte(remainder) for remainder in table]


def text():
    lines = []
    for table in tables():
        lines.append("    {")
        for row in range(0, 256, 8):
            values = ", ".join(f"0x{value:08X}U" for value in table[row : row + 8])
            lines.append(f"        {values}" + ("," if row < 248 else ""))
        lines.append("    },")
    lines[-1] = "    }"
    return HEAD + "\n".join(lines) + "\n" + TAIL


def main():
    if sys.argv[1:] == ["--check"]:
        if TARGET.read_text() != text():
            sys.exit(f"{TARGET}: differs from what the polynomial gives")
        return
    TARGET.write_text(text())


if __name__ == "__main__":
    main()
