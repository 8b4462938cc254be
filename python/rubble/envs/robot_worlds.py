"""Robots that environments put into fixed piles."""
import math

from .. import geometry
from ..arguments import real
from ..robots import RobotWorld


class RobotWorlds:
    """One robot in the piles of an environment. Each pile is laid when it is first asked for, and kept."""

    def __init__(self, model, threads):
        self._model, self._threads, self._made = model, threads, {}

    def place(self, pile, pose, friction=None):
        """The RobotWorld of that pile at its start, with the robot at the pose. friction: None: the model's."""
        if friction is not None:
            return RobotWorld(pile, self._model, pose, fixed_debris=True, threads=self._threads, friction=friction)
        world = self._made.get(id(pile))
        if world is None:
            # The world keeps the pile, so no other one gets its number.
            world = RobotWorld(pile, self._model, pose, fixed_debris=True, threads=self._threads)
            self._made[id(pile)] = world
        else:
            world.reset(pose)
        return world


def round_period(period):
    """(seconds, 1/s) of the whole steps of 1/240 s that RobotWorld and Session make of it."""
    steps = max(1, int(real("period", period, most=60) / (1 / 240) + 0.5))
    return steps / 240, 240 / steps


def moved_start(base, drawn):
    """The pose of a start on the ground, with what is drawn of `poses`."""
    sideways, away, yaw = (drawn.get(f"poses.{key}", 0.0) for key in ("sideways", "away", "yaw_deg"))
    if not (sideways or away or yaw):
        return base
    return geometry.compose(base, geometry.pose([-away, sideways, 0], (0, 0, math.radians(yaw))))
