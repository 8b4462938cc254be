"""What a judge had to work with, frame by frame: keypoints, and matches with the next frame that agree with the true
motion."""
import csv
import sqlite3

import numpy as np

import carriers

TRUE_WITHIN = 2.0  # distance from the true epipolar line; unit: pixel
PAIRS = 2147483647  # pair_id = PAIRS * first + second


def rotation(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def read_truth(dataset):
    """{name: (R, t) of camera from world}, in the order of names."""
    poses = {}
    for line in (dataset / "colmap" / "sparse" / "images.txt").read_text().splitlines():
        words = line.split()
        if len(words) == 10 and words[0] != "#":
            values = [float(v) for v in words[1:8]]
            poses[words[9]] = rotation(*values[:4]), np.array(values[4:])
    return dict(sorted(poses.items()))


def read_intrinsics(dataset):
    for line in (dataset / "colmap" / "sparse" / "cameras.txt").read_text().splitlines():
        words = line.split()
        if words and words[0] != "#":
            width, height, fx, fy, cx, cy = (float(v) for v in words[2:8])
            return width * height / 1e6, np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])


def blob(row, kind):
    rows, columns, data = row
    return np.frombuffer(data, kind).reshape(rows, columns) if rows else np.zeros((0, max(columns, 2)), kind)


def agree(points_a, points_b, pose_a, pose_b, k):
    """How many pairs of pixels lie within TRUE_WITHIN of the epipolar lines of the true motion, in both frames."""
    (ra, ta), (rb, tb) = pose_a, pose_b
    r = rb @ ra.T
    t = tb - r @ ta
    cross = np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]])
    inverse = np.linalg.inv(k)
    f = inverse.T @ cross @ r @ inverse
    a, b = (np.hstack([p[:, :2], np.ones((len(p), 1))]) for p in (points_a, points_b))
    in_b, in_a = a @ f.T, b @ f
    residual = np.abs(np.sum(b * in_b, 1))
    worst = residual / np.minimum(np.hypot(*in_b.T[:2]), np.hypot(*in_a.T[:2]))
    return int((worst < TRUE_WITHIN).sum())


def read_models(folder):
    """{image: number of the model that has it}; of several, the first."""
    models = {}
    for path in folder.glob("details/*_track.csv"):
        for row in csv.DictReader(open(path)):
            models.setdefault(row["image"], int(row["segment"]))
    return models


def measure(folder, dataset, deepest):
    """deepest: carriers.way_in() of a flight into the void; else None."""
    truth, (megapixels, k), models = read_truth(dataset), read_intrinsics(dataset), read_models(folder)
    names = list(truth)
    centres = np.array([-r.T @ t for r, t in truth.values()])
    into = carriers.metres_into(centres, deepest) if deepest is not None else [None] * len(names)
    database = sqlite3.connect(folder / "database.db")
    ids = dict(database.execute("SELECT name, image_id FROM images"))
    frames = []
    for i, name in enumerate(names):
        points = blob(database.execute("SELECT rows, cols, data FROM keypoints WHERE image_id = ?", (ids[name],)).fetchone(), np.float32)
        frame = {"name": name, "into": into[i] if into[i] is None else round(float(into[i]), 3),
                 "keypoints_mp": round(len(points) / megapixels, 1), "model": models.get(name)}
        if i + 1 < len(names):
            following = blob(database.execute("SELECT rows, cols, data FROM keypoints WHERE image_id = ?",
                                              (ids[names[i + 1]],)).fetchone(), np.float32)
            first, second = sorted((ids[name], ids[names[i + 1]]))
            found = database.execute("SELECT rows, cols, data FROM two_view_geometries WHERE pair_id = ?",
                                     (PAIRS * first + second,)).fetchone()
            pairs = blob(found, np.uint32) if found else np.zeros((0, 2), np.uint32)
            if first != ids[name]:
                pairs = pairs[:, ::-1]
            right = agree(points[pairs[:, 0]], following[pairs[:, 1]], truth[name], truth[names[i + 1]], k) if len(pairs) else 0
            frame["matches_mp"] = round(right / megapixels, 1)
        frames.append(frame)
    database.close()
    return frames
