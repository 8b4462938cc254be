"""Piles against closed forms and against the program."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import numpy as np

import rubble

BOX = """return rubble.mission {
  pile = { layers = 0, placed = { { box = { 2, 4, 1 }, position = { 1, 0, 0.5 } } } },
}"""


def script(text):
    file = tempfile.NamedTemporaryFile("w", suffix=".lua", delete=False)
    with file:
        file.write(text)
    return file.name


class PileOfABox(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.path = script(BOX)
        cls.pile = rubble.settle(cls.path, threads=2)

    @classmethod
    def tearDownClass(cls):
        os.remove(cls.path)

    def test_rays_meet_its_faces_and_the_ground(self):
        hits = self.pile.cast_rays([[-3, 0.5, 0.5], [1, 0, 5], [-3, 0, 2], [-3, 0, 2]],
                                   [[1, 0, 0], [0, 0, -2], [-1, 0, -1], [0, 0, 1]])
        # Cast faces of concrete are rough by a millimetre; the ground is even.
        np.testing.assert_allclose(hits["distance"][:2], [3, 4], atol=2e-3)
        np.testing.assert_allclose(hits["distance"][2], 2 * np.sqrt(2), atol=1e-9)
        self.assertEqual(hits["distance"][3], np.inf)
        self.assertEqual(hits["piece"].tolist(), [0, 0, -1, -2])
        np.testing.assert_allclose(hits["normal"][:2], [[-1, 0, 0], [0, 0, 1]], atol=0.1)

    def test_rays_meet_the_triangles_of_the_mesh(self):
        vertices, triangles = self.pile.mesh()
        a, b, c = (vertices[triangles[:, k]].astype(float) for k in range(3))
        chance = np.random.default_rng(1)
        origins = chance.uniform(-1, 1, (200, 3)) + [-3, 0, 2.5]
        directions = chance.uniform(-0.8, 0.8, (200, 3)) + [1, 0, 0.5] - origins
        hits = self.pile.cast_rays(origins, directions)
        met = 0
        for origin, direction, distance, piece in zip(origins, directions, hits["distance"], hits["piece"]):
            direction = direction / np.linalg.norm(direction)
            p = np.cross(direction, c - a)
            det = np.einsum("ij,ij->i", b - a, p)
            with np.errstate(divide="ignore", invalid="ignore"):
                u = np.einsum("ij,ij->i", origin - a, p) / det
                q = np.cross(origin - a, b - a)
                v, t = q @ direction / det, np.einsum("ij,ij->i", c - a, q) / det
            inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
            if piece == 0:
                met += 1
                self.assertAlmostEqual(t[inside].min(), distance, places=5)
        self.assertGreater(met, 150)

    def test_clearance_is_the_distance(self):
        points = [[-1, 0, 3], [1, 0, 2.5], [1, 0, 0.5], [-1, 3, 2]]
        np.testing.assert_allclose(self.pile.clearance(points), [np.sqrt(5), 1.5, 0, np.sqrt(3)], atol=8e-3)  # corners are rounded

    def test_mesh_and_poses(self):
        vertices, triangles = self.pile.mesh()
        np.testing.assert_allclose(vertices.min(axis=0), [0, -2, 0], atol=2e-3)
        np.testing.assert_allclose(vertices.max(axis=0), [2, 2, 1], atol=2e-3)
        self.assertLess(triangles.max(), len(vertices))
        self.assertEqual(self.pile.poses.shape, (len(self.pile), 7))

    def test_mistakes_name_file_line_and_key(self):
        path = script("return rubble.mission {\n  pile = { layer = 3 },\n}")
        with self.assertRaises(rubble.InputError) as raised:
            rubble.settle(path)
        self.assertEqual((raised.exception.file, raised.exception.line, raised.exception.key), (path, 2, "pile.layer"))
        self.assertIn("layers", raised.exception.diagnostics[0]["hint"])
        os.remove(path)

    def test_wrong_arrays_are_named(self):
        for call, key in ((lambda: self.pile.clearance([[1, 2]]), "points"),
                          (lambda: self.pile.clearance([[np.nan, 0, 0]]), "points"),
                          (lambda: self.pile.cast_rays([[0, 0, 0]], [[0, 0, 0]]), "directions"),
                          (lambda: self.pile.cast_rays(np.zeros((3, 3)), np.ones((2, 3))), "origins"),
                          (lambda: self.pile.cast_rays([[0, 0, 1]], [[0, 0, 1e300]]), "directions"),
                          (lambda: self.pile.cast_rays([[0, 0, 1]], [[0, 0, 1]], np.nan), "max_distance"),
                          (lambda: self.pile.cast_rays([[0, 0, 1]], [[0, 0, 1]], -1), "max_distance")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)

    def test_paths_are_text_bytes_or_objects(self):
        for path in (pathlib.Path(self.path), os.fsencode(self.path)):
            self.assertEqual(rubble.settle(path, threads=1).state_hash, self.pile.state_hash)
            self.assertEqual(rubble.Mission.load(path).check(), rubble.Mission.load(self.path).check())
            rubble._core.check_mission(path)
        self.assertEqual(rubble.settle(BOX.replace("\n", " ").encode(), threads=1).state_hash, self.pile.state_hash)
        with tempfile.TemporaryDirectory() as folder:
            for name, kind in (("a", pathlib.Path), ("b", os.fsencode)):
                out = os.path.join(folder, name)
                rubble.run(kind(self.path), kind(out), assets=[], settle=True)
                for given in (out, kind(out)):
                    self.assertEqual(rubble.open_pile(given, assets=[kind(folder)][:0]).state_hash, self.pile.state_hash)
            try:
                rubble.set_sandbox(pathlib.Path(folder))
            finally:
                rubble.set_sandbox(None)
        for call, key in ((lambda: rubble.settle(7), "mission"), (lambda: rubble.open_pile(7), "folder"),
                          (lambda: rubble.open_pile("a\0b"), "folder"), (lambda: rubble.run(self.path, 7), "out")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)

    def test_seeds_and_threads_are_refused_with_what_was_given(self):
        for seed in (2**63, 2**64 - 1, 2**64, -1, 1.5, "x"):
            for call in (lambda: rubble.settle(self.path, seed=seed), lambda: rubble._core.check_mission(self.path, seed)):
                with self.assertRaises(rubble.InputError) as raised:
                    call()
                self.assertEqual(raised.exception.key, "seed")
                self.assertIn(f"from 0 to 9223372036854775807, found {seed!r}", str(raised.exception))
        self.assertEqual(rubble.settle(self.path, seed=2**63 - 1, threads=1).seed, 2**63 - 1)
        for threads in (-1, 257, 2**40, 1.5):
            for call in (lambda: rubble.settle(self.path, threads=threads), lambda: rubble.open_pile("none", threads),
                         lambda: rubble.run(self.path, "none", threads=threads),
                         lambda: rubble.batch(self.path, [1], "none", threads=threads)):
                with self.assertRaises(rubble.InputError) as raised:
                    call()
                self.assertEqual(raised.exception.key, "threads")
                self.assertIn(f"from 0 to 256, found {threads!r}", str(raised.exception))

    def test_one_text_is_no_list(self):
        one = "pile.layers=1"
        for call, key in ((lambda: rubble.settle(self.path, overrides=one), "overrides"),
                          (lambda: self.pile.vary("light.type=sun"), "overrides"),
                          (lambda: rubble.Mission().check(one), "overrides"),
                          (lambda: rubble.Mission.load(self.path, one), "overrides"),
                          (lambda: rubble.run(self.path, "none", overrides=one), "overrides"),
                          (lambda: rubble.run(self.path, "none", assets="packs"), "assets"),
                          (lambda: rubble.open_pile("none", assets="packs"), "assets"),
                          (lambda: rubble.batch(self.path, [1], "none", overrides=one), "overrides"),
                          (lambda: rubble.batch(self.path, [1], "none", vary="wetness=0,1"), "vary"),
                          (lambda: rubble.batch(self.path, [1], "none", assets=b"packs"), "assets")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual((raised.exception.key, len(raised.exception.diagnostics)), (key, 1))
            self.assertIn("put it in a list: [", raised.exception.diagnostics[0]["hint"])
        with self.assertRaises(rubble.InputError) as raised:
            rubble.settle(self.path, overrides={"wetness": 0})  # its keys alone would be taken
        self.assertEqual(raised.exception.key, "overrides")
        self.assertIn("each key with its value", raised.exception.diagnostics[0]["hint"])
        with self.assertRaises(rubble.InputError) as raised:
            rubble.settle(self.path, overrides=[1])
        self.assertEqual(raised.exception.key, "overrides")
        rubble.settle(self.path, overrides=(text for text in ["wetness=0"]), threads=1)


class SettledPile(unittest.TestCase):
    def test_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "out")
            subprocess.run([os.environ["RUBBLE_PROGRAM"], "settle", "scripts/small.lua", "--quiet", "--out", out],
                           check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(out, "manifest.json"), encoding="utf-8") as file:
                wanted = re.search(r'"state_hash": *"([0-9a-f]{16})"', file.read()).group(1)
            for pile in (rubble.settle("scripts/small.lua", threads=1), rubble.open_pile(out)):
                self.assertEqual(f"{pile.state_hash:016x}", wanted)
        other = rubble.settle("scripts/small.lua", seed=99)
        self.assertNotEqual(f"{other.state_hash:016x}", wanted)

    def test_voids_of_a_pipe(self):
        path = script("""return rubble.mission { pile = { layers = 0, placed = {
          { box = { 4, 0.2, 1 }, position = { 0, -0.6, 0.5 } }, { box = { 4, 0.2, 1 }, position = { 0, 0.6, 0.5 } },
          { box = { 4, 1.4, 0.2 }, position = { 0, 0, 1.1 } } } } }""")
        voids = rubble.settle(path).voids(radius=0.3, voxel=0.05)
        os.remove(path)
        self.assertEqual(len(voids), 1)
        self.assertEqual(len(voids[0]["entrances"]), 2)
        self.assertLess(abs(voids[0]["widest_radius"] - 0.5), 0.06)
        self.assertGreater(voids[0]["volume"], 2)
        self.assertEqual(voids[0]["cells"].shape[1], 3)


class PileWithFines(unittest.TestCase):
    def test_it_is_that_of_the_program(self):
        amount = "fines.amount=400"
        bare = rubble.settle("scripts/fines.lua", overrides=["fines.amount=0"])
        strewn = rubble.settle("scripts/fines.lua", overrides=[amount], threads=2)
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "out")
            subprocess.run([os.environ["RUBBLE_PROGRAM"], "settle", "scripts/fines.lua", "--set", amount, "--quiet",
                            "--out", out], check=True)
            kept = rubble.open_pile(out)
        self.assertEqual(bare.state_hash, strewn.state_hash)
        for vertices, of_run in zip(strewn.mesh(), kept.mesh()):
            np.testing.assert_array_equal(vertices, of_run)
        self.assertGreater(len(strewn.mesh()[0]), len(bare.mesh()[0]) + 400)
        points = np.random.default_rng(1).uniform([-1.5, -1.2, 0.02], [1.5, 1.2, 0.3], (500, 3))
        nearer = strewn.clearance(points) < bare.clearance(points) - 1e-3
        self.assertGreater(nearer.sum(), 5)


class OwnTerrain(unittest.TestCase):
    def test_a_run_is_opened_with_its_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "ramp.obj"), "w", encoding="utf-8") as file:
                file.write("v -2 -2 0.5\nv 2 -2 0.5\nv 2 2 0.5\nv -2 2 0.5\nf 1 2 3\nf 1 3 4\n")
            mission, out = os.path.join(folder, "m.lua"), os.path.join(folder, "out")
            with open(mission, "w", encoding="utf-8") as file:
                file.write("return rubble.mission { pile = { layers = 0, terrain = { file = 'ramp.obj' } } }")
            subprocess.run([os.environ["RUBBLE_PROGRAM"], "settle", mission, "--quiet", "--out", out], check=True)
            down = rubble.open_pile(out).cast_rays([[0.3, 0.1, 3]], [[0, 0, -1]])["distance"]
            os.mkdir(os.path.join(folder, "moved"))
            os.rename(os.path.join(folder, "ramp.obj"), os.path.join(folder, "moved", "ramp.obj"))
            with self.assertRaises(rubble.InputError) as raised:
                rubble.open_pile(out)
            self.assertIn("`assets` in Python", str(raised.exception))
            again = rubble.open_pile(out, assets=[os.path.join(folder, "moved")]).cast_rays([[0.3, 0.1, 3]], [[0, 0, -1]])["distance"]
            self.assertEqual(down[0], again[0])
        self.assertAlmostEqual(down[0], 2.5, places=6)


class Sandbox(unittest.TestCase):
    def test_holds_what_missions_read(self):
        with tempfile.TemporaryDirectory() as root:
            inside, outside = os.path.join(root, "in"), os.path.join(root, "out")
            for folder in (inside, outside):
                os.mkdir(folder)
            with open(os.path.join(outside, "block.obj"), "w") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
            mission = os.path.join(inside, "m.lua")
            with open(mission, "w") as file:
                file.write("return rubble.mission { pile = { layers = 0,\nterrain = { file = '../out/block.obj' } } }")
            self.assertEqual(len(rubble.settle(mission, threads=1)), 1)
            try:
                rubble.set_sandbox(inside)
                with self.assertRaises(rubble.InputError) as raised:
                    rubble.settle(mission, threads=1)
                self.assertEqual((raised.exception.line, raised.exception.key), (2, "pile.terrain.file"))
                self.assertIn("lies outside the sandbox", str(raised.exception))
                with self.assertRaises(rubble.InputError):
                    rubble.set_sandbox(os.path.join(root, "none"))
            finally:
                rubble.set_sandbox(None)
            rubble.settle(mission, threads=1)


if __name__ == "__main__":
    unittest.main()
