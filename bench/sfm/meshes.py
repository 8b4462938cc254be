#!/usr/bin/python3
"""Fuses the true depth of a recorded ROS bag along the true poses.

usage: meshes.py BAG OUT

Writes OUT/fused_tsdf.ply, a mesh by Open3D's signed distance volume of 2 cm voxels, and OUT/fused_points.ply,
its points with normals, for `colmap poisson_mesher`.
"""
import pathlib
import sys

import numpy as np
import open3d as o3d
import rosbag

import slam


def write_points(path, cloud):
    kind = np.dtype([("p", "<f4", 3), ("n", "<f4", 3), ("rgb", "u1", 3)])
    points = np.zeros(len(cloud.points), kind)
    points["p"], points["n"] = np.asarray(cloud.points), np.asarray(cloud.normals)
    points["rgb"] = np.round(np.asarray(cloud.colors) * 255)
    names = ["float x", "float y", "float z", "float nx", "float ny", "float nz",
             "uchar red", "uchar green", "uchar blue"]
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n%send_header\n" % (
        len(points), "".join("property %s\n" % name for name in names))
    path.write_bytes(header.encode() + points.tobytes())


def main():
    out = pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    with rosbag.Bag(sys.argv[1]) as bag:
        frames, k, truth = slam.read(bag)
    volume = slam.fuse(frames, k, [truth[stamp] for stamp, _, _ in frames])
    o3d.io.write_triangle_mesh(str(out / "fused_tsdf.ply"), volume.extract_triangle_mesh())
    write_points(out / "fused_points.ply", volume.extract_point_cloud())


if __name__ == "__main__":
    main()
