"""Missions as objects: they say what the same mission in Lua says, and a run of them gives the same dataset."""
import copy
import json
import os
import pickle
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import rubble
from rubble import missions as m

BUNDLED = ["small.lua", "demo.lua", "lidar.lua", "robots/readings.lua"]


def scenario(text):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mission.lua")
        with open(path, "w") as file:
            file.write(text)
        return json.loads(rubble._core.check_mission(path))


class Text(unittest.TestCase):
    def test_bundled_missions_stay_what_they_are(self):
        for name in BUNDLED:
            script = os.path.join("scripts", name)
            with self.subTest(name):
                whole, loaded = json.loads(rubble._core.check_mission(script)), rubble.Mission.load(script)
                if any(robot.get("control") for robot in whole.get("robots", [])):
                    # Functions are in no text.
                    self.assertRaisesRegex(rubble.InputError, r"control: the script registers no function", loaded.check)
                else:
                    self.assertEqual(loaded.check(), whole)

    def test_objects_say_what_lua_says(self):
        mission = rubble.Mission(
            seed=4, wetness=0.25,
            pile=m.Pile(layers=2, pieces_per_layer=np.int64(5), spawn_position=np.array([0, 0, 2.5]),
                        mix=[m.Mix(asset="slab_1", weight=2), m.Mix(asset="brick", scale=[0.9, 1.1])]),
            cameras={"front": m.Camera(width=320, height=240, position=(0.1, 0, 0)), "end": m.Camera()},
            imu=True, outputs=m.Outputs(bag=True, frames=False))
        lua = """return rubble.mission { seed = 4, wetness = 0.25,
          pile = { layers = 2, pieces_per_layer = 5, spawn_position = { 0, 0, 2.5 },
                   mix = { { asset = "slab_1", weight = 2 }, { asset = "brick", scale = { 0.9, 1.1 } } } },
          cameras = { front = { width = 320, height = 240, position = { 0.1, 0, 0 } }, ["end"] = {} },
          imu = true, outputs = { bag = true, frames = false } }"""
        self.assertEqual(mission.check(), scenario(lua))
        self.assertNotEqual(mission.check(["pile.layers=3"]), scenario(lua))
        self.assertEqual(rubble.Mission.from_dict(mission.check()).check(), scenario(lua))

    def test_texts_are_escaped(self):
        for text in ('"quoted"', "back\\slash", "two\nlines", "ü", "zero\0zero"):
            line = rubble.Mission(packs=[text]).to_lua()
            self.assertIn("packs", line)
            self.assertNotIn("\n", line.split("packs", 1)[1].strip("\n"))
        self.assertIn('"a\\0001"', rubble.Mission(packs=["a\x001"]).to_lua())  # not the one character \01
        with self.assertRaisesRegex(rubble.InputError, "a string with a zero byte"):
            rubble.Mission(packs=["a\x001"]).check()
        self.assertIn('["a b"] = 1', m.Robot(efforts={"a b": 1.0}).given() and rubble.Mission(robots=[m.Robot(efforts={"a b": 1})]).to_lua())

    def test_misspelt_attributes_are_refused(self):
        pile, mission = m.Pile(layers=1), rubble.Mission(seed=3)
        with self.assertRaisesRegex(AttributeError, "Pile has no key `peices_per_layer`; did you mean `pieces_per_layer`?"):
            pile.peices_per_layer = 9
        with self.assertRaisesRegex(AttributeError, "Mission has no key `seeed`; did you mean `seed`?"):
            mission.seeed = 5
        pile.pieces_per_layer, mission.pile = 9, pile
        for same in (copy.copy(mission), copy.deepcopy(mission), pickle.loads(pickle.dumps(mission))):
            self.assertEqual(same, mission)
            self.assertEqual(same.check()["pile"]["pieces_per_layer"], 9)

    def test_loaded_missions_keep_the_seed_of_their_random_numbers(self):
        drew = rubble.Mission.load('local r = rubble.random("x")\nreturn rubble.mission { seed = 3, pile = { layers = 0, placed = { '
                                   "{ box = { 1, 1, 1 }, position = { r:uniform(), 0, 0.5 } } } } }")
        with tempfile.TemporaryDirectory() as folder:
            for call in (lambda: rubble.settle(drew, 4), lambda: rubble.settle(copy.copy(drew), None, ["seed=4"]),
                         lambda: rubble.run(drew, folder, seed=4), lambda: rubble.batch(drew, "1..3", folder),
                         lambda: rubble.batch(drew, [3, 4], folder)):
                with self.assertRaisesRegex(rubble.InputError, "seed: the script of this mission drew random numbers.*expected 3"):
                    call()
        self.assertEqual(rubble.settle(drew, 3).state_hash, rubble.settle(drew).state_hash)
        rubble.settle(rubble.Mission.load("return rubble.mission { seed = 3, pile = { layers = 0 } }"), 4)

    def test_loaded_missions_have_no_idle_defaults(self):
        program = ("import rubble\nfor name in ('small.lua', 'lidar.lua'):\n    loaded = rubble.Mission.load('scripts/' + name)\n"
                   "    print('again'), loaded.check(), rubble.Mission.from_dict(loaded.check()).check()\n")
        ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        self.assertNotIn("has no effect", ran.stderr)

    def test_mistakes_name_their_key(self):
        with self.assertRaises(TypeError):
            m.Pile(layer=3)
        with self.assertRaises(rubble.InputError) as caught:
            rubble.Mission.from_dict({"pile": {"layer": 3}})
        self.assertEqual(caught.exception.key, "layer")
        for wrong, key in ((m.Pile(layers=float("nan")), "pile.layers"), (m.Pile(layers=object()), "pile.layers"),
                           (m.Pile(mix=[m.Mix(weight=float("inf"))]), "pile.mix[1].weight")):
            with self.assertRaises(rubble.InputError) as caught:
                rubble.Mission(pile=wrong).to_lua()
            self.assertEqual(caught.exception.key, key)
        with self.assertRaises(rubble.InputError) as caught:
            rubble.Mission(pile=m.Pile(layers=-1)).check()
        self.assertEqual(caught.exception.key, "pile.layers")


class Run(unittest.TestCase):
    MISSION = "return rubble.mission { seed = 3, pile = { layers = 1, pieces_per_layer = 4 }, outputs = { bag = false, frames = false } }"

    def test_the_same_dataset_comes_out(self):
        made = rubble.Mission(seed=3, pile=m.Pile(layers=1, pieces_per_layer=4), outputs=m.Outputs(bag=False, frames=False))
        with tempfile.TemporaryDirectory() as folder:
            lua = rubble.run(self.MISSION, os.path.join(folder, "lua"), settle=True)
            python = rubble.run(made, os.path.join(folder, "python"), settle=True)
            again = rubble.run(rubble.Mission.load(self.MISSION), os.path.join(folder, "again"), settle=True)
            other = rubble.run(made, os.path.join(folder, "other"), seed=4, settle=True)
        for manifest in (python, again):
            for part in ("outputs", "metrics", "pile", "seed"):
                self.assertEqual(manifest[part], lua[part], part)
        self.assertNotEqual(other["pile"], lua["pile"])
        self.assertEqual(rubble.settle(made).state_hash, rubble.settle(self.MISSION).state_hash)

    def test_what_the_program_refuses_is_an_input_error(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(rubble.InputError, "pile.layers"):
            rubble.run(rubble.Mission(pile=m.Pile(layers=-1)), os.path.join(folder, "out"))


if __name__ == "__main__":
    unittest.main()
