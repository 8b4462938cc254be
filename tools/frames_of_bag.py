#!/usr/bin/python3
"""Puts some colour frames of a bag side by side into one PNG file.

usage: frames_of_bag.py BAG OUTPUT.png SIZE INDEX [INDEX ...]
SIZE is the width and height of each picture, a divisor of the frames' own.
"""
import struct
import sys
import zlib

import numpy as np
import rosbag


def read_frames(path, indices):
    frames = {}
    with rosbag.Bag(path) as bag:
        for i, (_, m, _) in enumerate(bag.read_messages(topics=["/camera/rgb/image_raw"])):
            if i in indices:
                frames[i] = np.frombuffer(m.data, np.uint8).reshape(m.height, m.width, 3)
    missing = [str(i) for i in indices if i not in frames]
    if missing:
        sys.exit("%s: no frame %s" % (path, ", ".join(missing)))
    return [frames[i] for i in indices]


def shrink(image, size):
    """The mean over square blocks, in light rather than in code values."""
    n = image.shape[0] // size
    light = (image[:n * size, :n * size] / 255.0) ** 2.2
    light = light.reshape(size, n, size, n, 3).mean(axis=(1, 3))
    return np.round(light ** (1 / 2.2) * 255).astype(np.uint8)


def write_png(path, image):
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    # Each row as the difference from the one above (filter 2): smaller for pictures.
    above = np.vstack([np.zeros_like(image[:1]), image[:-1]])
    rows = (image - above).reshape(image.shape[0], -1)
    raw = b"".join(b"\2" + row.tobytes() for row in rows)
    header = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 8, 2, 0, 0, 0)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                  chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def main(bag, output, size, *indices):
    frames = read_frames(bag, [int(i) for i in indices])
    write_png(output, np.hstack([shrink(f, int(size)) for f in frames]))


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
