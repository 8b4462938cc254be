"""Which SLAM systems judge which flights of the demonstration (plan.py has the flights)."""
import collections

import plan

# kind: of the recording that it reads. flights: names of plan.ROWS. scaled: whether its maps have a scale of their own, which
# the evaluation finds. runs: systems whose threads make them vary run more than once.
Judge = collections.namedtuple("Judge", "name title kind scaled runs")
JUDGES = [
    Judge("orbslam3_rgbd", "ORB-SLAM3, RGB-D", "camera", False, 3),
    Judge("orbslam3_monocular", "ORB-SLAM3, monocular", "camera", True, 3),
    Judge("orbslam3_stereo", "ORB-SLAM3, stereo", "camera", False, 3),
    Judge("orbslam3_rgbd_inertial", "ORB-SLAM3, RGB-D and IMU", "camera", False, 3),
    Judge("orbslam3_stereo_inertial", "ORB-SLAM3, stereo and IMU", "camera", False, 3),
    Judge("orbslam3_monocular_inertial", "ORB-SLAM3, monocular and IMU", "camera", False, 3),
    Judge("kiss_icp", "KISS-ICP", "lidar", False, 1),
    Judge("kiss_icp_near", "KISS-ICP, 20 m", "lidar", False, 1),
    Judge("genz_icp", "GenZ-ICP", "lidar", False, 1),
    Judge("rko_lio", "RKO-LIO", "lidar", False, 1),
    Judge("rko_lio_near", "RKO-LIO, from 0.3 m", "lidar", False, 1),
]
FLIGHTS = {"camera": ("exterior", "dark", "night_15", "night_200"), "lidar": ("exterior", "dark", "smoke")}
IMU = ("imu.on=true",)
STEREO_BASELINE = 0.1  # unit: m
RECORDINGS = {
    # What a robot's camera module has: a stereo pair, depth in every pixel (the true one, to 13.1 m), an inertial unit.
    "camera": plan.Size("640x480, 15 frames a second, 1,570 pieces", plan.SIZES["small"].pile,
                        ("camera.width=640", "camera.height=480", "trajectory.rate_hz=15", "camera.stereo_baseline=%g" % STEREO_BASELINE) + IMU,
                        ("tum", "euroc"), ("tum/rgb", "tum/depth", "euroc")),
    # A spinning LiDAR for near surroundings on the rig; the camera is there for the times of the true poses.
    "lidar": plan.Size("Ouster OS0, 64 rings, 10 scans a second", plan.SIZES["small"].pile,
                       plan.TINY + ("lidar=true",) + IMU, ("bag",), ("mission.bag",)),
}
LIDAR_IN_BODY = (0, 0, 0.08)  # as in the mission; unit: m


def order(seeds, flights, judges):
    """Every flight of the first seed with all its judges, then of the second: (seed, row, kind, judges)."""
    found = []
    for seed in seeds:
        for kind, names in FLIGHTS.items():
            chosen = [j for j in JUDGES if j.kind == kind and (not judges or j.name in judges)]
            found += [(seed, row, kind, chosen) for row in plan.ROWS if row.name in names and chosen and (not flights or row.name in flights)]
    return found
