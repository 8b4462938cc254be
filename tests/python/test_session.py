"""Robots of a mission stepped from Python: the recording's poses, contacts and samples, bit for bit."""
import os
import re
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np

import rubble

# Bricks that the rover pushes, within a street; what its function is told, it prints as sums in which the place counts.
MISSION = """return rubble.mission {
  seed = 11,
  pile = { layers = 1, pieces_per_layer = 6, spawn_bounds = { 0.5, 0.5, 0.4 }, mix = { { asset = "brick" } } },
  surroundings = { type = "street", reach = 40 },
  robots = { rubble.robot.rover { name = "rover", position = { -0.9, 0, 0.001 },
    senses = { "top", "eye", "imu", "tof", "bow" },
    control = function(sense)
      local function tell(name, t, list)
        local sum = 0
        for i, v in ipairs(list) do if v < 1e9 then sum = sum + v * (i % 97 + 1) end end
        print(string.format("told %s %.0f %d %.17g", name, t * 1e9, #list, sum))
      end
      local scan, depth = sense.lidars.top, sense.cameras.eye
      for _, axis in ipairs(scan and { "x", "y", "z", "intensity", "ring" } or {}) do tell(axis, scan.t, scan[axis]) end
      if depth then tell("depth", depth.t, depth.depth) end
      for _, r in ipairs(sense.imus.imu or {}) do
        local w, a = r.gyroscope, r.accelerometer
        tell("imu", r.t, { w[1], w[2], w[3], a[1], a[2], a[3] })
      end
      for _, r in ipairs(sense.sensors.tof or {}) do tell("tof", r.t, { r.range }) end
      for _, r in ipairs(sense.sensors.bow or {}) do tell("bow", r.t, { r.pressed, r.force }) end
      return { linear = 0.5, angular = 0.1 }
    end } },
  robot_run = { duration = 0.9 },
  lidars = { top = { model = "vlp16", ride = { robot = "rover" }, position = { 0.2, 0, 0.4 }, returns = "dual" } },
  imu = { on = true, rate_hz = 200, ride = { robot = "rover" } },
  range_finders = { tof = { ride = { robot = "rover" }, position = { 0.35, 0, 0.1 } } },
  bumpers = { bow = { ride = { robot = "rover" }, links = { "front_left_wheel", "front_right_wheel" } } },
  cameras = { eye = { ride = { robot = "rover" }, position = { 0.3, 0, 0.25 }, rpy_deg = { 0, 20, 0 },
                      width = 40, height = 30, fov_deg = 80, rate_hz = 10 } },
  outputs = { depth = "32FC1", rawlog = false, simplemap = false, stl = false, preview = false },
}"""
START_NS = 10**9


def weighted_sum(values):
    total = 0.0
    for i, value in enumerate(values, 1):
        total += float(value) * (i % 97 + 1) if value < 1e9 else 0.0
    return len(values), total


