"""A pile with the void that is explored in it: of VoidExplore and SnakeExplore."""
import numpy as np

from .. import _core
from ..arguments import checked_seeds, mistake, whole
from ..sensors import Renderer
from .pictures import Section, to_levels, upscale
from .settled import find_pile

_SIZE = 256     # of the pictures of render(), in pixels
_RENDERERS = 4  # that are kept of a pile, each with its own light


class VoidWorld:
    """The pile of a seed with its largest void that a ball of `radius` can enter (void: None where there is none),
    and what is seen of it."""

    def __init__(self, mission, seed, radius, voxel, size, fov_deg, max_range, colour, threads, metres, drawn):
        """drawn: the Drawn of the environment."""
        settled = find_pile(mission, seed, threads)
        self.pile = settled.pile
        voids = settled.once(("voids", radius, voxel),
                             lambda: [v for v in self.pile.voids(radius, voxel) if v["entrances"]])
        self.void = voids[0] if voids else None
        if not self.void:
            return
        entrance = self.void["entrances"][0]
        self.entrance, inward = entrance["position"], entrance["inward"]
        self.yaw = _core._atan2(inward[1], inward[0])
        explored = settled.once("explored", lambda: _core._ExploredPile(self.pile._shared))
        self.view = _core._Explorer(explored, self.void["cells"], voxel, radius, size, fov_deg, max_range, threads)
        self._size, self._fov_deg, self._max_range, self._metres = size, fov_deg, max_range, metres
        self._colour, self._renderers, self._threads, self._drawn = colour, {}, threads, drawn
        self._settled, self._of = settled, (radius, voxel)  # as long as the pile is there, others find it

    def once(self, key, make):
        """What follows from the pile and this void alone, made once for all environments."""
        return self._settled.once((key, *self._of), make)

    def begin(self):
        """For a new episode: nothing is seen, and all is as drawn."""
        self.view.forget()
        self._camera = [self._drawn.get(f"calibration.{key}", default) for key, default in
                        (("fov_deg", self._fov_deg), ("shift_x", 0.0), ("shift_y", 0.0))]
        self.view.set_camera(*self._camera)
        self._renderer = self._find_renderer() if self._colour else None

    def _find_renderer(self):
        """That of the light and weather of the episode."""
        key = tuple(self._drawn.overrides())
        renderer = self._renderers.pop(key, None)
        if renderer is None:
            if len(self._renderers) >= _RENDERERS:
                self._renderers.pop(next(iter(self._renderers)))
            renderer = Renderer(self.pile.vary(key) if key else self.pile, self._threads)
        self._renderers[key] = renderer  # the last one used is the last one dropped
        return renderer

    def look(self, pose):
        """(depth, clearance, colour or None) of a body there; what it shows of the void counts as seen. Depth as
        pictures.depth_space() says."""
        depth, clearance = self.view.look(pose)
        depth = self._drawn.measure(depth, self._max_range)
        if not self._metres:
            depth = to_levels(depth, self._max_range)
        fov_deg, *shift = self._camera
        rgb = self._renderer.render(pose, self._size, self._size, fov_deg, shift=shift)["rgb"] if self._renderer else None
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
        self._seeds, self._make, self._made = checked_seeds("pile_seeds", seeds), make, {}

    def choose(self, random, radius):
        """One with a void, drawn by `random`, and its seed."""
        for seed in map(int, random.permutation(self._seeds)):
            if seed not in self._made:
                self._made[seed] = self._make(seed)
            if self._made[seed].void:
                return self._made[seed], seed
        raise mistake("radius", f"no pile of pile_seeds has a void that a ball of {radius} m can enter: "
                                "expected a smaller radius, a smaller voxel or other seeds")


def checked_action(action, count):
    """As floats between -1 and 1. Raises InputError for another shape and for what is not finite or beyond these by more
    than rounding: gymnasium.wrappers.ClipAction clips what a policy draws."""
    try:
        if np.iscomplexobj(action):
            raise TypeError
        action = np.asarray(action, float)
    except (TypeError, ValueError):
        raise mistake("action", f"expected {count} numbers from -1 to 1: found {action!r}") from None
    if action.shape != (count,) or not np.all(np.isfinite(action)) or not np.all(np.abs(action) <= 1 + 1e-6):
        raise mistake("action", f"expected {count} numbers from -1 to 1: found {action!r}")
    return np.clip(action, -1, 1)


def checked_limit(max_steps):
    return None if max_steps is None else whole("max_steps", max_steps, 1)


def is_over(steps, max_steps):
    return max_steps is not None and steps >= max_steps
