"""flood_commands.py COUNT: publishes so many commands as fast as it can, in turn of NaN, infinity, huge
numbers and sticks without an end; then one of 0.125 m/s, again and again."""

import sys

import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Joy

rospy.init_node("flood", disable_signals=True)
velocity = rospy.Publisher("/cmd_vel", Twist, queue_size=1000)
stick = rospy.Publisher("/joy", Joy, queue_size=1000)
while not (velocity.get_num_connections() and stick.get_num_connections()):
    rospy.sleep(0.01)
for i in range(int(sys.argv[1])):
    twist = Twist()
    twist.linear.x = (float("nan"), float("inf"), 1e300, -1e308)[i % 4]
    twist.angular.z = (1e300, float("nan"))[i % 2]
    velocity.publish(twist)
    if i % 10 == 0:
        stick.publish(Joy(axes=[float("nan"), 3e38, float("-inf")][i % 3:], buttons=[2**31 - 1] * (i % 2000)))
good = Twist()
good.linear.x = 0.125
rate = rospy.Rate(50)
while not rospy.is_shutdown():
    velocity.publish(good)
    rate.sleep()
