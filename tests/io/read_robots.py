"""read_robots.py BAG: what a bag says of its robot, as JSON, by ROS's own rosbag, which computes each MD5 sum
from the definition that the bag holds."""

import json
import sys

import rosbag


def triple(v):
    return [v.x, v.y, v.z]


def odometry(m):
    return {"frame": m.header.frame_id, "child": m.child_frame_id,
            "position": triple(m.pose.pose.position), "linear": triple(m.twist.twist.linear),
            "angular": triple(m.twist.twist.angular)}


read = {"joints": [], "odom": [], "truth": [], "contacts": [], "description": [], "parents": {}, "poses": {}}
bag = rosbag.Bag(sys.argv[1])
for topic, m, time in bag.read_messages():
    for connection in bag._get_connections([topic]):
        if connection.md5sum != m._md5sum:
            sys.exit("%s: MD5 %s, of the definition %s" % (topic, connection.md5sum, m._md5sum))
    if topic == "/joint_states":
        read["joints"].append({"name": list(m.name), "position": list(m.position),
                               "velocity": list(m.velocity), "effort": list(m.effort)})
    elif topic == "/odom":
        read["odom"].append(odometry(m))
    elif topic == "/ground_truth/odom":
        read["truth"].append(odometry(m))
    elif topic == "/contacts":
        read["contacts"].append({"frame": m.header.frame_id, "force": triple(m.wrench.force),
                                 "torque": triple(m.wrench.torque)})
    elif topic == "/robot_description":
        read["description"].append(m.data)
    elif topic.endswith("/ground_truth/pose"):
        read["poses"].setdefault(topic, []).append([m.header.frame_id] + triple(m.pose.position))
    elif topic in ("/tf", "/tf_static"):
        for t in m.transforms:
            was = read["parents"].setdefault(t.child_frame_id, t.header.frame_id)
            if was != t.header.frame_id:
                sys.exit("%s has two parents" % t.child_frame_id)
print(json.dumps(read))
