"""check_robot.py DIR: what was heard of a robot while it was driven, DIR/live.bag, is in the bag of the run of its
first leg, DIR/leg_001/mission.bag: joints, odometry and inertial readings byte for byte, scans to a millimetre."""

import sys

import rosbag

folder = sys.argv[1]
live, run = rosbag.Bag(folder + "/live.bag"), rosbag.Bag(folder + "/leg_001/mission.bag")


def raw(bag, topic):
    return [data for _, (_, data, _, *_), _ in bag.read_messages(topic, raw=True)]


for topic in ("/odom", "/joint_states", "/imu"):
    heard, recorded = raw(live, topic), raw(run, topic)
    of_leg = [data for data in heard if data in set(recorded)]
    if len(of_leg) < 60:
        sys.exit("%s: only %d of %d are of the first leg" % (topic, len(of_leg), len(heard)))
    first = recorded.index(of_leg[0])
    if heard[:len(of_leg)] != recorded[first:first + len(of_leg)]:
        sys.exit(topic + ": not the recording's messages in their order")
stamps = [m.header.stamp for _, m, _ in live.read_messages("/odom")]
if any(after <= before for before, after in zip(stamps, stamps[1:])):
    sys.exit("time jumped back")
odometry = [m for _, m, _ in live.read_messages("/odom")]
if max(m.twist.twist.linear.x for m in odometry) < 0.3:
    sys.exit("it did not move")

recorded = {m.header.stamp: m.ranges for _, m, _ in run.read_messages("/scan")}
scans, rays, off = 0, 0, 0
for _, scan, _ in live.read_messages("/scan"):
    if scan.header.stamp not in recorded or scans == len(recorded):
        continue
    if scan.header.stamp > max(recorded):
        break
    scans += 1
    for a, b in zip(scan.ranges, recorded[scan.header.stamp]):
        if a != b:
            rays, off = rays + 1, off + (not abs(a - b) < 1e-3)
        elif a < 60:
            rays += 1
if scans < 15 or rays < 1000 or off > rays // 100:
    sys.exit("scans: %d, rays that met something: %d, elsewhere: %d" % (scans, rays, off))
