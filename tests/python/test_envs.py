"""Environments: equal episodes whatever came before, spaces kept, mistakes named, nothing left behind."""
import ctypes
import hashlib
import multiprocessing
import os
import random
import sys
import unittest

import numpy as np

import rubble
from rubble.envs import CrawlerNav, SnakeExplore, VoidExplore
from rubble.envs.pictures import Section

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()

SMALL = {"size": 16, "max_steps": 12, "pile_seeds": range(1, 4)}


def play(env, seed):
    """The hash of everything that an episode gives."""
    digest = hashlib.sha256()
    chance = np.random.default_rng(seed)

    def add(observation, *rest):
        for name in sorted(observation):
            digest.update(np.ascontiguousarray(observation[name]).tobytes())
        digest.update(repr(rest).encode())

    observation, info = env.reset(seed=seed)
    add(observation, sorted(info.items()))
    done = False
    while not done:
        observation, reward, terminated, truncated, info = env.step(
            chance.uniform(-1, 1, env.action_space.shape).astype(np.float32))
        add(observation, reward, terminated, truncated, sorted(info.items()))
        done = terminated or truncated
    return digest.hexdigest()


def play_alone(seed):
    return play(VoidExplore(**SMALL), seed)


class Episodes(unittest.TestCase):
    def test_are_equal_in_any_order(self):
        """200 episodes of 40 seeds, shuffled, in one environment."""
        env = VoidExplore(**SMALL)
        first = {seed: play(env, seed) for seed in range(40)}
        self.assertGreater(len(set(first.values())), 38)  # other seeds are other episodes
        order = [seed for seed in range(40) for _ in range(4)]
        random.Random(1).shuffle(order)
        for seed in order:
            self.assertEqual(play(env, seed), first[seed])

    def test_are_equal_in_other_processes_and_threads(self):
        env = VoidExplore(threads=2, **SMALL)
        here = [play(env, seed) for seed in (3, 1, 4)]
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            self.assertEqual(pool.map(play_alone, (3, 1, 4)), here)

    def test_half_an_episode_leaves_nothing_behind(self):
        env = VoidExplore(**SMALL)
        wanted = play(env, 7)
        env.reset(seed=8)
        for _ in range(5):
            env.step(np.ones(4))
        self.assertEqual(play(env, 7), wanted)


class Crawler(unittest.TestCase):
    OPTIONS = {"max_steps": 10, "pile_seeds": [1, 2], "rays": 16}

    def test_episodes_are_equal_whatever_came_before(self):
        env = CrawlerNav(**self.OPTIONS)
        first = {seed: play(env, seed) for seed in range(4)}
        self.assertEqual(len(set(first.values())), 4)
        for seed in (2, 0, 0, 3, 1):
            self.assertEqual(play(env, seed), first[seed])
        self.assertEqual(play(CrawlerNav(threads=2, **self.OPTIONS), 2), first[2])

    def test_driving_ahead_comes_nearer_and_observations_are_in_their_space(self):
        env = CrawlerNav(**self.OPTIONS)
        observation, _ = env.reset(seed=1)
        self.assertGreater(observation["scan"][0], 0.5)  # the pile is ahead
        self.assertAlmostEqual(float(observation["tilt"][2]), 1, places=5)
        start, total = float(observation["goal"][0]), 0.0
        for _ in range(10):
            self.assertTrue(env.observation_space.contains(observation))
            observation, reward, terminated, truncated, info = env.step([1, 0, 0.5, 0])
            total += reward
        self.assertTrue(truncated and not terminated and not info["goal_reached"])
        self.assertLess(float(observation["goal"][0]), start - 0.2)
        self.assertAlmostEqual(total, start - float(observation["goal"][0]) - 0.1, places=4)

    def test_a_goal_is_reached(self):
        env = CrawlerNav(mission="return rubble.mission { pile = { layers = 0 } }", pile_seeds=[1], max_steps=400)
        observation, _ = env.reset(seed=3)
        for _ in range(400):
            bearing = np.arctan2(observation["goal"][2], observation["goal"][1])
            observation, reward, terminated, truncated, info = env.step([0.8, np.clip(2 * bearing, -1, 1), 0.5, 0.5])
            if terminated or truncated:
                break
        self.assertTrue(info["goal_reached"])
        self.assertGreater(reward, 9)


