"""Recordings as arrays, against what the mission says and against rosbag."""
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

import numpy as np
import rosbag

import rubble

MISSION = """return rubble.mission {
  pile = { layers = 0 },
  camera = { width = 64, height = 48, fov_deg = 70 },
  imu = { on = true, rate_hz = 50 },
  lidars = { top = { model = "vlp16" }, low = { model = "utm30lx", noise = false, range_step = 0 } },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { 0, 0, 2 }, rpy_deg = { 0, 30, 0 } },
    { t = 1, position = { 1, 0, 2 }, rpy_deg = { 0, 30, 0 } } } },
}"""


class Recording(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        path = os.path.join(cls.folder.name, "m.lua")
        with open(path, "w", encoding="utf-8") as file:
            file.write(MISSION)
        cls.out = os.path.join(cls.folder.name, "out")
        subprocess.run([os.environ["RUBBLE_PROGRAM"], "run", path, "--quiet", "--out", cls.out], check=True,
                       stdout=subprocess.DEVNULL)
        cls.data = rubble.open_dataset(cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_pixel_and_point_is_that_of_rosbag(self):
        stamps, images = self.data.images("/camera/rgb/image_raw")
        _, clouds = self.data.clouds("/points")
        found, points = [], []
        with rosbag.Bag(os.path.join(self.out, "mission.bag")) as bag:
            for topic, message, _ in bag.read_messages():
                if topic == "/camera/rgb/image_raw":
                    found.append((message.header.stamp.to_nsec(), bytes(message.data)))
                elif topic == "/points":
                    points.append(bytes(message.data))
            counts = {t: i.message_count for t, i in bag.get_type_and_topic_info().topics.items()}
        self.assertEqual(self.data.topics, counts)
        self.assertEqual([(s, i.tobytes()) for s, i in zip(stamps.tolist(), images)], found)
        self.assertEqual([c.tobytes() for c in clouds], points)
        self.assertFalse(images[0].flags.owndata)  # a view of the message

    def test_depth_unprojects_onto_the_ground(self):
        _, depth = self.data.images("/camera/depth_registered/image_raw")
        stamps, poses = self.data.poses()
        k = self.data.intrinsics()["K"]
        np.testing.assert_allclose(poses[:, :3], [[t / 5, 0, 2] for t in range(6)], atol=1e-6)
        np.testing.assert_allclose(np.diff(stamps), 200_000_000)
        v, u = np.nonzero(depth[3])
        z = depth[3][v, u] / 1000
        body = np.stack([z, -(u - k[0, 2]) / k[0, 0] * z, -(v - k[1, 2]) / k[1, 1] * z], axis=1)
        world = body @ rubble.matrix(poses[3])[:3, :3].T + poses[3, :3]
        self.assertLess(np.abs(world[:, 2]).max(), 0.002)

    def test_scans_and_inertial_readings(self):
        stamps, scans = self.data.scans("/scan")
        self.assertEqual(len(stamps), 40)
        # The scanner looks 30 degrees down from 2 m: the ground ahead is 4 m away.
        ahead = int(np.argmin(np.abs(scans[0]["angles"])))
        self.assertAlmostEqual(float(scans[0]["ranges"][ahead]), 4, places=4)
        stamps, readings = self.data.imu()
        self.assertEqual(readings.shape, (51, 6))
        self.assertAlmostEqual(float(np.linalg.norm(readings[:, 3:], axis=1).mean()), 9.81, delta=0.6)

    def test_the_folder_is_text_bytes_or_an_object(self):
        for out in (pathlib.Path(self.out), os.fsencode(self.out)):
            data = rubble.open_dataset(out)
            self.assertEqual((data.folder, data.topics), (self.out, self.data.topics))
            self.assertEqual(rubble._core.read_messages(os.path.join(out, os.fsencode("mission.bag") if isinstance(out, bytes) else
                                                                     "mission.bag"), {"/none"}), {})

    def test_poses_of_what_is_on_robots(self):
        def poses(topics, topic=None):
            data = rubble.Dataset.__new__(rubble.Dataset)
            data.bag, data.topics, asked = "m.bag", dict.fromkeys(topics, 1), []
            data._messages = lambda name, parse: asked.append((name, parse.__name__)) or (np.zeros(0), [])
            data.poses(topic)
            return asked[0]
        self.assertEqual(poses(["/ground_truth/pose", "/a/ground_truth/pose"]), ("/ground_truth/pose", "_pose"))
        self.assertEqual(poses(["/a/ground_truth/pose", "/a/odom"]), ("/a/ground_truth/pose", "_pose"))
        self.assertEqual(poses(["/a/ground_truth/pose"], "/ground_truth/odom"), ("/ground_truth/odom", "_odometry"))
        with self.assertRaisesRegex(rubble.InputError, "one of /a/ground_truth/pose, /b/ground_truth/pose"):
            poses(["/a/ground_truth/pose", "/b/ground_truth/pose"])
        head = struct.pack("<III", 0, 3, 5) + struct.pack("<I", 5) + b"world" + struct.pack("<I", 4) + b"base"
        stamp, row = rubble.dataset._odometry(head + struct.pack("<7d", 1, 2, 3, 0.1, 0.2, 0.3, 0.9) + bytes(36 * 8))
        self.assertEqual((stamp, row), (3_000_000_005, (1, 2, 3, 0.9, 0.1, 0.2, 0.3)))

    def test_mistakes(self):
        with self.assertRaises(rubble.InputError) as raised:
            self.data.images("/nothing")
        self.assertEqual(raised.exception.key, "/nothing")
        for call, topics in ((lambda: self.data.images("/imu"), "/camera/depth_registered/image_raw, /camera/rgb/image_raw"),
                             (lambda: self.data.clouds("/imu"), "/points"), (lambda: self.data.scans("/imu"), "/scan"),
                             (lambda: self.data.imu("/points"), "/imu"), (lambda: self.data.poses("/imu"), "/ground_truth/pose")):
            with self.assertRaises(rubble.InputError) as raised:
                call()
            self.assertRegex(str(raised.exception), "has messages of sensor_msgs/(Imu|PointCloud2), not of ")
            self.assertIn("one of " + topics, str(raised.exception))
        with self.assertRaises(rubble.InputError):
            rubble.open_dataset(self.folder.name)
        path = os.path.join(self.out, "mission.bag")
        with open(path, "rb") as file:
            whole = file.read()
        broken = os.path.join(self.folder.name, "mission.bag")
        with open(broken, "wb") as file:
            file.write(whole[: len(whole) // 2])
        with self.assertRaises(rubble.InputError) as raised:
            rubble._core.read_messages(broken, {"/imu"})
        self.assertEqual(raised.exception.file, broken)


if __name__ == "__main__":
    unittest.main()
