"""Cameras, LiDARs and robots: against closed forms, and each against the other."""
import os
import tempfile
import unittest

import numpy as np

import rubble

ROOM = """return rubble.mission { pile = { layers = 0, placed = {
  { box = { 0.2, 6, 3 }, position = { 3.1, 0, 1.5 } } } } }"""


class Sensors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        file = tempfile.NamedTemporaryFile("w", suffix=".lua", delete=False)
        with file:
            file.write(ROOM)
        cls.pile = rubble.settle(file.name, threads=2)
        os.remove(file.name)

    def test_depth_of_a_facing_wall_is_planar(self):
        camera = rubble.DepthCamera(self.pile, 64, 48, fov_deg=60, max_range=20)
        depth = camera.depth(rubble.pose([0, 0, 1.5]))
        self.assertEqual(depth.shape, (48, 64))
        np.testing.assert_allclose(depth, 3, atol=2e-3)  # cast concrete is rough by a millimetre
        v, u = np.mgrid[0:48, 0:64]
        k = camera.K
        directions = np.stack([np.ones(u.shape), -(u - k[0, 2]) / k[0, 0], -(v - k[1, 2]) / k[1, 1]], -1).reshape(-1, 3)
        exact = self.pile.cast_rays([[0, 0, 1.5]], directions)["distance"] / np.linalg.norm(directions, axis=1)
        np.testing.assert_allclose(depth.ravel(), exact, atol=3e-6)
        sky = camera.depth(rubble.pose([0, 0, 1.5], (0, -1.2, np.pi)))
        self.assertTrue(np.isinf(sky).all())

    def test_the_renderer_sees_the_same(self):
        eye = rubble.look_at([-1, 0.5, 2], [3, 0, 1])
        frame = rubble.Renderer(self.pile).render(eye, 96, 64, fov_deg=70)
        depth = rubble.DepthCamera(self.pile, 96, 64, fov_deg=70, max_range=100).depth(eye)
        both = np.isfinite(frame["depth"]) & np.isfinite(depth)
        self.assertGreater(both.mean(), 0.5)
        off = np.abs(frame["depth"][both] - depth[both])
        self.assertLess(np.quantile(off, 0.98), 1e-4)
        self.assertEqual(frame["rgb"].shape, (64, 96, 3))
        self.assertGreater(frame["rgb"].std(), 1)
        np.testing.assert_allclose(frame["K"][0, 0], 48 / np.tan(np.radians(35)))

    def test_many_poses_at_once_are_as_one_by_one(self):
        eyes = np.stack([rubble.look_at([-1 - 0.2 * i, 0.5, 2], [3, 0, 1]) for i in range(6)])
        renderer, camera = rubble.Renderer(self.pile), rubble.DepthCamera(self.pile, 48, 32)
        many = renderer.render(eyes, 48, 32, number=5)
        self.assertEqual(many["rgb"].shape, (6, 32, 48, 3))
        for i, eye in enumerate(eyes):
            one = renderer.render(eye, 48, 32, number=5 + i)
            np.testing.assert_array_equal(many["rgb"][i], one["rgb"])
            np.testing.assert_array_equal(many["depth"][i], one["depth"])
            np.testing.assert_array_equal(camera.depth(eyes)[i], camera.depth(eye))
        self.assertEqual(renderer.render(eyes[:1], 48, 32)["depth"].shape, (1, 32, 48))
        self.assertEqual(renderer.render(eyes[:0], 48, 32)["depth"].shape, (0, 32, 48))
        self.assertEqual(camera.depth(eyes[:0]).shape, (0, 32, 48))

    def test_a_lidar_meets_wall_and_ground(self):
        lidar = rubble.Lidar(self.pile, "vlp16", noise=False)
        points = lidar.scan(rubble.pose([0, 0, 1.5]))
        ahead = points[(points["ring"] == 7) & (np.abs(points["y"]) < 1)]
        ahead = ahead[ahead["x"] > 0]
        self.assertGreater(len(ahead), 50)
        np.testing.assert_allclose(ahead["x"], 3, atol=4e-3)  # its step, 2 mm, and the wall's roughness
        noisy = [rubble.Lidar(self.pile, "vlp16", seed=s).scan(rubble.pose([0, 0, 1.5])) for s in (1, 1, 2)]
        self.assertEqual(noisy[0].tobytes(), noisy[1].tobytes())
        self.assertNotEqual(noisy[0].tobytes(), noisy[2].tobytes())

    def test_mistakes(self):
        for call, key in ((lambda: rubble.Lidar(self.pile, "vlp61"), "model"),
                          (lambda: rubble.DepthCamera(self.pile, 4, 4), "width"),
                          (lambda: rubble.DepthCamera(self.pile).depth([0, 0, 1]), "pose"),
                          (lambda: rubble.DepthCamera(self.pile).depth([0, 0, 1, 0, 0, 0, 0]), "pose"),
                          (lambda: rubble.DepthCamera(self.pile).depth([0, 0, 1, 1e200, 0, 0, 0]), "pose"),
                          (lambda: rubble.Lidar(self.pile, seed=-1), "seed"),
                          (lambda: rubble.Lidar(self.pile, seed=2**64), "seed"),
                          (lambda: rubble.RobotWorld(self.pile, "cat", rubble.pose([0, 0, 1])), "model")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)


    def test_numbers_that_no_ray_can_have(self):
        """Embree would end the interpreter."""
        for wrong in (np.nan, np.inf, 0, -1, 1e300):
            with self.subTest(wrong), self.assertRaises(rubble.InputError) as raised:
                rubble.DepthCamera(self.pile, 32, 32, max_range=wrong).depth(rubble.pose([0, 0, 1.5]))
            self.assertEqual(raised.exception.key, "max_range")
        far = rubble.pose([0, 0, 1.5])
        far[0] = 1e38
        for call in (rubble.DepthCamera(self.pile, 32, 32).depth, rubble.Lidar(self.pile).scan,
                     lambda pose: rubble.RobotWorld(self.pile, "crawler", pose), lambda pose: rubble.compose(pose, far)):
            with self.assertRaises(rubble.InputError) as raised:
                call(far)
            self.assertIn("from -1e9 to 1e9 m", str(raised.exception))
        far[0] = -1e9
        self.assertTrue(np.isinf(rubble.DepthCamera(self.pile, 32, 32).depth(far)[:8]).all())
        pile = rubble._core._ExploredPile(self.pile._shared)
        fine = {"cells": [[0, 0, 1], [0.1, 0, 1]], "voxel": 0.1, "radius": 0.15, "max_range": 5.0}
        def explore(cells, voxel, radius, max_range):
            return rubble._core._Explorer(pile, cells, voxel, radius, 32, 90.0, max_range, 1)
        explore(**fine)
        for key, values in (("voxel", (np.nan, np.inf, 0, -0.1)), ("radius", (np.nan, np.inf, 0, -1)),
                            ("max_range", (np.nan, np.inf, 0, -1)), ("cells", (np.zeros((0, 3)),))):
            for wrong in values:
                with self.subTest(key=key, wrong=wrong), self.assertRaises(rubble.InputError) as raised:
                    explore(**{**fine, key: wrong})
                self.assertEqual(raised.exception.key, key)
        with self.assertRaises(rubble.InputError) as raised:
            explore(**fine).move([0, 0, 1], [1e300, 0, 0])
        self.assertEqual(raised.exception.key, "way")
        with self.assertRaises(rubble.InputError) as raised:
            explore(**{**fine, "cells": [[0, 0, 0], [1e6, 1e6, 1e6]]})
        self.assertEqual(raised.exception.key, "voxel")

    def test_threads_are_those_of_the_program(self):
        eye = rubble.pose([0, 0, 1])
        for wrong in (-1, 257, 2**40, 1.5, "2"):
            for call in (lambda: rubble.DepthCamera(self.pile, threads=wrong), lambda: rubble.Renderer(self.pile, threads=wrong),
                         lambda: rubble.Lidar(self.pile, threads=wrong), lambda: rubble.Session(self.pile, threads=wrong),
                         lambda: rubble.RobotWorld(self.pile, "crawler", eye, threads=wrong)):
                with self.assertRaises(rubble.InputError) as raised:
                    call()
                self.assertEqual(raised.exception.key, "threads")
                self.assertIn(f"from 0 to 256, found {wrong!r}", str(raised.exception))
        rubble.DepthCamera(self.pile, threads=np.int64(2))


