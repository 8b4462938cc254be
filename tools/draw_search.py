#!/usr/bin/python3
"""Stands between `rubble bench search` and an agent and keeps what the agent saw where it saw most warmth, its way and its
reports; then draws them: depth, heat, and the way from above.

usage: rubble bench search MISSION --seeds 1 --agent "tools/draw_search.py record SEEN.json COMMAND..."
       tools/draw_search.py draw SEEN.json OUT.png

Needs python3-numpy, and to draw python3-matplotlib. They are two steps because an agent has two seconds to end.
"""
import base64
import json
import subprocess
import sys

import numpy as np


def picture(text, camera, unit):
    return np.frombuffer(base64.b64decode(text), "<u2").reshape(camera["height"], -1) * unit


def draw(seen, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    start, best, way, reports, end = (seen[name] for name in ("start", "best", "way", "reports", "end"))
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
    axes[2].set_xlim(x0 - 3, x1 + 3)  # agents may fly away
    axes[2].set_ylim(y0 - 3, y1 + 3)
    axes[2].set_xlabel("x, m")
    axes[2].set_ylabel("y, m")
    axes[2].legend(fontsize=8, loc="upper right")
    figure.savefig(path, dpi=90)


def record(path, command):
    agent = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    first = sys.stdin.readline()
    seen, most = {"start": json.loads(first), "best": None, "way": [], "reports": []}, -1
    agent.stdin.write(first)
    for line in sys.stdin:
        now = json.loads(line)
        agent.stdin.write(line)
        agent.stdin.flush()
        if now["type"] == "end":
            seen["end"] = now
            with open(path, "w") as file:
                json.dump(seen, file)
            break
        seen["way"].append(now["position"])
        warm = int((picture(now["thermal_ck"], seen["start"]["camera"], 0.01) > 295).sum())
        if warm > most:
            seen["best"], most = now, warm
        answer = agent.stdout.readline()
        seen["reports"] += json.loads(answer).get("report", [])
        print(answer, end="", flush=True)


def main():
    if len(sys.argv) > 3 and sys.argv[1] == "record":
        record(sys.argv[2], sys.argv[3:])
    elif len(sys.argv) == 4 and sys.argv[1] == "draw":
        with open(sys.argv[2]) as file:
            draw(json.load(file), sys.argv[3])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
