#!/usr/bin/env python3
"""Flies ahead, turns where something is near, and reports where it sees something warm."""
import base64
import json
import math
import sys

import numpy as np

start = json.loads(sys.stdin.readline())
camera, reported, side = start["camera"], [], 1
for line in sys.stdin:
    seen = json.loads(line)
    if seen["type"] == "end":
        break
    depth, kelvin = (np.frombuffer(base64.b64decode(seen[name]), "<u2").reshape(camera["height"], -1) * unit
                     for name, unit in (("depth_mm", 0.001), ("thermal_ck", 0.01)))
    answer = {"velocity": [0, 0, 0], "turn": 0, "report": []}
    v, u = np.nonzero((kelvin > 295) & (depth > 0) & (depth < 2.5))
    if len(v) > 20:  # to the world: X ahead, Y left, Z up, turned by the yaw
        ahead = depth[v, u]
        left, up = (camera["cx"] - u) / camera["fx"] * ahead, (camera["cy"] - v) / camera["fy"] * ahead
        c, s = math.cos(seen["yaw"]), math.sin(seen["yaw"])
        moved = np.stack([c * ahead - s * left, s * ahead + c * left, up]).mean(axis=1)
        place = [p + float(m) for p, m in zip(seen["position"], moved)]
        if all(math.dist(place, other) > 1 for other in reported):
            reported.append(place)
            answer["report"] = [place]
    near = np.where(depth > 0, depth, camera["max_range"])[20:40]
    if seen["stopped"] or near[:, 25:55].min() < 0.5:
        answer["turn"] = side * start["turn_rate"]
    else:
        side = 1 if near[:, :40].mean() > near[:, 40:].mean() else -1
        answer["velocity"][0] = start["speed"]
    print(json.dumps(answer), flush=True)
