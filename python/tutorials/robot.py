"""Drive a crawler against a pile and read its sensors: python3 robot.py MISSION.lua"""
import sys

import rubble

pile = rubble.settle(sys.argv[1], seed=3)
robot = rubble.RobotWorld(pile, "crawler", rubble.pose([-4, 0, 0.01]))
print("joints:", robot.joint_count, "links:", ", ".join(robot.link_names[:3]), "...")
robot.drive(linear=0.5, flippers=[0.6, 0.6, 0, 0])
for second in range(3):
    state = robot.step(1.0)
    x, y, z = state["links"][0, :3]
    force = abs(state["contact_forces"]).sum()
    print(f"t = {state['time']:.2f} s: at {x:.2f} {y:.2f} {z:.2f} m, contacts carry {force:.0f} N")
