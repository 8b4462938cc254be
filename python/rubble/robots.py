"""Robots that are driven through a settled pile, step by step."""
from __future__ import annotations

from typing import Any, Iterable, Mapping, Optional

from numpy.typing import ArrayLike

from . import _core


class RobotWorld:
    """A pile and one robot in it: snake, crawler, rover or vine (docs/reference/robots.md). What it touches moves, unless
    fixed_debris. pose: of its first link. friction: of its tracks, wheels or skin against concrete, instead of the model's;
    0 to 2. The same commands give the same bits."""

    def __init__(self, pile: _core.Pile, model: str, pose: ArrayLike, fixed_debris: bool = False,
                 threads: int = 0, friction: Optional[float] = None) -> None:
        self._made = _core._Session(pile._shared, model, pose, fixed_debris, threads or pile.threads, friction)
        self._name = self._made.robots[0]
        self.link_names = self._made.link_names(self._name)
        self.joint_count = len(self._made.state(self._name)["joint_positions"])

    def reset(self, pose: Optional[ArrayLike] = None) -> dict[str, Any]:
        """Back to time 0, with the bits of a new RobotWorld, in milliseconds; returns state(). pose: for this time; None: that of
        the constructor."""
        self._made.reset({} if pose is None else {self._name: pose})
        return self.state()

    def drive(self, linear: float, angular: float = 0.0, flippers: Iterable[float] = ()) -> None:
        """Of crawler and rover: forwards (m/s), counter-clockwise (rad/s), and a crawler's
        flippers (rad): front left, front right, rear left, rear right; none: as they stood at first."""
        self._made.drive(self._name, linear, angular, list(flippers))

    def grow(self, speed: float, left: float = 0.0, up: float = 0.0) -> None:
        """Of a vine: speed of its tip (m/s; negative: it retracts), curvature of what grows, to the left and upwards (1/m)."""
        self._made.grow(self._name, speed, left, up)

    def set_joints(self, targets: Iterable[float]) -> None:
        """Targets of all joints; rad."""
        self._made.set_joints(self._name, [float(t) for t in targets])

    def step(self, seconds: float = 1 / 60) -> dict[str, Any]:
        """Goes on under the last command, by whole steps of 1/240 s; returns state()."""
        self._made.step(seconds)
        return self.state()

    def state(self) -> dict[str, Any]:
        """dict: time; links (n, 7) poses in the world; joint_positions, joint_speeds, joint_torques;
        contact_forces (n, 3) in the world; linear_velocity, angular_velocity of the first link; lost."""
        return self._made.state(self._name)


class Session:
    """The robots of the pile's own mission, with its surroundings, from its time 0: what `rubble run` does, step by step.
    Samples have the bits of the recording, except the depth of cameras with `shutter.readout`: here it is that of one pose for all
    rows, the recorded one goes row by row. depth: whether cameras on robots give exact depth, by rays. observed: whether
    observe() gives samples; without, steps are faster."""

    def __init__(self, pile: _core.Pile, depth: bool = False, threads: int = 0, observed: bool = True) -> None:
        self._made = _core._Session(pile._shared, observed, depth, threads or pile.threads)

    @property
    def robots(self) -> list[str]:
        """Their names, in the mission's order."""
        return self._made.robots

    @property
    def time(self) -> float:
        """Since the start; s."""
        return self._made.time

    def reset(self, poses: Mapping[str, ArrayLike] = {}) -> None:
        """Back to time 0, with the bits of a new session, in milliseconds. poses: of first links, by robot, for this time; other
        robots stand where the mission puts them."""
        self._made.reset(dict(poses))

    def drive(self, robot: str, linear: float, angular: float = 0.0, flippers: Iterable[float] = ()) -> None:
        """As RobotWorld.drive(), instead of what the mission says, from the robot's next control step on."""
        self._made.drive(robot, linear, angular, list(flippers))

    def grow(self, robot: str, speed: float, left: float = 0.0, up: float = 0.0) -> None:
        """Likewise, as RobotWorld.grow()."""
        self._made.grow(robot, speed, left, up)

    def set_joints(self, robot: str, targets: Iterable[float]) -> None:
        """Likewise: targets of all joints; rad, m."""
        self._made.set_joints(robot, [float(t) for t in targets])

    def follow_mission(self, robot: str) -> None:
        """From now on the robot does again what the mission says."""
        self._made.follow_mission(robot)

    def step(self, seconds: float = 1 / 60) -> None:
        """Goes on by whole steps of 1/240 s."""
        self._made.step(seconds)

    def observe(self) -> list[dict[str, Any]]:
        """All samples of robots and of sensors on them since the last call, in order of `stamp` (ns): dicts with `kind`
        (robot, imu, lidar, reading or camera), `sensor` (its name) and numpy arrays."""
        return self._made.observe()

    def state(self, robot: str) -> dict[str, Any]:
        """As RobotWorld.state()."""
        return self._made.state(robot)

    def link_names(self, robot: str) -> list[str]:
        """The links of state(), in order."""
        return self._made.link_names(robot)
