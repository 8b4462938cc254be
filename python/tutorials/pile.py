"""Settle a pile and ask it questions: python3 pile.py MISSION.lua"""
import sys

import numpy as np

import rubble

pile = rubble.settle(sys.argv[1], seed=3)
print(f"{len(pile)} pieces, settled: {pile.settled}, hash {pile.state_hash:016x}")

# What lies under each point of a grid, seen from above.
x, y = np.meshgrid(np.linspace(-2, 2, 41), np.linspace(-2, 2, 41))
from_above = np.stack([x.ravel(), y.ravel(), np.full(x.size, 10.0)], axis=1)
hits = pile.cast_rays(from_above, np.tile([0.0, 0.0, -1.0], (x.size, 1)))
heights = 10 - hits["distance"].reshape(x.shape)
print(f"the pile is {heights.max():.2f} m high; {np.mean(hits['piece'] >= 0):.0%} of the square is covered")

# How much room there is.
print("room for a ball 1 m above the middle:", pile.clearance([[0, 0, heights.max() + 1]]).round(3))
for void in pile.voids(radius=0.1, voxel=0.05)[:3]:
    print(f"a void of {void['volume']:.3f} m3, {len(void['entrances'])} entrances, reaches {void['path_length']:.2f} m in")
