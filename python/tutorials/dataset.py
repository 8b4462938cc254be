"""Read what a run recorded: python3 dataset.py RUN"""
import sys

import numpy as np

import rubble

data = rubble.open_dataset(sys.argv[1])
for topic, count in data.topics.items():
    print(f"{count:5d}  {topic}")
stamps, depth = data.images("/camera/depth_registered/image_raw")
k = data.intrinsics()["K"]
print("depth:", len(depth), "images of", depth[0].shape, "from", depth[0][depth[0] > 0].min() / 1000, "m")

# Where the camera was, and the scene of its first picture in the world.
when, where = data.poses()
v, u = np.nonzero(depth[0])
z = depth[0][v, u] / 1000
body = np.stack([z, -(u - k[0, 2]) / k[0, 0] * z, -(v - k[1, 2]) / k[1, 1] * z], axis=1)
world = body @ rubble.matrix(where[0])[:3, :3].T + where[0, :3]
print("its points reach from", world.min(axis=0).round(2), "to", world.max(axis=0).round(2))
