"""Arrays of the module with any numpy: their strides, their values, and arithmetic that no build of numpy changes."""
import glob
import os
import re
import tempfile
import unittest

import numpy as np

import rubble
from rubble import _core

ROOT = os.path.join(os.path.dirname(__file__), "..", "..")
ROOM = """return rubble.mission { pile = { layers = 0, placed = {
  { box = { 0.2, 6, 3 }, position = { 3.1, 0, 1.5 } }, { box = { 1, 1, 1 }, position = { 0, 4, 0.5 } } } } }"""


def read(path):
    with open(path) as file:
        return file.read()


def arrays_in(value):
    """All arrays in what the module gave."""
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, dict):
        for member in value.values():
            yield from arrays_in(member)
    elif isinstance(value, (list, tuple)):
        for member in value:
            yield from arrays_in(member)


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        file = tempfile.NamedTemporaryFile("w", suffix=".lua", delete=False)
        with file:
            file.write(ROOM)
        cls.pile = rubble.settle(file.name, threads=1)
        os.remove(file.name)

    def check(self, value):
        """Every array has the strides of its shape, and not one element in all places."""
        found = list(arrays_in(value))
        self.assertTrue(found)
        for array in found:
            expected = np.empty(array.shape, array.dtype).strides
            self.assertEqual(array.strides, expected, f"of shape {array.shape}")
            self.assertEqual(array.nbytes, array.size * array.dtype.itemsize)

    def test_have_their_strides(self):
        pile = self.pile
        camera = rubble.DepthCamera(pile, 24, 16)
        eye = rubble.look_at([-1, 0.5, 2], [3, 0, 1])
        robot = rubble.RobotWorld(pile, "crawler", rubble.pose([0, 0, 0.005]), threads=1)
        for value in (pile.poses, pile.mesh(), pile.clearance([[0, 0, 1], [0, 1, 1]]), camera.K, camera.depth(eye), eye,
                      pile.cast_rays([[0, 0, 1]], [[1, 0, 0], [0, 1, 0]]), robot.state(), robot.step(0.02),
                      rubble.Lidar(pile, "utm30lx").scan(eye), rubble.compose(eye, eye), rubble.rotate(eye, [[1, 0, 0]]),
                      rubble.rotate(eye, [1, 0, 0]), _core._directions([0, 1]), _core._lengths([[1, 2], [3, 4]]),
                      pile.voids(0.2, 0.2)):
            if not isinstance(value, list) or value:
                self.check(value)

    def test_that_would_lose_a_part_are_refused(self):
        down = [[0, 0, -1], [0, 0, -1]]
        points = np.array([[0, 0, 1.0], [0, 1, 1]])
        plain = self.pile.clearance(points)
        for same in (np.ma.masked_array(points), points.astype(">f8"), points.astype("f4"), np.asfortranarray(points), points.tolist()):
            np.testing.assert_array_equal(self.pile.clearance(same), plain)
        for wrong, word in ((np.ma.masked_array(points, mask=points > 0), "mask"), (points + 1j, "complex"), ((points + 1j).tolist(), "complex"),
                            (points.astype("complex64"), "complex")):
            for call in (lambda: self.pile.clearance(wrong), lambda: self.pile.cast_rays(wrong, down), lambda: rubble.rotate([0, 0, 0, 1, 0, 0, 0], wrong)):
                with self.assertRaisesRegex(rubble.InputError, word):
                    call()
        with self.assertRaisesRegex(rubble.InputError, "target: nothing to look at"):
            rubble.look_at([1, 2, 3], [1, 2, 3])
        with self.assertRaisesRegex(rubble.InputError, "expected 1, found 2"):
            self.pile.cast_rays(points, [[0, 0, -1]])
        with self.assertRaisesRegex(rubble.InputError, "expected 3, or 1 for all, found 2"):
            self.pile.cast_rays(points, [[0, 0, -1]] * 3)

    def test_have_their_values(self):
        np.testing.assert_allclose(self.pile.poses, [[3.1, 0, 1.5, 1, 0, 0, 0], [0, 4, 0.5, 1, 0, 0, 0]], atol=1e-12)
        np.testing.assert_array_equal(rubble.pose([1, 2, 3]), [1, 2, 3, 1, 0, 0, 0])
        hits = self.pile.cast_rays([[0, 0, 1.5]], [[1, 0, 0], [0, 0, -1]])
        np.testing.assert_allclose(hits["distance"], [3, 1.5], atol=3e-3)
        np.testing.assert_array_equal(hits["piece"], [0, -1])
        np.testing.assert_allclose(hits["normal"], [[-1, 0, 0], [0, 0, 1]], atol=3e-3)
        np.testing.assert_array_equal(_core._lengths([[3, 4, 0], [0, 0, 2]]), [5, 2])
        state = rubble.RobotWorld(self.pile, "crawler", rubble.pose([0, 0, 0.3]), threads=1).step(0.05)
        self.assertLess(state["linear_velocity"][2], -0.3, "it falls")
        self.assertLess(abs(state["linear_velocity"][0]), 0.01)

    def test_are_made_in_one_place(self):
        """take_vector() alone gives an array its owner, without which numpy reads memory that is gone."""
        made = re.compile(r"\b(nb::ndarray|Array)<[^<>;()]*>\(|new nb::ndarray")
        for path in sorted(glob.glob(os.path.join(ROOT, "python", "*.cpp"))):
            for number, line in enumerate(read(path).splitlines(), 1):
                self.assertFalse(made.search(line), f"{path}:{number}: take_vector() and make_array() make arrays: {line.strip()}")
        for line in ("return Array<double>(p, 1, &n);", "nb::ndarray<nb::numpy, float>(p);"):
            self.assertTrue(made.search(line), "the control")


