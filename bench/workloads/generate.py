#!/usr/bin/env python3
"""Writes the standard settling workloads w0.txt, w1.txt and w2.txt (format and rules: README.md).

The same Python version gives the same bytes; a file that differs from its checksum is an error,
because figures taken with it could not be compared.
"""
import argparse
import hashlib
import math
import pathlib
import random
import sys

# name: layers, pieces per layer, seed, MD5
WORKLOADS = {
    "w0": (1, 100, 3, "a3ae7a0a00167e45a1b41bbab1d69e4e"),
    "w1": (4, 300, 1, "30191f58089166ff7f7444bda294272f"),
    "w2": (15, 250, 2, "62d2098e52bde7ce3e0d19fe87322faa"),
}
CHUNKS = 8
SLAB, BLOCK, BRICK, REBAR = 8, 9, 10, 11
FOOTPRINT = 10.0  # edge of the square on which pieces are dropped; m
HEIGHT = 7.0  # of the spawn volume; m


def chunk(rng):
    """A broken lump: 20 points near an ellipsoid of half axes 1, 0.8 and 0.55."""
    points = []
    for _ in range(20):
        length = 0.0
        while length <= 1e-6:
            v = [rng.gauss(0, 1) for _ in range(3)]
            length = math.sqrt(sum(c * c for c in v))
        half_axes = [1.0, 0.8, 0.55]
        k = rng.uniform(0.8, 1.0)
        points.append([k * half_axes[i] * v[i] / length for i in range(3)])
    return points


def box(x, y, z):
    return [[i * x / 2, j * y / 2, k * z / 2] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]


def prism(length, radius, sides=6):
    angles = [2 * math.pi * k / sides for k in range(sides)]
    return [
        [i * length / 2, radius * math.cos(a), radius * math.sin(a)] for i in (-1, 1) for a in angles
    ]


def make_shapes():
    rng = random.Random(12345)
    shapes = [("chunk%d" % i, chunk(rng)) for i in range(CHUNKS)]
    shapes.append(("slab", box(1.2, 0.8, 0.12)))
    shapes.append(("block", box(0.4, 0.2, 0.2)))
    shapes.append(("brick", box(0.215, 0.1025, 0.065)))
    shapes.append(("rebar", prism(1.5, 0.02)))
    return shapes


def draw_piece(rng):
    """Index of a shape, and its scale."""
    u = rng.random()
    if u < 0.55:
        return rng.randrange(CHUNKS), rng.uniform(0.12, 0.45)
    if u < 0.70:
        return SLAB, rng.uniform(0.7, 1.3)
    if u < 0.85:
        return BLOCK, 1.0
    if u < 0.95:
        return BRICK, 1.0
    return REBAR, rng.uniform(0.7, 1.3)


def draw_rotation(rng):
    """A uniformly distributed unit quaternion w, x, y, z (Shoemake 1992)."""
    u1, u2, u3 = rng.random(), rng.random(), rng.random()
    a, b = math.sqrt(1 - u1), math.sqrt(u1)
    p, q = 2 * math.pi * u2, 2 * math.pi * u3
    return b * math.cos(q), a * math.sin(p), a * math.cos(p), b * math.sin(q)


def draw_position(rng, radius, placed):
    """A place where the bounding sphere touches no other one; z is above the bottom."""
    while True:
        half = FOOTPRINT / 2
        p = (rng.uniform(-half, half), rng.uniform(-half, half), rng.uniform(radius, HEIGHT))
        if all(math.dist(p, centre) > radius + other for centre, other in placed):
            return p


def make_workload(shapes, layers, per_layer, seed):
    radii = [max(math.hypot(*p) for p in points) for _, points in shapes]
    rng = random.Random(seed)
    lines = ["shapes %d" % len(shapes)]
    for name, points in shapes:
        lines.append("shape %s %d" % (name, len(points)))
        lines += ["%.9g %.9g %.9g" % tuple(p) for p in points]
    for _ in range(layers):
        lines.append("layer %d" % per_layer)
        placed = []
        for _ in range(per_layer):
            shape, scale = draw_piece(rng)
            rotation = draw_rotation(rng)
            radius = scale * radii[shape]
            position = draw_position(rng, radius, placed)
            placed.append((position, radius))
            numbers = (scale, *position, *rotation)
            lines.append("%d " % shape + " ".join("%.9g" % n for n in numbers))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="folder")
    parser.add_argument("names", nargs="*", default=[], help="w0, w1, w2; none: all three")
    args = parser.parse_args()
    unknown = [name for name in args.names if name not in WORKLOADS]
    if unknown:
        parser.error("no workload is named " + ", ".join(unknown))
    shapes = make_shapes()
    for name in args.names or WORKLOADS:
        layers, per_layer, seed, md5 = WORKLOADS[name]
        data = make_workload(shapes, layers, per_layer, seed).encode()
        found = hashlib.md5(data, usedforsecurity=False).hexdigest()
        if found != md5:
            sys.exit("%s.txt: MD5 %s, expected %s: this Python draws other numbers"
                     % (name, found, md5))
        path = args.out / (name + ".txt")
        part = path.with_suffix(".part")
        part.write_bytes(data)
        part.replace(path)


if __name__ == "__main__":
    main()
