"""rubble/TeamNav-v0: the robots of a mission drive past a fixed pile and one another, each to a goal of its own on the ground.

It has the parallel interface of PettingZoo: the agents are the robots of the mission by their names, and `reset()` and `step()` have dictionaries by agent. All must have tracks or wheels. The robots start around the pile and face it, at the height that the mission gives them. Their goals are on the other side. An agent that has ended stands still and stays in the way. `TeamNav(...)` makes the environment; its first pile settles then.

Action:
  0  forward velocity, in units of `speed`
  1  turn rate to the left, in units of `turn_rate`

Observation:
  goal  distance (m), cosine and sine of the bearing, in the plane of the base
  motion  linear velocity (m/s) and angular velocity (rad/s) of the base, in its axes
  others  distance (m), cosine and sine of the bearing of each other robot, in the order of `possible_agents`
  scan  distances to pile and ground, counter-clockwise from straight ahead, 0.25 m above the base and in its plane; `max_range` without a surface; m. It does not see robots
  tilt  vertical components of the X, Y and Z axes of the base

Reward:
  +1 x distance  metres that the robot comes nearer to its goal
  -0.01  every step
  -0.1  every step in which another robot is nearer than `apart`
  +10  at the goal

End:
  terminated  within `reach` of the goal; or the base lies on its back or side; or the robot has left the world
  truncated  after `max_steps` steps

Info:
  pile_seed  seed of the pile, from reset()
  goal_reached  the goal is within `reach`
  randomization  values of the episode by key, from reset(), where there is a `randomization`

Arguments:
  mission  mission of the pile and of two robots or more, as Lua text; its debris is fixed whatever it says
  pile_seeds  seeds from which each episode draws its pile
  speed  largest forward velocity; m/s
  turn_rate  largest turn rate; rad/s
  period  duration of a step, rounded to whole steps of 1/240 s; s
  max_steps  longest episode, in steps; None: no limit
  reach  distance at which the goal is reached; m
  around  distance of start and goals from the circle around the pile; m
  apart  distance of the bases of two robots below which both lose reward; m
  rays  number of rays of the scan
  max_range  range of the scan; m
  threads  number of threads; results do not depend on it
  randomization  a Randomization: what each episode draws besides
"""
import numpy as np

from .. import _core, geometry
from ..arguments import checked_seed, checked_seeds, mistake, real
from ..robots import Session
from .ground_senses import EYE, GROUND_KEYS, GroundSenses, bearing, bearing_box, is_fallen, within_bearing
from .pictures import Section
from .randomization import Drawn
from .robot_worlds import moved_start, round_period
from .settled import find_pile
from .spaces import Box, Dict, ParallelEnv, make_random
from .void_world import checked_action, checked_limit, is_over

MISSION = """
return rubble.mission {
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2 }, spawn_bounds = { 3, 3, 2 } },
  robots = {
    rubble.robot.rover { name = "first", position = { 6, 0, 0.005 } },
    rubble.robot.rover { name = "second", position = { -6, 0, 0.005 } },
  },
}
"""
_ROOM = 1.5  # between two robots at the start; m