class Snake(unittest.TestCase):
    OPTIONS = {"max_steps": 10, "pile_seeds": [1, 2]}

    def test_episodes_are_equal_whatever_came_before(self):
        env = SnakeExplore(**self.OPTIONS)
        first = {seed: play(env, seed) for seed in range(3)}
        for seed in (2, 0, 1):
            self.assertEqual(play(env, seed), first[seed])
        self.assertEqual(play(SnakeExplore(threads=2, **self.OPTIONS), 2), first[2])

    def test_it_lies_on_the_ground_and_moves_as_it_is_told(self):
        env = SnakeExplore(max_steps=40, pile_seeds=[1])
        observation, info = env.reset(seed=1)
        self.assertFalse(info["entered"])
        self.assertAlmostEqual(float(observation["head"][4]), 1, places=3)  # its Z axis is up
        np.testing.assert_array_equal(observation["head"][:3], 0)
        bend = np.zeros(15)
        bend[::2] = 0.25
        for _ in range(20):
            observation, reward, terminated, truncated, info = env.step(bend)
            self.assertTrue(env.observation_space.contains(observation))
        np.testing.assert_allclose(observation["joints"][::2], 0.3, atol=0.1)
        weight = 16 * 0.2 * 9.81
        self.assertAlmostEqual(float(observation["touch"].sum()), weight, delta=0.6 * weight)

    def test_a_gait_changes_the_distance_to_the_entrance(self):
        """The reward before it has entered is how much nearer it came, and what it saw."""
        env = SnakeExplore(max_steps=60, pile_seeds=[1])
        env.reset(seed=1)
        before, seen, total = env._to_entrance(), env._world.view.seen, 0.0
        i = np.arange(15)
        for step in range(60):
            even = i % 2 == 0
            action = np.where(even, 0.75 * np.sin(0.5 * i - 0.4 * step), 0.9 * np.sin(0.5 * i - 0.4 * step + np.pi / 4))
            _, reward, _, _, info = env.step(action)
            total += reward
        self.assertGreater(abs(env._to_entrance() - before), 0.02)
        if not info["entered"]:
            share = (env._world.view.seen - seen) / env._world.view.count
            self.assertAlmostEqual(total, before - env._to_entrance() + 100 * share - 0.6, places=4)

    def test_mistakes_are_named(self):
        env = SnakeExplore(**self.OPTIONS)
        with self.assertRaises(RuntimeError):
            env.step(np.zeros(15))
        env.reset(seed=1)
        with self.assertRaises(rubble.InputError) as raised:
            env.step(np.zeros(4))
        self.assertEqual(raised.exception.key, "action")


