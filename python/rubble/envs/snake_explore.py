"""rubble/SnakeExplore-v0: a snake of 16 modules, in contact with a fixed pile, explores a void of the pile.

The snake starts straight on the ground, with its head towards an entrance of the largest void. A camera is in its head.

Action:
  0 to 14  target angles of the joints, from head to tail, in units of 1.2 rad

Observation:
  depth  picture of the depths along the optical axis: 255 is `max_range` or more. With `metres`, without the channel; m
  head  forward, left and up since the start, in the frame of the start (m); vertical components of the X and Z axes of the head; cosine and sine of its heading since the start
  joints  joint angles; rad
  speeds  joint speeds; rad/s
  torques  motor torques; N m
  touch  contact force on each module; N

Reward:
  +100 x share  share of the cells of the void that the camera sees for the first time
  +1 x distance  metres that the head comes nearer to the entrance, until it has been within 0.3 m
  -0.01  every step

End:
  terminated  the share `enough` of the void has been seen, or the snake has left the world
  truncated  after `max_steps` steps; with gymnasium.make(), after max_episode_steps

Info:
  pile_seed  seed of the pile, from reset()
  coverage  share of the void that has been seen
  entered  the head has been within 0.3 m of the entrance
  randomization  values of the episode by key, from reset(), where there is a `randomization`

Arguments:
  mission  mission of the pile, as Lua text
  pile_seeds  seeds from which each episode draws its pile
  radius  radius of the ball that defines the void; m
  size  width and height of the depth image; pixel
  fov_deg  field of view; degree
  max_range  range of the depth camera; m
  period  duration of a step, rounded to whole steps of 1/240 s; s
  max_steps  longest episode, in steps; None: no limit
  enough  share of the void at which the episode ends
  voxel  edge of the cells of the void; m
  metres  gives `depth` in metres
  threads  number of threads; results do not depend on it
  randomization  a Randomization: what each episode draws besides
"""
import math

import numpy as np

from .. import _core, geometry
from ..arguments import checked_seed, mistake, real, whole
from .pictures import depth_space
from .randomization import Drawn
from .spaces import Box, Dict, Env
from .robot_worlds import RobotWorlds, round_period
from .void_explore import MISSION
from .void_world import VoidWorld, VoidWorlds, checked_action, checked_limit, is_over

_JOINTS = 15
_LENGTH = 0.95  # of the snake; m
_HEIGHT = 0.03  # of its middle above the ground; m
_MOST = 1000.0  # of a component of the observation that has no limit of its own


