"""The environments as users of gymnasium and stable-baselines3 have them: found without an import, without a warning."""
import os
import subprocess
import sys
import unittest
import warnings

import gymnasium
from gymnasium.utils.env_checker import check_env

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()

NAMES = ("rubble/VoidExplore-v0", "rubble/CrawlerNav-v0", "rubble/SnakeExplore-v0")


def make(name, **more):
    return gymnasium.make(name, pile_seeds=[1], **more)


class Gymnasium(unittest.TestCase):
    def test_make_knows_them_without_an_import(self):
        # As the wheel's entry point tells it; rubble itself is not loaded.
        code = ("import gymnasium, sys; from gymnasium.envs.registration import registry; "
                "print(sorted(n for n in registry if n.startswith('rubble/')), 'rubble' in sys.modules)")
        if not os.environ.get("RUBBLE_INSTALLED"):
            code = "import rubble_gymnasium; rubble_gymnasium.register(); " + code
        out = subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.PIPE, text=True).stdout
        self.assertEqual(out, f"{sorted(NAMES)} False\n")

    def test_the_checker_has_nothing_to_say(self):
        import rubble.envs  # noqa: F401
        for name in NAMES:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                check_env(make(name, render_mode="rgb_array").unwrapped)

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
