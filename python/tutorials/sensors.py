"""Look at a pile with a camera, a depth camera and a LiDAR: python3 sensors.py MISSION.lua"""
import sys

import numpy as np

import rubble

pile = rubble.settle(sys.argv[1], seed=3)
eye = rubble.look_at([-3.5, -1, 1.5], [0, 0, 0.3])

frame = rubble.Renderer(pile).render(eye, 160, 120, fov_deg=80)
print("colour", frame["rgb"].shape, "mean", frame["rgb"].mean().round(1))

# The same depth twice: by the renderer, and by exact rays.
depth = rubble.DepthCamera(pile, 160, 120, fov_deg=80, max_range=50).depth(eye)
seen = np.isfinite(frame["depth"]) & np.isfinite(depth)
print(f"{seen.mean():.0%} of the pixels see something; largest difference "
      f"{np.median(np.abs(frame['depth'][seen] - depth[seen])):.2e} m (median)")

points = rubble.Lidar(pile, "vlp16").scan(eye)
xyz = np.stack([points["x"], points["y"], points["z"]], axis=1).astype(float)
in_world = xyz @ rubble.matrix(eye)[:3, :3].T + eye[:3]
print(len(points), "echoes of", len(np.unique(points["ring"])), "rings; lowest", in_world[:, 2].min().round(3), "m")