class SnakeExplore(Env):
    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}
    task = "explore a void of the pile"  # of datasets
    randomized = ("calibration.*", "materials.friction", "poses.away")

    def __init__(self, mission=MISSION, pile_seeds=range(1, 6), radius=0.12, size=36, fov_deg=90.0, max_range=4.0,
                 period=0.1, max_steps=600, enough=0.95, voxel=0.1, metres=False, threads=1,
                 randomization=None, render_mode=None):
        self._period, rate = round_period(period)
        self.render_mode, self.metadata = render_mode, {**self.metadata, "render_fps": rate}
        self._radius, self._max_steps, self._enough = radius, checked_limit(max_steps), real("enough", enough, most=1)
        self._robot, max_range = None, real("max_range", max_range)
        self._drawn = Drawn(randomization, self.randomized, "SnakeExplore")
        size = whole("size", size, 16, 8192)
        self._worlds = VoidWorlds(pile_seeds, lambda seed: VoidWorld(mission, seed, radius, voxel, size, fov_deg, max_range,
                                                                     False, threads, metres, self._drawn))
        self._robots = RobotWorlds("snake", threads)
        self.action_space = Box(-1.0, 1.0, (_JOINTS,), np.float32, unit="of 1.2 rad, by joint from head to tail")
        head = [(way, "m") for way in ("forwards", "left", "up")] + [
            (name, "") for name in ("X axis upwards", "Z axis upwards", "cosine of heading", "sine of heading")]
        self.observation_space = Dict({
            "depth": depth_space(size, max_range, metres),
            "head": Box(-_MOST, _MOST, (7,), np.float32, parts=head),
            "joints": Box(-_MOST, _MOST, (_JOINTS,), np.float32, unit="rad"),
            "speeds": Box(-_MOST, _MOST, (_JOINTS,), np.float32, unit="rad/s"),
            "torques": Box(-_MOST, _MOST, (_JOINTS,), np.float32, unit="N m"),
            "touch": Box(0.0, 100 * _MOST, (_JOINTS + 1,), np.float32, unit="N")})

    def _find_start(self):
        """On the ground before the entrance, as near as the snake has room (or as much farther as is drawn), looking at it."""
        away = self._drawn.get("poses.away", 0.0)
        found = first = self._world.once("start of a snake", lambda: next(self._find_rooms(), None))
        if first and away:
            back = self._find_room(first[0], first[1] + away, 10)
            found = (first[0], back) if back else next(self._find_rooms(away), None)
        if not found:
            raise mistake("mission", "no room for a snake before the entrance of a void: expected 1 m of flat ground within "
                                     f"{6 + away:g} m of it")
        yaw, back = found
        return geometry.pose(self._head_at(yaw, back), (0, 0, yaw))

    def _find_rooms(self, away=0.0):
        """Places where it has room, as yaw and distance from the entrance, one for each direction that has one."""
        for turn in (0.0, 0.4, -0.4, 0.8, -0.8):
            back = self._find_room(self._world.yaw + turn, 0.2 + away, 29)
            if back:
                yield self._world.yaw + turn, back

    def _head_at(self, yaw, back):
        return self._world.entrance * [1, 1, 0] - back * np.append(_core._directions([yaw])[0], 0.0) + [0, 0, _HEIGHT]

    def _find_room(self, yaw, least, tries):
        """The first of `tries` distances from the entrance at which the snake has room; None: none of them."""
        ahead = np.append(_core._directions([yaw])[0], 0.0)
        for back in (least + 0.2 * k for k in range(tries)):
            body = self._head_at(yaw, back) - np.outer(np.linspace(-0.05, _LENGTH, 21), ahead)
            # Its own height above the ground is the clearance of an empty place.
            if np.all(self._world.pile.clearance(body, 1.0) >= _HEIGHT - 1e-6):
                return back
        return None

    def reset(self, *, seed=None, options=None):
        super().reset(seed=checked_seed(seed))
        self._world, pile_seed = self._worlds.choose(self.np_random, self._radius)
        self._drawn.draw(self.np_random)
        self._world.begin()
        self._start = self._find_start()
        self._robot = self._robots.place(self._world.pile, self._start, self._drawn.get("materials.friction"))
        self._state, self._steps, self._entered = self._robot.state(), 0, False
        self._distance, self._places = self._to_entrance(), [self._state["links"][0][:3]]
        return self._observe(), {"pile_seed": pile_seed, "coverage": 0.0, "entered": False, **self._drawn.info()}

    def step(self, action):
        if self._robot is None:
            raise RuntimeError("reset() comes before step()")
        self._robot.set_joints(1.2 * checked_action(action, _JOINTS))
        self._state = self._robot.step(self._period)
        self._steps += 1
        self._places.append(self._state["links"][0][:3])
        view = self._world.view
        before, was = view.seen, self._distance
        observation = self._observe()
        self._distance = self._to_entrance()
        reward = 100.0 * (view.seen - before) / view.count - 0.01 + (0 if self._entered else was - self._distance)
        self._entered = self._entered or self._distance < 0.3
        terminated = bool(view.seen >= self._enough * view.count or self._state["lost"])
        return observation, float(reward), terminated, is_over(self._steps, self._max_steps), {
            "coverage": view.seen / view.count, "entered": self._entered}

    def render(self):
        if self.render_mode is not None and self._robot is not None:
            return self._world.draw(self._state["links"][0], self._seen, self._places)

    def _to_entrance(self):
        return float(_core._lengths((self._state["links"][0][:3] - self._world.entrance)[None])[0])

    def _observe(self):
        state = self._state
        head = state["links"][0]
        self._seen = depth = self._world.look(head)[0]
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
