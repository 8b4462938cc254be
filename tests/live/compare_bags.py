"""compare_bags.py BAG OTHER: every message of both bags the same, byte for byte and in order within its
topic, with the same types. Their times may differ: one is stamped as it arrives."""

import sys

import rosbag


def content(path):
    topics = {}
    bag = rosbag.Bag(path)
    for topic, (name, data, md5, *_), _ in bag.read_messages(raw=True):
        topics.setdefault(topic, []).append((name, md5, data))
    definitions = {c.topic: c.msg_def for c in bag._get_connections()}
    latched = {c.topic for c in bag._get_connections() if c.header.get("latching") in (b"1", "1")}
    return topics, definitions, latched


(wanted, wanted_definitions, wanted_latched), (found, definitions, latched) = map(content, sys.argv[1:3])
if set(found) != set(wanted):
    sys.exit("topics differ: %s" % sorted(set(found) ^ set(wanted)))
for topic in wanted:
    if len(found[topic]) != len(wanted[topic]):
        sys.exit("%s: %d messages, expected %d" % (topic, len(found[topic]), len(wanted[topic])))
    for i, (a, b) in enumerate(zip(wanted[topic], found[topic])):
        if a != b:
            sys.exit("%s: message %d differs" % (topic, i))
    if definitions[topic].strip() != wanted_definitions[topic].strip():
        sys.exit(topic + ": the definitions differ")
if latched != wanted_latched:
    sys.exit("latched: %s, expected %s" % (latched, wanted_latched))
print("ok: %d messages" % sum(map(len, wanted.values())))
