"""check_robot.py DIR: what was heard of a robot while it was driven, DIR/live.bag, is in the bag of the run of its
first leg, DIR/leg_001/mission.bag: joints, odometry, contacts, inertial readings and scans, byte for byte."""

import sys

import rosbag

folder = sys.argv[1]
live, run = rosbag.Bag(folder + "/live.bag"), rosbag.Bag(folder + "/leg_001/mission.bag")


def raw(bag, topic):
    return [data for _, (_, data, _, *_), _ in bag.read_messages(topic, raw=True)]


for topic, least in (("/odom", 60), ("/joint_states", 60), ("/contacts", 60), ("/imu", 60), ("/scan", 15)):
    heard, recorded = raw(live, topic), raw(run, topic)
    of_leg = [data for data in heard if data in set(recorded)]
    if len(of_leg) < least:
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
