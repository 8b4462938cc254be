"""Poses as arrays: x y z qw qx qy qz of a body with X forward, Y left, Z up."""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def _multiply(a, b):
    w, x, y, z = a
    s, u, v, t = b
    return np.array([w * s - x * u - y * v - z * t, w * u + x * s + y * t - z * v,
                     w * v - x * t + y * s + z * u, w * t + x * v - y * u + z * s])


def pose(position: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
    """The pose at a position (m), turned by roll, pitch (positive: down) and yaw (rad): Rz Ry Rx."""
    roll, pitch, yaw = (0.5 * float(a) for a in rpy)
    q = _multiply([np.cos(yaw), 0, 0, np.sin(yaw)],
                  _multiply([np.cos(pitch), 0, np.sin(pitch), 0], [np.cos(roll), np.sin(roll), 0, 0]))
    return np.concatenate([np.asarray(position, float), q])


def look_at(position: ArrayLike, target: ArrayLike) -> NDArray[np.float64]:
    """The upright pose at a position whose X axis points at the target."""
    d = np.asarray(target, float) - np.asarray(position, float)
    return pose(position, (0, -np.arctan2(d[2], np.hypot(d[0], d[1])), np.arctan2(d[1], d[0])))


def matrix(of: ArrayLike) -> NDArray[np.float64]:
    """The pose as a 4x4 matrix: world from body."""
    x, y, z, qw, qx, qy, qz = np.asarray(of, float)
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qw * qz), 2 * (qx * qz + qw * qy)],
                 [2 * (qx * qy + qw * qz), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qw * qx)],
                 [2 * (qx * qz - qw * qy), 2 * (qy * qz + qw * qx), 1 - 2 * (qx * qx + qy * qy)]]
    m[:3, 3] = [x, y, z]
    return m


def compose(world_from_a: ArrayLike, a_from_b: ArrayLike) -> NDArray[np.float64]:
    """world_from_b."""
    at = matrix(world_from_a) @ np.append(np.asarray(a_from_b, float)[:3], 1)
    return np.concatenate([at[:3], _multiply(np.asarray(world_from_a, float)[3:], np.asarray(a_from_b, float)[3:])])