class Robots(unittest.TestCase):
    setUpClass = Sensors.__dict__["setUpClass"]

    def test_a_crawler_drives_to_the_wall_and_no_farther(self):
        states = []
        for _ in range(2):
            robot = rubble.RobotWorld(self.pile, "crawler", rubble.pose([0, 0, 0.005]))
            robot.drive(0.5)
            first = robot.step(2.0)
            self.assertAlmostEqual(first["links"][0, 0], 1.0, delta=0.15)
            states.append(robot.step(8.0))
        self.assertLess(states[0]["links"][0, 0], 3.0)
        self.assertGreater(states[0]["links"][0, 0], 2.0)
        self.assertEqual(states[0]["links"].tobytes(), states[1]["links"].tobytes())

    def test_a_vine_grows_as_fast_as_it_is_asked_to(self):
        robot = rubble.RobotWorld(self.pile, "vine", rubble.pose([0, 0, 0.06]))
        start = robot.state()["length"]
        robot.grow(0.2)
        state = robot.step(3.0)
        self.assertAlmostEqual(state["length"] - start, 0.6, delta=0.05)
        self.assertAlmostEqual(state["links"][-1, 0], state["length"], delta=0.05)
        self.assertGreater(state["tip_force"], 10)
        robot.grow(0.2, left=1.0)
        state = robot.step(4.0)
        self.assertGreater(state["links"][-1, 1], 0.2)
        robot.grow(-0.2)
        back = robot.step(2.0)
        self.assertAlmostEqual(back["length"], state["length"] - 0.4, delta=0.02)
        self.assertLess(np.linalg.norm(back["links"][-1, :3]), np.linalg.norm(state["links"][-1, :3]) - 0.2)
        for call, key in ((lambda: robot.drive(1), "drive"), (lambda: robot.grow(np.inf), "grow"),
                          (lambda: robot.grow(0.1, np.nan), "grow"), (lambda: robot.grow(0.1, 0, -1e300), "grow")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)

    def test_commands_that_do_not_fit(self):
        crawler = rubble.RobotWorld(self.pile, "crawler", rubble.pose([-2, 0, 0.005]))
        for flippers in ([0, 0], [0, 0, 0, np.nan]):
            with self.assertRaises(rubble.InputError) as raised:
                crawler.drive(0.1, 0, flippers)
            self.assertEqual(raised.exception.key, "flippers")
        robot = rubble.RobotWorld(self.pile, "snake", rubble.pose([-1, 0, 0.05]))
        for call, key in ((lambda: robot.drive(1), "drive"), (lambda: robot.set_joints([0]), "targets"),
                          (lambda: robot.set_joints([np.nan] * robot.joint_count), "targets"),
                          (lambda: robot.step(-1), "seconds")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)

    def test_a_robot_in_a_wall_is_refused(self):
        robot = rubble.RobotWorld(self.pile, "crawler", rubble.pose([3, 0, 0.3]))
        with self.assertRaises(rubble.InputError) as raised:
            robot.step()
        self.assertEqual(raised.exception.key, "pose")

    def test_a_robot_outside_the_world_is_refused(self):
        for place, key in (([-2, 0, -1], "lost_below"), ([500, 0, 0.1], "lost_beyond")):
            with self.assertRaisesRegex(rubble.InputError, key) as raised:
                rubble.RobotWorld(self.pile, "crawler", rubble.pose(place)).step()
            self.assertEqual(raised.exception.key, "pose")


RUIN = """return rubble.mission { seed = 4,
  pile = rubble.building { storeys = 1, bays_x = 1, bays_y = 1, span_x = 4, span_y = 4, column = 0.25, piece = 2,
    infill = "none", continuity = 0.3, cause = { shake = 8, shake_seconds = 2, weak_storey = 0, weakness = 0.03 } },
  settle = { final_time_limit = 30 } }"""


class Ruin(unittest.TestCase):
    def test_a_crawler_drives_where_a_building_collapsed(self):
        file = tempfile.NamedTemporaryFile("w", suffix=".lua", delete=False)
        with file:
            file.write(RUIN)
        pile = rubble.settle(file.name, threads=2)
        os.remove(file.name)
        self.assertLess(pile.poses[:, 2].max(), 2, "it fell")
        ways = []
        for fixed in (False, True):
            robot = rubble.RobotWorld(pile, "crawler", rubble.pose([-3.6, 0, 0.002]), fixed_debris=fixed, threads=1)
            robot.drive(0.6)
            for _ in range(3):
                state = robot.step(0.5)
            self.assertFalse(state["lost"])
            ways.append(state["links"][0][0] + 3.6)
            self.assertGreater(ways[-1], 0.4)


if __name__ == "__main__":
    unittest.main()
