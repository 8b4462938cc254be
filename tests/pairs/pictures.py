"""Readers of PNG, OpenEXR and Middlebury's .flo, by zlib and numpy alone."""
import struct
import zlib

import numpy as np


def read_png(source):
    """Array of rows: 8 or 16 bits, one value a pixel or several."""
    data = source
    if not isinstance(source, bytes):
        with open(source, "rb") as file:
            data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG")
    at, packed, head = 8, b"", None
    while at < len(data):
        size, = struct.unpack_from(">I", data, at)
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    width, height, bits, colour, _, _, interlace = head
    if interlace or bits not in (8, 16):
        raise ValueError("a PNG that this reader does not know")
    values = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    step = values * bits // 8
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * step)
    out = np.zeros((height, width * step), np.uint8)
    before = np.zeros(width * step, np.uint8)
    for y in range(height):
        before = unfilter(rows[y, 0], rows[y, 1:], before, step)
        out[y] = before
    if bits == 16:
        out = out.view(">u2").astype(np.uint16)
    out = out.reshape(height, width, values)
    return out[:, :, 0] if values == 1 else out


def unfilter(kind, row, above, step):
    if kind == 0:
        return row.copy()
    if kind == 2:
        return row + above
    out = row.astype(int)
    up = above.astype(int)
    for i in range(len(out)):
        left = out[i - step] if i >= step else 0
        if kind == 1:
            guess = left
        elif kind == 3:
            guess = (left + up[i]) // 2
        else:
            corner = up[i - step] if i >= step else 0
            p = left + up[i] - corner
            near = (abs(p - left), abs(p - up[i]), abs(p - corner))
            guess = (left, up[i], corner)[near.index(min(near))]
        out[i] = (out[i] + guess) & 255
    return out.astype(np.uint8)


def read_exr(path):
    """Channel name -> array of float32 (or uint32): single part, scan lines, no compression or ZIP."""
    with open(path, "rb") as file:
        data = file.read()
    if struct.unpack_from("<I", data)[0] != 20000630:
        raise ValueError(path + " is no EXR file")
    at, attributes = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name = data[at:end].decode()
        end2 = data.index(b"\0", end + 1)
        size, = struct.unpack_from("<i", data, end2 + 1)
        attributes[name] = data[end2 + 5:end2 + 5 + size]
        at = end2 + 5 + size
    at += 1
    channels, place, listed = [], 0, attributes["channels"]
    while listed[place]:
        end = listed.index(b"\0", place)
        kind, = struct.unpack_from("<i", listed, end + 1)
        channels.append((listed[place:end].decode(), {0: "<u4", 1: "<f2", 2: "<f4"}[kind]))
        place = end + 17
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = attributes["compression"][0]
    lines = {0: 1, 2: 1, 3: 16}[compression]
    blocks = -(-height // lines)
    offsets = struct.unpack_from("<%dQ" % blocks, data, at)
    out = {name: np.zeros((height, width), code) for name, code in channels}
    row = sum(np.dtype(code).itemsize for _, code in channels) * width
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        count = min(lines, height - (y - y0))
        body = data[offset + 8:offset + 8 + size]
        if compression and size < row * count:
            body = unpredict(zlib.decompress(body))
        place = 0
        for line in range(count):
            for name, code in channels:
                out[name][y - y0 + line] = np.frombuffer(body, code, width, place)
                place += width * np.dtype(code).itemsize
    return out


def unpredict(packed):
    bytes_ = np.frombuffer(packed, np.uint8).astype(np.int64)
    bytes_[1:] -= 128
    summed = (np.cumsum(bytes_) & 255).astype(np.uint8)
    half = (len(summed) + 1) // 2
    out = np.zeros(len(summed), np.uint8)
    out[0::2] = summed[:half]
    out[1::2] = summed[half:]
    return out.tobytes()


def read_flo(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"PIEH":
        raise ValueError(path + " is no .flo file")
    width, height = struct.unpack_from("<ii", data, 4)
    return np.frombuffer(data, "<f4", width * height * 2, 12).reshape(height, width, 2)
