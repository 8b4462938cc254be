"""The array, the list of factors and the judges themselves: each judge is shown data that is wrong, and must see it."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy as np

import covering_array
import factors
import judges_formats
import judges_geometry
import judges_motion
import judges_sensors
import judges_streams
import known_failures
import recordings
import rules
import run_pairs
from dataset import Dataset, Finding

PROGRAM = os.environ["RUBBLE_PROGRAM"]
# What most judges have something to say about.
ROW = {"pile": "spawned", "imu": "lever", "lidar": "vlp16", "scans": "both", "ros2": "mcap", "folders": "all", "robots": "rover",
       "control": "drive", "lens": "plumb_bob", "meshes": "all", "ros1": "metres", "rawlog": "observations", "sensors": "exact"}


class Array(unittest.TestCase):
    def test_every_pair_meets_but_the_forbidden(self):
        small = {"a": "123", "b": "12", "c": "1234", "d": "12"}
        forbidden = [(("a", "1"), ("b", "1")), (("a", "2"), ("b", "1")), (("c", "4"), ("b", "2"))]
        rows, implied = covering_array.make_array(small, forbidden, [{"a": "3", "c": "2"}])
        self.assertEqual(rows[0]["a"] + rows[0]["c"], "32")
        met = set().union(*(covering_array.pairs_of(row) for row in rows))
        for pair in forbidden:
            self.assertNotIn(tuple(sorted(pair)), met)
        # c=4 needs b=1, which needs a=3.
        self.assertEqual(sorted(implied), [(("a", "1"), ("c", "4")), (("a", "2"), ("c", "4"))])
        self.assertEqual(len(met), covering_array.count_pairs(small) - len(forbidden) - len(implied))
        self.assertLess(len(rows), 20)
        self.assertEqual(rows, covering_array.make_array(small, forbidden, [{"a": "3", "c": "2"}])[0])

    def test_rules_name_levels(self):
        for pair in list(rules.expand(rules.REFUSED)) + list(rules.expand(rules.MEANINGLESS)):
            for factor, level in pair:
                self.assertIn(level, factors.FACTORS[factor])

    def test_the_dozen_keeps_the_rules(self):
        forbidden = set(rules.expand(rules.REFUSED)) | set(rules.expand(rules.MEANINGLESS))
        for row in run_pairs.dozen_rows():
            self.assertFalse(forbidden & covering_array.pairs_of(row), row)


class Schema(unittest.TestCase):
    def test_every_key_is_of_a_factor_or_has_a_reason(self):
        printed = subprocess.run([PROGRAM, "check", "--schema"], capture_output=True, text=True, check=True).stdout
        keys = {key for key in json.loads(printed)["properties"] if not factors.is_published_name(key)}
        known = factors.keys_of_levels() | set(factors.NOT_FACTORS)
        self.assertEqual(keys - known, set(), "new keys of a mission: make each a factor of tests/pairs/factors.py, or say in "
                                              "NOT_FACTORS why it is none")
        self.assertEqual(known - keys, set(), "keys that no mission has any more")


class Judges(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        mission = run_pairs.write_mission(dict({name: next(iter(levels)) for name, levels in factors.FACTORS.items()}, **ROW), 3,
                                          os.path.join(cls.scratch.name, "mission"))
        cls.out = os.path.join(cls.scratch.name, "out")
        subprocess.run([PROGRAM, "run", mission, "--out", cls.out, "--quiet"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def load(self, folder=None):
        folder = folder or self.out
        return Dataset(folder, ROW, os.path.join(folder, "pile.ply"))

    def copy(self):
        folder = os.path.join(self.scratch.name, "copy")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.out, folder)
        return folder

    def assert_sees(self, judge, data, words):
        with self.assertRaises(Finding) as raised:
            judge(data)
        self.assertIn(words, str(raised.exception))

    def test_nothing_is_found_in_what_is_right(self):
        data = self.load()
        for judge in run_pairs.JUDGES:
            try:
                judge(data)
            except Finding as finding:
                self.assertIsNotNone(known_failures.find(ROW, judge.__name__, str(finding)), "%s: %s" % (judge.__name__, finding))

    def test_a_moved_pose(self):
        data = self.load()
        data.cameras[0].poses[1][:] += [0, 0, 0.02]
        self.assert_sees(judges_geometry.depth_meets_geometry, data, "is not that of the geometry")
        self.assert_sees(judges_geometry.positions_meet_depth, data, "beside that of the depth")
        self.assert_sees(judges_formats.poses_are_equal, data, "poses differ")
        self.assert_sees(judges_formats.euroc_meets_poses, data, "beside groundtruth.txt")
        data.cameras[0].poses[1][2] += [0.01, 0, 0]
        self.assert_sees(judges_geometry.flow_meets_poses, data, "flow")
        self.assert_sees(judges_motion.imu_meets_poses, data, "specific force")

    def test_a_turned_pose(self):
        data = self.load()
        turns = data.cameras[0].poses[2]
        turns[2] = turns[2] @ run_pairs.judges_motion.geometry.turn([0, 0, 0.01])
        self.assert_sees(judges_motion.imu_meets_poses, data, "attitude")

    def test_a_scaled_range(self):
        folder = self.copy()
        for name in sorted(os.listdir(os.path.join(folder, "pcd", "top"))):
            if not name.endswith(".pcd"):
                continue
            path = os.path.join(folder, "pcd", "top", name)
            with open(path, "rb") as file:
                body = file.read()
            end = body.index(b"DATA binary\n") + 12
            points = judges_geometry.read_pcd(path).copy()
            for axis in "xyz":
                points[axis] *= 1.02
            with open(path, "wb") as file:
                file.write(body[:end] + points.tobytes())
        self.assert_sees(judges_geometry.scans_meet_geometry, self.load(folder), "are not those of the geometry")
        self.assert_sees(judges_formats.scan_files_are_equal, self.load(folder), "differs between")

    def test_another_reading(self):
        for name, change, judge, words in (("ahrs", lambda v: [-v[0]] + v[1:], judges_sensors.attitudes_meet_poses, "beside the pose"),
                                           ("baro", lambda v: [v[0] + 1], judges_sensors.pressures_meet_heights, "at this height"),
                                           ("mag", lambda v: [v[1], v[0], v[2]], judges_sensors.fields_meet_poses, "beside the Earth's"),
                                           ("gps", lambda v: [v[0] + 1e-6] + v[1:], judges_sensors.fixes_meet_poses, "beside the place"),
                                           ("sonar", lambda v: [v[0]], judges_sensors.readings_are_recorded, "other stamps")):
            folder = self.copy()
            path = os.path.join(folder, "sensors", name + ".csv")
            with open(path, encoding="ascii") as file:
                head, *rows = file.read().splitlines()
            with open(path, "w", encoding="ascii") as file:
                file.write(head + "\n")
                for row in rows[name == "sonar":]:
                    stamp, *values = row.split(",")
                    file.write(",".join([stamp] + [repr(value) for value in change([float(value) for value in values])]) + "\n")
            self.assert_sees(judge, self.load(folder), words)

    def test_a_shifted_stamp(self):
        data = self.load()
        topic = "/imu"
        data.bag.topics[topic][5] = (data.bag.topics[topic][5][0] + 1000, data.bag.topics[topic][5][1])
        self.assert_sees(judges_formats.bag_is_mcap, data, "differs between bag and MCAP")
        self.assert_sees(judges_streams.stamps_are_in_order, data, "header and log")
        data = self.load()
        data.bag.topics["/camera/rgb/image_raw"].pop()
        self.assert_sees(judges_formats.bag_is_mcap, data, "messages in the bag")
        self.assert_sees(judges_formats.poses_are_equal, data, "stamps of the pictures")
        self.assert_sees(judges_formats.pictures_are_equal, data, "poses")

    def test_another_lens_label_and_impulse(self):
        data = self.load()
        data.cameras[0].settings["lens"]["k1"] += 0.01
        self.assert_sees(judges_formats.intrinsics_are_equal, data, "distortion")
        data = self.load()
        data.legend["instances"][0]["label"] += 1
        data.legend["instances"][3]["label"] += 1
        self.assert_sees(judges_geometry.labels_meet_legend, data, "has the labels")
        data = self.load()
        for message in data.bag.messages("/contacts"):
            message["wrench"]["force"]["z"] *= 1.2
        self.assert_sees(judges_motion.contacts_meet_momentum, data, "ask for")
        data = self.load()
        data.bag.messages("/imu")[3]["angular_velocity"]["x"] += 1e-6
        self.assert_sees(judges_formats.inertial_files_are_equal, data, "are not those of the recording")
        self.assert_sees(judges_formats.rawlog_meets_recording, self.shortened(), "inertial readings")

    def shortened(self):
        data = self.load()
        data.bag.topics["/imu"].pop()
        return data

    def test_another_file(self):
        folder = self.copy()
        with open(os.path.join(folder, "groundtruth.txt.part"), "w", encoding="ascii"):
            pass
        self.assert_sees(judges_streams.files_are_whole, self.load(folder), "is left")
        folder = self.copy()
        path = os.path.join(folder, "pile.stl")
        with open(path, "rb") as file:
            body = bytearray(file.read())
        triangles = np.frombuffer(body, np.uint8)[84:].reshape(-1, 50)
        corner = triangles[int(np.argmax([np.frombuffer(row[12:48].tobytes(), "<f4")[2] for row in triangles]))]
        corner[12:48] = (np.frombuffer(corner[12:48].tobytes(), "<f4") + np.float32(0.01)).view(np.uint8)
        with open(path, "wb") as file:
            file.write(body)
        self.assert_sees(judges_geometry.meshes_agree, self.load(folder), "beside pile.ply")


class Mcap(unittest.TestCase):
    def test_a_cut_file_is_refused(self):
        with tempfile.NamedTemporaryFile() as file:
            file.write(b"\x89MCAP0\r\n" + b"\0" * 40)
            file.flush()
            with self.assertRaises(ValueError):
                recordings.read_mcap(file.name)


if __name__ == "__main__":
    unittest.main()
