"""Every format against every other: poses, stamps, pictures, intrinsics, numbers of messages."""
import csv
import glob
import json
import os
import re
import shutil
import subprocess

import numpy as np

import geometry
import pictures
from dataset import decode_image, nanoseconds, need, read_tum
from judges_geometry import read_pcd


def bag_is_mcap(data):
    """The same topics, types, stamps and values in both."""
    if data.bag is None or data.mcap is None:
        return
    used = [{(topic, kind) for topic, kind in recording.types.items() if recording.topics[topic]} for recording in (data.bag, data.mcap)]
    need(used[0] == used[1], "topics differ: %s", sorted(used[0] ^ used[1]))
    for topic in data.bag.topics:
        one, other = data.bag.topics[topic], data.mcap.topics[topic]
        need(len(one) == len(other), "%s: %d messages in the bag, %d in the MCAP file", topic, len(one), len(other))
        for k, (a, b) in enumerate(zip(one, other)):
            need(repr(a) == repr(b), "%s: message %d differs between bag and MCAP file", topic, k)


def pictures_are_equal(data):
    """Colour pictures of each folder are those of the recording; depth within the rounding of each format."""
    for camera in data.cameras:
        sources = {}
        for name, pattern in (("frames", camera.file("frames", "rgb", "*.png")), ("tum", camera.file("tum", "rgb", "*.png")),
                              ("colmap", data.file("colmap", "images", colmap_eye(data, camera), "*.png"))):
            files = sorted(glob.glob(pattern))
            if files:
                sources[name] = [pictures.read_png(path) for path in files]
        if data.recording is not None and data.recording.messages(camera.topic("/rgb/image_raw")):
            sources["recording"] = [decode_image(m) for m in data.recording.messages(camera.topic("/rgb/image_raw"))]
        count = len(camera.poses[0])
        for name, found in sources.items():
            need(len(found) == count, "%s: %d pictures in %s, %d poses", camera.name, len(found), name, count)
        names = list(sources)
        for other in names[1:]:
            for k, (a, b) in enumerate(zip(sources[names[0]], sources[other])):
                need(np.array_equal(a, b), "%s: picture %d differs between %s and %s", camera.name, k, names[0], other)
        if "tum" in sources:
            depths, rounding = camera.frames_of("depth")
            if depths is not None:
                for k, path in enumerate(sorted(glob.glob(camera.file("tum", "depth", "*.png")))):
                    found = pictures.read_png(path) / 5000.0
                    wanted = np.where((depths[k] > 0) & (depths[k] < 65535.5 / 5000), depths[k], 0)
                    wanted = np.where(np.isnan(wanted), 0, wanted)
                    both = (found > 0) & (wanted > 0)
                    need((np.abs(found - wanted)[both] < 2e-4 + rounding).all() and ((found > 0) == (wanted > 0)).mean() > 0.999,
                         "%s: depth %d of the TUM folder is not that of the recording", camera.name, k)


