"""What a robot on the ground knows of itself, its goal and the pile: of CrawlerNav and TeamNav."""
import numpy as np

from .. import _core, geometry
from ..arguments import real, whole
from .spaces import Box

EYE = np.array([0.0, 0.0, 0.25])  # of the scan, in the base; m
MOST = 50.0                       # of a component of the observation that has no limit of its own

# What may be drawn for each episode.
GROUND_KEYS = ("calibration.range_scale", "calibration.range_noise", "calibration.dropout", "materials.friction", "poses.*")


def bearing(base, place):
    """Distance, and cosine and sine of the bearing in the plane of the base, of a place of the world."""
    away = geometry.rotate(base, place - base[:3], back=True)
    flat = max(float(_core._lengths(away[None, :2])[0]), 1e-9)
    return float(_core._lengths(away[None])[0]), away[0] / flat, away[1] / flat


def bearing_box(shape, parts=(), unit=""):
    return Box(np.float32([0, -1, -1]), np.float32([2 * MOST, 1, 1]), shape, np.float32, parts=parts, unit=unit)


def within_bearing(values):
    return np.array(values, np.float32).clip([0, -1, -1], [2 * MOST, 1, 1]).astype(np.float32)


def is_fallen(state):
    """Whether the base lies on its back or side, or has left the world."""
    return bool(geometry.matrix(state["links"][0])[2, 2] < 0.1 or state["lost"])


class GroundSenses:
    def __init__(self, rays, max_range, drawn):
        """drawn: the Drawn of the environment."""
        rays, self._max_range, self._drawn = whole("rays", rays, 1, 100_000), real("max_range", max_range), drawn
        turns = _core._directions(2 * np.pi * np.arange(rays) / rays)
        self._rays = np.append(turns, np.zeros((rays, 1)), axis=1)

    def spaces(self):
        return {"goal": bearing_box((3,), [("distance", "m"), ("cosine of bearing", ""), ("sine of bearing", "")]),
                "motion": Box(-MOST, MOST, (6,), np.float32, parts=[(f"velocity along {axis}", "m/s") for axis in "XYZ"]
                              + [(f"turning about {axis}", "rad/s") for axis in "XYZ"]),
                "scan": Box(0.0, self._max_range, (len(self._rays),), np.float32, unit="m"),
                "tilt": Box(-1.0, 1.0, (3,), np.float32, parts=[(f"vertical along {axis}", "") for axis in "XYZ"])}

    def observe(self, pile, state, goal):
        base = state["links"][0]
        hits = pile.cast_rays((base[:3] + geometry.rotate(base, EYE))[None], geometry.rotate(base, self._rays),
                              self._max_range)
        motion = geometry.rotate(base, [state["linear_velocity"], state["angular_velocity"]], back=True).ravel()
        scan = self._drawn.measure(np.minimum(hits["distance"], self._max_range), self._max_range)
        return {"goal": within_bearing(bearing(base, goal)),
                "motion": np.clip(motion, -MOST, MOST).astype(np.float32), "scan": scan.astype(np.float32),
                "tilt": np.clip(geometry.matrix(base)[2, :3], -1, 1).astype(np.float32)}
