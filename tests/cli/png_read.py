"""Reads the 8-bit PNG files that cag writes: read(path) returns width, height, channels, and rows of bytes."""
import struct
import zlib


def unfilter(kind, row, before, step):
    for x in range(len(row)):
        a = row[x - step] if x >= step else 0
        b = before[x]
        c = before[x - step] if x >= step else 0
        if kind == 1:
            row[x] = (row[x] + a) & 255
        elif kind == 2:
            row[x] = (row[x] + b) & 255
        elif kind == 3:
            row[x] = (row[x] + (a + b) // 2) & 255
        elif kind == 4:
            p = a + b - c
            near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))
            row[x] = (row[x] + near[2]) & 255
    return row


def read(path):
    data = open(path, "rb").read()
    at, packed = 8, b""
    while at < len(data):
        (n,) = struct.unpack(">I", data[at:at + 4])
        name, body = data[at + 4:at + 8], data[at + 8:at + 8 + n]
        if name == b"IHDR":
            width, height, _, kind = struct.unpack(">IIBB", body[:10])
        elif name == b"IDAT":
            packed += body
        at += 12 + n
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
    raw, line = zlib.decompress(packed), width * channels
    rows, before = [], bytearray(line)
    for y in range(height):
        start = y * (line + 1)
        before = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + line]), before, channels)
        rows.append(before)
    return width, height, channels, rows


def light(byte):
    """The linear value of a byte of sRGB."""
    v = byte / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4
