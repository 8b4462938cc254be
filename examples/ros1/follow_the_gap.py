#!/usr/bin/python3
"""follow_the_gap.py [AHEAD [ASIDE]]: drives a robot to a goal, that far ahead and to the left of where it starts (m).

A program of its own: it knows the robot by ROS 1 topics alone, /scan and /odom, and drives it by /cmd_vel. Each
scan is answered by a direction: of all that the robot fits through as far as it looks, the one nearest to the goal
(Sezer and Gokasan 2012, "A novel obstacle avoidance method: Follow the Gap Method"). It prints what became of it as
JSON, and ends with 0 if it arrived.

    roscore &
    rubble drive examples/ros1/lean_to.lua --ros1 &
    examples/ros1/follow_the_gap.py 6.5
"""

import json
import math
import sys
import time

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

HALF_WIDTH = 0.27     # of the robot, with room to spare (m)
LOOK = 1.2            # how far a way must be free (m)
SEEN = math.radians(90)  # on both sides: behind that are wheels (rad)
SPEED, TURN = 0.35, 1.2  # at most (m/s, rad/s)
NEAR = 0.3            # of the goal: there (m)
PATIENCE = 8.0        # without coming nearer to the goal (s)
LIMIT = 90.0          # s
YAW_SCALE = 0.4  # wheels that skid turn the robot by less than odometry says


class Driver:
    def __init__(self, goal):
        self.goal, self.pose, self.yaw, self.last_yaw = np.array(goal), None, 0.0, None
        self.first = self.last = None  # stamps of scans (s)
        self.started, self.scans, self.way, self.closest = time.time(), 0, 0.0, math.inf
        self.best, self.best_at = math.inf, 0.0
        self.result = None
        self.velocity = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("/odom", Odometry, self.hear_odometry, queue_size=100)
        rospy.Subscriber("/scan", LaserScan, self.hear_scan, queue_size=1)

    def hear_odometry(self, message):
        q, p = message.pose.pose.orientation, message.pose.pose.position
        yaw, at = 2 * math.atan2(q.z, q.w), np.array([p.x, p.y])
        if self.pose is None:
            self.pose = np.zeros(2)
        else:
            turned = math.remainder(yaw - self.last_yaw, 2 * math.pi) * YAW_SCALE
            middle = self.yaw + turned / 2
            step = np.linalg.norm(at - self.last_at) * math.copysign(1, message.twist.twist.linear.x)
            self.pose = self.pose + step * np.array([math.cos(middle), math.sin(middle)])
            self.yaw += turned
            self.way += abs(step)
        self.last_yaw, self.last_at = yaw, at

    def free_ranges(self, angles, ranges):
        """How far the robot gets in each direction: to where a point comes nearer than half its width to the line."""
        x, y = ranges * np.cos(angles), ranges * np.sin(angles)
        free = np.full(len(self.ways), LOOK + 1)
        for i, way in enumerate(self.ways):
            along, aside = x * math.cos(way) + y * math.sin(way), y * math.cos(way) - x * math.sin(way)
            hit = (along > 0) & (np.abs(aside) < HALF_WIDTH)
            if hit.any():
                free[i] = min(free[i], along[hit].min())
        return free

    ways = np.radians(np.arange(-100, 101, 4))

    def hear_scan(self, scan):
        if self.pose is None or self.result is not None:
            return
        stamp = scan.header.stamp.to_sec()
        if self.first is None:
            self.first, self.started = stamp, time.time()
            self.best_at = stamp
        self.last, self.scans = stamp, self.scans + 1
        ranges = np.asarray(scan.ranges, float)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        seen = (np.abs(angles) < SEEN) & np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
        self.closest = min(self.closest, ranges[seen].min(initial=math.inf))
        to = self.goal - self.pose
        distance = float(np.linalg.norm(to))
        if distance < self.best - 0.1:
            self.best, self.best_at = distance, stamp
        if distance < NEAR:
            return self.end("arrived")
        if stamp - self.best_at > PATIENCE:
            return self.end("stuck")
        if stamp - self.first > LIMIT:
            return self.end("too late")
        bearing = math.remainder(math.atan2(to[1], to[0]) - self.yaw, 2 * math.pi)
        free = self.free_ranges(angles[seen], ranges[seen])
        wanted = min(LOOK, distance)
        off = np.abs(np.remainder(self.ways - bearing + math.pi, 2 * math.pi) - math.pi)
        # Where nothing is free far enough, the farthest counts most.
        cost = off + 4 * np.maximum(0, wanted - free)
        way = self.ways[int(np.argmin(cost))]
        ahead = free[int(np.argmin(np.abs(self.ways)))]
        twist = Twist()
        twist.angular.z = float(np.clip(2.5 * way, -TURN, TURN))
        slow = max(0.0, 1 - abs(way) / 0.9) * min(1.0, max(0.0, ahead - 0.15) / 0.6)
        twist.linear.x = SPEED * slow
        self.velocity.publish(twist)

    def end(self, result):
        self.velocity.publish(Twist())
        simulated, wall = self.last - self.first, time.time() - self.started
        self.result = {
            "result": result, "simulated_s": round(simulated, 2), "wall_s": round(wall, 2),
            "real_time_factor": round(simulated / wall, 3), "scans": self.scans, "way_m": round(self.way, 2),
            "closest_m": round(float(self.closest), 3), "left_m": round(float(np.linalg.norm(self.goal - self.pose)), 2)}


def main():
    goal = [float(sys.argv[1]) if len(sys.argv) > 1 else 6.5, float(sys.argv[2]) if len(sys.argv) > 2 else 0.0]
    rospy.init_node("follow_the_gap", disable_signals=True)
    driver = Driver(goal)
    while driver.result is None and time.time() - driver.started < 600:
        time.sleep(0.02)
    if driver.result is None:
        driver.result = {"result": "no scans"}
    print(json.dumps(driver.result))
    return 0 if driver.result["result"] == "arrived" else 1


if __name__ == "__main__":
    sys.exit(main())
