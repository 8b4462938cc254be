"""The learned agent of examples/search/ppo: it sees in a search what it saw in training, and answers."""
import base64
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rubble

FOLDER = "examples/search/ppo"
sys.path.insert(0, FOLDER)
from senses import ACTIONS, AROUND, CELL, COLUMNS, FAR, ROWS, SIZE, Senses, coarse_depth, policy  # noqa: E402

HIDDEN = 8


def random_weights(seed):
    random = np.random.default_rng(seed)
    sizes = [SIZE, HIDDEN, HIDDEN, len(ACTIONS)]
    weights = {f"w{k}": random.normal(size=(sizes[k], sizes[k + 1])) for k in range(3)}
    return {**weights, **{f"b{k}": random.normal(size=sizes[k + 1]) for k in range(3)}}


def observation(**more):
    picture = base64.b64encode(np.full((60, 80), 1500, "<u2").tobytes()).decode()
    cold = base64.b64encode(np.full((60, 80), 28815, "<u2").tobytes()).decode()
    return {"type": "observation", "time": 0.0, "position": [0, 0, 1], "yaw": 0.0, "stopped": False, "found": 0,
            "reports_left": 8, "depth_mm": picture, "thermal_ck": cold, **more}


class SensesTest(unittest.TestCase):
    def test_depth_is_the_same_in_search_and_training(self):
        pile = rubble.settle("scripts/small.lua", seed=1)
        eye = rubble.look_at([-3, 0.2, 0.6], [0, 0, 0.3])
        fine = rubble.DepthCamera(pile, 80, 60, max_range=FAR).depth(eye)
        square = rubble.DepthCamera(pile, COLUMNS, COLUMNS, max_range=FAR).depth(eye)
        margin = (COLUMNS - ROWS) // 2
        there = coarse_depth(fine)
        self.assertEqual(there.shape, (ROWS, COLUMNS))
        np.testing.assert_allclose(there, square[margin:-margin], atol=1e-3)
        self.assertGreater(np.unique(there).size, 20)

    def test_visits_turn_with_the_body(self):
        blank, middle = np.zeros((ROWS, COLUMNS)), AROUND // 2
        senses = Senses()
        for x in (0.25, 0.25 + CELL, 0.25 + 2 * CELL):
            senses.encode(blank, (x, 0.25, 0), 0, False)
        def visits(yaw):
            seen = senses.encode(blank, (0.25 + 2 * CELL, 0.25, 0.5), yaw, True)
            return seen[ROWS * COLUMNS:-2].reshape(AROUND, AROUND), seen[-2:]
        behind, rest = visits(0.0)
        self.assertTrue((behind[[middle - 1, middle - 2], middle] > 0).all())
        self.assertEqual(behind[middle + 1, middle], 0)
        left, _ = visits(np.pi / 2)
        self.assertTrue((left[middle, [middle + 1, middle + 2]] > 0).all())
        np.testing.assert_allclose(rest, [0.5, 1])

    def test_policy_is_that_of_the_equations(self):
        weights = {f"{name}{k}": np.zeros(1) for k in range(3) for name in "wb"}
        for k, sizes in enumerate([(2, 1), (1, 1), (1, 2)]):
            weights[f"w{k}"], weights[f"b{k}"] = np.ones(sizes), np.zeros(sizes[1])
        np.testing.assert_allclose(policy(weights, np.array([0.2, 0.1])), np.tanh(np.tanh(0.3)) * np.ones(2))


class AgentTest(unittest.TestCase):
    def talk(self, weights_seed, lines):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "weights.npz")
            np.savez(path, **random_weights(weights_seed))
            start = {"type": "start", "version": 1, "seed": 3, "speed": 0.5, "turn_rate": 1.0,
                     "camera": {"width": 80, "height": 60, "fx": 40.0, "fy": 40.0, "cx": 39.5, "cy": 29.5}}
            text = "".join(json.dumps(line) + "\n" for line in [start, *lines, {"type": "end"}])
            ran = subprocess.run(["/usr/bin/python3", f"{FOLDER}/agent.py", path], input=text, capture_output=True,
                                 text=True, check=True)
        return [json.loads(line) for line in ran.stdout.splitlines()]

    def test_it_answers_each_observation_and_repeats_itself(self):
        answers = self.talk(1, [observation()] * 20)
        self.assertEqual(len(answers), 20)
        self.assertEqual(answers, self.talk(1, [observation()] * 20))
        self.assertNotEqual(answers, self.talk(2, [observation()] * 20))
        for answer in answers:
            self.assertLessEqual(max(map(abs, answer["velocity"])), 0.5)
            self.assertNotIn("report", answer)

    def test_what_is_warm_is_reported_once_and_where_it_is(self):
        kelvin = np.full((60, 80), 28815, "<u2")
        kelvin[25:35, 35:45] = 30100
        warm = observation(thermal_ck=base64.b64encode(kelvin.tobytes()).decode(), yaw=np.pi / 2)
        answers = self.talk(1, [warm, warm])
        np.testing.assert_allclose(answers[0]["report"], [[0, 1.5, 1]], atol=0.03)
        self.assertNotIn("report", answers[1])


# Only where it is asked for: it needs PyTorch.
class TrainingTest(unittest.TestCase):
    def test_it_sees_more_of_the_void_than_at_first(self):
        with tempfile.TemporaryDirectory() as folder:
            weights, curve = os.path.join(folder, "weights.npz"), os.path.join(folder, "curve.csv")
            subprocess.run(["/usr/bin/python3", f"{FOLDER}/train.py", "scripts/search.lua", weights, "--steps", "200000",
                            "--piles", "101..104", "--curve", curve], check=True)
            with open(curve) as file:
                rows = list(csv.DictReader(file))
            # The same episodes before and after: what episodes of training see varies by a sixth from seed to seed.
            self.assertEqual(rows[0]["steps"], "0")
            self.assertEqual(rows[-1]["episodes"], rows[0]["episodes"])
            self.assertGreater(float(rows[-1]["coverage"]), 1.3 * float(rows[0]["coverage"]))
            self.assertEqual(np.load(weights)["w0"].shape[0], SIZE)


if __name__ == "__main__":
    unittest.main()
