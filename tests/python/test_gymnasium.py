"""The environments as users of gymnasium, pettingzoo and stable-baselines3 have them: by their names, without a warning."""
import os
import subprocess
import sys
import unittest
import warnings

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()

NAMES = ("rubble/VoidExplore-v0", "rubble/CrawlerNav-v0", "rubble/SnakeExplore-v0")


def make(name, **more):
    return gymnasium.make(name, pile_seeds=[1], **more)


class Gymnasium(unittest.TestCase):
    def test_make_knows_them_without_an_import(self):
        code = ("import gymnasium; env = gymnasium.make('rubble.envs:rubble/CrawlerNav-v0', pile_seeds=[1]); "
                "print(sorted(n for n in gymnasium.registry if n.startswith('rubble/')), env.spec.max_episode_steps)")
        out = subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.PIPE, text=True).stdout
        self.assertEqual(out, f"{sorted(NAMES)} 600\n")

    def test_the_checker_has_nothing_to_say(self):
        import rubble.envs  # noqa: F401
        for name in NAMES:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                check_env(make(name, render_mode="rgb_array").unwrapped)

    def test_seeds_are_those_of_rubble(self):
        import rubble.envs
        for name in NAMES:
            env = make(name)
            for seed in (-1, 1.5):
                with self.assertRaises(rubble.InputError) as raised:
                    env.reset(seed=seed)
                self.assertEqual(raised.exception.key, "seed")
            env.reset(seed=np.int64(3))

    def test_the_limit_of_make_ends_episodes(self):
        import rubble.envs  # noqa: F401
        for name in NAMES:
            env = make(name, max_episode_steps=3)
            env.reset(seed=1)
            self.assertEqual([env.step(0 * env.action_space.low)[3] for _ in range(3)], [False, False, True])
            self.assertGreater(gymnasium.spec(name).max_episode_steps, 100)

    def test_vector_environments_of_both_kinds_step(self):
        import rubble.envs  # noqa: F401
        vector = gymnasium.make_vec("rubble/CrawlerNav-v0", num_envs=2, vectorization_mode="sync", pile_seeds=[1])
        observation, _ = vector.reset(seed=[1, 2])
        self.assertEqual(observation["scan"].shape, (2, 64))
        vector.step(vector.action_space.sample())
        vector.close()


    def test_make_vec_gives_a_batch(self):
        import rubble.envs
        vector = gymnasium.make_vec("rubble/CrawlerNav-v0", num_envs=3, pile_seeds=[1], rays=16, max_episode_steps=2, batch_threads=2)
        self.assertIsInstance(vector, rubble.envs.Batch)
        observation, _ = vector.reset(seed=1)
        self.assertTrue(vector.observation_space.contains(observation))
        ends = [vector.step(vector.action_space.sample())[3].tolist() for _ in range(3)]
        self.assertEqual(ends, [[False] * 3, [True] * 3, [False] * 3])
        # As gymnasium's own, step by step.
        vector, own = (gymnasium.make_vec("rubble/CrawlerNav-v0", num_envs=2, pile_seeds=[1], rays=16, max_episode_steps=2,
                                          vectorization_mode=mode) for mode in (None, "sync"))
        steps = [[env.reset(seed=7)] + [env.step(np.full((2, 4), 0.5, np.float32)) for _ in range(4)] for env in (vector, own)]
        for mine, theirs in zip(*steps):
            self.assertEqual(str(mine[1:]), str(theirs[1:]))
            for name in mine[0]:
                np.testing.assert_array_equal(mine[0][name], theirs[0][name])
        wrapped = gymnasium.wrappers.vector.RecordEpisodeStatistics(vector)
        wrapped.reset(seed=1)
        wrapped.step(wrapped.action_space.sample())
        vector.close()


class PettingZoo(unittest.TestCase):
    def test_its_parallel_test_passes(self):
        try:
            from pettingzoo import ParallelEnv
            from pettingzoo.test import parallel_api_test
        except ImportError:
            self.skipTest("PettingZoo is not installed")
        from rubble.envs import TeamNav
        env = TeamNav(pile_seeds=[1], max_steps=15)
        self.assertIsInstance(env, ParallelEnv)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            parallel_api_test(env, num_cycles=40)
        self.assertEqual(str(env), "rubble/TeamNav-v0")


class StableBaselines(unittest.TestCase):
    def test_its_checker_has_nothing_to_say(self):
        try:
            import torch  # noqa: F401
        except ImportError:
            self.skipTest("PyTorch is not installed")
        from stable_baselines3.common.env_checker import check_env as check
        import rubble.envs  # noqa: F401
        for name in NAMES:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                check(make(name, render_mode="rgb_array").unwrapped)


if __name__ == "__main__":
    unittest.main()
