"""rubble/VoidExplore-v0: a flying ball with a depth camera explores a void of a settled pile.

The ball starts at the entrance of the largest void. It stops before it comes nearer to a surface than its radius.

Action:
  0  forward velocity, in units of `speed`
  1  velocity to the left, in units of `speed`
  2  upward velocity, in units of `speed`
  3  turn rate to the left, in units of `turn_rate`

Observation:
  clearance  distance from the centre of the ball to the nearest surface; m
  depth  picture of the depths along the optical axis: 255 is `max_range` or more. With `metres`, without the channel; m
  pose  forward, left and up since the start, in the frame of the start (m); yaw (rad)
  rgb  colour image, only with `colour`

Reward:
  +100 x share  share of the cells of the void that the camera sees for the first time
  -0.01  every step
  -0.1  the ball was stopped before a surface

End:
  terminated  the share `enough` of the void has been seen
  truncated  after `max_steps` steps; with gymnasium.make(), after max_episode_steps

Info:
  pile_seed  seed of the pile, from reset()
  coverage  share of the void that has been seen
  stops  number of steps in which the ball was stopped
  randomization  values of the episode by key, from reset(), where there is a `randomization`

Arguments:
  mission  mission of the pile, as Lua text
  pile_seeds  seeds from which each episode draws its pile
  radius  radius of the ball; m
  size  width and height of the images; pixel
  fov_deg  field of view; degree
  max_range  range of the depth camera; m
  speed  largest velocity along each axis; m/s
  turn_rate  largest turn rate; rad/s
  period  duration of a step; s
  max_steps  longest episode, in steps; None: no limit
  enough  share of the void at which the episode ends
  voxel  edge of the cells of the void; m
  metres  gives `depth` in metres
  colour  adds `rgb`; the light of each pile is baked at its first use
  threads  number of threads; results do not depend on it
  randomization  a Randomization: what each episode draws besides
"""
import numpy as np

from .. import _core, geometry
from ..arguments import checked_seed, real, whole
from .pictures import depth_space
from .randomization import Drawn
from .spaces import Box, Dict, Env
from .void_world import VoidWorld, VoidWorlds, checked_action, checked_limit, is_over

MISSION = """
return rubble.mission {
  pile = { layers = 2, pieces_per_layer = 60, spawn_position = { 0, 0, 3 }, spawn_bounds = { 5, 5, 4 } },
}
"""


class VoidExplore(Env):
    metadata = {"render_modes": ["rgb_array"], "render_fps": 5}
    task = "explore a void of the pile"  # of datasets
    randomized = ("calibration.*", "poses.yaw_deg", "light.*", "weather.*")  # the last two: with colour

    def __init__(self, mission=MISSION, pile_seeds=range(1, 6), radius=0.15, size=64, fov_deg=90.0, max_range=5.0,
                 speed=0.5, turn_rate=1.0, period=0.2, max_steps=500, enough=0.95, voxel=0.1, metres=False, colour=False,
                 threads=1, randomization=None, render_mode=None):
        self._period = real("period", period)
        self.render_mode, self.metadata = render_mode, {**self.metadata, "render_fps": 1 / self._period}
        self._radius, self._speed, self._turn_rate = radius, real("speed", speed), real("turn_rate", turn_rate, zero=True)
        self._max_steps, self._enough = checked_limit(max_steps), real("enough", enough, most=1)
        max_range = real("max_range", max_range)
        self._drawn = Drawn(randomization, self.randomized if colour else self.randomized[:2],
                            "VoidExplore" if colour else "VoidExplore without colour")
        size = whole("size", size, 16, 8192)
        self._worlds = VoidWorlds(pile_seeds, lambda seed: VoidWorld(mission, seed, radius, voxel, size, fov_deg, max_range,
                                                                     colour, threads, metres, self._drawn))
        self._world = None
        self.action_space = Box(-1.0, 1.0, (4,), np.float32, parts=[
            (way, f"of {speed:g} m/s") for way in ("forwards", "left", "up")] + [("turning to the left", f"of {turn_rate:g} rad/s")])
        spaces = {"clearance": Box(0.0, max_range, (1,), np.float32, unit="m"),
                  "depth": depth_space(size, max_range, metres),
                  "pose": Box(-1000.0, 1000.0, (4,), np.float32,
                              parts=[("forwards", "m"), ("left", "m"), ("up", "m"), ("yaw", "rad")])}
        if colour:
            spaces["rgb"] = Box(0, 255, (size, size, 3), np.uint8, unit="levels of sRGB")
        self.observation_space = Dict(spaces)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=checked_seed(seed))
        self._world, pile_seed = self._worlds.choose(self.np_random, self._radius)
        self._drawn.draw(self.np_random)
        self._world.begin()
        self._position, self._yaw = self._world.entrance.copy(), 0.0
        self._start_yaw = self._world.yaw + np.radians(self._drawn.get("poses.yaw_deg", 0.0))
        self._steps = self._stopped = 0
        self._places = [self._position.copy()]
        observation = self._observe()
        return observation, self._describe(pile_seed=pile_seed, **self._drawn.info())

    def step(self, action):
        if self._world is None:
            raise RuntimeError("reset() comes before step()")
        action = checked_action(action, 4)
        view = self._world.view
        self._yaw += float(action[3]) * self._turn_rate * self._period
        way = self._turned(action[:3] * (self._speed * self._period), self._start_yaw + self._yaw)
        self._position, free = view.move(self._position, way)
        self._places.append(self._position.copy())
        self._steps += 1
        self._stopped += not free
        before = view.seen
        observation = self._observe()
        reward = 100.0 * (view.seen - before) / view.count - 0.01 - 0.1 * (not free)
        terminated = view.seen >= self._enough * view.count
        return observation, float(reward), terminated, is_over(self._steps, self._max_steps), self._describe()

    @staticmethod
    def _turned(vector, yaw):
        c, s = _core._directions([yaw])[0]
        return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1], vector[2]])

    def _body(self):
        return geometry.pose(self._position, (0, 0, self._start_yaw + self._yaw))

    def _observe(self):
        depth, clearance, rgb = self._world.look(self._body())
        moved = self._turned(self._position - self._world.entrance, -self._start_yaw)
        observation = {"clearance": np.array([clearance], np.float32), "depth": depth,
                       "pose": np.append(moved, self._yaw).astype(np.float32)}
        if rgb is not None:
            observation["rgb"] = rgb
        self._seen = depth if rgb is None else rgb
        return observation

    def render(self):
        if self.render_mode is not None and self._world is not None:
            return self._world.draw(self._body(), self._seen, self._places)

    def _describe(self, **more):
        return {"coverage": self._world.view.seen / self._world.view.count, "stops": self._stopped, **more}
