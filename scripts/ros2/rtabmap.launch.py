"""RTAB-Map on the pictures of scripts/ros2/yard.lua: rubble run scripts/ros2/yard.lua --ros2, then ros2 launch this file."""
from launch import LaunchDescription
from launch_ros.actions import Node

PARAMETERS = {"use_sim_time": True, "frame_id": "base_link", "odom_frame_id": "odom", "subscribe_depth": True, "approx_sync": False,
              "qos": 1, "Grid/RangeMax": "5", "Grid/3D": "true"}
REMAPPINGS = [("rgb/image", "/camera/rgb/image_raw"), ("rgb/camera_info", "/camera/rgb/camera_info"),
              ("depth/image", "/camera/depth_registered/image_raw")]


def generate_launch_description():
    return LaunchDescription([
        Node(package="rtabmap_slam", executable="rtabmap", output="screen", parameters=[PARAMETERS], remappings=REMAPPINGS, arguments=["-d"]),
        Node(package="rtabmap_viz", executable="rtabmap_viz", output="screen", parameters=[PARAMETERS], remappings=REMAPPINGS),
    ])