def poses_are_equal(data):
    """groundtruth.txt, TUM, EuRoC, COLMAP, frames and /ground_truth/pose name the same poses at the same stamps."""
    for camera in data.cameras:
        stamps, places, turns = camera.poses
        if os.path.exists(camera.file("tum", "groundtruth.txt")):
            compare(camera.poses, read_tum(camera.file("tum", "groundtruth.txt")), camera.name + ": tum/groundtruth.txt")
            with open(camera.file("tum", "rgb.txt"), encoding="ascii") as file:
                found = [nanoseconds(line.split()[0]) for line in file if not line.startswith("#")]
            need(found == stamps.tolist(), "%s: stamps of rgb.txt are not those of the poses", camera.name)
        if data.has("colmap", "sparse", "images.txt"):
            eye = colmap_eye(data, camera)
            left = [(p, t) for name, p, t in read_colmap(data.file("colmap", "sparse", "images.txt")) if os.path.dirname(name) == eye]
            compare(camera.poses, (stamps, np.array([p for p, _ in left]), np.array([t for _, t in left])),
                    camera.name + ": colmap/sparse/images.txt")
        if os.path.exists(camera.file("frames", "poses.csv")):
            with open(camera.file("frames", "poses.csv"), encoding="ascii") as file:
                rows = list(csv.DictReader(file))
            found = np.array([[float(row[a]) for a in "xyz"] for row in rows])
            rotations = np.array([geometry.matrix(*(float(row["q" + a]) for a in "wxyz")) @ geometry.BODY_FROM_OPTICAL
                                  for row in rows])
            compare(camera.poses, (np.array([int(row["stamp_ns"]) for row in rows]), found, rotations),
                    camera.name + ": frames/poses.csv")
        if data.recording is not None:
            messages = data.recording.messages(camera.topic("/rgb/image_raw")) or \
                data.recording.messages(camera.topic("/rgb/image_raw/compressed"))
            need([m["header"]["stamp"] for m in messages] == stamps.tolist(), "%s: stamps of the pictures are not those of the poses",
                 camera.name)
            truth = data.recording.messages("/ground_truth/pose")
            if not data.scenario["cameras"] and truth:
                found = [m["pose"] for m in truth]
                compare(camera.poses, (np.array([m["header"]["stamp"] for m in truth]),
                                       np.array([[p["position"][a] for a in "xyz"] for p in found]),
                                       np.array([geometry.matrix(*(p["orientation"][a] for a in "wxyz")) @ geometry.BODY_FROM_OPTICAL
                                                 for p in found])), "/ground_truth/pose")


def compare(wanted, found, what):
    need(len(wanted[0]) == len(found[0]) and np.array_equal(wanted[0], found[0]), "%s: stamps differ from those of groundtruth.txt",
         what)
    if len(wanted[0]):
        error = float(np.abs(wanted[1] - found[1]).max())
        angle = max(geometry.angle_between(a, b) for a, b in zip(wanted[2], found[2]))
        need(error < 2e-6 and angle < 2e-4, "%s: poses differ by %.2g m, %.2g rad from groundtruth.txt", what, error, angle)


def colmap_eye(data, camera):
    """The folder of the pictures of the camera, the left ones of a pair, below colmap/images."""
    parts = [camera.name] if len(data.cameras) > 1 else []
    return "/".join(parts + (["left"] if camera.settings.get("stereo_baseline") else []))


def read_colmap(path):
    """(file, centre, world_from_optical) of each picture."""
    with open(path, encoding="utf-8") as file:
        lines = [line.rstrip("\n") for line in file if not line.startswith("#")]
    for line in lines[0::2]:
        words = line.split()
        rotation = geometry.matrix(*map(float, words[1:5]))
        yield words[9], -rotation.T @ np.array([float(word) for word in words[5:8]]), rotation.T


def intrinsics_are_equal(data):
    """CameraInfo, COLMAP, camera.json, calibration.txt and EuRoC's sensor.yaml have the lens of the scenario."""
    for number, camera in enumerate(data.cameras):
        k, model, coefficients = camera.lens
        found = {}
        if data.recording is not None:
            for end in ("/rgb/camera_info", "/depth_registered/camera_info"):
                for message in data.recording.messages(camera.topic(end))[:1]:
                    found[end] = ([message["k"][i] for i in (0, 4, 2, 5)], message["d"])
                    need(message["distortion_model"] == {"fisheye": "equidistant"}.get(model, model), "%s: model %s", end,
                         message["distortion_model"])
                    need((message["width"], message["height"]) == (camera.settings["width"], camera.settings["height"]),
                         "%s: %dx%d", end, message["width"], message["height"])
        if os.path.exists(camera.file("frames", "camera.json")):
            with open(camera.file("frames", "camera.json"), encoding="utf-8") as file:
                item = json.load(file)
            found["camera.json"] = ([item["fx"], item["fy"], item["cx"], item["cy"]], item["distortion"])
        if os.path.exists(camera.file("tum", "calibration.txt")):
            with open(camera.file("tum", "calibration.txt"), encoding="ascii") as file:
                numbers = [float(word) for word in " ".join(line for line in file if not line.startswith("#")).split()]
            found["calibration.txt"] = (numbers[:4], numbers[4:])
        if data.has("colmap", "sparse", "cameras.txt"):
            before = sum(2 if other.settings.get("stereo_baseline") else 1 for other in data.cameras[:number])
            with open(data.file("colmap", "sparse", "cameras.txt"), encoding="ascii") as file:
                words = [line for line in file if not line.startswith("#")][before].split()
            numbers = [float(word) for word in words[4:]]
            found["cameras.txt"] = ([numbers[0], numbers[1], numbers[2] - 0.5, numbers[3] - 0.5], numbers[4:])
        for name, (focal, distortion) in found.items():
            need(np.allclose(focal, [k[0], k[4], k[2], k[5]], rtol=1e-8, atol=1e-6), "%s: %s has the intrinsics %s, expected %s",
                 camera.name, name, focal, [k[0], k[4], k[2], k[5]])
            size = min(len(distortion), len(coefficients))
            need(np.allclose(distortion[:size], coefficients[:size], atol=1e-9), "%s: %s has the distortion %s, expected %s",
                 camera.name, name, list(distortion), coefficients)


