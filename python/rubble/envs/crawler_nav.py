"""rubble/CrawlerNav-v0: a tracked crawler, in contact with a fixed pile, drives to a goal on the ground.

The crawler starts beside the pile and faces it. The goal is on the other side.

Action:
  0  forward velocity, in units of `speed`
  1  turn rate to the left, in units of `turn_rate`
  2  angle of the front flippers, in units of 1.2 rad; positive: raised
  3  angle of the rear flippers, in units of 1.2 rad; positive: raised

Observation:
  goal  distance (m), cosine and sine of the bearing, in the plane of the base
  joints  flipper angles; rad
  motion  linear velocity (m/s) and angular velocity (rad/s) of the base, in its axes
  scan  distances to pile and ground, counter-clockwise from straight ahead, 0.25 m above the base and in its plane; `max_range` without a surface; m
  tilt  vertical components of the X, Y and Z axes of the base

Reward:
  +1 x distance  metres that the crawler comes nearer to the goal
  -0.01  every step
  +10  at the goal

End:
  terminated  within `reach` of the goal; or the base lies on its back or side; or the crawler has left the world
  truncated  after `max_steps` steps; with gymnasium.make(), after max_episode_steps

Info:
  pile_seed  seed of the pile, from reset()
  goal_reached  the goal is within `reach`

Arguments:
  mission  mission of the pile, as Lua text
  pile_seeds  seeds from which each episode draws its pile
  speed  largest forward velocity; m/s
  turn_rate  largest turn rate; rad/s
  period  duration of a step; s
  max_steps  longest episode, in steps; None: no limit
  reach  distance at which the goal is reached; m
  around  distance of start and goal from the circle around the pile; m
  rays  number of rays of the scan
  max_range  range of the scan; m
  threads  number of threads; results do not depend on it
"""
import numpy as np

from .. import _core, geometry
from ..robots import RobotWorld
from .pictures import Section
from .settled import settle_text
from .spaces import Box, Dict, Env
from .void_world import checked_action, is_over

MISSION = """
return rubble.mission {
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2 }, spawn_bounds = { 3, 3, 2 } },
}
"""
_EYE = np.array([0.0, 0.0, 0.25])  # of the scan, in the base; m
_MOST = 50.0                       # of a component of the observation that has no limit of its own


