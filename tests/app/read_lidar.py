#!/usr/bin/python3
"""Reads the LiDARs of a run by rosbag, numpy and PCL's converter and prints, as JSON, what is in the bag:
of every cloud and scan its layout and a hash of its data. Fails where the PCD and KITTI files differ from
the clouds of the bag.

usage: read_lidar.py RUN SCRATCH
"""
import hashlib
import json
import os
import subprocess
import sys

import numpy as np
import rosbag

TYPES = {4: "<u2", 7: "<f4"}


def points_of(message):
    layout = np.dtype({"names": [f.name for f in message.fields],
                       "formats": [TYPES[f.datatype] for f in message.fields],
                       "offsets": [f.offset for f in message.fields],
                       "itemsize": message.point_step})
    return np.frombuffer(message.data, layout)


def read_pcd(path, scratch):
    """By PCL: binary to ASCII."""
    text = os.path.join(scratch, "ascii.pcd")
    subprocess.run(["pcl_convert_pcd_ascii_binary", path, text, "0"], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    lines = open(text).read().split("\n")
    fields = next(line for line in lines if line.startswith("FIELDS")).split()[1:]
    rows = [line.split() for line in lines[lines.index("DATA ascii") + 1:] if line]
    return fields, np.array(rows, float)


def check_files(run, name, clouds, scratch):
    for i, cloud in enumerate(clouds):
        points = points_of(cloud)
        kitti = np.fromfile(f"{run}/kitti/{name}/velodyne/{i:06d}.bin", "<f4").reshape(-1, 4)
        for k, field in enumerate(["x", "y", "z"]):
            assert np.array_equal(kitti[:, k], points[field]), (name, i, field)
        assert np.allclose(kitti[:, 3] * 100, points["intensity"], rtol=1e-6), (name, i)
        if i > 1:
            continue
        fields, rows = read_pcd(f"{run}/pcd/{name}/{i:06d}.pcd", scratch)
        assert fields == list(points.dtype.names), fields
        for k, field in enumerate(fields):
            assert np.allclose(rows[:, k], points[field].astype(float), rtol=1e-5, atol=1e-6), (name, i, field)
    assert not os.path.exists(f"{run}/pcd/{name}/{len(clouds):06d}.pcd")


def main(run, scratch):
    result, clouds = {}, {}
    with rosbag.Bag(run + "/mission.bag") as bag:
        for topic, message, _ in bag.read_messages():
            if message._type == "sensor_msgs/PointCloud2":
                clouds.setdefault(topic, []).append(message)
                data = hashlib.sha1(bytes(message.data)).hexdigest()
                layout = [[f.name, f.offset, f.datatype, f.count] for f in message.fields]
                entry = {"size": [message.height, message.width, message.point_step], "fields": layout, "data": data}
            elif message._type == "sensor_msgs/LaserScan":
                data = np.array(message.ranges, "<f4").tobytes() + np.array(message.intensities, "<f4").tobytes()
                angles = np.array([message.angle_min, message.angle_max, message.angle_increment], "<f4").tolist()
                entry = {"size": len(message.ranges), "angles": angles, "data": hashlib.sha1(data).hexdigest()}
            else:
                continue
            entry["frame"] = message.header.frame_id
            result.setdefault(topic, []).append(entry)
    for topic, list_of in clouds.items():
        check_files(run, topic.split("/")[1], list_of, scratch)
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
