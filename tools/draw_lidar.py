#!/usr/bin/python3
"""Draws a scan of a LiDAR from above: as measured, corrected by the true motion, and that of another run.

usage: draw_lidar.py RUN NAME OUT.png [--beside OTHER_RUN] [--scan N]

Both runs need outputs.pcd. Needs python3-numpy and python3-matplotlib.
"""
import argparse

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")])


def read_pcd(path):
    data = open(path, "rb").read()
    return np.frombuffer(data[data.index(b"DATA binary\n") + 12:], POINT)


def matrices(rows):
    w, x, y, z = rows[:, 7], rows[:, 4], rows[:, 5], rows[:, 6]
    return np.stack([np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
                     np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], -1),
                     np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1)], -2)


def in_world(folder, scan, straight):
    """The points of a scan, placed by the pose at its stamp, or each by the pose at its own time."""
    stamp, name = open(f"{folder}/stamps.txt").read().split("\n")[scan].split()
    points, motion = read_pcd(f"{folder}/{name}"), np.loadtxt(f"{folder}/motion.txt")
    times = float(stamp) + (points["time"].astype(float) if straight else 0 * points["time"])
    row = np.clip(np.searchsorted(motion[:, 0], times, "right") - 1, 0, len(motion) - 2)
    share = ((times - motion[row, 0]) / (motion[row + 1, 0] - motion[row, 0]))[:, None]
    xyz = np.stack([points["x"], points["y"], points["z"]], -1).astype(float)
    poses = matrices(motion)
    placed = [np.einsum("nij,nj->ni", poses[r], xyz) + motion[r, 1:4] for r in (row, row + 1)]
    return placed[0] * (1 - share) + placed[1] * share, points["intensity"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("name")
    parser.add_argument("out")
    parser.add_argument("--beside")
    parser.add_argument("--scan", type=int, default=5)
    args = parser.parse_args()
    views = [("as measured, placed by the pose at its stamp", args.run, False),
             ("corrected by the true motion", args.run, True)]
    if args.beside:
        views.append(("the same in smoke", args.beside, True))
    figure, axes = plt.subplots(1, len(views), figsize=(5 * len(views), 5), facecolor="black")
    for axis, (title, run, straight) in zip(np.atleast_1d(axes), views):
        points, intensity = in_world(f"{run}/pcd/{args.name}", args.scan, straight)
        order = np.argsort(points[:, 2])
        axis.scatter(points[order, 0], points[order, 1], c=points[order, 2], s=2.0, cmap="turbo", vmin=-0.3, vmax=1.2,
                     linewidths=0)
        axis.set(xlim=(-5, 3), ylim=(-4, 4), aspect="equal", facecolor="black")
        axis.set_title(title, color="white", fontsize=10)
        axis.tick_params(colors="white", labelsize=7)
    figure.tight_layout()
    figure.savefig(args.out, dpi=80)


if __name__ == "__main__":
    main()
