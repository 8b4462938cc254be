#!/usr/bin/python3
"""MRPT's own programs on a recorded rawlog and simplemap: `icp-slam`, which follows the robot in the plane by
laying each frame's points on the map so far, and `observations2map`, which builds a point map at given poses.

usage: mrpt.py MISSION.simplemap OUT.ply      builds the map
"""
import pathlib
import subprocess
import sys

import numpy as np

POINT_MAP = """
pointsMap_count = 1
[{section}_pointsMap_00_insertOpts]
minDistBetweenLaserPoints = {spacing}
isPlanarMap = false
"""
# For frames that move by centimetres. Wider thresholds (0.5 m) gave as short a track.
ICP_SLAM = """
[MappingApplication]
rawlog_file = {rawlog}
rawlog_offset = 0
logOutput_dir = {out}
LOG_FREQUENCY = 1000000
SAVE_POSE_LOG = false
SAVE_3D_SCENE = false
CAMERA_3DSCENE_FOLLOWS_ROBOT = false
SHOW_PROGRESS_3D_REAL_TIME = false
verbosity_level = WARN
insertionLinDistance = 0.05
insertionAngDistance = 3
localizationLinDistance = 0.01
localizationAngDistance = 1
minICPgoodnessToAccept = 0.3
matchAgainstTheGrid = false
likelihoodMapSelection = -1
""" + POINT_MAP.format(section="MappingApplication", spacing=0.05) + """
[ICP]
ICP_algorithm = icpClassic
maxIterations = 60
thresholdDist = 0.15
thresholdAng_deg = 10
ALFA = 0.8
smallestThresholdDist = 0.03
onlyUniqueCorrespondences = false
corresponding_points_decimation = 20
"""
MAP = "[MappingApplication]" + POINT_MAP.format(section="MappingApplication", spacing=0.02)


def run(words, log):
    with open(log, "ab") as sink:
        code = subprocess.run([str(w) for w in words], stdin=subprocess.DEVNULL, stdout=sink, stderr=sink).returncode
    if code:
        raise SystemExit("%s failed with %d; see %s" % (words[0], code, log))


def rawlog_edit(*words, log):
    run(["rawlog-edit", *words, "--overwrite"], log)


def follow(rawlog, work):
    """The plane pose (x, y, yaw) of the robot at each frame, from where it was at the first; unit: m, rad. The
    program is given the camera alone: the recorded ground truth is taken out first."""
    work.mkdir(parents=True, exist_ok=True)
    log, camera, points = work / "mrpt.log", work / "camera.rawlog", work / "points.rawlog"
    rawlog_edit("--input", rawlog, "--output", camera, "--keep-label", "camera", log=log)
    rawlog_edit("--input", camera, "--output", points, "--generate-3d-pointclouds", log=log)
    config = work / "icp_slam.ini"
    config.write_text(ICP_SLAM.format(rawlog=points, out=work / "icp_slam"))
    run(["icp-slam", config], log)
    camera.unlink()
    points.unlink()
    return np.loadtxt(work / "icp_slam" / "log_estimated_path.txt")[:, 1:4]


def build_map(simplemap, ply):
    work = ply.parent / "observations2map"
    work.mkdir(parents=True, exist_ok=True)
    (work / "map.ini").write_text(MAP)
    run(["observations2map", work / "map.ini", simplemap, work / "map"], work / "mrpt.log")
    points = np.loadtxt(next(work.glob("map*PointsMap*.txt")), dtype="<f4")[:, :3]
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n%send_header\n" % (
        len(points), "".join("property float %s\n" % axis for axis in "xyz"))
    ply.write_bytes(header.encode() + points.tobytes())


if __name__ == "__main__":
    build_map(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
