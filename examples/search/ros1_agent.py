#!/usr/bin/python3
"""ros1_agent.py [PATIENCE]: an agent that lets a program of ROS 1 search.

    roscore &
    my_searcher &
    rubble bench search scripts/search.lua --agent "examples/search/ros1_agent.py" --seeds 1..2

Each observation goes out once, in this order, all with its time as their stamp; the search waits for /cmd_vel.

    /search/start                std_msgs/String, latched  the line of the type `start`, docs/explanation/search.md
    /odom                        nav_msgs/Odometry         the true pose of the robot in the frame `map`
    /camera/thermal/image_raw    sensor_msgs/Image         16UC1, hundredths of a kelvin
    /camera/depth/image_raw      sensor_msgs/Image         16UC1, millimetres
    /camera/depth/camera_info    sensor_msgs/CameraInfo    of both pictures
    /search/status               std_msgs/String           the observation without its pictures
    /clock                       rosgraph_msgs/Clock       the time of the search, for /use_sim_time
    /search/end                  std_msgs/String           the score

and what comes is the answer:

    /cmd_vel                     geometry_msgs/Twist       forwards, left, up (m/s); angular.z: to the left (rad/s)
    /search/report               geometry_msgs/PointStamped  a place in the frame `map`; counts with the next /cmd_vel
    /search/done                 std_msgs/Empty            ends the search with the next /cmd_vel

Until the first command an observation is repeated each second. Without a command for PATIENCE seconds (8) it gives up,
and the search ends.
"""
import base64
import json
import math
import os
import queue
import sys
import time

answers = os.fdopen(os.dup(1), "w")  # what ROS prints must not be taken for an answer
os.dup2(2, 1)

import rospy  # noqa: E402
from geometry_msgs.msg import PointStamped, Twist  # noqa: E402
from nav_msgs.msg import Odometry  # noqa: E402
from rosgraph_msgs.msg import Clock  # noqa: E402
from sensor_msgs.msg import CameraInfo, Image  # noqa: E402
from std_msgs.msg import Empty, String  # noqa: E402


class Topics:
    def __init__(self, start):
        self.camera = start["camera"]
        self.commands, self.reports, self.done = queue.Queue(), queue.Queue(), False

        def publish(name, kind, latch=False):
            return rospy.Publisher(name, kind, queue_size=2, latch=latch)
        self.start = publish("/search/start", String, True)
        self.odometry = publish("/odom", Odometry)
        self.thermal = publish("/camera/thermal/image_raw", Image)
        self.depth = publish("/camera/depth/image_raw", Image)
        self.info = publish("/camera/depth/camera_info", CameraInfo)
        self.status = publish("/search/status", String)
        self.clock = publish("/clock", Clock)
        self.end = publish("/search/end", String, True)
        rospy.Subscriber("/cmd_vel", Twist, self.commands.put, queue_size=10)
        rospy.Subscriber("/search/report", PointStamped, lambda m: self.reports.put(m.point), queue_size=10)
        rospy.Subscriber("/search/done", Empty, lambda _: setattr(self, "done", True), queue_size=1)
        self.start.publish(json.dumps(start))

    def picture(self, text, stamp):
        message = Image(height=self.camera["height"], width=self.camera["width"], encoding="16UC1",
                        step=2 * self.camera["width"], data=base64.b64decode(text))
        message.header.stamp, message.header.frame_id = stamp, "camera"
        return message

    def lens(self, stamp):
        c = self.camera
        message = CameraInfo(height=c["height"], width=c["width"], distortion_model="plumb_bob", D=[0] * 5)
        message.K = [c["fx"], 0, c["cx"], 0, c["fy"], c["cy"], 0, 0, 1]
        message.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
        message.P = [c["fx"], 0, c["cx"], 0, 0, c["fy"], c["cy"], 0, 0, 0, 1, 0]
        message.header.stamp, message.header.frame_id = stamp, "camera"
        return message

    def send(self, seen):
        stamp = rospy.Time.from_sec(seen["time"])
        odometry = Odometry(child_frame_id="base_link")
        odometry.header.stamp, odometry.header.frame_id = stamp, "map"
        place, turn = odometry.pose.pose.position, odometry.pose.pose.orientation
        place.x, place.y, place.z = seen["position"]
        turn.z, turn.w = math.sin(seen["yaw"] / 2), math.cos(seen["yaw"] / 2)
        self.clock.publish(Clock(stamp))
        self.odometry.publish(odometry)
        self.thermal.publish(self.picture(seen["thermal_ck"], stamp))
        self.depth.publish(self.picture(seen["depth_mm"], stamp))
        self.info.publish(self.lens(stamp))
        self.status.publish(json.dumps({k: v for k, v in seen.items() if k not in ("depth_mm", "thermal_ck")}))

    def wait_for_command(self, seen, repeat, patience):
        self.send(seen)
        limit = time.monotonic() + patience
        while time.monotonic() < limit:
            try:
                return self.commands.get(timeout=1)
            except queue.Empty:
                if repeat:
                    self.send(seen)
        sys.exit("ros1_agent: nobody answered by /cmd_vel within %g s" % patience)

    def answer(self, command):
        reports = []
        while not self.reports.empty():
            p = self.reports.get()
            reports.append([p.x, p.y, p.z])
        v = command.linear
        return {"velocity": [v.x, v.y, v.z], "turn": command.angular.z, "report": reports, "done": self.done}


def main():
    patience = float(sys.argv[1]) if len(sys.argv) > 1 else 8
    start = json.loads(sys.stdin.readline())
    rospy.init_node("search_agent", anonymous=True, disable_signals=True)
    topics, first = Topics(start), True
    for line in sys.stdin:
        seen = json.loads(line)
        if seen["type"] == "end":
            topics.end.publish(json.dumps(seen))
            time.sleep(0.5)  # for it to arrive
            return
        command = topics.wait_for_command(seen, first, 3 * patience if first else patience)
        first = False
        print(json.dumps(topics.answer(command)), file=answers, flush=True)


main()
