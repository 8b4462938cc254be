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
  randomization  values of the episode by key, from reset(), where there is a `randomization`

Arguments:
  mission  mission of the pile, as Lua text
  pile_seeds  seeds from which each episode draws its pile
  speed  largest forward velocity; m/s
  turn_rate  largest turn rate; rad/s
  period  duration of a step, rounded to whole steps of 1/240 s; s
  max_steps  longest episode, in steps; None: no limit
  reach  distance at which the goal is reached; m
  around  distance of start and goal from the circle around the pile; m
  rays  number of rays of the scan
  max_range  range of the scan; m
  threads  number of threads; results do not depend on it
  randomization  a Randomization: what each episode draws besides
"""
import numpy as np

from .. import _core, geometry
from ..arguments import checked_seed, checked_seeds, real
from .ground_senses import EYE, GROUND_KEYS, MOST, GroundSenses, bearing, is_fallen
from .pictures import Section
from .randomization import Drawn
from .robot_worlds import RobotWorlds, moved_start, round_period
from .settled import find_pile
from .spaces import Box, Dict, Env
from .void_world import checked_action, checked_limit, is_over

MISSION = """
return rubble.mission {
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2 }, spawn_bounds = { 3, 3, 2 } },
}
"""


class CrawlerNav(Env):
    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}
    task = "drive past the pile to the goal"  # of datasets
    randomized = GROUND_KEYS

    def __init__(self, mission=MISSION, pile_seeds=range(1, 4), speed=0.6, turn_rate=1.5, period=0.1, max_steps=600,
                 reach=0.3, around=1.5, rays=64, max_range=8.0, threads=1, randomization=None, render_mode=None):
        self._period, rate = round_period(period)
        self.render_mode, self.metadata = render_mode, {**self.metadata, "render_fps": rate}
        self._mission, self._seeds, self._threads = mission, checked_seeds("pile_seeds", pile_seeds), threads
        self._speed, self._turn_rate = real("speed", speed), real("turn_rate", turn_rate, zero=True)
        self._max_steps, self._reach = checked_limit(max_steps), real("reach", reach)
        self._around = real("around", around, zero=True)
        self._robot, self._piles = None, {}
        self._drawn = Drawn(randomization, GROUND_KEYS, "CrawlerNav")
        self._robots = RobotWorlds("crawler", threads)
        self._senses = GroundSenses(rays, max_range, self._drawn)
        self.action_space = Box(-1.0, 1.0, (4,), np.float32, parts=[
            ("forwards", f"of {speed:g} m/s"), ("turning to the left", f"of {turn_rate:g} rad/s"),
            ("front flippers", "of 1.2 rad"), ("rear flippers", "of 1.2 rad")])
        self.observation_space = Dict({"joints": Box(-MOST, MOST, (4,), np.float32, unit="rad"), **self._senses.spaces()})

    def _find_pile(self, seed):
        if seed not in self._piles:
            self._piles[seed] = find_pile(self._mission, seed, self._threads)
        return self._piles[seed]

    def reset(self, *, seed=None, options=None):
        super().reset(seed=checked_seed(seed))
        pile_seed = int(self.np_random.choice(self._seeds))
        settled = self._find_pile(pile_seed)
        self._pile = settled.pile
        # On one side of the pile, facing it; the goal on the other.
        start, goal = self.np_random.uniform(-np.pi, np.pi), self.np_random.uniform(-1, 1)
        ring = settled.radius + self._around
        (start_x, start_y), (goal_x, goal_y) = ring * _core._directions([start, start + goal])
        self._goal = np.array([-goal_x, -goal_y, 0])
        self._drawn.draw(self.np_random)
        base = geometry.pose([start_x, start_y, 0.005], (0, 0, start + np.pi))
        self._robot = self._robots.place(self._pile, moved_start(base, self._drawn), self._drawn.get("materials.friction"))
        self._state, self._steps = self._robot.state(), 0
        self._distance, self._places = self._to_goal()[0], [self._state["links"][0][:3]]
        return self._observe(), {"pile_seed": pile_seed, "goal_reached": False, **self._drawn.info()}

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
        fallen = is_fallen(self._state)
        reward = before - self._distance - 0.01 + 10.0 * reached
        return self._observe(), float(reward), reached or fallen, is_over(self._steps, self._max_steps), {"goal_reached": reached}

    def render(self):
        """The section at the height of the scan with the way and the goal, as wide as start and goal need."""
        if self.render_mode is None or self._robot is None:
            return None
        half = float(np.max(np.abs([*self._places, self._goal]))) + 1
        section = Section(self._pile, (0, 0, self._places[-1][2] + EYE[2]), half, 512)
        section.draw_way(self._places, goal=self._goal, radius=0.2)
        return section.rgb

    def _to_goal(self):
        return bearing(self._state["links"][0], self._goal)

    def _observe(self):
        observation = self._senses.observe(self._pile, self._state, self._goal)
        observation["joints"] = np.clip(self._state["joint_positions"][-4:], -MOST, MOST).astype(np.float32)
        return dict(sorted(observation.items()))
