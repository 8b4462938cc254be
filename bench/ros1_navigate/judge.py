"""judge_navigation.py RUN: where the robot of a drive truly was at its end, from where it started, and what it touched.

RUN is the folder of `rubble run` on the mission that the drive left. Body and flippers of the crawler touch no level
ground: where one begins to be pressed, it touches debris."""

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
poses = []
with open(sys.argv[1] + "/robots/crawler.txt") as file:
    for line in file:
        if not line.startswith("#"):
            _, x, y, _, _, _, qz, qw = map(float, line.split())
            poses.append((x, y, 2 * math.atan2(qz, qw)))
(x0, y0, yaw0), (x1, y1, yaw1) = poses[0], poses[-1]
c, s = math.cos(yaw0), math.sin(yaw0)
way = sum(math.hypot(b[0] - a[0], b[1] - a[1]) for a, b in zip(poses, poses[1:]))
with open(sys.argv[1] + "/manifest.json") as file:
    moved = json.load(file)["metrics"]["robot_pieces_moved"]
print(json.dumps({
    "ahead_m": round(c * (x1 - x0) + s * (y1 - y0), 3), "aside_m": round(c * (y1 - y0) - s * (x1 - x0), 3),
    "yaw_rad": round(math.remainder(yaw1 - yaw0, 2 * math.pi), 3), "way_m": round(way, 2), "touched": touched,
    "hardest_n": round(pressed, 1), "pieces_moved": int(moved)}))