class MallocInfo(ctypes.Structure):
    """struct mallinfo2 of glibc."""
    _fields_ = [(name, ctypes.c_size_t) for name in
                "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()]


def used_memory():
    """Bytes that are allocated and not freed. Resident memory would hide a leak behind what was freed before."""
    ask = ctypes.CDLL(None).mallinfo2
    ask.restype = MallocInfo
    info = ask()
    return info.uordblks + info.hblkhd + 64 * sys.getallocatedblocks()  # Python's own blocks are not of malloc


class Memory(unittest.TestCase):
    STEPS = int(os.environ.get("RUBBLE_MEMORY_STEPS", "3000"))
    ENVS = ((VoidExplore, {"size": 16}, 1.0), (CrawlerNav, {"rays": 16}, 0.2), (SnakeExplore, {"size": 16}, 0.2))

    @staticmethod
    def grow(env, steps, keep=lambda observation: None, warm_up=200):
        """How much more memory is in use after so many steps; bytes."""
        actions = np.random.default_rng(1).uniform(-1, 1, (100, 15))
        env.reset(seed=1)
        before = 0
        for k in range(-warm_up, steps):  # the first of them make what is made once
            if k == 0:
                before = used_memory()
            observation, _, terminated, truncated, _ = env.step(actions[k % 100, :env.action_space.shape[0]])
            keep(observation)
            if terminated or truncated:
                env.reset(seed=1)
        return used_memory() - before

    def test_does_not_grow(self):
        """3,000 and 600 steps; 100,000 and 20,000 by `make test-nightly`."""
        for make, options, share in self.ENVS:
            steps = int(share * self.STEPS)
            env = make(max_steps=100, pile_seeds=[1], **options)
            self.assertLess(self.grow(env, steps), (64 << 10) + steps, make.__name__)
            kept = []  # the control: observations that are kept are seen
            self.assertGreater(self.grow(env, 200, kept.append, 0), (64 << 10) + 200, make.__name__)


class Rules(unittest.TestCase):
    def test_observations_are_in_their_space_and_the_body_keeps_its_distance(self):
        env = VoidExplore(**SMALL)
        observation, _ = env.reset(seed=2)
        chance = np.random.default_rng(1)
        seen = 0.0
        for _ in range(40):
            self.assertTrue(env.observation_space.contains(observation))
            self.assertGreaterEqual(float(observation["clearance"][0]), 0.15 - 1e-6)
            action = chance.uniform(-1, 1, 4).astype(np.float32)
            self.assertTrue(env.action_space.contains(action))
            observation, reward, _, _, info = env.step(action)
            self.assertGreaterEqual(info["coverage"], seen)
            seen = info["coverage"]
        self.assertGreater(seen, 0)

    def test_the_body_stops_where_the_pile_says_so(self):
        """Its short cut over clearances against all clearances on the way."""
        env = VoidExplore(**SMALL)
        env.reset(seed=2)
        chance = np.random.default_rng(4)
        stops = 0
        for _ in range(12):
            before = env._position.copy()
            action = chance.uniform(-1, 1, 4)
            _, _, _, _, info = env.step(action)
            way = env._turned(action[:3] * 0.1, env._world.yaw + env._yaw)
            fine = before + np.outer(np.linspace(0, 1, 9)[1:], way)
            free = bool(np.all(env._world.pile.clearance(fine, 1.0) >= 0.15 - 1e-3))
            if np.allclose(env._position, before + way):
                self.assertTrue(free)
            else:
                stops += 1
                self.assertFalse(bool(np.all(env._world.pile.clearance(fine, 1.0) >= 0.15 + 1e-3)))
        self.assertEqual(stops, info["stops"])

    def test_colour_is_what_the_renderer_draws(self):
        env = VoidExplore(colour=True, size=32, max_steps=3, pile_seeds=[1], metres=True)
        observation, _ = env.reset(seed=1)
        self.assertTrue(env.observation_space.contains(observation))
        drawn = rubble.Renderer(env._world.pile).render(env._body(), 32, 32)
        np.testing.assert_array_equal(observation["rgb"], drawn["rgb"])
        seen = np.isfinite(drawn["depth"]) & (drawn["depth"] < 4.9)
        self.assertGreater(seen.mean(), 0.3)
        self.assertLess(np.quantile(np.abs(drawn["depth"] - observation["depth"])[seen], 0.9), 1e-3)

    def test_depth_is_that_of_the_pile(self):
        env = VoidExplore(**SMALL, metres=True)
        observation, _ = env.reset(seed=2)
        body = env._body()
        k = env._world.view.K
        v, u = np.mgrid[0:16, 0:16]
        optical = np.stack([np.ones(u.shape), -(u - k[0, 2]) / k[0, 0], -(v - k[1, 2]) / k[1, 1]], axis=-1)
        directions = optical.reshape(-1, 3) @ rubble.matrix(body)[:3, :3].T
        hits = env._world.pile.cast_rays(body[:3], directions)
        planar = np.minimum(hits["distance"] / np.linalg.norm(directions, axis=1), 5).reshape(16, 16)
        self.assertLess(np.quantile(np.abs(planar - observation["depth"]), 0.97), 1e-4)

    def test_arguments_are_checked(self):
        nan, inf = float("nan"), float("inf")
        every = {"pile_seeds": ([], [1.7], [-1], 3, ["1"], [True]), "period": (0, -0.1, nan, inf, "1"),
                 "max_steps": (0, -5, 1.5, True), "max_range": (0, -1, nan, inf)}
        wrong = {CrawlerNav: {**every, "speed": (0, -1, nan), "turn_rate": (-1, inf), "reach": (0, -1, nan), "around": (-100, inf),
                              "rays": (0, 1.5)},
                 SnakeExplore: {**every, "enough": (0, nan, 1.5)},
                 VoidExplore: {**every, "speed": (0, -1, nan), "turn_rate": (-1, inf), "enough": (0, nan, 1.5)}}
        for kind, cases in wrong.items():
            for key, values in cases.items():
                for value in values:
                    with self.assertRaises(rubble.InputError, msg=f"{kind.__name__} {key}={value!r}") as raised:
                        kind(**{key: value})
                    self.assertEqual(raised.exception.key, key)
        CrawlerNav(pile_seeds=np.arange(1, 3), speed=np.float32(0.5), max_steps=np.int64(5), period=1, around=0)
        SnakeExplore(pile_seeds=iter([1, 2]), enough=1)

    def test_periods_are_of_whole_steps(self):
        for period, steps in ((0.1, 24), (0.001, 1), (0.01, 2), (0.02, 5), (1 / 60, 4)):
            env = CrawlerNav(mission="return rubble.mission { pile = { layers = 0 } }", pile_seeds=[1], rays=16, period=period)
            self.assertEqual((env._period, env.metadata["render_fps"]), (steps / 240, 240 / steps))
            env.reset(seed=1)
            for _ in range(10):
                env.step([1, 0, 0, 0])
            self.assertAlmostEqual(env._state["time"], 10 * steps / 240, places=9)
        self.assertEqual(SnakeExplore(period=0.03).metadata["render_fps"], 240 / 7)
        with self.assertRaises(rubble.InputError) as raised:
            CrawlerNav(period=61)
        self.assertEqual(raised.exception.key, "period")
        self.assertEqual(VoidExplore(period=0.01).metadata["render_fps"], 100)  # a ball has no steps of its own

    def test_mistakes_are_named(self):
        env = VoidExplore(**SMALL)
        with self.assertRaises(RuntimeError):
            env.step(np.zeros(4))
        env.reset(seed=1)
        for action in (np.zeros(3), [0, 0, np.nan, 0], np.zeros((4, 1)), [0, 0, 1.5, 0], [-2, 0, 0, 0], "left",
                       [0, 1j, 0, 0], [[1], 2, 3, 4]):
            with self.assertRaises(rubble.InputError) as raised:
                env.step(action)
            self.assertEqual(raised.exception.key, "action")
        for make, key in ((lambda: VoidExplore(size=10**6), "size"), (lambda: SnakeExplore(size=15), "size"),
                          (lambda: CrawlerNav(rays=10**9), "rays")):
            with self.assertRaises(rubble.InputError) as raised:
                make()
            self.assertEqual(raised.exception.key, key)
        for seed in (-1, 2**64, 1.5, "1"):
            with self.assertRaises(rubble.InputError) as raised:
                rubble.settle("scripts/first_pile.lua", seed=seed)
            self.assertEqual(raised.exception.key, "seed")
        with self.assertRaises(rubble.InputError) as raised:
            env.reset(seed=-1)
        self.assertEqual(raised.exception.key, "seed")
        self.assertIn("float32", repr(env.action_space))
        self.assertIn("depth", repr(env.observation_space))
        with self.assertRaises(rubble.InputError) as raised:
            VoidExplore(radius=3.0, voxel=0.5, pile_seeds=[1]).reset(seed=1)
        self.assertEqual(raised.exception.key, "radius")
        env.close()
        env.close()

    def test_depth_pictures_are_levels_of_metres(self):
        for kind, options, most in ((VoidExplore, SMALL, 5.0), (SnakeExplore, Snake.OPTIONS, 4.0)):
            picture = kind(**options).reset(seed=2)[0]["depth"]
            metres = kind(**options, metres=True).reset(seed=2)[0]["depth"]
            self.assertEqual((picture.dtype, picture.shape), (np.uint8, metres.shape + (1,)))
            self.assertLess(np.abs(picture[..., 0] * (most / 255) - metres).max(), most / 510 + 1e-6)
            self.assertGreater(len(np.unique(picture)), 5)

    def test_episodes_without_a_limit_are_not_truncated(self):
        env = CrawlerNav(**{**Crawler.OPTIONS, "max_steps": None})
        env.reset(seed=1)
        for _ in range(15):
            self.assertFalse(env.step([0, 0, 0, 0])[3])


class Pictures(unittest.TestCase):
    """What render() draws: the places that the pile has, and those where the body has been."""

    def test_only_an_environment_that_was_asked_to_draws(self):
        env = VoidExplore(**SMALL)
        env.reset(seed=1)
        self.assertIsNone(env.render())

    def test_a_section_is_dark_where_the_pile_is_solid(self):
        pile = VoidExplore(**SMALL)
        pile.reset(seed=1)
        pile = pile._world.pile
        section = Section(pile, (0.5, 0, 0.3), 2.0, 64)
        steps = (np.arange(64) + 0.5) / 64 * 4 - 2
        x, y = np.meshgrid(0.5 + steps, -steps)
        clear = pile.clearance(np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.3)], axis=1), 1.0).reshape(64, 64)
        dark = section.rgb[..., 0] == 70
        self.assertGreater((clear == 0).mean(), 0.02)
        self.assertGreater((dark == (clear == 0)).mean(), 0.985)  # but where pieces overlap within one pixel

    def test_body_goal_and_way_stand_where_they_are(self):
        env = CrawlerNav(**Crawler.OPTIONS, render_mode="rgb_array")
        self.assertEqual(env.metadata["render_fps"], 10)
        env.reset(seed=1)
        for _ in range(5):
            env.step([1, 0, 0, 0])
        picture = env.render()
        self.assertEqual((picture.shape, picture.dtype), ((512, 512, 3), np.uint8))
        half = np.max(np.abs([*env._places, env._goal])) + 1
        for place, colour in ((env._places[-1], (214, 72, 40)), (env._goal, (30, 150, 70))):
            rows, columns = np.nonzero(np.all(picture == colour, axis=2))
            self.assertAlmostEqual((columns.mean() + 0.5) / 256 * half - half, place[0], delta=0.1)
            self.assertAlmostEqual(half - (rows.mean() + 0.5) / 256 * half, place[1], delta=0.1)

    def test_what_the_camera_sees_stands_beside_the_section(self):
        env = VoidExplore(**SMALL, render_mode="rgb_array")
        observation, _ = env.reset(seed=1)
        picture = env.render()
        self.assertEqual(picture.shape, (256, 512, 3))
        np.testing.assert_array_equal(picture[::16, 256::16, 1], observation["depth"][..., 0])


if __name__ == "__main__":
    unittest.main()
