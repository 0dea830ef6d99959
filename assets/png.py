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
        check = struct.pack(">I", zlib.crc32(name + data))
        return struct.pack(">I", len(data)) + name + data + check

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
    out = np.zeros((rows, columns * step), np.uint8)
    above = np.zeros(columns * step, np.uint8)
    for y in range(rows):
        filter_kind, row = lines[y, 0], lines[y, 1:]
        if filter_kind == 1:
            row = np.cumsum(row.reshape(columns, step), axis=0, dtype=np.uint8).ravel()
        elif filter_kind == 2:
            row = row + above
        elif filter_kind > 2:
            row = undo(filter_kind == 3, row.tobytes(), above.tobytes(), step)
        out[y] = above = row
    return out.reshape(rows, columns, step)


def undo(average, row, above, step):
    """The filters whose guess needs the pixel before: average, else Paeth's."""
    out = bytearray(row)
    for i, b in enumerate(above):
        a = out[i - step] if i >= step else 0
        c = above[i - step] if i >= step else 0
        if average:
            guess = (a + b) // 2
        else:
            pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
            guess = a if pa <= pb and pa <= pc else b if pb <= pc else c
        out[i] = (row[i] + guess) & 255
    return np.frombuffer(out, np.uint8)