def inertial_files_are_equal(data):
    """IMU samples of the recording, of frames/ and of EuRoC."""
    if data.recording is None or not data.scenario["imu"]["on"]:
        return
    topic = data.scenario["imu"]["topic"] or "/imu"
    samples = [(m["header"]["stamp"], *(m["angular_velocity"][a] for a in "xyz"), *(m["linear_acceleration"][a] for a in "xyz"))
               for m in data.recording.messages(topic)]
    for path, names in ((data.file("frames", "imu.csv"), None), (data.file("euroc", "mav0", "imu0", "data.csv"), None)):
        if not os.path.exists(path):
            continue
        with open(path, encoding="ascii") as file:
            rows = [line.strip().split(",") for line in file if line[:1].isdigit()]
        found = [(int(row[0]), *map(float, row[1:7])) for row in rows]
        need(len(found) == len(samples), "%s has %d samples, the recording %d", os.path.basename(path), len(found), len(samples))
        need(np.allclose([row[1:] for row in found], [row[1:] for row in samples], atol=1e-9) and
             [row[0] for row in found] == [row[0] for row in samples], "samples of %s are not those of the recording", path)


def scan_files_are_equal(data):
    """PCD, KITTI and PointCloud2 have the same points."""
    for name, lidar in data.scenario["lidars"].items():
        pcd = sorted(glob.glob(data.file("pcd", name, "*.pcd")))
        kitti = sorted(glob.glob(data.file("kitti", name, "velodyne", "*.bin")))
        clouds = [read_pcd(path) for path in pcd]
        points = [np.stack([cloud[axis] for axis in ("x", "y", "z", "intensity")], axis=1) for cloud in clouds]
        if pcd and kitti:
            need(len(pcd) == len(kitti), "%s: %d PCD files, %d KITTI files", name, len(pcd), len(kitti))
            for k, path in enumerate(kitti):
                found = np.fromfile(path, "<f4").reshape(-1, 4)
                need(found.shape == points[k].shape and np.array_equal(found[:, :3], points[k][:, :3]),
                     "%s: scan %d differs between KITTI and PCD", name, k)
        if data.recording is None:
            continue
        end = "scan" if lidar["model"] == "utm30lx" else "points"
        topics = [lidar["topic"]] if lidar["topic"] else ["/%s/%s" % (name, end), "/" + end]
        topics = [topic for topic in topics if data.recording.messages(topic)]
        need(topics, "no topic of the LiDAR %s", name)
        messages = data.recording.messages(topics[0])
        if pcd:
            need(len(messages) == len(pcd), "%s: %d messages, %d PCD files", name, len(messages), len(pcd))
        if pcd and "points" in messages[0]:  # Livox
            for k, message in enumerate(messages):
                found = np.array([[point[a] for a in "xyz"] for point in message["points"]], np.float32).reshape(-1, 3)
                need(np.array_equal(found, points[k][:, :3].astype(np.float32)), "%s: scan %d differs between the recording and PCD", name, k)
        if pcd and "point_step" in messages[0]:
            for k, message in enumerate(messages):
                record = np.dtype({"names": [f["name"] for f in message["fields"]],
                                   "formats": [{7: "<f4", 4: "<u2", 2: "u1", 6: "<u4", 8: "<f8"}[f["datatype"]] for f in message["fields"]],
                                   "offsets": [f["offset"] for f in message["fields"]], "itemsize": message["point_step"]})
                found = np.frombuffer(bytes(message["data"]), record)
                finite = found[np.isfinite(found["x"])]
                need(len(finite) == len(clouds[k]) and all(np.array_equal(finite[a], clouds[k][a]) for a in "xyz"),
                     "%s: scan %d differs between the recording and PCD", name, k)


