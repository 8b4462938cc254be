#!/usr/bin/python3
"""Reads a bag of several cameras with rosbag and numpy alone and prints, as JSON, what is in it: of every
topic with a header its frame and stamps; the transforms; and how far the depth images, unprojected by
camera info and the chain of transforms, lie from the ground z = 0.

usage: read_cameras.py BAG DEPTH_TOPIC...
"""
import json
import sys

import numpy as np
import rosbag


def matrix(transform):
    t, q = transform.translation, transform.rotation
    w, x, y, z = q.w, q.x, q.y, q.z
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                 [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                 [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    m[:3, 3] = [t.x, t.y, t.z]
    return m


def main(path, depth_topics):
    headers, fixed, moving, infos, depths = {}, {}, {}, {}, {}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages():
            if hasattr(message, "header"):
                entry = headers.setdefault(topic, {"frame": message.header.frame_id, "stamps": []})
                entry["stamps"].append(message.header.stamp.to_nsec())
                assert entry["frame"] == message.header.frame_id or topic.endswith("/contacts")
            if topic == "/tf_static":
                for t in message.transforms:
                    fixed[t.child_frame_id] = (t.header.frame_id, matrix(t.transform))
            elif topic == "/tf":
                for t in message.transforms:
                    moving[(t.child_frame_id, t.header.stamp.to_nsec())] = matrix(t.transform)
            elif topic.endswith("/camera_info"):
                infos[topic] = message
            elif topic in depth_topics:
                depths.setdefault(topic, []).append(message)
    result = {"headers": headers, "fixed": {c: p for c, (p, _) in fixed.items()}, "planes": {}}
    for topic in depth_topics:
        info = infos[topic.rsplit("/", 1)[0] + "/camera_info"]
        worst, points, eyes = 0.0, 0, []
        for image in depths[topic]:
            assert image.encoding == "32FC1"
            chain, frame = np.eye(4), image.header.frame_id
            while frame in fixed:
                parent, step = fixed[frame]
                chain, frame = step @ chain, parent
            world = moving[(frame, image.header.stamp.to_nsec())] @ chain
            depth = np.frombuffer(image.data, "<f4").reshape(image.height, image.width)
            v, u = np.nonzero(np.isfinite(depth) & (depth > 0))
            z = depth[v, u].astype(float)
            optical = np.stack([(u - info.K[2]) / info.K[0] * z, (v - info.K[5]) / info.K[4] * z, z])
            height = (world[:3, :3] @ optical)[2] + world[2, 3]
            worst = max(worst, float(np.abs(height).max()) if len(z) else 0.0)
            points += len(z)
            eyes.append(world[:3, 3].tolist() + world[:3, 2].tolist())
        result["planes"][topic] = {"worst": worst, "points": points, "eyes": eyes}
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
