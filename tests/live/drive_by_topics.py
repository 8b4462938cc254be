"""drive_by_topics.py LOG: drives as teleop_twist and joy_node would, then ends the drive. The topics'
other ends are waited for, not slept for."""

import sys
import time

import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image, Joy

sys.stdout = open(sys.argv[1], "w", 1)
rospy.init_node("driver", anonymous=True, disable_signals=True)
frames = [0]
rospy.Subscriber("/camera/rgb/image_raw", Image, lambda _: frames.__setitem__(0, frames[0] + 1))
velocity = rospy.Publisher("/cmd_vel", Twist, queue_size=10)
stick = rospy.Publisher("/joy", Joy, queue_size=10)


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


until("the drive to listen", lambda: velocity.get_num_connections() and stick.get_num_connections())
until("the recorder", lambda: rospy.get_published_topics() and frames[0] > 5)
twist = Twist()
twist.linear.x, twist.linear.z, twist.angular.z = 0.5, 0.25, 0.4
steps(15, lambda: velocity.publish(twist))
steps(15, lambda: None)  # silence: it stops
stick.publish(Joy(axes=[0] * 8, buttons=[1] + [0] * 10))  # the lamp: a new leg
steps(10, lambda: stick.publish(Joy(axes=[0, 1, 0, 0, 0, 0, 0, 0], buttons=[0] * 11)))
bad = Twist()
bad.linear.x = float("nan")
steps(3, lambda: velocity.publish(bad))
stick.publish(Joy(axes=[0] * 8, buttons=[0] * 6 + [1] + [0] * 4))
until("the drive to end", lambda: stick.get_num_connections() == 0)
