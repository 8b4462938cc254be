"""Robots of a mission stepped from Python: the recording's poses, contacts and samples, bit for bit."""
import os
import re
import subprocess
import tempfile
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
        for y in range(8, 20, 2):  # across the street, into a house
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

    def test_mistakes(self):
        for call, key in ((lambda: self.session.drive("cat", 1), "robot"),
                          (lambda: self.session.grow("rover", 1), "grow"),
                          (lambda: self.session.step(0), "seconds")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertEqual(raised.exception.key, key)


if __name__ == "__main__":
    unittest.main()
