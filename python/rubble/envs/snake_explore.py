"""rubble/SnakeExplore-v0: a snake of 16 modules, in contact with a settled pile that stands like rock, explores a
void of it. It starts on the ground, straight, its head towards an entrance of the void.

Action: Box(-1, 1, (15,)): the targets of the joints, from head to tail, of 1.2 rad, for `period` seconds.

Observation: dict of
  depth   (size, size) float32, m along the optical axis of a camera in the head, max_range where nothing is nearer
  head    (7,) float32: forwards, left and up since the start (m, in the frame of the start), and of the head's X and
          Z axis what lies along the world's vertical, and the cosine and sine of its heading from that of the start
  joints  (15,) float32: angles; rad
  speeds  (15,) float32: of the joints; rad/s
  torques (15,) float32: of the motors; N m
  touch   (16,) float32: how hard each module is pressed on; N

Reward of a step: 100 times the share of the void's cells that the camera sees for the first time, 1 for every metre
that the head comes nearer to the entrance until it has been within 0.3 m of it, less 0.01. The episode ends
(terminated) when `enough` of the void has been seen, and when the snake left the world; it is cut off (truncated)
after max_steps. As in VoidExplore, the episode's seed alone decides it.
"""
import math

import numpy as np

from .. import _core, geometry
from ..robots import RobotWorld
from .spaces import Box, Dict, Env
from .void_explore import MISSION
from .void_world import VoidWorld, VoidWorlds, checked_action

_JOINTS = 15
_LENGTH = 0.95  # of the snake; m
_HEIGHT = 0.03  # of its middle above the ground; m
_MOST = 1000.0  # of a component of the observation that has no limit of its own


class SnakeExplore(Env):
    metadata = {"render_modes": []}

    def __init__(self, mission=MISSION, pile_seeds=range(1, 6), radius=0.12, size=16, fov_deg=90.0, max_range=4.0,
                 period=0.1, max_steps=600, enough=0.95, voxel=0.1, threads=1, render_mode=None):
        self.render_mode = render_mode
        self._radius, self._period, self._max_steps, self._enough = radius, period, max_steps, enough
        self._threads, self._robot = threads, None
        self._worlds = VoidWorlds(pile_seeds, lambda seed: VoidWorld(mission, seed, radius, voxel, size, fov_deg,
                                                                     max_range, False, threads))
        self.action_space = Box(-1.0, 1.0, (_JOINTS,), np.float32, unit="of 1.2 rad, by joint from head to tail")
        head = [(way, "m") for way in ("forwards", "left", "up")] + [
            (name, "") for name in ("X axis upwards", "Z axis upwards", "cosine of heading", "sine of heading")]
        self.observation_space = Dict({
            "depth": Box(0.0, max_range, (size, size), np.float32, unit="m"),
            "head": Box(-_MOST, _MOST, (7,), np.float32, parts=head),
            "joints": Box(-_MOST, _MOST, (_JOINTS,), np.float32, unit="rad"),
            "speeds": Box(-_MOST, _MOST, (_JOINTS,), np.float32, unit="rad/s"),
            "torques": Box(-_MOST, _MOST, (_JOINTS,), np.float32, unit="N m"),
            "touch": Box(0.0, 100 * _MOST, (_JOINTS + 1,), np.float32, unit="N")})

    def _find_start(self):
        """On the ground before the entrance, as near as the snake has room, looking at it."""
        world = self._world
        for turn in (0.0, 0.4, -0.4, 0.8, -0.8):
            yaw = world.yaw + turn
            ahead = np.append(_core._directions([yaw])[0], 0.0)
            for back in (0.2 + 0.2 * k for k in range(29)):
                head = world.entrance * [1, 1, 0] - back * ahead + [0, 0, _HEIGHT]
                body = head - np.outer(np.linspace(-0.05, _LENGTH, 21), ahead)
                # Its own height above the ground is the clearance of an empty place.
                if np.all(world.pile.clearance(body, 1.0) >= _HEIGHT - 1e-6):
                    return geometry.pose(head, (0, 0, yaw))
        error = _core.InputError("mission: no room for a snake before the entrance of a void: expected 1 m of flat ground "
                                 "within 6 m of it")
        error.key = "mission"
        raise error

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self._world, pile_seed = self._worlds.choose(self.np_random, self._radius)
        self._world.view.forget()
        self._start = self._find_start()
        self._robot = RobotWorld(self._world.pile, "snake", self._start, fixed_debris=True, threads=self._threads)
        self._state, self._steps, self._entered = self._robot.state(), 0, False
        self._distance = self._to_entrance()
        return self._observe(), {"pile_seed": pile_seed, "coverage": 0.0, "entered": False}

    def step(self, action):
        if self._robot is None:
            raise RuntimeError("reset() comes before step()")
        self._robot.set_joints(1.2 * checked_action(action, _JOINTS))
        self._state = self._robot.step(self._period)
        self._steps += 1
        view = self._world.view
        before, was = view.seen, self._distance
        observation = self._observe()
        self._distance = self._to_entrance()
        reward = 100.0 * (view.seen - before) / view.count - 0.01 + (0 if self._entered else was - self._distance)
        self._entered = self._entered or self._distance < 0.3
        terminated = bool(view.seen >= self._enough * view.count or self._state["lost"])
        return observation, float(reward), terminated, self._steps >= self._max_steps, {
            "coverage": view.seen / view.count, "entered": self._entered}

    def _to_entrance(self):
        return float(_core._lengths((self._state["links"][0][:3] - self._world.entrance)[None])[0])

    def _observe(self):
        state = self._state
        head = state["links"][0]
        depth, _, _ = self._world.look(head)
        now = geometry.matrix(head)
        moved, turned = geometry.rotate(self._start, [head[:3] - self._start[:3], now[:3, 0]], back=True)
        flat = max(math.sqrt(turned[0] * turned[0] + turned[1] * turned[1]), 1e-9)

        def within(values):
            return np.clip(values, -_MOST, _MOST).astype(np.float32)

        return {"depth": depth,
                "head": within(np.append(moved, [now[2, 0], now[2, 2], turned[0] / flat, turned[1] / flat])),
                "joints": within(state["joint_positions"]), "speeds": within(state["joint_speeds"]),
                "torques": within(state["joint_torques"]),
                "touch": _core._lengths(state["contact_forces"]).clip(0, 100 * _MOST).astype(np.float32)}
