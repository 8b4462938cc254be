"""Many environments in one process: each as it is alone, on any number of threads; piles in common; ends and mistakes."""
import os
import sys
import unittest

import numpy as np

import rubble
from rubble.envs import Batch, CrawlerNav, Materials, Randomization, Uniform, VoidExplore

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()

KINDS = {CrawlerNav: {"rays": 16, "pile_seeds": [1, 2], "max_steps": 3}, VoidExplore: {"size": 16, "pile_seeds": [1, 2], "max_steps": 3}}
FRICTION = Randomization(materials=Materials(friction=Uniform(0.3, 0.9)))


class Batches(unittest.TestCase):
    def play(self, env, steps=7):
        observations, infos = env.reset(seed=5)
        told = [(observations, None, None, None, infos)]
        for k in range(steps):
            told.append(env.step(np.full((env.num_envs, 4), 0.8 - 0.2 * k, np.float32)))
        return told

    def test_each_environment_is_as_it_is_alone(self):
        for kind, options in KINDS.items():
            batch = Batch(lambda: kind(**options), 5, threads=2)
            told = self.play(batch)
            self.assertEqual(told[0][0][sorted(told[0][0])[0]].shape[0], 5)
            for i in range(5):
                env = kind(**options)
                observation, info = env.reset(seed=5 + i)
                ended = False
                for k, (observations, rewards, terminated, truncated, infos) in enumerate(told):
                    if k > 0 and ended:  # the next episode begins
                        observation, info = env.reset()
                        answer, ended = (0.0, False, False), False
                    elif k > 0:
                        observation, *answer, info = env.step(np.full(4, 0.8 - 0.2 * (k - 1), np.float32))
                        ended = answer[1] or answer[2]
                    for name, values in observations.items():
                        np.testing.assert_array_equal(values[i], observation[name], f"{kind.__name__} {i} {k} {name}")
                    if k > 0:
                        self.assertEqual((rewards[i], terminated[i], truncated[i]), tuple(answer))
                    for key, value in info.items():
                        self.assertEqual((infos[key][i], infos["_" + key][i]), (value, True))
            batch.close()
            batch.close()

    def test_threads_change_nothing(self):
        one, three = (self.play(Batch(lambda: CrawlerNav(randomization=FRICTION, **KINDS[CrawlerNav]), 4, threads)) for threads in (1, 3))
        for a, b in zip(one, three):
            for name in a[0]:
                np.testing.assert_array_equal(a[0][name], b[0][name])
        drawn = one[0][4]["randomization"]["materials.friction"]
        self.assertEqual(len(set(drawn)), 4)
        np.testing.assert_array_equal(drawn, three[0][4]["randomization"]["materials.friction"])

    def test_environments_have_their_piles_in_common(self):
        batch = Batch(lambda: CrawlerNav(**{**KINDS[CrawlerNav], "pile_seeds": [1]}), 3)
        batch.reset(seed=1)
        self.assertEqual(len({id(env._pile) for env in batch.envs}), 1)

    def test_spaces_hold_what_is_given(self):
        batch = Batch(lambda: VoidExplore(**KINDS[VoidExplore]), 2)
        self.assertEqual(batch.action_space.shape, (2, 4))
        observations, _ = batch.reset(seed=[3, 4])
        self.assertTrue(batch.observation_space.contains(observations))
        batch.step(batch.action_space.sample())
        self.assertEqual(batch.render(), (None, None))

    def test_seeds_may_be_of_numpy(self):
        batch = Batch(lambda: CrawlerNav(**KINDS[CrawlerNav]), 2)
        first = batch.reset(seed=3)[0]
        for seed in (np.int64(3), np.array(3), np.array([3, 4]), [np.int32(3), 4], range(3, 5), iter([3, 4])):
            np.testing.assert_array_equal(first["goal"], batch.reset(seed=seed)[0]["goal"])
        batch.reset(seed=[None, 4])
        for seed in (-1, 1.5, "34", [3, -1], np.array([3.0, 4.0]), [3, True]):
            with self.assertRaises(rubble.InputError, msg=repr(seed)) as raised:
                batch.reset(seed=seed)
            self.assertEqual(raised.exception.key, "seed")

    def test_mistakes_are_named(self):
        make = lambda: CrawlerNav(**KINDS[CrawlerNav])
        batch = Batch(make, 2)
        with self.assertRaises(RuntimeError):
            batch.step(np.zeros((2, 4)))
        batch.reset(seed=1)
        for call, key in ((lambda: Batch(make, 0), "count"), (lambda: Batch(make, 2.0), "count"),
                          (lambda: Batch(make, 2, 0), "threads"),
                          (lambda: batch.reset(seed=[1]), "seed"), (lambda: batch.step(np.zeros(4)), "action"),
                          (lambda: batch.step(np.full((2, 4), 3.0)), "action"),
                          (lambda: Batch(lambda: CrawlerNav(randomization=3), 2), "randomization")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)


if __name__ == "__main__":
    unittest.main()
