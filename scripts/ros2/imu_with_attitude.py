#!/usr/bin/env python3
"""Joins /imu and the attitude sensor /ahrs to /imu/data, an inertial unit with an orientation, for LIO-SAM. Runs in ROS 2."""
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Imu


class Join(Node):
    def __init__(self):
        super().__init__("imu_with_attitude")
        self.attitude = None
        self.out = self.create_publisher(Imu, "/imu/data", 100)
        self.create_subscription(Imu, "/ahrs", self.keep, 100)
        self.create_subscription(Imu, "/imu", self.send, 100)

    def keep(self, message):
        self.attitude = message

    def send(self, message):
        if self.attitude is None:
            return
        message.orientation = self.attitude.orientation
        message.orientation_covariance = self.attitude.orientation_covariance
        self.out.publish(message)


rclpy.init()
rclpy.spin(Join())
