"""Sensors over a settled pile. Poses: see geometry.py."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core


class Renderer:
    """Draws frames as `rubble run` does: colour and exact depth. Preparing one bakes the light of the pile
    (seconds; kept in the cache). Use it on the thread that made it."""

    def __init__(self, pile: _core.Pile, threads: int = 0) -> None:
        self._made = _core._Renderer(pile._shared, threads or pile.threads)

    def render(self, pose: ArrayLike, width: int = 640, height: int = 480,
               fov_deg: float = 90.0, number: int = 0, shift: tuple[float, float] = (0.0, 0.0)) -> dict[str, NDArray[Any]]:
        """dict of rgb (h, w, 3) uint8, depth (h, w) float32 along the optical axis (nan: nothing), K (3, 3). Of n poses,
        (n, 7): rgb (n, h, w, 3) and depth (n, h, w), so that a graphics card always has some to draw. Pictures of other
        numbers have other noise, which hides the steps of 8 bits; of several, `number` is the first. shift: of the principal
        point from the middle, to the right and downwards; pixel."""
        return self._made.render(pose, width, height, fov_deg, number, shift)


class DepthCamera:
    """Planar depth by exact rays, without colour: for loops that need many small pictures. fov_deg: 1 to 170. max_range: above 0,
    at most 1e9 m."""

    def __init__(self, pile: _core.Pile, width: int = 64, height: int = 64, fov_deg: float = 90.0,
                 max_range: float = 20.0, threads: int = 0) -> None:
        self._made = _core._DepthCamera(pile._shared, width, height, fov_deg, max_range, threads or pile.threads)
        self.K = self._made.K

    def depth(self, pose: ArrayLike) -> NDArray[np.float32]:
        """(h, w) float32; inf: nothing within max_range along the ray. Of n poses, (n, 7): (n, h, w)."""
        return self._made.depth(pose)


class Lidar:
    """A LiDAR that stands still: vlp16, os0, os1, os2, mid360 or utm30lx (docs/reference/lidar.md)."""

    def __init__(self, pile: _core.Pile, model: str = "vlp16", noise: bool = True, seed: int = 0,
                 threads: int = 0) -> None:
        self._made = _core._Lidar(pile._shared, model, noise, seed, threads or pile.threads)

    def scan(self, pose: ArrayLike, number: int = 0) -> NDArray[Any]:
        """A structured array of x, y, z (m, in the sensor's frame), intensity, time (s), ring and column. Scans
        of other numbers have other noise."""
        return self._made.scan(pose, number)
