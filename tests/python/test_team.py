"""Several robots by the parallel interface: agents, spaces, repeated episodes, goals, others; mistakes are named."""
import os
import sys
import unittest

import numpy as np

import rubble
from rubble.envs import Calibration, Choice, Materials, Poses, Randomization, TeamNav, Uniform

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()

SMALL = {"pile_seeds": [1, 2], "rays": 16, "max_steps": 6}
FLAT = """return rubble.mission { pile = { layers = 0 }, robots = {
  rubble.robot.crawler { name = "a", position = { 3, 0, 0.005 } }, rubble.robot.rover { name = "b", position = { -3, 0, 0.005 } },
  rubble.robot.rover { name = "c", position = { 0, 3, 0.005 } } } }"""


def play(env, seed, action=(0.8, 0.1)):
    observations, infos = env.reset(seed=seed)
    told = [infos]
    while env.agents:
        told.append([values[name].tobytes() for values in observations.values() for name in sorted(values)])
        observations, *rest = env.step({name: np.array(action, np.float32) for name in env.agents})
        told.append(rest)
    return told


class Team(unittest.TestCase):
    def test_episodes_are_equal_whatever_came_before(self):
        env = TeamNav(**SMALL)
        first = {seed: play(env, seed) for seed in (1, 2)}
        self.assertNotEqual(first[1], first[2])
        for seed in (2, 1):
            self.assertEqual(play(env, seed), first[seed])
        self.assertEqual(play(TeamNav(threads=2, **SMALL), 2), first[2])

    def test_observations_are_in_their_spaces(self):
        env = TeamNav(mission=FLAT, **{**SMALL, "pile_seeds": [1]})
        self.assertEqual(env.possible_agents, ["a", "b", "c"])
        observations, infos = env.reset(seed=1)
        self.assertEqual(env.agents, env.possible_agents)
        self.assertEqual(infos["a"], {"pile_seed": 1, "goal_reached": False})
        for name in env.agents:
            self.assertTrue(env.observation_space(name).contains(observations[name]))
            self.assertEqual(list(observations[name]), list(env.observation_space(name).spaces))
            self.assertEqual(observations[name]["others"].shape, (2, 3))
            self.assertAlmostEqual(float(observations[name]["goal"][1]), 1, delta=0.15)  # ahead
        distances = [observations["a"]["others"][1, 0], observations["c"]["others"][0, 0]]
        self.assertAlmostEqual(*map(float, distances), delta=0.05)  # of a and c from one another

    def test_each_robot_does_what_it_is_told(self):
        env = TeamNav(mission=FLAT, **{**SMALL, "pile_seeds": [1]})
        env.reset(seed=1)
        before = dict(env._distances)
        for _ in range(5):
            _, rewards, terminated, truncated, _ = env.step({"a": [1, 0], "b": [0, 0], "c": [-1, 0]})
        moved = {name: before[name] - env._distances[name] for name in before}
        self.assertGreater(moved["a"], 0.1)
        self.assertAlmostEqual(moved["b"], 0, places=2)
        self.assertLess(moved["c"], -0.1)
        self.assertFalse(any(truncated.values()) or any(terminated.values()))
        truncated = env.step({name: [0, 0] for name in env.agents})[3]
        self.assertTrue(all(truncated.values()))
        self.assertEqual(env.agents, [])
        self.assertEqual(env.step({}), ({}, {}, {}, {}, {}))

    def test_a_robot_at_its_goal_ends_alone_and_others_go_on(self):
        env = TeamNav(mission=FLAT, pile_seeds=[1], rays=16, max_steps=None, reach=3.0)
        env.reset(seed=1)
        for _ in range(40):
            live = list(env.agents)
            _, rewards, terminated, _, infos = env.step({name: [1 if name == "a" else 0, 0] for name in live})
            if terminated["a"]:
                break
        self.assertTrue(infos["a"]["goal_reached"])
        self.assertGreater(rewards["a"], 9)
        self.assertEqual(env.agents, ["b", "c"])
        stands = env._base("a").copy()
        for _ in range(10):
            env.step({"b": [0, 0], "c": [0, 0]})
        self.assertLess(np.abs(env._base("a") - stands)[:3].max(), 0.15)

    def test_robots_that_are_near_lose_reward(self):
        env = TeamNav(mission=FLAT, pile_seeds=[1], rays=16, apart=50.0)
        env.reset(seed=1)
        rewards = env.step({name: [0, 0] for name in env.agents})[1]
        for reward in rewards.values():
            self.assertAlmostEqual(reward, -0.11, places=2)

    def test_what_is_drawn_is_recorded_and_felt(self):
        slow, fast = (TeamNav(mission=FLAT, randomization=Randomization(
            materials=Materials(friction=friction), poses=Poses(away=0.5), calibration=Calibration(range_noise=Uniform(0, 0.1))),
            **{**SMALL, "pile_seeds": [1]}) for friction in (0.02, 0.9))
        told = play(slow, 1)
        self.assertEqual(told, play(slow, 1))
        self.assertEqual(list(told[0]["b"]["randomization"]), ["calibration.range_noise", "materials.friction", "poses.away"])
        play(fast, 1)
        self.assertLess(fast._distances["a"], slow._distances["a"] - 0.02)

    def test_it_draws_all_robots_and_goals(self):
        env = TeamNav(render_mode="rgb_array", **SMALL)
        self.assertIsNone(env.render())
        env.reset(seed=1)
        picture = env.render()
        self.assertEqual(picture.shape, (512, 512, 3))
        for colour in ((214, 72, 40), (30, 150, 70)):
            self.assertGreater(np.all(picture == colour, axis=2).sum(), 2 * 9)

    def test_seeds_periods_and_arguments_are_checked(self):
        for key, values in {"pile_seeds": ([], [1.7]), "period": (0, 61), "max_steps": (0, 1.5), "speed": (0, float("nan")), "turn_rate": (-1,),
                            "reach": (0, float("inf")), "around": (-1,), "apart": (-1, float("nan")), "rays": (0,)}.items():
            for value in values:
                with self.assertRaises(rubble.InputError, msg=f"{key}={value!r}") as raised:
                    TeamNav(**{"mission": FLAT, "pile_seeds": [1], key: value})
                self.assertEqual(raised.exception.key, key)
        env = TeamNav(mission=FLAT, pile_seeds=[1], rays=16, period=0.01)
        self.assertEqual(env.metadata["render_fps"], 120)
        env.reset(seed=np.int64(1))
        env.step({name: [0, 0] for name in env.agents})
        self.assertAlmostEqual(env._session.time, 1 / 120, places=9)
        for seed in (-1, 1.5):
            with self.assertRaises(rubble.InputError) as raised:
                env.reset(seed=seed)
            self.assertEqual(raised.exception.key, "seed")

    def test_friction_may_be_a_number_of_numpy(self):
        env = TeamNav(mission=FLAT, pile_seeds=[1], rays=16, randomization=Randomization(
            materials=Materials(friction=Choice(list(np.linspace(0.4, 0.6, 3))))))
        self.assertIs(type(env.reset(seed=1)[1]["a"]["randomization"]["materials.friction"]), float)

    def test_mistakes_are_named(self):
        one = 'return rubble.mission { pile = { layers = 0 }, robots = { rubble.robot.rover { name = "a" } } }'
        snake = FLAT.replace('rubble.robot.rover { name = "c"', 'rubble.robot.snake { name = "c"')
        for mission, text in ((one, "two robots or more"), (snake, "'c'"), ("return rubble.mission { pile = { layers = 0 } }", "no robots")):
            with self.assertRaises(rubble.InputError) as raised:
                TeamNav(mission=mission, pile_seeds=[1])
            self.assertIn(text, str(raised.exception))
        env = TeamNav(mission=FLAT, pile_seeds=[1])
        with self.assertRaises(RuntimeError):
            env.step({})
        env.reset(seed=1)
        with self.assertRaises(rubble.InputError) as raised:
            env.step({"a": [0, 0]})
        self.assertEqual(raised.exception.key, "actions")
        with self.assertRaises(rubble.InputError) as raised:
            TeamNav(mission=FLAT, pile_seeds=[1], around=-0.9).reset(seed=1)
        self.assertEqual(raised.exception.key, "around")


if __name__ == "__main__":
    unittest.main()
