#!/usr/bin/python3
"""Stands between `rubble bench search` and an agent, and draws what the agent saw where it saw most warmth: depth,
heat, and its way from above with its reports.

usage: rubble bench search MISSION --seeds 1 --agent "tools/draw_search.py OUT.png COMMAND..."

Needs python3-numpy and python3-matplotlib.
"""
import base64
import json
import subprocess
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def picture(text, camera, unit):
    return np.frombuffer(base64.b64decode(text), "<u2").reshape(camera["height"], -1) * unit


def draw(path, start, best, way, reports, end):
    camera = start["camera"]
    depth = picture(best["depth_mm"], camera, 0.001)
    celsius = picture(best["thermal_ck"], camera, 0.01) - 273.15
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.4), constrained_layout=True)
    for axis, values, title, colours, unit in ((axes[0], np.where(depth > 0, depth, np.nan), "depth", "viridis", "m"),
                                               (axes[1], celsius, "heat", "inferno", "°C")):
        figure.colorbar(axis.imshow(values, cmap=colours, interpolation="nearest"), ax=axis, label=unit, shrink=0.8)
        axis.set_title(f"{title} at {best['time']:.0f} s")
        axis.set_axis_off()
    (x0, y0, _), (x1, y1, _) = start["bounds"]
    axes[2].add_patch(plt.Rectangle((x0, y0), x1 - x0, y1 - y0, color="0.9"))
    axes[2].plot(*np.array(way)[:, :2].T, linewidth=0.8, label="its way")
    if reports:
        axes[2].plot(*np.array(reports)[:, :2].T, "rx", label="its reports")
    axes[2].set_title(f"{end['found']} of {end['victims']} found")
    axes[2].set_aspect("equal")
    axes[2].set_xlabel("x, m")
    axes[2].set_ylabel("y, m")
    axes[2].legend(fontsize=8)
    figure.savefig(path, dpi=90)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    agent = subprocess.Popen(sys.argv[2:], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    first = sys.stdin.readline()
    start, best, most, way, reports = json.loads(first), None, -1, [], []
    agent.stdin.write(first)
    for line in sys.stdin:
        seen = json.loads(line)
        agent.stdin.write(line)
        agent.stdin.flush()
        if seen["type"] == "end":
            draw(sys.argv[1], start, best, way, reports, seen)
            break
        way.append(seen["position"])
        warm = int((picture(seen["thermal_ck"], start["camera"], 0.01) > 295).sum())
        if warm > most:
            best, most = seen, warm
        answer = agent.stdout.readline()
        reports += json.loads(answer).get("report", [])
        print(answer, end="", flush=True)


if __name__ == "__main__":
    main()
