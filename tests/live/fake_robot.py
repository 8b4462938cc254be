"""fake_robot.py MODE: a robot on a plane, by rospy's messages: /odom, /tf_static and /points with fields of float64 in an
order of their own, at 5 scans a second, driven by /cmd_vel. It prints "ready", and, whenever it has moved, where it is.

MODE: open: among four walls; nan: every other point is NaN; blind: every point is NaN; again: its time begins anew after 3 s
"""

import math
import sys
import time

import numpy as np
import rospy
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2, PointField
from tf2_msgs.msg import TFMessage

mode = sys.argv[1]
rospy.init_node("fake_robot", disable_signals=True)
velocity = [0.0, 0.0]


def hear(twist):
    velocity[:] = [twist.linear.x, twist.angular.z]


rospy.Subscriber("/cmd_vel", Twist, hear)
odometry = rospy.Publisher("/odom", Odometry, queue_size=100)
clouds = rospy.Publisher("/points", PointCloud2, queue_size=3)
fixed = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
frame = TransformStamped()
frame.header.frame_id, frame.child_frame_id = "base_link", "mast/lidar"
frame.transform.translation.z, frame.transform.rotation.w = 0.5, 1.0
fixed.publish(TFMessage([frame]))

side = np.arange(-4, 4, 0.05)
walls = np.concatenate([[(s, o, z), (o, s, z)] for s in side for o in (-4, 4) for z in (0.15, 0.3, 0.45)], axis=0)
ground = np.array([(x, y, 0) for x in np.arange(-3, 3, 0.15) for y in np.arange(-3, 3, 0.15)])
layout = np.dtype({"names": ["z", "y", "x"], "formats": ["<f8"] * 3, "offsets": [0, 8, 24], "itemsize": 40})


def cloud(stamp, x, y, yaw):
    c, s = math.cos(yaw), math.sin(yaw)
    dx, dy = walls[:, 0] - x, walls[:, 1] - y
    seen = np.concatenate([np.stack([c * dx + s * dy, c * dy - s * dx, walls[:, 2]], axis=1), ground])
    points = np.zeros(len(seen), layout)
    points["x"], points["y"], points["z"] = seen[:, 0], seen[:, 1], seen[:, 2] - 0.5
    if mode == "nan":
        points["x"][::2] = np.nan
    if mode == "blind":
        points["y"] = np.nan
    message = PointCloud2(height=1, width=len(seen), point_step=40, row_step=40 * len(seen), is_dense=False)
    message.header.stamp, message.header.frame_id = stamp, "mast/lidar"
    message.fields = [PointField(n, layout.fields[n][1], PointField.FLOAT64, 1) for n in ("z", "y", "x")]
    message.data = points.tobytes()
    return message


print("ready", flush=True)
x = y = yaw = 0.0
begun = time.time()
for k in range(6000):
    x, y, yaw = x + 0.02 * velocity[0] * math.cos(yaw), y + 0.02 * velocity[0] * math.sin(yaw), yaw + 0.02 * velocity[1]
    stamp = rospy.Time.from_sec(100 + 0.02 * (k - 150 if mode == "again" and k >= 150 else k))
    pose = Odometry()
    pose.header.stamp, pose.header.frame_id, pose.child_frame_id = stamp, "odom", "base_link"
    pose.pose.pose.position.x, pose.pose.pose.position.y = x, y
    pose.pose.pose.orientation.z, pose.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    odometry.publish(pose)
    if k % 10 == 0:
        clouds.publish(cloud(stamp, x, y, yaw))
        print("at %.3f %.3f driven by %.3f %.3f" % (x, y, velocity[0], velocity[1]), flush=True)
    time.sleep(max(0.0, begun + 0.02 * (k + 1) - time.time()))
