"""usage: judge_orbslam3.py DATASET SETTINGS VOCABULARY MODE OUT.csv: ORB-SLAM3 on a recording with tum/ and euroc/. It maps in threads
of its own: each picture waits until these have nothing to do, so the result does not depend on how fast or busy the machine is.
MODE: monocular, rgbd, stereo, with _inertial behind it or not. OUT: for each picture its stamp, the number of the map, and the pose
of the optical frame in it at that time; no map: no pose."""
import os
import pathlib
import sys
import threading
import time

import cv2
import numpy as np
import pyorbslam3 as orb

SENSORS = {"monocular": orb.Sensor.MONOCULAR, "rgbd": orb.Sensor.RGBD, "stereo": orb.Sensor.STEREO,
           "monocular_inertial": orb.Sensor.IMU_MONOCULAR, "rgbd_inertial": orb.Sensor.IMU_RGBD,
           "stereo_inertial": orb.Sensor.IMU_STEREO}


def read_list(path):
    """(stamp, file) of rgb.txt, and in a file of associations (stamp, file, stamp, file)."""
    return [line.split() for line in path.read_text().splitlines() if line and line[0] != "#"]


def read_imu(dataset):
    """Rows of stamp, angular velocity, acceleration, from EuRoC's table in nanoseconds."""
    rows = np.loadtxt(dataset / "euroc" / "mav0" / "imu0" / "data.csv", delimiter=",", comments="#")
    rows[:, 0] *= 1e-9
    return rows[:, :7]


def read_grey(path):
    picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if picture is None:
        raise SystemExit("%s: no picture" % path)
    return picture


def pictures(dataset, kind):
    """(stamp, arguments of the tracker) of every picture."""
    if kind == "stereo":
        cameras = dataset / "euroc" / "mav0"
        for row in (cameras / "cam0" / "data.csv").read_text().splitlines():
            if row and row[0] != "#":
                stamp, name = row.split(",")[:2]
                yield int(stamp) * 1e-9, [read_grey(cameras / cam / "data" / name.strip()) for cam in ("cam0", "cam1")]
    else:
        for stamp, rgb, _, depth in read_list(dataset / "tum" / "associations.txt"):
            colour = cv2.imread(str(dataset / "tum" / rgb))[:, :, ::-1]
            frames = [np.ascontiguousarray(colour)]
            if kind == "rgbd":  # in units of the file: RGBD.DepthMapFactor has them
                frames.append(cv2.imread(str(dataset / "tum" / depth), cv2.IMREAD_UNCHANGED).astype(np.float32))
            yield float(stamp), frames


def quaternion(m):
    """x y z w (Bar-Itzhack 2000)."""
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0], [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                  [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], 0],
                  [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m.trace()]])
    values, vectors = np.linalg.eigh(k)
    return vectors[:, values.argmax()]


POLL = 0.005          # between two looks at the other threads; unit: s
POLLS = 4             # of theirs without work after which they count as idle: they look for work every 3 to 5 ms
LOOK = 1e-4           # processor time of such a poll, at most; unit: s
LONGEST = 20.0        # wait; unit: s


def used_by_others():
    """Processor time of the other threads in seconds, and how often they got a processor. A thread that finds no work sleeps again at
    once, however busy the machine is; one that works keeps its processor."""
    used = times = 0
    for task in pathlib.Path("/proc/self/task").iterdir():
        if int(task.name) != threading.get_native_id():
            try:
                words = (task / "schedstat").read_text().split()
            except OSError:  # it has just ended
                continue
            used, times = used + int(words[0]) * 1e-9, times + int(words[2])
    return used, times


def wait_for_mapping():
    end, (used, times) = time.monotonic() + LONGEST, used_by_others()
    while time.monotonic() < end:
        time.sleep(POLL)
        now, turns = used_by_others()
        if turns - times < POLLS and now - used < POLLS * LOOK:
            continue  # too little has been seen
        if now - used < LOOK * (turns - times):
            return
        used, times = now, turns


def main():
    dataset, settings, vocabulary, mode, out = sys.argv[1:]
    dataset, kind = pathlib.Path(dataset), mode.split("_")[0]
    imu = read_imu(dataset) if mode.endswith("_inertial") else None
    slam = orb.Slam(vocabulary, settings, SENSORS[mode])
    track = {"monocular": slam.track_monocular, "rgbd": slam.track_rgbd, "stereo": slam.track_stereo}[kind]
    number, followed, before = 0, False, -np.inf
    with open(out, "w") as file:
        for stamp, frames in pictures(dataset, kind):
            fed = {} if imu is None else {"imu": imu[(imu[:, 0] > before) & (imu[:, 0] <= stamp)]}
            result, before = track(*frames, stamp, **fed), stamp
            wait_for_mapping()
            good = result.state in (orb.TrackingState.OK, orb.TrackingState.OK_KLT) and result.pose_valid
            if followed and not good and result.state != orb.TrackingState.RECENTLY_LOST:
                number, followed = number + 1, False  # what comes next is another map, unless a place is recognised
            if good:
                followed = True
                pose = np.asarray(result.pose_wc, float)
                values = " ".join("%.9f" % v for v in [*pose[:3, 3], *quaternion(pose[:3, :3])])
                file.write("%.9f,%d,%s\n" % (stamp, number, values.replace(" ", ",")))
            else:
                file.write("%.9f,,,,,,,,\n" % stamp)
            file.flush()
    os._exit(0)  # all is written, and its threads do not always end


if __name__ == "__main__":
    main()