def rawlog_meets_recording(data):
    """What MRPT's rawlog-edit reads: labels and their numbers, inertial readings, true poses."""
    if not data.has("mission.rawlog") or shutil.which("rawlog-edit") is None:
        return
    info = subprocess.run(["rawlog-edit", "--info", "-i", data.file("mission.rawlog")], capture_output=True, text=True, check=False)
    need(info.returncode == 0, "rawlog-edit cannot read mission.rawlog: %s", info.stderr.strip()[-200:])
    counts = {label: int(count) for label, count in re.findall(r"\(Label/Occurs/Rate/Durat\.\) :\s+(\S+) /\s*(\d+)", info.stdout)}
    actions = data.scenario["outputs"]["rawlog_format"] == "actions"
    for camera in data.cameras:
        need(counts.get(camera.name) == len(camera.poses[0]), "the rawlog has %s observations of %s, groundtruth.txt %d poses",
             counts.get(camera.name), camera.name, len(camera.poses[0]))
    if data.recording is not None and data.scenario["imu"]["on"] and not actions:
        samples = len(data.recording.messages(data.scenario["imu"]["topic"] or "/imu"))
        need(counts.get("imu") == samples, "the rawlog has %s inertial readings, the recording %d", counts.get("imu"), samples)
    for name in data.scenario["lidars"]:
        pcd = glob.glob(data.file("pcd", name, "*.pcd"))
        if pcd and not actions:
            need(counts.get(name) == len(pcd), "the rawlog has %s scans of %s, there are %d PCD files", counts.get(name), name, len(pcd))


def euroc_meets_poses(data):
    """State and camera rows of the EuRoC folder: stamps and body poses."""
    if not data.has("euroc", "mav0"):
        return
    with open(data.file("euroc", "mav0", "state_groundtruth_estimate0", "data.csv"), encoding="ascii") as file:
        rows = [[float(word) if i else int(word) for i, word in enumerate(line.strip().split(","))] for line in file if line[:1].isdigit()]
    # cam0 is the first camera in the order of the names.
    camera = sorted(data.cameras, key=lambda item: item.name)[0]
    with open(data.file("euroc", "mav0", "cam0", "data.csv"), encoding="ascii") as file:
        stamps = [int(line.split(",")[0]) for line in file if line[:1].isdigit()]
    need(stamps == camera.poses[0].tolist(), "cam0 of EuRoC has other stamps than %s", camera.name)
    if data.scenario["cameras"]:
        return
    state = {row[0]: row for row in rows}
    for stamp, place, turned in zip(*camera.poses):
        need(int(stamp) in state, "EuRoC has no state at %d", stamp)
        row = state[int(stamp)]
        body = turned @ geometry.BODY_FROM_OPTICAL.T
        error = float(np.abs(np.array(row[1:4]) - place).max())
        need(error < 2e-6 and geometry.angle_between(geometry.matrix(*row[4:8]), body) < 2e-4,
             "EuRoC's state at %d is %.2g m beside groundtruth.txt", stamp, error)


JUDGES = [bag_is_mcap, pictures_are_equal, poses_are_equal, intrinsics_are_equal, inertial_files_are_equal, scan_files_are_equal,
          rawlog_meets_recording, euroc_meets_poses]
