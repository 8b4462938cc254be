"""A pile with the void that is explored in it: of VoidExplore and SnakeExplore."""
import numpy as np

from .. import _core
from ..sensors import Renderer
from .pictures import Section, to_levels, upscale
from .settled import settle_text

_SIZE = 256  # of the pictures of render(), in pixels


class VoidWorld:
    """The pile of a seed with its largest void that a ball of `radius` can enter (void: None where there is none),
    and what is seen of it."""

    def __init__(self, mission, seed, radius, voxel, size, fov_deg, max_range, colour, threads, metres):
        self.pile = settle_text(mission, seed, threads)
        voids = [v for v in self.pile.voids(radius, voxel) if v["entrances"]]
        self.void = voids[0] if voids else None
        if not self.void:
            return
        entrance = self.void["entrances"][0]
        self.entrance, inward = entrance["position"], entrance["inward"]
        self.yaw = _core._atan2(inward[1], inward[0])
        self.view = _core._Explorer(self.pile._shared, self.void["cells"], voxel, radius, size, fov_deg, max_range,
                                    threads)
        self.renderer = Renderer(self.pile, threads) if colour else None
        self._size, self._fov_deg, self._max_range, self._metres = size, fov_deg, max_range, metres

    def look(self, pose):
        """(depth, clearance, colour or None) of a body there; what it shows of the void counts as seen. Depth as
        pictures.depth_space() says."""
        depth, clearance = self.view.look(pose)
        if not self._metres:
            depth = to_levels(depth, self._max_range)
        rgb = self.renderer.render(pose, self._size, self._size, self._fov_deg)["rgb"] if self.renderer else None
        return depth, clearance, rgb

    def draw(self, pose, picture, places):
        """What render() returns: the section at the height of the body, 4 m wide, beside what its camera sees."""
        section = Section(self.pile, pose[:3], 2.0, _SIZE)
        section.draw_way(places, goal=self.entrance, radius=0.06)
        if self._metres and picture.ndim == 2:
            picture = to_levels(picture, self._max_range)
        return np.concatenate([section.rgb, upscale(picture, _SIZE)], axis=1)


class VoidWorlds:
    """The worlds of some seeds, each settled when it is first asked for, and kept."""

    def __init__(self, seeds, make):
        self._seeds, self._make, self._made = [int(s) for s in seeds], make, {}

    def choose(self, random, radius):
        """One with a void, drawn by `random`, and its seed."""
        for seed in map(int, random.permutation(self._seeds)):
            if seed not in self._made:
                self._made[seed] = self._make(seed)
            if self._made[seed].void:
                return self._made[seed], seed
        error = _core.InputError(f"radius: no pile of pile_seeds has a void that a ball of {radius} m can enter: "
                                 "expected a smaller radius, a smaller voxel or other seeds")
        error.key = "radius"
        raise error


def checked_action(action, count):
    """As floats between -1 and 1. Raises InputError for another shape and for what is not finite or beyond these by more
    than rounding: gymnasium.wrappers.ClipAction clips what a policy draws."""
    action = np.asarray(action, float)
    if action.shape != (count,) or not np.all(np.isfinite(action)) or not np.all(np.abs(action) <= 1 + 1e-6):
        error = _core.InputError(f"action: expected {count} numbers from -1 to 1: found {action!r}")
        error.key = "action"
        raise error
    return np.clip(action, -1, 1)


def is_over(steps, max_steps):
    return max_steps is not None and steps >= max_steps
