"""What a run recorded, as numpy arrays.

    data = rubble.open_dataset("out/first_pile")
    data.topics                        # how many messages each has
    depth = data.images("/camera/depth_registered/image_raw")[0]
    stamps, poses = data.poses()       # the truth
    data.intrinsics()                  # K, width, height, distortion

Messages are read from mission.bag. Pixels and points are views of the messages' own bytes: nothing is copied.
"""
from __future__ import annotations

import json
import os
import struct
from typing import Any, Sequence

import numpy as np
from numpy.typing import NDArray

from . import _core
from .mission_text import Path, path_text

_ENCODINGS = {"rgb8": ("u1", 3), "mono8": ("u1", 1), "8UC2": ("u1", 2), "16UC1": ("<u2", 1), "16UC2": ("<u2", 2),
              "16UC3": ("<u2", 3), "32FC1": ("<f4", 1), "32FC2": ("<f4", 2), "32FC3": ("<f4", 3), "32SC1": ("<i4", 1),
              "32SC2": ("<i4", 2), "32SC3": ("<i4", 3)}
_POINT_TYPES = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 8: "<f8"}


class _Wire:
    """Fields off the front of a ROS 1 message."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, layout):
        values = struct.unpack_from("<" + layout, self.data, self.at)
        self.at += struct.calcsize("<" + layout)
        return values if len(values) > 1 else values[0]

    def block(self):
        size = self.take("I")
        self.at += size
        return memoryview(self.data)[self.at - size:self.at]

    def text(self):
        return bytes(self.block()).decode()

    def header(self):
        _, seconds, nanoseconds = self.take("III")
        return seconds * 1_000_000_000 + nanoseconds, self.text()


def _image(data):
    wire = _Wire(data)
    stamp, _ = wire.header()
    height, width = wire.take("II")
    encoding = wire.text()
    wire.take("BI")
    kind, components = _ENCODINGS[encoding]
    shape = (height, width) if components == 1 else (height, width, components)
    return stamp, np.frombuffer(wire.block(), kind).reshape(shape)


def _cloud(data):
    wire = _Wire(data)
    stamp, _ = wire.header()
    wire.take("II")
    names, formats, offsets = [], [], []
    for _ in range(wire.take("I")):
        names.append(wire.text())
        offset, kind, _ = wire.take("IBI")
        offsets.append(offset)
        formats.append(_POINT_TYPES[kind])
    _, step, _ = wire.take("BII")
    layout = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": step})
    return stamp, np.frombuffer(wire.block(), layout)


def _laser_scan(data):
    wire = _Wire(data)
    stamp, _ = wire.header()
    first, _, step, between, _, _, _ = wire.take("7f")
    ranges = np.frombuffer(data, "<f4", wire.take("I"), wire.at)
    return stamp, {"ranges": ranges, "angles": first + step * np.arange(len(ranges)),
                   "times": between * np.arange(len(ranges))}


def _imu(data):
    wire = _Wire(data)
    stamp, _ = wire.header()
    wire.take("13d")
    turning = wire.take("3d")
    wire.take("9d")
    return stamp, turning + wire.take("3d")


def _camera_info(data):
    wire = _Wire(data)
    stamp, _ = wire.header()
    height, width = wire.take("II")
    model = wire.text()
    d = [wire.take("d") for _ in range(wire.take("I"))]
    return stamp, {"K": np.array(wire.take("9d")).reshape(3, 3), "width": width, "height": height,
                   "model": model, "D": np.array(d)}


def _pose(data):
    wire = _Wire(data)
    stamp, _ = wire.header()
    x, y, z, qx, qy, qz, qw = wire.take("7d")
    return stamp, (x, y, z, qw, qx, qy, qz)


def _odometry(data):
    wire = _Wire(data)
    stamp, _ = wire.header()
    wire.text()
    x, y, z, qx, qy, qz, qw = wire.take("7d")
    return stamp, (x, y, z, qw, qx, qy, qz)


# What each function reads; the wire says nothing of it.
_KINDS = {_image: "sensor_msgs/Image", _cloud: "sensor_msgs/PointCloud2", _laser_scan: "sensor_msgs/LaserScan", _imu: "sensor_msgs/Imu",
          _camera_info: "sensor_msgs/CameraInfo", _pose: "geometry_msgs/PoseStamped", _odometry: "nav_msgs/Odometry"}


def _mistake(file, key, message, expected):
    parts = [part for part in (file, key, message) if part]
    error = _core.InputError(": ".join(parts) + ": expected " + expected)
    error.file, error.key = file, key
    error.diagnostics = [{"file": file, "line": 0, "key": key, "message": message, "expected": expected,
                          "found": "", "hint": ""}]
    return error


class Dataset:
    """The folder of a finished run that has a bag."""

    def __init__(self, folder: Path) -> None:
        self.folder = path_text(folder, "folder")
        self.bag = os.path.join(self.folder, "mission.bag")
        if not os.path.exists(self.bag):
            raise _mistake(self.bag, "", "no such file", "a run with outputs.bag")
        with open(os.path.join(self.folder, "manifest.json"), encoding="utf-8") as file:
            self.manifest = json.load(file)
        found = _core.list_topics(self.bag)
        self.topics = {topic: count for topic, (_, count) in found.items()}
        self._types = {topic: kind for topic, (kind, _) in found.items()}

    def _messages(self, topic, parse):
        if topic not in self.topics:
            raise _mistake(self.bag, topic, "no such topic", "one of " + ", ".join(sorted(self.topics)))
        wanted = _KINDS.get(parse)
        if wanted and self._types[topic] != wanted:
            raise _mistake(self.bag, topic, f"has messages of {self._types[topic]}, not of {wanted}",
                           "one of " + ", ".join(sorted(t for t, kind in self._types.items() if kind == wanted))
                           if wanted in self._types.values() else f"a run that records {wanted}")
        found = [parse(m) for m in _core.read_messages(self.bag, {topic})[topic]]
        return np.array([stamp for stamp, _ in found], np.int64), [value for _, value in found]

    def images(self, topic: str = "/camera/rgb/image_raw") -> tuple[NDArray[np.int64], list[NDArray[Any]]]:
        """(stamps in ns, list of (h, w) or (h, w, c) arrays); 16UC1 depth is in millimetres, 0: none."""
        return self._messages(topic, _image)

    def clouds(self, topic: str = "/points") -> tuple[NDArray[np.int64], list[NDArray[Any]]]:
        """(stamps, list of structured arrays: x y z intensity ring time)."""
        return self._messages(topic, _cloud)

    def scans(self, topic: str = "/scan") -> tuple[NDArray[np.int64], list[dict[str, NDArray[Any]]]]:
        """(stamps, list of dict of ranges (inf: none), angles and times)."""
        return self._messages(topic, _laser_scan)

    def imu(self, topic: str = "/imu") -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """(stamps, (n, 6) array: angular velocity, then specific force)."""
        stamps, rows = self._messages(topic, _imu)
        return stamps, np.array(rows)

    def readings(self, name: str) -> tuple[NDArray[np.int64], dict[str, NDArray[np.float64]]]:
        """(stamps, dict of arrays by column) of a range finder, bumper, attitude sensor, barometer, magnetometer, battery or GNSS
        receiver, by its name in the mission; units as sensors/NAME.csv says."""
        path = os.path.join(self.folder, "sensors", name + ".csv")
        if not os.path.exists(path):
            raise _mistake(path, "name", "the dataset has no such sensor", "one of " + self._sensor_names())
        with open(path) as table:
            head = table.readline().rstrip("\n").split(",")
            rows = [line.split(",") for line in table]
        stamps = np.array([int(row[0]) for row in rows], np.int64)
        values = np.array([row[1:] for row in rows], np.float64).reshape(len(rows), len(head) - 1)
        return stamps, {column.split(" ")[0]: values[:, i] for i, column in enumerate(head[1:])}

    def _sensor_names(self):
        folder = os.path.join(self.folder, "sensors")
        files = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
        return ", ".join(os.path.splitext(file)[0] for file in files) or "nothing: no sensors were recorded"

    def poses(self, topic: str | None = None) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """(stamps, (n, 7) array): where the rig truly was; of a camera on a robot "/NAME/ground_truth/pose", which need not be
        given where there is no other; of a robot "/ground_truth/odom"."""
        if topic is None:
            found = sorted(t for t in self.topics if t.endswith("/ground_truth/pose"))
            if "/ground_truth/pose" not in found and len(found) > 1:
                raise _mistake(self.bag, "topic", "no camera is on the rig, and several are on robots",
                               "one of " + ", ".join(found))
            topic = "/ground_truth/pose" if "/ground_truth/pose" in found or not found else found[0]
        stamps, rows = self._messages(topic, _odometry if topic.endswith("/odom") else _pose)
        return stamps, np.array(rows)

    def intrinsics(self, topic: str = "/camera/rgb/camera_info") -> dict[str, Any]:
        """dict of K (3, 3), width, height, model and D of the first frame."""
        return self._messages(topic, _camera_info)[1][0]

    def pile(self, threads: int = 0, assets: Sequence[Path] | None = None) -> _core.Pile:
        """The settled pile. assets: as of open_pile()."""
        return _core.open_pile(self.folder, threads, [] if assets is None else assets)


def open_dataset(folder: Path) -> Dataset:
    return Dataset(folder)