class TeamNav(ParallelEnv):
    metadata = {"render_modes": ["rgb_array"], "render_fps": 10, "name": "rubble/TeamNav-v0", "is_parallelizable": True}
    randomized = GROUND_KEYS

    def __init__(self, mission=MISSION, pile_seeds=range(1, 4), speed=0.6, turn_rate=1.5, period=0.1, max_steps=600,
                 reach=0.3, around=1.5, apart=0.8, rays=64, max_range=8.0, threads=1, randomization=None, render_mode=None):
        self._period, rate = round_period(period)
        self.render_mode, self.metadata = render_mode, {**self.metadata, "render_fps": rate}
        self._mission, self._seeds, self._threads = mission, checked_seeds("pile_seeds", pile_seeds), threads
        self._speed, self._turn_rate = real("speed", speed), real("turn_rate", turn_rate, zero=True)
        self._max_steps, self._reach = checked_limit(max_steps), real("reach", reach)
        self._around, self._apart = real("around", around, zero=True), real("apart", apart, zero=True)
        self._drawn = Drawn(randomization, GROUND_KEYS, "TeamNav")
        self._senses, self._random, self._sessions = GroundSenses(rays, max_range, self._drawn), None, {}
        _, self._session = self._find_session(self._seeds[0])
        self.possible_agents, self.agents = list(self._session.robots), []
        self._check_robots()
        self._heights = {name: float(self._session.state(name)["links"][0][2]) for name in self.possible_agents}
        # No parts where their number depends on the mission.
        others = bearing_box((len(self.possible_agents) - 1, 3), unit="m, and cosine and sine of the bearing")
        self._actions = {name: Box(-1.0, 1.0, (2,), np.float32, parts=[
            ("forwards", f"of {speed:g} m/s"), ("turning to the left", f"of {turn_rate:g} rad/s")])
            for name in self.possible_agents}
        self._observations = {name: Dict({"others": others, **self._senses.spaces()}) for name in self.possible_agents}

    def _check_robots(self):
        if len(self.possible_agents) < 2:
            raise mistake("mission", f"expected two robots or more: found {len(self.possible_agents)}; CrawlerNav is for one")
        for name in self.possible_agents:
            try:
                self._session.drive(name, 0.0)
            except _core.InputError as error:
                raise mistake("mission", f"expected robots that have tracks or wheels: found {name!r}, which has neither") from error

    def observation_space(self, agent):
        return self._observations[agent]

    def action_space(self, agent):
        return self._actions[agent]

    def _find_session(self, seed, friction=None):
        """The SettledPile of that seed, and a session of its robots at their start."""
        if seed not in self._sessions:
            settled = find_pile(self._mission, seed, self._threads, ["robot_run.debris=fixed"])
            self._sessions[seed] = settled, Session(settled.pile, threads=self._threads, observed=False)
        settled, session = self._sessions[seed]
        if friction is not None:
            changed = [f"robots[{i + 1}].friction={friction!r}" for i in range(len(session.robots))]
            session = Session(settled.pile.vary(changed), threads=self._threads, observed=False)
        return settled, session

    def reset(self, seed=None, options=None):
        seed = checked_seed(seed)
        if seed is not None or self._random is None:
            self._random, _ = make_random(seed)
        pile_seed = int(self._random.choice(self._seeds))
        start, goals = self._random.uniform(-np.pi, np.pi), self._random.uniform(-0.5, 0.5, len(self.possible_agents))
        self._drawn.draw(self._random)
        settled, self._session = self._find_session(pile_seed, self._drawn.get("materials.friction"))
        self._pile, self.agents, self._steps = settled.pile, list(self.possible_agents), 0
        self._place(settled.radius + self._around, start, goals)
        self._take_states()
        self._places = {name: [self._base(name)[:3]] for name in self.agents}
        self._distances = {name: self._to_goal(name) for name in self.agents}
        infos = {name: {"pile_seed": pile_seed, "goal_reached": False, **self._drawn.info()} for name in self.agents}
        return {name: self._observe(name) for name in self.agents}, infos

    def _place(self, ring, start, goals):
        """The robots on a ring about the pile, equally far from one another; the goals on the other side."""
        count = len(self.possible_agents)
        if 2 * ring * _core._directions([np.pi / count])[0, 1] < _ROOM:
            raise mistake("around", f"no room for {count} robots about the pile: expected more than {self._around:g} m")
        angles = start + 2 * np.pi * np.arange(count) / count
        at, self._goals, poses = ring * _core._directions(angles), {}, {}
        across = -ring * _core._directions(angles + goals)
        for i, name in enumerate(self.possible_agents):
            self._goals[name] = np.append(across[i], 0.0)
            base = geometry.pose([at[i, 0], at[i, 1], self._heights[name]], (0, 0, angles[i] + np.pi))
            poses[name] = moved_start(base, self._drawn)
        self._session.reset(poses)

    def _take_states(self):
        self._states = {name: self._session.state(name) for name in self.possible_agents}

    def _base(self, name):
        return self._states[name]["links"][0]

    def _to_goal(self, name):
        return bearing(self._base(name), self._goals[name])[0]

    def _observe(self, name):
        others = [bearing(self._base(name), self._base(other)[:3]) for other in self.possible_agents if other != name]
        observation = self._senses.observe(self._pile, self._states[name], self._goals[name])
        return dict(sorted({**observation, "others": within_bearing(others)}.items()))

    def _is_crowded(self, name):
        return any(float(_core._lengths((self._base(name) - self._base(other))[None, :3])[0]) < self._apart
                   for other in self.possible_agents if other != name)

    def step(self, actions):
        if self._random is None:
            raise RuntimeError("reset() comes before step()")
        if set(actions) != set(self.agents):
            raise mistake("actions", f"expected one of each agent that has not ended ({', '.join(self.agents)}): "
                                     f"found {', '.join(map(str, actions)) or 'none'}")
        if not self.agents:
            return {}, {}, {}, {}, {}
        checked = {name: checked_action(actions[name], 2) for name in self.agents}
        for name, (forwards, turning) in checked.items():
            self._session.drive(name, forwards * self._speed, turning * self._turn_rate)
        for name in set(self.possible_agents) - set(self.agents):
            self._session.drive(name, 0.0)
        self._session.step(self._period)
        self._steps += 1
        self._take_states()
        observations, rewards, terminated, truncated, infos = {}, {}, {}, {}, {}
        for name in self.agents:
            self._places[name].append(self._base(name)[:3])
            before, self._distances[name] = self._distances[name], self._to_goal(name)
            reached = bool(self._distances[name] < self._reach)
            observations[name] = self._observe(name)
            rewards[name] = float(before - self._distances[name] - 0.01 - 0.1 * self._is_crowded(name) + 10.0 * reached)
            terminated[name] = reached or is_fallen(self._states[name])
            truncated[name] = is_over(self._steps, self._max_steps)
            infos[name] = {"goal_reached": reached}
        self.agents = [name for name in self.agents if not (terminated[name] or truncated[name])]
        return observations, rewards, terminated, truncated, infos

    def render(self):
        """The section at the height of the first robot's scan with the ways and the goals, as wide as they need."""
        if self.render_mode is None or self._random is None:
            return None
        places = [place for way in self._places.values() for place in way]
        half = float(np.max(np.abs([*places, *self._goals.values()]))) + 1
        section = Section(self._pile, (0, 0, self._base(self.possible_agents[0])[2] + EYE[2]), half, 512)
        for name, way in self._places.items():
            section.draw_way(way, goal=self._goals[name], radius=0.2)
        return section.rgb

    def close(self):
        pass
