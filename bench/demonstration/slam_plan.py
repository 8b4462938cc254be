"""Which SLAM systems judge which flights of the demonstration (plan.py has the flights)."""
import collections

import plan

# kind: of the recording that it reads. scaled: whether its maps have a scale of their own, which the evaluation finds. runs: systems
# whose threads make them vary run more than once.
Judge = collections.namedtuple("Judge", "name title kind scaled runs")
JUDGES = [
    Judge("orbslam3_rgbd", "ORB-SLAM3, RGB-D", "camera", False, 3),
    Judge("orbslam3_monocular", "ORB-SLAM3, monocular", "camera", True, 3),
    Judge("orbslam3_rgbd_inertial", "ORB-SLAM3, RGB-D and IMU", "camera", False, 3),
    Judge("orbslam3_monocular_inertial", "ORB-SLAM3, monocular and IMU", "camera", False, 3),
    Judge("kiss_icp", "KISS-ICP", "lidar", False, 1),
    Judge("kiss_icp_near", "KISS-ICP, 20 m", "lidar", False, 1),
    Judge("genz_icp", "GenZ-ICP", "lidar", False, 1),
    Judge("rko_lio", "RKO-LIO", "lidar", False, 1),
    Judge("rko_lio_near", "RKO-LIO, from 0.3 m", "lidar", False, 1),
    Judge("orbslam3_stereo", "ORB-SLAM3, stereo", "stereo", False, 3),
    Judge("orbslam3_stereo_inertial", "ORB-SLAM3, stereo and IMU", "stereo", False, 3),
]
# flights: names of plan.ROWS. seeds: how many of the seeds.
Kind = collections.namedtuple("Kind", "flights seeds recording")
SEEN = ("exterior", "dark", "night_15", "night_200")
# Systems with an inertial unit take the beginning for rest.
MOVING = ("imu.on=true", "trajectory.rest_at_ends=true", "trajectory.smoothing=0.25")
VIDEO = ("camera.width=640", "camera.height=480", "trajectory.rate_hz=15") + MOVING
PILE = plan.SIZES["small"].pile
LIDAR_IN_BODY = (0, 0, 0.08)  # as in the mission; unit: m
KINDS = {
    # Depth is the true one in every pixel, to 13.1 m.
    "camera": Kind(SEEN, 5, plan.Size("640x480, 15 frames a second, 1,570 pieces", PILE, VIDEO, ("tum", "euroc"),
                                      ("tum/rgb", "tum/depth", "euroc"))),
    # The camera is there for the times of the true poses; no judge reads its pictures.
    "lidar": Kind(("exterior", "street", "dark", "smoke"), 5, plan.Size("Ouster OS0, 64 rings, 10 scans a second", PILE,
                                                              plan.TINY + ("lidar=true",) + MOVING, ("bag",), ("mission.bag",))),
    "stereo": Kind(SEEN, 2, plan.Size("as camera, with a second one 10 cm to its right", PILE, VIDEO + ("camera.stereo_baseline=0.1",),
                                      ("euroc",), ("euroc",))),
}


def order(seeds, flights, judges):
    """Every flight of the first seed with all its judges, then of the second: (seed, row, kind, judges)."""
    found = []
    for seed in seeds:
        for kind, of in KINDS.items():
            chosen = [j for j in JUDGES if j.kind == kind and (not judges or j.name in judges)]
            found += [(seed, row, kind, chosen) for row in plan.ROWS
                      if row.name in of.flights and seed <= of.seeds and chosen and (not flights or row.name in flights)]
    return found
