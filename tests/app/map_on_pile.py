#!/usr/bin/python3
"""Measures how far the points of an MRPT map (text, x y z a line) lie from the triangles of an STL
file and from the ground z = 0.

usage: map_on_pile.py POINTS STL SAMPLES
Prints "points N max_mm M on_pile K".
"""
import sys

import numpy as np

from unproject_bag import distance_to_triangles, read_stl


def main(points_path, stl_path, samples):
    triangles = read_stl(stl_path)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    points = np.loadtxt(points_path)
    points = points[np.linalg.norm(points, axis=1) < 20]  # of the ground, what is near
    chosen = points[np.linspace(0, len(points) - 1, samples).astype(int)]
    worst, on_pile = 0.0, 0
    for p in chosen:
        near = np.all((low < p + 0.01) & (high > p - 0.01), axis=1)
        to_pile = distance_to_triangles(p, triangles[near]) if near.any() else np.inf
        worst = max(worst, min(to_pile, abs(p[2])))
        on_pile += to_pile < abs(p[2])
    print("points %d max_mm %.4f on_pile %d" % (len(chosen), 1000 * worst, on_pile))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
