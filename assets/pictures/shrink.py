#!/usr/bin/python3
"""A figure of an experiment as the READMEs have it: smaller, in 256 colours, and with no more than Python's own library.

    limpid experiment zwidth --out out
    assets/pictures/shrink.py out/zwidth.png assets/pictures/zwidth.png 1200
"""

from __future__ import annotations

import argparse
import struct
import zlib
from collections import Counter

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {2: 3, 6: 4}
STEP = 8  # colours are rounded to this: few enough are left for a palette

Pixel = tuple[int, int, int]


def unfiltered(kind: int, line: bytearray, before: bytearray, channels: int) -> None:
    """Undoes the filter of a line, whose neighbours are to the left and above."""
    for i in range(len(line)):
        left = line[i - channels] if i >= channels else 0
        up = before[i]
        corner = before[i - channels] if i >= channels else 0
        if kind == 1:
            line[i] = (line[i] + left) & 255
        elif kind == 2:
            line[i] = (line[i] + up) & 255
        elif kind == 3:
            line[i] = (line[i] + (left + up) // 2) & 255
        elif kind == 4:
            middle = left + up - corner
            line[i] = (line[i] + min((left, up, corner), key=lambda c: abs(middle - c))) & 255


def read(path: str) -> tuple[int, int, list[bytearray]]:
    """Number of columns, of channels, and the lines of an 8-bit picture."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = len(SIGNATURE), b""
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + size]
        if name == b"IHDR":
            columns, rows, _, kind = struct.unpack_from(">IIBB", body)
        elif name == b"IDAT":
            packed += body
        at += 12 + size
    channels = CHANNELS[kind]
    raw, length = zlib.decompress(packed), 1 + columns * channels
    lines: list[bytearray] = []
    before = bytearray(length - 1)
    for y in range(rows):
        line = bytearray(raw[y * length + 1 : (y + 1) * length])
        if raw[y * length] != 0:
            unfiltered(raw[y * length], line, before, channels)
        lines.append(line)
        before = line
    return columns, channels, lines


def shares(many: int, few: int) -> list[list[tuple[int, float]]]:
    """Which of many lie under each of few, and with what share of it."""
    found = []
    for i in range(few):
        low, high = i * many / few, (i + 1) * many / few
        inside = range(int(low), min(many, int(high - 1e-9) + 1))
        found.append([(k, (min(k + 1, high) - max(k, low)) * few / many) for k in inside])
    return found


def shrunk(path: str, width: int) -> list[list[Pixel]]:
    columns, channels, lines = read(path)
    across = shares(columns, width)
    narrow = [
        [[sum(line[k * channels + c] * share for k, share in under) for c in range(3)]
         for under in across]
        for line in lines
    ]  # fmt: skip
    down = shares(len(lines), round(len(lines) * width / columns))

    def rounded(value: float) -> int:
        return min(255, STEP * int(value / STEP + 0.5))

    def pixel(x: int, under: list[tuple[int, float]]) -> Pixel:
        r, g, b = (rounded(sum(narrow[k][x][c] * share for k, share in under)) for c in range(3))
        return r, g, b

    return [[pixel(x, under) for x in range(width)] for under in down]


def write(path: str, pixels: list[list[Pixel]]) -> None:
    count = Counter(pixel for row in pixels for pixel in row)
    palette = [colour for colour, _ in count.most_common(256)]

    def nearest(colour: Pixel) -> int:
        return min(range(len(palette)),
                   key=lambda i: sum((a - b) ** 2 for a, b in zip(palette[i], colour)))  # fmt: skip

    place = {colour: nearest(colour) for colour in count}
    lines = b"".join(b"\0" + bytes(place[pixel] for pixel in row) for row in pixels)

    def chunk(name: bytes, body: bytes) -> bytes:
        check = zlib.crc32(name + body)
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", check)

    header = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, 3, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(
            SIGNATURE + chunk(b"IHDR", header)
            + chunk(b"PLTE", bytes(c for colour in palette for c in colour))
            + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b"")
        )  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("picture")
    parser.add_argument("out")
    parser.add_argument("width", type=int)
    options = parser.parse_args()
    write(options.out, shrunk(options.picture, options.width))


if __name__ == "__main__":
    main()
