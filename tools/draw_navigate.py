#!/usr/bin/python3
"""Draws a mission of `rubble bench navigate` from above: what stands in the crawler's way, the void's roof, its way and the
goal.

usage: PYTHONPATH=build/release/python tools/draw_navigate.py MISSION SEED FOLDER/ways/SEED.csv... OUT.png

docs/pictures/navigate.png:
  rubble bench navigate scripts/navigate.lua --seeds 2 --planner none --out out/navigate/none
  rubble bench navigate scripts/navigate.lua --seeds 2 --planner ompl --out out/navigate/ompl
  tools/draw_navigate.py scripts/navigate.lua 2 out/navigate/none/ways/2.csv out/navigate/ompl/ways/2.csv docs/pictures/navigate.png

Several ways of one seed, as of different planners, are drawn side by side. Needs python3-numpy and python3-matplotlib.
"""
import csv
import os
import sys

import matplotlib
import numpy as np

import rubble

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

STEP = 0.04  # of the picture's grid; m
LOW, HIGH = 0.12, 0.48  # what is in between stands in the robot's way; m


def survey(pile, box):
    """Whether something stands in the robot's way, and whether there is a roof above it; by row and column."""
    x, y = np.arange(box[0], box[1], STEP), np.arange(box[2], box[3], STEP)
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    solid = np.zeros(len(places), bool)
    for height in np.arange(LOW, HIGH, 0.06):
        solid |= pile.clearance(np.column_stack([places, np.full(len(places), height)]), 0.01) == 0
    up = pile.cast_rays(np.column_stack([places, np.full(len(places), HIGH)]), np.tile([0.0, 0, 1], (len(places), 1)))
    shape = (len(y), len(x))
    return solid.reshape(shape), np.isfinite(up["distance"]).reshape(shape)


def read_way(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def draw(axis, way, picture, box):
    solid, roof = picture
    shades = np.ones((*solid.shape, 3))
    shades[roof] = 0.88
    shades[solid] = (0.55, 0.45, 0.38)
    axis.imshow(shades, origin="lower", extent=box, interpolation="nearest")
    axis.plot(way["x"], way["y"], "-", color="tab:blue", linewidth=1.4, label="its way")
    for k in range(0, len(way["x"]), 25):  # the robot every five seconds, to scale
        ahead = np.array([np.cos(way["yaw"][k]), np.sin(way["yaw"][k])])
        left = np.array([-ahead[1], ahead[0]])
        corners = [np.array([way["x"][k], way["y"][k]]) + 0.34 * a * ahead + 0.25 * b * left
                   for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
        axis.add_patch(plt.Polygon(corners, fill=False, color="tab:blue", linewidth=0.5))
    axis.plot(way["target_x"], way["target_y"], ".", color="tab:orange", markersize=3, label="places it drove to")
    axis.plot(way["x"][0], way["y"][0], "ko", markersize=4, label="start")
    axis.plot(way["goal_x"][0], way["goal_y"][0], "g*", markersize=11, label="goal")
    folder = os.path.dirname(os.path.dirname(os.path.abspath(way["path"])))
    axis.set_title(f"{os.path.basename(folder)}: {way['time_s'][-1]:.0f} s", fontsize=10)
    axis.set_xlabel("x, m")
    axis.set_ylabel("y, m")


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    mission, seed, paths, out = sys.argv[1], int(sys.argv[2]), sys.argv[3:-1], sys.argv[-1]
    pile = rubble.settle(mission, seed=seed)
    ways = [dict(read_way(path), path=path) for path in paths]
    x, y = (np.concatenate([np.append(way[name], way[f"goal_{name}"]) for way in ways]) for name in "xy")
    box = (min(x.min(), -1) - 1, max(x.max(), 4) + 1, min(y.min(), -3) - 1, max(y.max(), 3) + 1)
    picture = survey(pile, box)
    figure, axes = plt.subplots(1, len(ways), figsize=(3.8 * len(ways), 5.2), constrained_layout=True, squeeze=False)
    for axis, way in zip(axes[0], ways):
        draw(axis, way, picture, box)
    axes[0][0].legend(fontsize=7, loc="lower right")
    figure.savefig(out, dpi=90)


if __name__ == "__main__":
    main()
