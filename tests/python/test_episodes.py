"""Episodes of environments as a LeRobot dataset: what is in its tables, that it repeats, what is refused."""
import hashlib
import json
import os
import sys
import tempfile
import unittest

import numpy as np

import rubble
from rubble.envs import Calibration, CrawlerNav, LerobotRecorder, Poses, Randomization, Uniform, VoidExplore

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from shared_piles import share_piles

share_piles()


def record(path, env, seeds, steps):
    """Plays an episode of each seed; what was seen, done and given, by row."""
    rows = []
    with LerobotRecorder(env, path) as env:
        for seed in seeds:
            env.action_space.seed(seed)
            observation, _ = env.reset(seed=seed)
            for _ in range(steps):
                action = env.action_space.sample()
                rows.append([observation, action])
                observation, reward, terminated, truncated, _ = env.step(action)
                rows[-1].append(reward)
                if terminated or truncated:
                    break
    return rows


def read(path, name):
    with open(os.path.join(path, name), "rb") as file:
        return file.read()


def hash_of(path):
    files = sorted(os.path.join(folder, name) for folder, _, names in os.walk(path) for name in names)
    return [(os.path.relpath(name, path), hashlib.sha256(read("", name)).hexdigest()) for name in files]


class Episodes(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self._folder.name, "episodes")

    def tearDown(self):
        self._folder.cleanup()

    def test_tables_have_what_was_seen_and_done(self):
        random = Randomization(calibration=Calibration(dropout=Uniform(0, 0.2)), poses=Poses(yaw_deg=5))
        rows = record(self.path, VoidExplore(pile_seeds=[1], size=16, max_steps=3, randomization=random), [4, 5], 10)
        self.assertEqual(len(rows), 6)
        info = json.loads(read(self.path, "meta/info.json"))
        self.assertEqual((info["total_episodes"], info["total_frames"], info["fps"], info["robot_type"]), (2, 6, 5, "VoidExplore"))
        self.assertEqual(info["features"]["observation.state"]["names"],
                         ["clearance.0", "pose.forwards", "pose.left", "pose.up", "pose.yaw"])
        self.assertEqual(info["features"]["observation.images.depth"]["shape"], [16, 16, 3])
        self.assertEqual(info["features"]["action"]["names"][3], "action.turning_to_the_left")
        table = read(self.path, "data/chunk-000/file-000.parquet")
        for observation, action, reward in rows:  # float32, one after another
            self.assertIn(np.concatenate([observation["clearance"], observation["pose"]]).astype("<f4").tobytes(), table)
            self.assertIn(action.astype("<f4").tobytes(), table)
        self.assertIn(np.array([row[2] for row in rows], "<f4").tobytes(), table)
        episodes = read(self.path, "meta/episodes/chunk-000/file-000.parquet").decode("latin1")
        for seed in (4, 5):
            self.assertRegex(episodes, f'"randomization": {{"calibration.dropout": 0.[0-9]+, "poses.yaw_deg": 5}}.*"seed": {seed}, "terminated": false, "truncated": true')
        self.assertIn("explore a void of the pile", read(self.path, "meta/tasks.parquet").decode("latin1"))

    def test_the_same_seeds_give_the_same_bytes(self):
        hashes = []
        for name, seeds in (("a", [1, 2]), ("b", [1, 2]), ("c", [1, 3])):
            record(self.path + name, CrawlerNav(pile_seeds=[1], rays=16), seeds, 3)
            hashes.append(hash_of(self.path + name))
        self.assertEqual(hashes[0], hashes[1])
        self.assertNotEqual(hashes[0], hashes[2])

    def test_an_episode_that_reset_ends_is_kept(self):
        rows = record(self.path, CrawlerNav(pile_seeds=[1], rays=16), [1, 2, 3], 2)
        info = json.loads(read(self.path, "meta/info.json"))
        self.assertEqual((info["total_episodes"], info["total_frames"], len(rows)), (3, 6, 6))

    def test_nothing_is_recorded_without_reset_or_after_close(self):
        env = LerobotRecorder(VoidExplore(pile_seeds=[1], size=16, max_steps=2), self.path)
        with self.assertRaisesRegex(RuntimeError, "reset"):
            env.step([0, 0, 0, 0])
        env.reset(seed=np.int64(1))
        for _ in range(2):
            ended = env.step([0, 0, 0, 0])[3]
        self.assertTrue(ended)
        with self.assertRaisesRegex(RuntimeError, "reset"):
            env.step([0, 0, 0, 0])
        env.reset(seed=2)
        env.step([0, 0, 0, 0])
        with self.assertRaises(rubble.InputError):
            env.reset(seed=-1)
        env.step([0, 0, 0, 0])  # the episode goes on
        env.close()
        for call in (lambda: env.step([0, 0, 0, 0]), env.reset):
            with self.assertRaisesRegex(RuntimeError, "close"):
                call()
        info = json.loads(read(self.path, "meta/info.json"))
        self.assertEqual((info["total_episodes"], info["total_frames"]), (2, 4))

    def test_the_rate_is_that_of_the_steps(self):
        record(self.path, CrawlerNav(pile_seeds=[1], rays=16, period=0.01), [1], 2)  # of 2/240 s
        self.assertEqual(json.loads(read(self.path, "meta/info.json"))["fps"], 120)

    def test_mistakes_are_named(self):
        with self.assertRaisesRegex(rubble.InputError, "depth of shape .16, 16.; make the environment without metres"):
            LerobotRecorder(VoidExplore(pile_seeds=[1], size=16, metres=True), self.path)
        with self.assertRaisesRegex(rubble.RunError, "no episode was recorded"):
            LerobotRecorder(CrawlerNav(pile_seeds=[1], rays=16), self.path).close()
        self.assertFalse(os.path.exists(self.path))
        os.mkdir(self.path)
        with self.assertRaisesRegex(rubble.RunError, "episodes"):
            LerobotRecorder(CrawlerNav(pile_seeds=[1], rays=16), self.path)
        with self.assertRaisesRegex(ValueError, "mine"), LerobotRecorder(CrawlerNav(pile_seeds=[1], rays=16), self.path + "2"):
            raise ValueError("mine")


if __name__ == "__main__":
    unittest.main()
