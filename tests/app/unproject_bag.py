#!/usr/bin/python3
"""Unprojects the depth images of a bag at their recorded poses and measures how far the points lie
from the triangles of an STL file and from the ground z = 0. Reads with rosbag and numpy alone.

usage: unproject_bag.py BAG STL SAMPLES_PER_FRAME
Prints "points N max_mm M median_mm D on_pile K".
"""
import sys

import numpy as np
import rosbag


def read_stl(path):
    data = np.fromfile(path, dtype=np.uint8)
    count = int(data[80:84].view("<u4")[0])
    rows = data[84:84 + 50 * count].reshape(count, 50)
    return rows[:, 12:48].copy().view("<f4").reshape(count, 3, 3).astype(float)


def rotation(q):
    w, x, y, z = q.w, q.x, q.y, q.z
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def squared_distance_to_segments(p, a, b):
    d = b - a
    t = np.clip(np.einsum("ij,ij->i", p - a, d) / np.maximum(np.einsum("ij,ij->i", d, d), 1e-30), 0, 1)
    r = p - (a + t[:, None] * d)
    return np.einsum("ij,ij->i", r, r)


def distance_to_triangles(p, triangles):
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    n = np.cross(b - a, c - a)
    length = np.linalg.norm(n, axis=1)
    n = n / np.maximum(length, 1e-30)[:, None]
    height = np.einsum("ij,ij->i", p - a, n)
    foot = p - height[:, None] * n
    inside = length > 1e-12
    for u, v in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("ij,ij->i", np.cross(v - u, foot - u), n) >= 0
    edges = np.minimum.reduce([squared_distance_to_segments(p, u, v)
                               for u, v in ((a, b), (b, c), (c, a))])
    return float(np.sqrt(np.min(np.where(inside, height * height, edges))))


def main(bag_path, stl_path, samples):
    triangles = read_stl(stl_path)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    camera_from_optical = np.array([[0., 0., 1.], [-1., 0., 0.], [0., -1., 0.]])
    poses, depths, info = {}, {}, None
    with rosbag.Bag(bag_path) as bag:
        for topic, message, _ in bag.read_messages():
            if topic == "/ground_truth/pose":
                poses[message.header.stamp.to_nsec()] = message.pose
            elif topic == "/camera/depth_registered/image_raw":
                assert message.encoding == "16UC1"
                depths[message.header.stamp.to_nsec()] = np.frombuffer(
                    message.data, "<u2").reshape(message.height, message.width) / 1000.0
            elif topic == "/camera/depth_registered/camera_info":
                info = message
    assert depths and depths.keys() == poses.keys(), "a depth image without a pose"
    errors, on_pile = [], 0
    random = np.random.RandomState(1)
    for stamp, depth in sorted(depths.items()):
        pose = poses[stamp]
        r, o = rotation(pose.orientation) @ camera_from_optical, pose.position
        rows, columns = np.nonzero(depth)
        for k in random.choice(len(rows), min(samples, len(rows)), replace=False):
            z = depth[rows[k], columns[k]]
            optical = np.array([(columns[k] - info.K[2]) / info.K[0] * z,
                                (rows[k] - info.K[5]) / info.K[4] * z, z])
            point = r @ optical + np.array([o.x, o.y, o.z])
            ground = abs(point[2])
            near = np.all((low < point + 0.05) & (high > point - 0.05), axis=1)
            pile = distance_to_triangles(point, triangles[near]) if near.any() else np.inf
            on_pile += pile <= ground
            errors.append(min(pile, ground))
    errors = np.array(errors) * 1000
    print("points %d max_mm %.3f median_mm %.3f on_pile %d"
          % (len(errors), errors.max(), np.median(errors), on_pile))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