class Arithmetic(unittest.TestCase):
    def test_of_poses_is_that_of_the_program(self):
        """To the bit: what is written here was computed once."""
        eye = rubble.look_at([-1, 0.5, 2], [3, 0, 1])
        self.assertEqual([float(v).hex() for v in eye[3:]], LOOK_AT)

    def test_turns_and_back(self):
        at = rubble.pose([1, 2, 3], (0.3, -0.4, 2.5))
        rows = np.array([[1.0, 0, 0], [0.2, -3, 5]])
        np.testing.assert_allclose(rubble.rotate(at, rows), rows @ rubble.matrix(at)[:3, :3].T, atol=1e-14)
        np.testing.assert_allclose(rubble.rotate(at, rubble.rotate(at, rows), back=True), rows, atol=1e-14)
        np.testing.assert_allclose(rubble.matrix(rubble.compose(at, at)), rubble.matrix(at) @ rubble.matrix(at), atol=1e-13)

    def test_rotations_need_no_unit_length(self):
        of = [1, 2, 3, 1, 1, 0, 0]
        turn = rubble.matrix(of)
        np.testing.assert_allclose(turn, [[1, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3], [0, 0, 0, 1]], atol=1e-15)
        np.testing.assert_array_equal(rubble.rotate(of, np.eye(3)), turn[:3, :3].T)
        for wrong in ([0] * 7, [0, 0, 0, np.nan, 0, 0, 0], [np.inf, 0, 0, 1, 0, 0, 0], [0] * 6):
            with self.assertRaises(rubble.InputError) as raised:
                rubble.matrix(wrong)
            self.assertEqual(raised.exception.key, "pose")

    def test_of_episodes_uses_no_function_that_differs_between_builds(self):
        """Products of matrices, cos and the like have other last bits in another numpy or C library."""
        banned = re.compile(r" @ |\.dot\(|linalg|einsum|matmul|(np|math)\.(sin|cos|tan|arc\w+|a?(sin|cos|tan)h?|atan2|hypot|exp|log\w*|power|mean|std|var)\b")
        paths = glob.glob(os.path.join(ROOT, "python", "rubble", "envs", "*.py"))
        self.assertGreater(len(paths), 4)
        for path in paths + [os.path.join(ROOT, "python", "rubble", "geometry.py")]:
            for number, line in enumerate(read(path).splitlines(), 1):
                self.assertIsNone(banned.search(line), f"{path}:{number}: {line.strip()}")


# The rotation, w x y z.
LOOK_AT = ["0x1.fb3d09f9f57a1p-1", "0x1.ede2c24af784dp-8", "0x1.efcebafcbafa8p-4", "-0x1.f945b99d49677p-5"]

if __name__ == "__main__":
    unittest.main()
