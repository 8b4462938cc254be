"""judge.py RUN [LOG]: where the robot of a drive truly was at its end, from where it started, and what it touched.

RUN is the folder of `rubble run` on the mission that the drive left, LOG what ros1_navigator --log wrote: how wrong its poses
were. Body and flippers of the crawler touch no level ground: where one begins to be pressed, it touches debris."""

import bisect
import csv
import json
import math
import sys

import rosbag

PRESSED = 1.0  # N
touching, touched, pressed = {}, 0, 0.0
for _, message, _ in rosbag.Bag(sys.argv[1] + "/mission.bag").read_messages("/contacts"):
    link, f = message.header.frame_id, message.wrench.force
    force = math.sqrt(f.x ** 2 + f.y ** 2 + f.z ** 2)
    if link != "base_link" and "flipper" not in link:
        continue
    if force > PRESSED and not touching.get(link):
        touched += 1
    touching[link] = force > PRESSED
    pressed = max(pressed, force)
stamps, poses = [], []
with open(sys.argv[1] + "/robots/crawler.txt") as file:
    for line in file:
        if not line.startswith("#"):
            stamp, x, y, _, _, _, qz, qw = map(float, line.split())
            stamps.append(stamp)
            poses.append((x, y, 2 * math.atan2(qz, qw)))
(x0, y0, yaw0), (x1, y1, yaw1) = poses[0], poses[-1]
c, s = math.cos(yaw0), math.sin(yaw0)
errors = {}
if len(sys.argv) > 2:
    off, turned = [0.0], [0.0]
    with open(sys.argv[2]) as file:
        for row in csv.DictReader(file):
            x, y, yaw = poses[min(bisect.bisect_left(stamps, float(row["stamp_s"]) - 1e-6), len(poses) - 1)]
            ahead, aside = c * (x - x0) + s * (y - y0), c * (y - y0) - s * (x - x0)
            off.append(math.hypot(float(row["x_m"]) - ahead, float(row["y_m"]) - aside))
            turned.append(abs(math.remainder(float(row["yaw_rad"]) - (yaw - yaw0), 2 * math.pi)))
    errors = {"worst_m": round(max(off), 3), "worst_rad": round(max(turned), 3)}
way = sum(math.hypot(b[0] - a[0], b[1] - a[1]) for a, b in zip(poses, poses[1:]))
with open(sys.argv[1] + "/manifest.json") as file:
    moved = json.load(file)["metrics"]["robot_pieces_moved"]
print(json.dumps({
    "ahead_m": round(c * (x1 - x0) + s * (y1 - y0), 3), "aside_m": round(c * (y1 - y0) - s * (x1 - x0), 3),
    "yaw_rad": round(math.remainder(yaw1 - yaw0, 2 * math.pi), 3), "way_m": round(way, 2), "touched": touched,
    "hardest_n": round(pressed, 1), "pieces_moved": int(moved), **errors}))
