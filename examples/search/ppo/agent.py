#!/usr/bin/env python3
"""A learned policy as an agent of `rubble bench search`; weights.npz is what train.py wrote.

usage: rubble bench search MISSION --agent "python3 examples/search/ppo/agent.py weights.npz"

It draws each action by its probability, from the seed of the search, and reports what is warm as ../agent.py does.
"""
import base64
import json
import math
import sys

import numpy as np

from senses import ACTIONS, HOLD, Senses, coarse_depth, policy


def find_warm(seen, depth, kelvin, camera):
    """The middle of what is warm and near, in the world; None: there is none."""
    v, u = np.nonzero((kelvin > 295) & (depth > 0) & (depth < 2.5))
    if len(v) <= 20:
        return None
    ahead = depth[v, u]
    left, up = (camera["cx"] - u) / camera["fx"] * ahead, (camera["cy"] - v) / camera["fy"] * ahead
    c, s = math.cos(seen["yaw"]), math.sin(seen["yaw"])
    moved = np.stack([c * ahead - s * left, s * ahead + c * left, up]).mean(axis=1)
    return [p + float(m) for p, m in zip(seen["position"], moved)]


def main():
    weights = np.load(sys.argv[1])
    start = json.loads(sys.stdin.readline())
    camera, reported, senses = start["camera"], [], Senses()
    random = np.random.default_rng(start["seed"])
    action, left = None, 0
    for line in sys.stdin:
        seen = json.loads(line)
        if seen["type"] == "end":
            break
        depth, kelvin = (np.frombuffer(base64.b64decode(seen[name]), "<u2").reshape(camera["height"], -1) * unit
                         for name, unit in (("depth_mm", 0.001), ("thermal_ck", 0.01)))
        if left == 0 or seen["stopped"]:
            scores = policy(weights, senses.encode(coarse_depth(depth), seen["position"], seen["yaw"], seen["stopped"]))
            chance = np.exp(scores - scores.max())
            action, left = ACTIONS[random.choice(len(ACTIONS), p=chance / chance.sum())], HOLD
        left -= 1
        answer = {"velocity": (action[:3] * start["speed"]).tolist(), "turn": action[3] * start["turn_rate"]}
        place = find_warm(seen, depth, kelvin, camera)
        if place and all(math.dist(place, other) > 1 for other in reported):
            reported.append(place)
            answer["report"] = [place]
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
