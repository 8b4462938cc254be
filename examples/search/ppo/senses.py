"""What the policy sees, both in training and in the search benchmark, and what it can do.

A picture of 16 x 12 depths, 90 degrees across; how often the body has been in the half metres around it; how high it
is above its start; and whether it was just stopped.
"""
import math

import numpy as np

ROWS, COLUMNS = 12, 16
FAR = 8.0  # m
CELL, AROUND, MOST_VISITS = 0.5, 11, 8  # of the map of visits: side of a cell in m, cells, and where counting ends
SIZE = ROWS * COLUMNS + AROUND * AROUND + 2

HOLD = 3  # steps of 0.2 s that an action lasts, unless the body is stopped
# Forwards, left, up and turn to the left, each from -1 to 1.
ACTIONS = np.array([[1, 0, 0, 0], [0.7, 0, 0, 0.7], [0.7, 0, 0, -0.7], [0, 0, 0, 1], [0, 0, 0, -1],
                    [0.3, 0, 0.7, 0], [0.3, 0, -0.7, 0]], float)


class Senses:
    def __init__(self):
        half = AROUND // 2
        steps = (np.arange(AROUND) - half) * CELL
        self._ahead, self._left = (a.ravel() for a in np.meshgrid(steps, steps, indexing="ij"))
        self._visits = {}
        self._start = None

    def encode(self, depth, position, yaw, stopped):
        """depth: ROWS x COLUMNS along the optical axis, m; 0 or FAR: nothing. yaw: rad."""
        x, y, z = position
        if self._start is None:
            self._start = z
        here = (math.floor(x / CELL), math.floor(y / CELL))
        self._visits[here] = min(self._visits.get(here, 0) + 1, MOST_VISITS)
        c, s = math.cos(yaw), math.sin(yaw)
        i = np.floor((x + c * self._ahead - s * self._left) / CELL).astype(int).tolist()
        j = np.floor((y + s * self._ahead + c * self._left) / CELL).astype(int).tolist()
        visits = [self._visits.get(cell, 0) / MOST_VISITS for cell in zip(i, j)]
        depth = np.where((depth <= 0) | (depth > FAR), FAR, depth).ravel()
        return np.concatenate([1 / (1 + depth), visits, [z - self._start, float(stopped)]]).astype(np.float32)


def coarse_depth(picture):
    """ROWS x COLUMNS of a picture of 60 x 80: the middle of each block of 5 x 5."""
    return picture[2::5, 2::5]


def policy(weights, seen):
    """Scores of the actions: two hidden layers with tanh."""
    for layer in range(2):
        seen = np.tanh(seen @ weights[f"w{layer}"] + weights[f"b{layer}"])
    return seen @ weights["w2"] + weights["b2"]
