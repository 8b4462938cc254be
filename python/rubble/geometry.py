"""Poses as arrays: x y z qw qx qy qz of a body with X forward, Y left, Z up.

What poses are made of has the same bits with every build of numpy and on every machine.
"""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core


def pose(position: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
    """The pose at a position (m), turned by roll, pitch (positive: down) and yaw (rad): Rz Ry Rx."""
    return _core._pose(position, rpy)


def look_at(position: ArrayLike, target: ArrayLike) -> NDArray[np.float64]:
    """The upright pose at a position (m) whose X axis points at the target (m), another point."""
    return _core._look_at(position, target)


def matrix(of: ArrayLike) -> NDArray[np.float64]:
    """The pose as a 4x4 matrix: world from body."""
    m = np.eye(4)
    m[:3, :3] = _core._rotate(of, m[:3, :3]).T
    m[:3, 3] = np.asarray(of, float)[:3]
    return m


def compose(world_from_a: ArrayLike, a_from_b: ArrayLike) -> NDArray[np.float64]:
    """world_from_b."""
    return _core._compose(world_from_a, a_from_b)


def rotate(of: ArrayLike, vectors: ArrayLike, back: bool = False) -> NDArray[np.float64]:
    """Vectors in the axes of the pose's body as vectors of the world: (3,) or (n, 3). back: the other way."""
    return _core._rotate(of, vectors, back)
