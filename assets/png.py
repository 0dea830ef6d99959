"""8-bit PNG pictures as numpy arrays (rows x columns x 3 or 4)."""

import struct
import zlib

import numpy as np

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {2: 3, 6: 4}


def encode(pixels):
    rows, columns, channels = pixels.shape
    kind = {3: 2, 4: 6}[channels]
    pixels = pixels.astype(np.uint8).reshape(rows, -1)
    above = np.vstack([np.zeros_like(pixels[:1]), pixels[:-1]])
    lines = np.column_stack([np.full(rows, 2, np.uint8), pixels - above])  # filter 2: up

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    return (SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, kind, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(lines.tobytes(), 9)) + chunk(b"IEND", b""))


def decode(data):
    at, packed = len(SIGNATURE), b""
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if name == b"IHDR":
            columns, rows, _, kind = struct.unpack_from(">IIBB", body)
        if name == b"IDAT":
            packed += body
        at += 12 + size
    step = CHANNELS[kind]
    lines = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(rows, -1)
    out = np.zeros((rows + 1, columns + 1, step), np.int32)  # a border of zeros before and above
    for y in range(rows):
        wanted = lines[y, 1:].reshape(columns, step).astype(np.int32)
        row, above = out[y + 1], out[y]
        filter_kind = lines[y, 0]
        if filter_kind == 0:
            row[1:] = wanted
        elif filter_kind == 1:
            row[1:] = np.cumsum(wanted, axis=0) & 255
        elif filter_kind == 2:
            row[1:] = (wanted + above[1:]) & 255
        else:
            for x in range(1, columns + 1):
                a, b, c = row[x - 1], above[x], above[x - 1]
                if filter_kind == 3:
                    guess = (a + b) // 2
                else:
                    pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
                    guess = np.where((pa <= pb) & (pa <= pc), a, np.where(pb <= pc, b, c))
                row[x] = (wanted[x - 1] + guess) & 255
    return out[1:, 1:].astype(np.uint8)