class CrawlerNav(Env):
    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(self, mission=MISSION, pile_seeds=range(1, 4), speed=0.6, turn_rate=1.5, period=0.1, max_steps=600,
                 reach=0.3, around=1.5, rays=64, max_range=8.0, threads=1, render_mode=None):
        self.render_mode, self.metadata = render_mode, {**self.metadata, "render_fps": 1 / period}
        self._mission, self._seeds, self._threads = mission, [int(s) for s in pile_seeds], threads
        self._speed, self._turn_rate, self._period = speed, turn_rate, period
        self._max_steps, self._reach, self._around = max_steps, reach, around
        self._max_range, self._robot, self._piles = max_range, None, {}
        turns = _core._directions(2 * np.pi * np.arange(rays) / rays)
        self._rays = np.append(turns, np.zeros((rays, 1)), axis=1)
        self.action_space = Box(-1.0, 1.0, (4,), np.float32, parts=[
            ("forwards", f"of {speed:g} m/s"), ("turning to the left", f"of {turn_rate:g} rad/s"),
            ("front flippers", "of 1.2 rad"), ("rear flippers", "of 1.2 rad")])
        self.observation_space = Dict({
            "goal": Box(np.float32([0, -1, -1]), np.float32([2 * _MOST, 1, 1]), (3,), np.float32,
                        parts=[("distance", "m"), ("cosine of bearing", ""), ("sine of bearing", "")]),
            "joints": Box(-_MOST, _MOST, (4,), np.float32, unit="rad"),
            "motion": Box(-_MOST, _MOST, (6,), np.float32, parts=[
                (f"velocity along {axis}", "m/s") for axis in "XYZ"] + [(f"turning about {axis}", "rad/s") for axis in "XYZ"]),
            "scan": Box(0.0, max_range, (rays,), np.float32, unit="m"),
            "tilt": Box(-1.0, 1.0, (3,), np.float32, parts=[(f"vertical along {axis}", "") for axis in "XYZ"])})

    def _find_pile(self, seed):
        """The pile of that seed, and the radius of a circle about the origin that holds it."""
        if seed not in self._piles:
            pile = settle_text(self._mission, seed, self._threads)
            vertices, _ = pile.mesh()
            radius = float(_core._lengths(vertices[:, :2]).max()) if len(vertices) else 1.0
            self._piles[seed] = pile, radius
        return self._piles[seed]

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        pile_seed = int(self.np_random.choice(self._seeds))
        self._pile, radius = self._find_pile(pile_seed)
        # On one side of the pile, facing it; the goal on the other.
        start, goal = self.np_random.uniform(-np.pi, np.pi), self.np_random.uniform(-1, 1)
        ring = radius + self._around
        (start_x, start_y), (goal_x, goal_y) = ring * _core._directions([start, start + goal])
        self._goal = np.array([-goal_x, -goal_y, 0])
        base = geometry.pose([start_x, start_y, 0.005], (0, 0, start + np.pi))
        self._robot = RobotWorld(self._pile, "crawler", base, fixed_debris=True, threads=self._threads)
        self._state, self._steps = self._robot.state(), 0
        self._distance, self._places = self._to_goal()[0], [self._state["links"][0][:3]]
        return self._observe(), {"pile_seed": pile_seed, "goal_reached": False}

    def step(self, action):
        if self._robot is None:
            raise RuntimeError("reset() comes before step()")
        forwards, turning, front, rear = checked_action(action, 4)
        self._robot.drive(forwards * self._speed, turning * self._turn_rate, 1.2 * np.array([front, front, rear, rear]))
        self._state = self._robot.step(self._period)
        self._steps += 1
        self._places.append(self._state["links"][0][:3])
        before, self._distance = self._distance, self._to_goal()[0]
        reached = bool(self._distance < self._reach)
        fallen = bool(self._tilt()[2] < 0.1 or self._state["lost"])
        reward = before - self._distance - 0.01 + 10.0 * reached
        return self._observe(), float(reward), reached or fallen, is_over(self._steps, self._max_steps), {"goal_reached": reached}

    def render(self):
        """The section at the height of the scan with the way and the goal, as wide as start and goal need."""
        if self.render_mode is None or self._robot is None:
            return None
        half = float(np.max(np.abs([*self._places, self._goal]))) + 1
        section = Section(self._pile, (0, 0, self._places[-1][2] + _EYE[2]), half, 512)
        section.draw_way(self._places, goal=self._goal, radius=0.2)
        return section.rgb

    def _base(self):
        return geometry.matrix(self._state["links"][0])

    def _tilt(self):
        return self._base()[2, :3]

    def _to_goal(self):
        base = self._state["links"][0]
        away = geometry.rotate(base, self._goal - base[:3], back=True)
        flat = max(float(_core._lengths(away[None, :2])[0]), 1e-9)
        return float(_core._lengths(away[None])[0]), away[0] / flat, away[1] / flat

    def _observe(self):
        state = self._state
        base = state["links"][0]
        hits = self._pile.cast_rays((base[:3] + geometry.rotate(base, _EYE))[None], geometry.rotate(base, self._rays),
                                    self._max_range)
        motion = geometry.rotate(base, [state["linear_velocity"], state["angular_velocity"]], back=True).ravel()
        return {"goal": np.array(self._to_goal(), np.float32).clip([0, -1, -1], [2 * _MOST, 1, 1]).astype(np.float32),
                "joints": np.clip(state["joint_positions"][-4:], -_MOST, _MOST).astype(np.float32),
                "motion": np.clip(motion, -_MOST, _MOST).astype(np.float32),
                "scan": np.minimum(hits["distance"], self._max_range).astype(np.float32),
                "tilt": np.clip(self._tilt(), -1, 1).astype(np.float32)}
