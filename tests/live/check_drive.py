"""check_drive.py DIR heard|unheard: the first leg in DIR went as drive_by_topics.py asked for, and what
was heard of it while it was driven, DIR/live.bag, is in its recording byte for byte."""

import sys

import rosbag

folder = sys.argv[1]


def messages(path):
    by_topic = {}
    for topic, (_, data, _, *_), _ in rosbag.Bag(path).read_messages(raw=True):
        by_topic.setdefault(topic, []).append(data)
    return by_topic


def poses(path):
    return [(m.transforms[0].header.stamp.to_nsec(), m.transforms[0].transform.translation)
            for _, m, _ in rosbag.Bag(path).read_messages("/tf")]


def check_heard():
    recorded = messages(folder + "/out/leg_001/mission.bag")
    heard = messages(folder + "/live.bag")
    if set(heard) != {"/tf", "/camera/rgb/image_raw", "/camera/depth_registered/image_raw"}:
        sys.exit("heard: %s" % sorted(heard))
    for topic, live in heard.items():
        of_leg = [data for data in live if data in set(recorded[topic])]
        if len(of_leg) < 10:
            sys.exit("%s: only %d of %d are of the first leg" % (topic, len(of_leg), len(live)))
        first = recorded[topic].index(of_leg[0])
        if live[:len(of_leg)] != recorded[topic][first:first + len(of_leg)]:
            sys.exit(topic + ": not the recording's messages in their order")
    stamps = [stamp for stamp, _ in poses(folder + "/live.bag")]
    if any(after <= before for before, after in zip(stamps, stamps[1:])):
        sys.exit("time jumped back")


if sys.argv[2] == "heard":
    check_heard()

way = [p for _, p in poses(folder + "/out/leg_001/mission.bag")]
moved = [((b.x - a.x) ** 2 + (b.y - a.y) ** 2 + (b.z - a.z) ** 2) ** 0.5 for a, b in zip(way, way[1:])]
# hypot(0.5, 0.25) m/s at 10 Hz, or nothing at all
if any(abs(d - 0.0559017) > 1e-6 and d > 1e-9 for d in moved):
    sys.exit("steps of %s" % sorted(set(moved)))
driven = [i for i, d in enumerate(moved) if d > 1e-9]
if not 10 <= len(driven) <= 40 or driven != list(range(driven[0], driven[-1] + 1)):
    sys.exit("driven in steps %s" % driven)
if driven[0] < 2 or len(moved) - driven[-1] < 3:
    sys.exit("it did not stand before and after: %s of %d" % (driven, len(moved)))
way = [p for _, p in poses(folder + "/out/leg_002/mission.bag")]
if not any(abs(b.x - a.x) + abs(b.y - a.y) > 1e-3 for a, b in zip(way, way[1:])):
    sys.exit("the stick moved nothing")
