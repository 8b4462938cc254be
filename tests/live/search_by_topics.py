"""search_by_topics.py PROGRAM: gives what examples/search/ros1_agent.py publishes to a program that knows lines of JSON, and
publishes its answers: both ways it must find the same. `silent` as PROGRAM: listens alone."""
import base64
import json
import subprocess
import sys
import time

import rospy
from geometry_msgs.msg import PointStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Empty, String


class Searcher:
    def __init__(self):
        self.parts, self.answered, self.program, self.briefing = {}, -1.0, None, None
        self.velocity = rospy.Publisher("/cmd_vel", Twist, queue_size=10)
        self.report = rospy.Publisher("/search/report", PointStamped, queue_size=10)
        self.done = rospy.Publisher("/search/done", Empty, queue_size=1)
        for name, topic, kind in (("depth_mm", "/camera/depth/image_raw", Image),
                                  ("thermal_ck", "/camera/thermal/image_raw", Image), ("pose", "/odom", Odometry),
                                  ("lens", "/camera/depth/camera_info", CameraInfo)):
            rospy.Subscriber(topic, kind, lambda m, name=name: self.hear(name, m.header.stamp.to_sec(), m))
        rospy.Subscriber("/search/status", String, self.hear_status)
        rospy.Subscriber("/search/start", String, self.hear_start)
        rospy.Subscriber("/search/end", String, lambda m: print("end", m.data, flush=True))

    def hear_start(self, message):
        self.briefing = json.loads(message.data)
        if self.program:
            self.program.kill()
        self.program = subprocess.Popen(sys.argv[1], shell=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.program.stdin.write(message.data + "\n")
        self.parts, self.answered = {}, -1.0

    def hear_status(self, message):
        self.hear("status", json.loads(message.data)["time"], json.loads(message.data))

    def hear(self, name, stamp, message):
        self.parts.setdefault(round(stamp, 3), {})[name] = message

    def spin(self):
        while not rospy.is_shutdown():
            for stamp, parts in list(self.parts.items()):
                if len(parts) == 5 and stamp > self.answered and self.program and sys.argv[1] != "silent":
                    self.answer(stamp, parts)
            time.sleep(0.001)

    def answer(self, stamp, parts):
        self.answered = stamp
        camera, lens, pose = self.briefing["camera"], parts["lens"], parts["pose"].pose.pose
        assert lens.K[0] == camera["fx"] and lens.K[5] == camera["cy"] and lens.width == camera["width"]
        seen = parts["status"]
        seen["position"] = [pose.position.x, pose.position.y, pose.position.z]
        for name in ("depth_mm", "thermal_ck"):
            seen[name] = base64.b64encode(parts[name].data).decode()
        self.program.stdin.write(json.dumps(seen) + "\n")
        self.program.stdin.flush()
        answer = json.loads(self.program.stdout.readline())
        for place in answer.get("report", []):
            message = PointStamped()
            message.point.x, message.point.y, message.point.z = place
            self.report.publish(message)
            time.sleep(0.1)  # so that it is there before the command
        if answer.get("done"):
            self.done.publish()
            time.sleep(0.1)
        command = Twist()
        command.linear.x, command.linear.y, command.linear.z = answer["velocity"]
        command.angular.z = answer["turn"]
        self.velocity.publish(command)
        self.parts = {t: p for t, p in self.parts.items() if t > stamp}


rospy.init_node("searcher")
searcher = Searcher()
print("ready", flush=True)
searcher.spin()
