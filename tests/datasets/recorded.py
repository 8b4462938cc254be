"""What the checks of read_datasets.py share: the recorded missions and their exact tables."""
import csv
import io
import json
import sys
import tarfile
from pathlib import Path

import numpy as np

DATA = Path(sys.argv[1])
OPTICAL = np.array([[0.0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # camera body from optical frame


def need(condition, text, *values):
    if not condition:
        raise AssertionError(text % values if values else text)


def close(a, b, limit, text, *values):
    a, b = np.asarray(a, float), np.asarray(b, float)
    need(a.shape == b.shape, text + ": %s values, not %s", *values, a.shape, b.shape)
    worst = np.abs(a - b).max() if a.size else 0
    need(worst <= limit, text + ": differs by %g", *values, worst)


def rotation(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def matrix(turn, place):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, place
    return pose


class Frames:
    """The folder `frames` of a camera, in which every bit is."""

    def __init__(self, folder):
        self.folder = folder
        with open(folder / "frames" / "poses.csv", encoding="ascii") as file:
            self.rows = list(csv.DictReader(file))
        self.stamps = [int(row["stamp_ns"]) for row in self.rows]
        self.bodies = [matrix(rotation(*(float(row["q" + a]) for a in "wxyz")), [float(row[a]) for a in "xyz"]) for row in self.rows]
        self.optical = [body @ matrix(OPTICAL, [0, 0, 0]) for body in self.bodies]
        self.camera = json.loads((folder / "frames" / "camera.json").read_text(encoding="ascii"))

    def rgb(self, index):
        from PIL import Image
        return np.array(Image.open(self.folder / "frames" / "rgb" / ("%06d.png" % index)))


def of_webdataset(folder):
    """By frame, each array and text of the shards; read by tarfile alone."""
    samples = {}
    for path in sorted((folder / "webdataset").glob("*.tar")):
        with tarfile.open(path) as tar:
            for member in tar:
                key, kind = member.name.split(".", 1)
                content = tar.extractfile(member).read()
                samples.setdefault(int(key), {})[kind] = np.load(io.BytesIO(content)) if kind.endswith("npy") else content
    return samples
