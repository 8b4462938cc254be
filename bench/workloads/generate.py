#!/usr/bin/env python3
"""Writes the standard settling workloads w0.txt, w1.txt and w2.txt, and benches of other engines (README.md has the format
and the rules).

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
# name: MD5. Rebuilt from the published parameters of PerformanceTest of Jolt Physics and of Box3D's benchmark.
OTHERS = {
    "pyramid": "af2d5a2a712f6533c2fb9bacf97028d3",
    "convex_vs_mesh": "23774db58b7d8da83047b312c8c7f560",
    "convex_pile": "0e97f1d91cc69279c26d91810299b573",
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


def write_scene(shapes, pieces, terrain=()):
    """pieces: (index of the shape, place), none turned. terrain: heights in rows along x, and the side of a cell."""
    lines = ["shapes %d" % len(shapes)]
    for name, points in shapes:
        lines.append("shape %s %d" % (name, len(points)))
        lines += ["%.9g %.9g %.9g" % tuple(p) for p in points]
    if terrain:
        heights, cell = terrain
        lines.append("terrain %d %d %.9g" % (len(heights[0]), len(heights), cell))
        lines += [" ".join("%.9g" % h for h in row) for row in heights]
    lines.append("layer %d" % len(pieces))
    lines += ["%d 1 %.9g %.9g %.9g 1 0 0 0" % (shape, *place) for shape, place in pieces]
    return "\n".join(lines) + "\n"


def make_pyramid():
    """Boxes of 2 m in 15 courses, half a metre apart, so that each course falls onto the one below."""
    side, gap, height = 2.0, 0.5, 15
    pieces = []
    for i in range(height):
        shift = side / 2 if i % 2 else 0.0
        for j in range(i // 2, height - (i + 1) // 2):
            for k in range(i // 2, height - (i + 1) // 2):
                pieces.append((0, (side * j - height + shift, side * k - height + shift, 1 + (side + gap) * i)))
    return write_scene([("box", box(side, side, side))], pieces)


def sphere_points(radius, turns=6, rings=5):
    """A sphere as a hull, with a point at each pole."""
    points = [(0.0, 0.0, -radius), (0.0, 0.0, radius)]
    for ring in range(1, rings + 1):
        polar = math.pi * ring / (rings + 1)
        for turn in range(turns):
            angle = 2 * math.pi * (turn + 0.5 * (ring % 2)) / turns
            points.append((radius * math.sin(polar) * math.cos(angle), radius * math.sin(polar) * math.sin(angle), radius * math.cos(polar)))
    return points


def make_convex_vs_mesh():
    """Boxes, spheres, capsules and pyramids that fall onto waves of 5 m. What is round is a hull of 32 points here."""
    cells, cell, amplitude = 100, 3.0, 5.0
    heights = [[amplitude * (1 + math.sin(x * 50 / cells) * math.cos(y * 50 / cells)) for x in range(cells + 1)] for y in range(cells + 1)]
    ball = sphere_points(0.5)
    shapes = [("box", box(1.0, 2.0, 1.5)), ("sphere", ball),
              ("capsule", [(x, y, z + end) for x, y, z in ball for end in (-0.75, 0.75) if z * end > -1e-9]),
              ("pyramid", [(0, 0, 1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)])]
    pieces = [(shape, (7.5 * x, 7.5 * y, 15.0 + 2.0 * shape)) for x in range(-10, 11) for shape in range(4) for y in range(-10, 11)]
    return write_scene(shapes, pieces, (heights, cell))


def make_convex_pile():
    """8 x 8 columns of 80 hulls of 32 points on a sphere of 2 m, which touch each other's spheres."""
    columns, layers, radius = 8, 80, 2.0
    rng = random.Random(42)
    points = []
    for _ in range(32):
        v = [rng.gauss(0, 1) for _ in range(3)]
        length = math.sqrt(sum(c * c for c in v))
        points.append([radius * c / length for c in v])
    pieces = [(0, (2 * radius * (x - columns / 2), 2 * radius * (y - columns / 2), radius + 2 * radius * layer))
              for layer in range(layers) for y in range(columns) for x in range(columns)]
    return write_scene([("hull", points)], pieces)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="folder")
    parser.add_argument("names", nargs="*", default=[], help="%s; none: all" % ", ".join([*WORKLOADS, *OTHERS]))
    args = parser.parse_args()
    makers = {name: lambda name=name: make_workload(make_shapes(), *WORKLOADS[name][:3]) for name in WORKLOADS}
    makers.update(pyramid=make_pyramid, convex_vs_mesh=make_convex_vs_mesh, convex_pile=make_convex_pile)
    sums = {**{name: work[3] for name, work in WORKLOADS.items()}, **OTHERS}
    unknown = [name for name in args.names if name not in makers]
    if unknown:
        parser.error("no workload is named " + ", ".join(unknown))
    for name in args.names or makers:
        data = makers[name]().encode()
        found = hashlib.md5(data, usedforsecurity=False).hexdigest()
        if found != sums[name]:
            sys.exit("%s.txt: MD5 %s, expected %s: this Python draws other numbers"
                     % (name, found, sums[name]))
        path = args.out / (name + ".txt")
        part = path.with_suffix(".part")
        part.write_bytes(data)
        part.replace(path)


if __name__ == "__main__":
    main()