class Sessions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        mission = os.path.join(cls.folder.name, "m.lua")
        with open(mission, "w", encoding="utf-8") as file:
            file.write(MISSION)
        out = os.path.join(cls.folder.name, "out")
        run = subprocess.run([os.environ["RUBBLE_PROGRAM"], "run", mission, "--quiet", "--out", out], check=True,
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        cls.told = {}
        for name, stamp, count, total in re.findall(r"told (\S+) (\d+) (\d+) (\S+)", run.stderr):
            cls.told.setdefault(name, {})[int(stamp)] = (int(count), float(total))
        cls.data = rubble.open_dataset(out)
        cls.out = out
        cls.pile = rubble.settle(mission, threads=2)
        cls.session = rubble.Session(cls.pile, depth=True)
        cls.samples = []
        for _ in range(54):
            cls.session.step(1 / 60)
            cls.samples += cls.session.observe()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def recorded(self):
        """(what is told, what it is called here, stamps, values) of all streams but readings."""
        stamps, clouds = self.data.clouds("/points")
        for axis in ("x", "y", "z", "intensity", "ring"):
            yield axis, stamps, [cloud[axis] for cloud in clouds]
        stamps, depths = self.data.images("/eye/depth_registered/image")
        yield "depth", stamps, [np.where(np.isnan(d), np.inf, d).ravel() for d in depths]
        yield ("imu", *self.data.imu("/imu"))
        for name, columns in (("tof", ["range"]), ("bow", ["pressed", "force"])):
            stamps, readings = self.data.readings(name)
            yield name, stamps, np.stack([readings[c] for c in columns], axis=1)

    def test_a_function_is_told_what_is_recorded(self):
        for name, stamps, values in self.recorded():
            found = {int(stamp) - START_NS: weighted_sum(value) for stamp, value in zip(stamps, values)}
            self.assertGreater(len(self.told[name]), 7, name)
            for stamp, told in self.told[name].items():
                self.assertEqual(told, found[stamp], f"{name} at {stamp} ns")

    def test_a_session_senses_what_is_recorded(self):
        mine = {}
        for s in self.samples:
            if s["kind"] == "lidar":
                for axis in ("x", "y", "z", "intensity", "ring"):
                    mine.setdefault(axis, {})[s["stamp"]] = s["points"][axis]
            elif s["kind"] == "camera":
                mine.setdefault("depth", {})[s["stamp"]] = np.where(np.isnan(s["depth"]), np.inf, s["depth"]).ravel()
            elif s["kind"] == "imu":
                both = np.concatenate([s["angular_velocity"], s["linear_acceleration"]])
                mine.setdefault("imu", {})[s["stamp"]] = both
            elif s["sensor"] == "tof":
                mine.setdefault("tof", {})[s["stamp"]] = np.array([s["range"]])
            elif s["sensor"] == "bow":
                mine.setdefault("bow", {})[s["stamp"]] = np.array([s["pressed"], s["force"]])
        for name, stamps, values in self.recorded():
            self.assertGreater(len(mine[name]), 7, name)
            found = dict(zip(stamps.tolist(), values))
            for stamp, value in mine[name].items():
                np.testing.assert_array_equal(value, found[stamp], f"{name} at {stamp} ns")
        stamps = [s["stamp"] for s in self.samples if s["kind"] != "robot"]
        self.assertGreater(len(set(stamps)), 100)

    def test_poses_and_contacts_are_those_of_the_run(self):
        states = [s for s in self.samples if s["kind"] == "robot"]
        poses, contacts = (self.data._messages(topic, lambda m: (0, m))[1] for topic in ("/ground_truth/odom", "/contacts"))
        self.assertEqual(len(states), len(poses) - 1)  # the recording has the last state, too
        for state, message in zip(states, poses):  # x y z qx qy qz qw, covariance, twist, covariance
            x, y, z, qx, qy, qz, qw = np.frombuffer(message[-8 * 85:-8 * 78], "<f8")
            np.testing.assert_array_equal(state["pose"], [x, y, z, qw, qx, qy, qz])
        self.assertGreater(sum(s["contacts"].any() for s in states), 40)
        links = len(self.session.link_names("rover"))
        wire = np.frombuffer(b"".join(m[-48:] for m in contacts), "<f8").reshape(-1, links, 6)
        np.testing.assert_array_equal(np.array([s["contacts"] for s in states]), wire[:len(states)])

    def test_surroundings_are_felt(self):
        refused = None
        for y in range(2, 20):  # away from the pile, into whatever stands there
            robot = rubble.RobotWorld(self.pile, "rover", rubble.pose([1, y, 0.002]), threads=1)
            try:
                robot.step()
            except rubble.InputError as error:
                refused = error
                break
        self.assertIn("deep in the surroundings", str(refused))
        self.assertEqual(refused.key, "pose")
        with self.assertRaises(rubble.InputError):  # it does not go on either
            robot.step()

    def test_commands_replace_what_the_mission_says(self):
        session = rubble.Session(self.pile, threads=1)
        start = session.state("rover")["links"][0, 0]
        session.drive("rover", -0.5)
        session.step(0.5)
        back = session.state("rover")["links"][0, 0]
        self.assertLess(back, start - 0.1)
        session.follow_mission("rover")
        session.step(0.5)
        self.assertGreater(session.state("rover")["links"][0, 0], back)
        self.assertAlmostEqual(session.time, 1)

    @staticmethod
    def play(session, steps=20):
        """All that the session senses from now on; bytes."""
        told = []
        for _ in range(steps):
            session.step(1 / 60)
            for sample in session.observe():
                told.append([(name, np.asarray(value).tobytes()) for name, value in sorted(sample.items())])
        return told

    def test_a_reset_session_has_the_bits_of_a_new_one(self):
        session = rubble.Session(self.pile, depth=True, threads=1)
        first = self.play(session)
        session.drive("rover", 0.8, 0.5)
        session.step(0.4)
        session.reset()
        self.assertEqual(session.time, 0)
        self.assertEqual(self.play(session), first)  # and the mission drives again
        there = rubble.pose([0, -1.5, 0.001], (0, 0, 1.5))
        session.reset({"rover": there})
        np.testing.assert_allclose(session.state("rover")["links"][0], there, atol=1e-12)
        self.assertNotEqual(self.play(session), first)
        session.reset()
        self.assertEqual(self.play(session), first)
        with self.assertRaises(rubble.InputError) as raised:
            session.reset({"cat": there})
        self.assertEqual(raised.exception.key, "robot")

    def test_a_reset_robot_has_the_bits_of_a_new_one_and_the_pile_lies_as_before(self):
        def push(robot):
            robot.drive(0.7, 0.1)
            return b"".join(np.ascontiguousarray(value).tobytes() for _ in range(40) for value in robot.step(1 / 60).values())

        here, there = rubble.pose([-0.9, 0, 0.001]), rubble.pose([0.9, 0.1, 0.001], (0, 0, 3.1))
        robot = rubble.RobotWorld(self.pile, "rover", here, threads=1)
        first = push(robot)
        robot.reset(there)
        second = push(robot)
        self.assertNotEqual(first, second)
        self.assertEqual(second, push(rubble.RobotWorld(self.pile, "rover", there, threads=1)))
        robot.reset()
        self.assertEqual(first, push(robot))
        # One that was refused its place goes on after a reset.
        robot.reset(rubble.pose([0, 0, 0.001]))
        with self.assertRaises(rubble.InputError):
            robot.step()
        robot.reset()
        self.assertEqual(first, push(robot))

    def test_friction_is_that_of_the_robot(self):
        def climb(friction):
            robot = rubble.RobotWorld(self.pile, "rover", rubble.pose([-0.9, 0, 0.001]), threads=1, friction=friction)
            robot.drive(1.0)
            return robot.step(0.3)["links"][0][0]
        self.assertLess(climb(0.01), climb(0.8) - 0.02)
        self.assertEqual(climb(None), climb(0.8))
        with self.assertRaises(rubble.InputError) as raised:
            climb(3.0)
        self.assertEqual(raised.exception.key, "friction")

    def test_a_session_that_is_not_observed_moves_alike(self):
        seen, unseen = (rubble.Session(self.pile, threads=1, observed=observed) for observed in (True, False))
        for session in (seen, unseen):
            session.drive("rover", 0.5)
            session.step(0.3)
        self.assertEqual(unseen.observe(), [])
        np.testing.assert_array_equal(seen.state("rover")["links"], unseen.state("rover")["links"])

    def test_a_pile_is_varied_without_settling(self):
        varied = self.pile.vary(["light.type=sun", "air.fog_density=0.5", "robots[1].friction=0.3"])
        self.assertEqual(varied.state_hash, self.pile.state_hash)
        slow, fast = (rubble.Session(pile, threads=1, observed=False) for pile in (self.pile.vary(["robots[1].friction=0.01"]), varied))
        for session in (slow, fast):
            session.drive("rover", 1.0)
            session.step(0.3)
        self.assertLess(slow.state("rover")["links"][0][0], fast.state("rover")["links"][0][0])
        for overrides, key in ((["air.fog_density=0.5", "pile.layers=2"], "pile.layers"), (["settle.gravity=5"], "settle.gravity"),
                               (["surroundings.reach=60"], "surroundings.reach"), (["seed=3"], "seed")):
            with self.assertRaises(rubble.InputError) as raised:
                self.pile.vary(overrides)
            self.assertEqual(raised.exception.key, key)
            self.assertIn("settle", str(raised.exception))

    def test_a_second_thread_is_refused_and_the_object_goes_on(self):
        session = rubble.Session(self.pile, threads=1, observed=False)
        alone = rubble.Session(self.pile, threads=1, observed=False)
        camera = rubble.DepthCamera(self.pile, 200, 150, fov_deg=90, max_range=20, threads=1)
        eye = rubble.pose([-2, 0, 0.5])
        picture, done = camera.depth(eye), []
        for work, ask in ((lambda: session.step(0.5), lambda: session.state("rover")),
                          (lambda: camera.depth(eye), lambda: camera.depth(eye))):
            refused, stop, calls = threading.Event(), threading.Event(), []

            def go_on():
                while not stop.is_set():
                    try:
                        work()
                        calls.append(1)
                    except rubble.RunError:  # the question came first
                        refused.set()

            worker = threading.Thread(target=go_on)
            worker.start()
            deadline = time.monotonic() + 120
            while not refused.is_set() and time.monotonic() < deadline:
                try:
                    ask()
                except rubble.RunError as error:
                    self.assertIn("each thread needs an object of its own", str(error))
                    refused.set()
            stop.set()
            worker.join()
            self.assertTrue(refused.is_set())
            done.append(len(calls))
        for _ in range(done[0]):
            alone.step(0.5)
        np.testing.assert_array_equal(session.state("rover")["links"], alone.state("rover")["links"])
        np.testing.assert_array_equal(camera.depth(eye), picture)

    def test_mistakes(self):
        for call, key in ((lambda: self.session.drive("cat", 1), "robot"),
                          (lambda: self.session.grow("rover", 1), "grow"),
                          (lambda: self.session.step(0), "seconds")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)


if __name__ == "__main__":
    unittest.main()
