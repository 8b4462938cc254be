"""What Gymnasium asks of an environment, checked without it: signatures, spaces, seeds, ends of episodes, and both ways
in which vector environments begin the next episode."""
import functools
import inspect
import os
import sys
import unittest

import numpy as np

import rubble
from rubble.envs import CrawlerNav, SnakeExplore, VoidExplore
from rubble.envs.spaces import Box

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()

STEPS = 4
OPTIONS = {VoidExplore: {"size": 16}, CrawlerNav: {"rays": 16}, SnakeExplore: {"size": 16}}


@functools.lru_cache(maxsize=None)
def make(kind, number=0):
    """An environment; the same one each time, because its piles take long to settle."""
    return kind(max_steps=STEPS, pile_seeds=[1, 2], **OPTIONS[kind])


def flat(observation):
    return {name: np.array(values) for name, values in observation.items()}


def same(a, b):
    return a.keys() == b.keys() and all(np.array_equal(a[name], b[name]) for name in a)


class Contract(unittest.TestCase):
    def check_observation(self, env, observation):
        self.assertTrue(env.observation_space.contains(observation))
        self.assertEqual(list(observation), list(env.observation_space.spaces), "the order of the space")
        for name, space in env.observation_space.spaces.items():
            value = observation[name]
            self.assertIsInstance(value, np.ndarray, name)
            self.assertEqual((value.shape, value.dtype), (space.shape, space.dtype), name)
            self.assertTrue(np.all(np.isfinite(value)), name)

    def test_signatures_are_gymnasiums(self):
        for kind in OPTIONS:
            env = make(kind)
            reset = inspect.signature(env.reset).parameters
            self.assertEqual([(p.name, p.kind, p.default) for p in reset.values()],
                             [("seed", inspect.Parameter.KEYWORD_ONLY, None),
                              ("options", inspect.Parameter.KEYWORD_ONLY, None)])
            self.assertEqual(list(inspect.signature(env.step).parameters), ["action"])
            self.assertIn("render_modes", env.metadata)
            self.assertTrue(env.render_mode is None or env.render_mode in env.metadata["render_modes"])
            self.assertIs(env.unwrapped, env)

    def test_actions_are_a_box_from_minus_one_to_one(self):
        for kind in OPTIONS:
            space = make(kind).action_space
            self.assertEqual(space.dtype, np.float32)
            self.assertTrue(np.all(space.low == -1) and np.all(space.high == 1))
            space.seed(3)
            first = [space.sample() for _ in range(5)]
            space.seed(3)
            self.assertTrue(all(np.array_equal(a, space.sample()) for a in first))
            self.assertTrue(all(space.contains(a) for a in first))
            self.assertFalse(space.contains(np.full(space.shape, 1.5, np.float32)))
            self.assertFalse(space.contains(np.zeros(space.shape[0] + 1, np.float32)))
            self.assertFalse(space.contains(np.zeros(space.shape, np.float64)), "is wider than the space's numbers")

    def test_spaces_print_names_ranges_and_units(self):
        for kind in OPTIONS:
            env = make(kind)
            for name, space in env.observation_space.spaces.items():
                self.assertIn(f"{name!r}: {space!r}", str(env.observation_space))
                self.assertTrue(space.unit or len(space.parts) == int(np.prod(space.shape)), f"{kind.__name__}: {name}")
            self.assertNotIn("object at", str(env.action_space) + str(env.observation_space))
            self.assertTrue(env.action_space.unit or len(env.action_space.parts) == env.action_space.shape[0])
        self.assertEqual(str(make(VoidExplore).action_space),
                         "Box((4,), float32: forwards -1 to 1 of 0.5 m/s, left -1 to 1 of 0.5 m/s, up -1 to 1 of 0.5 m/s, "
                         "turning to the left -1 to 1 of 1 rad/s)")
        self.assertEqual(str(make(CrawlerNav).observation_space["goal"]),
                         "Box((3,), float32: distance 0 to 100 m, cosine of bearing -1 to 1, sine of bearing -1 to 1)")
        self.assertEqual(str(make(SnakeExplore).observation_space["depth"]), "Box((16, 16, 1), uint8, 0 to 255 levels of 4/255 m)")
        self.assertEqual(str(Box(0, 1, (2,))), "Box((2,), float32, 0 to 1)")

    def test_observations_are_in_their_space_at_the_limits_of_actions(self):
        for kind in OPTIONS:
            env = make(kind)
            observation, info = env.reset(seed=3, options={})
            self.assertIsInstance(info, dict)
            self.check_observation(env, observation)
            for action in (env.action_space.low, env.action_space.high, np.zeros(env.action_space.shape, np.float32)):
                answer = env.step(action)
                self.assertEqual(len(answer), 5)
                observation, reward, terminated, truncated, info = answer
                self.check_observation(env, observation)
                self.assertIs(type(reward), float)
                self.assertTrue(np.isfinite(reward))
                self.assertIs(type(terminated), bool)
                self.assertIs(type(truncated), bool)
                self.assertIsInstance(info, dict)

    def test_an_observation_is_not_written_over_by_the_next(self):
        for kind in OPTIONS:
            env = make(kind)
            observation, _ = env.reset(seed=1)
            kept = flat(observation)
            later = env.step(env.action_space.high)[0]
            self.assertTrue(same(observation, kept))
            self.assertFalse(same(later, kept), "nothing changes")

    def test_a_seed_binds_and_none_goes_on(self):
        for kind in OPTIONS:
            env, other = make(kind), make(kind, 1)
            first, _ = env.reset(seed=5)
            second, _ = env.reset()
            third, _ = env.reset()
            self.assertTrue(same(first, other.reset(seed=5)[0]))
            self.assertTrue(same(second, other.reset()[0]), "the second episode, too, follows from the seed")
            self.assertTrue(same(third, other.reset()[0]))
            self.assertFalse(all(same(first, env.reset(seed=seed)[0]) for seed in range(12)), "no seed changes anything")

    def test_seeds_are_whole_numbers_of_at_least_0(self):
        for kind in OPTIONS:
            env = make(kind)
            first = env.reset(seed=5)[0]
            self.assertTrue(same(first, env.reset(seed=np.int64(5))[0]))
            for seed in (-1, 1.5, np.float64(2), "1", True, np.bool_(True)):
                with self.assertRaises(rubble.InputError, msg=repr(seed)) as raised:
                    env.reset(seed=seed)
                self.assertEqual(raised.exception.key, "seed")

    def test_an_episode_is_cut_off_at_its_last_step_and_not_before(self):
        for kind in OPTIONS:
            env = make(kind)
            env.reset(seed=1)
            ends = [env.step(np.zeros(env.action_space.shape, np.float32))[2:4] for _ in range(STEPS)]
            if not any(terminated for terminated, _ in ends):
                self.assertEqual([truncated for _, truncated in ends], [False, False, False, True])

    def test_is_the_same_in_vectors_whenever_the_next_episode_begins(self):
        """As vector environments play: the next episode begins in the step that ends one, or in the step after it."""
        for kind in OPTIONS:
            actions = np.random.default_rng(2).uniform(-1, 1, (2, 3 * STEPS, *make(kind).action_space.shape)).astype(np.float32)
            played = {}
            for next_step in (False, True):
                envs = [make(kind), make(kind, 1)]
                episodes = [[[flat(env.reset(seed=7 + i)[0])]] for i, env in enumerate(envs)]
                done, used = [False, False], [0, 0]
                while min(used) < 3 * STEPS:
                    for i, env in enumerate(envs):
                        if done[i] and next_step:
                            episodes[i].append([flat(env.reset()[0])])
                            done[i] = False
                        elif used[i] < 3 * STEPS:
                            observation, reward, terminated, truncated, _ = env.step(actions[i, used[i]])
                            used[i] += 1
                            episodes[i][-1].append({**flat(observation), "reward": np.float64(reward)})
                            done[i] = terminated or truncated
                            if done[i] and not next_step:
                                episodes[i].append([flat(env.reset()[0])])
                played[next_step] = episodes
            for ours, others in zip(played[False], played[True]):
                self.assertGreaterEqual(len(ours), 3)
                for a, b in zip(ours, others):
                    self.assertEqual(len(a), len(b))
                    self.assertTrue(all(same(x, y) for x, y in zip(a, b)))

    def test_the_spaces_refuse_what_is_not_in_them(self):
        box = Box(0.0, 5.0, (2, 3), np.float32)
        self.assertTrue(box.contains(np.full((2, 3), 5, np.float32)))
        for wrong in (np.full((2, 3), 5.01, np.float32), np.zeros((3, 2), np.float32), np.full((2, 3), np.nan, np.float32)):
            self.assertFalse(box.contains(wrong))
        env = make(VoidExplore)
        observation, _ = env.reset(seed=1)
        self.assertFalse(env.observation_space.contains({**observation, "more": np.zeros(1)}))
        self.assertFalse(env.observation_space.contains({k: v for k, v in observation.items() if k != "depth"}))
        far = {**observation, "depth": observation["depth"] + np.float32(5.1)}
        self.assertFalse(env.observation_space.contains(far))


if __name__ == "__main__":
    unittest.main()
