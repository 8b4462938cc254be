"""drive_by_topics.py LOG [robot]: drives as teleop_twist and joy_node would, a robot by trajectories of its joints,
too, then ends the drive. The topics' other ends are waited for, not slept for."""

import sys
import time

import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image, Joy
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

sys.stdout = open(sys.argv[1], "w", 1)
rospy.init_node("driver", anonymous=True, disable_signals=True)
frames = [0]
rospy.Subscriber("/camera/rgb/image_raw", Image, lambda _: frames.__setitem__(0, frames[0] + 1))
velocity = rospy.Publisher("/cmd_vel", Twist, queue_size=10)
stick = rospy.Publisher("/joy", Joy, queue_size=10)
joints = rospy.Publisher("/joint_trajectory", JointTrajectory, queue_size=10)


def until(what, condition):
    end = time.time() + 30
    while not condition():
        if time.time() > end:
            sys.exit("waited too long for " + what)
        time.sleep(0.01)
    print(what)


def steps(count, send):
    goal = frames[0] + count
    end = time.time() + 30
    while frames[0] < goal and time.time() < end:
        send()
        time.sleep(0.05)


def trajectory(joint, position):
    point = JointTrajectoryPoint(positions=[position], velocities=[0], time_from_start=rospy.Duration(0.5))
    joints.publish(JointTrajectory(joint_names=[joint], points=[point]))


until("the drive to listen", lambda: all(p.get_num_connections() for p in (velocity, stick, joints)))
until("the recorder", lambda: rospy.get_published_topics() and frames[0] > 5)
twist = Twist()
twist.linear.x, twist.linear.z, twist.angular.z = 0.5, 0.25, 0.4
steps(15, lambda: velocity.publish(twist))
steps(15, lambda: None)  # silence: it stops
if sys.argv[2:] == ["robot"]:
    trajectory("tail", 1)
    trajectory("front_left_flipper_joint", float("nan"))
    trajectory("front_left_flipper_joint", 0.25)
    steps(12, lambda: None)
stick.publish(Joy(axes=[0] * 8, buttons=[1] + [0] * 10))  # the lamp: a new leg
steps(10, lambda: stick.publish(Joy(axes=[0, 1, 0, 0, 0, 0, 0, 0], buttons=[0] * 11)))
bad = Twist()
bad.linear.x = float("nan")
steps(3, lambda: velocity.publish(bad))
stick.publish(Joy(axes=[0] * 8, buttons=[0] * 6 + [1] + [0] * 4))
until("the drive to end", lambda: stick.get_num_connections() == 0)
