"""Robots that are driven through a settled pile, step by step."""
from __future__ import annotations

from typing import Any, Iterable

from numpy.typing import ArrayLike

from . import _core


class RobotWorld:
    """A pile and one robot in it: snake, crawler, rover or vine (docs/reference/robots.md). What it touches moves, unless
    fixed_debris. pose: of its first link. The same commands give the same bits."""

    def __init__(self, pile: _core.Pile, model: str, pose: ArrayLike, fixed_debris: bool = False,
                 threads: int = 0) -> None:
        self._made = _core._RobotWorld(pile._shared, model, pose, fixed_debris, threads or pile.threads)
        self.joint_count = self._made.joint_count
        self.link_names = self._made.link_names

    def drive(self, linear: float, angular: float = 0.0, flippers: Iterable[float] = ()) -> None:
        """Of crawler and rover: forwards (m/s), counter-clockwise (rad/s), and a crawler's
        flippers (rad): front left, front right, rear left, rear right; none: as they stood at first."""
        self._made.drive(linear, angular, list(flippers))

    def grow(self, speed: float, left: float = 0.0, up: float = 0.0) -> None:
        """Of a vine: speed of its tip (m/s; negative: it retracts), curvature of what grows, to the left and upwards (1/m)."""
        self._made.grow(speed, left, up)

    def set_joints(self, targets: Iterable[float]) -> None:
        """Targets of all joints; rad."""
        self._made.set_joints([float(t) for t in targets])

    def step(self, seconds: float = 1 / 60) -> dict[str, Any]:
        """Goes on under the last command, by whole steps of 1/240 s; returns state()."""
        self._made.step(seconds)
        return self.state()

    def state(self) -> dict[str, Any]:
        """dict: time; links (n, 7) poses in the world; joint_positions, joint_speeds, joint_torques;
        contact_forces (n, 3) in the world; linear_velocity, angular_velocity of the first link; lost."""
        return self._made.state()
