"""read_readings.py FOLDER: compares the tables of a run's sensors with its bag, read by ROS's own rosbag, which computes
each MD5 sum from the definition that the bag holds. A difference ends it with a message."""

import csv
import math
import os
import sys

import rosbag

folder = sys.argv[1]
VALUES = {
    "sensor_msgs/Range": lambda m, row: ([m.range], row),
    "std_msgs/Bool": lambda m, row: ([float(m.data)], row[:1]),
    "geometry_msgs/WrenchStamped": lambda m, row: ([-m.wrench.force.x], row[1:]),
    "sensor_msgs/Imu": lambda m, row: ([m.orientation.x, m.orientation.y, m.orientation.z, m.orientation.w], row),
    "sensor_msgs/FluidPressure": lambda m, row: ([m.fluid_pressure], row),
    "sensor_msgs/MagneticField": lambda m, row: ([m.magnetic_field.x, m.magnetic_field.y, m.magnetic_field.z], row),
    "sensor_msgs/NavSatFix": lambda m, row: ([m.latitude, m.longitude, m.altitude], row[:3]),
    "sensor_msgs/BatteryState": lambda m, row: ([m.voltage, -m.current, m.percentage], row),
}


def same(a, b, single):
    if math.isnan(a) or math.isnan(b):
        return math.isnan(a) and math.isnan(b)
    return a == b or (single and abs(a - b) <= 1e-6 * abs(b))


compared = 0
bag = rosbag.Bag(os.path.join(folder, "mission.bag"))
for file in sorted(os.listdir(os.path.join(folder, "sensors"))):
    name = os.path.splitext(file)[0]
    with open(os.path.join(folder, "sensors", file)) as text:
        rows = list(csv.reader(text))[1:]
    for topic in ("/battery_state" if name == "pack" else "/" + name, "/" + name + "/wrench"):
        messages = list(bag.read_messages(topics=[topic]))
        if not messages and topic.endswith("wrench"):
            continue
        if len(messages) != len(rows):
            sys.exit("%s: %d messages, %d rows" % (topic, len(messages), len(rows)))
        for connection in bag._get_connections([topic]):
            if connection.md5sum != messages[0].message._md5sum:
                sys.exit("%s: MD5 %s, of the definition %s" % (topic, connection.md5sum, messages[0].message._md5sum))
        for (_, message, time), row in zip(messages, rows):
            found, wanted = VALUES[message._type](message, [float(value) for value in row[1:]])
            if time.to_nsec() != int(row[0]) or not all(map(same, found, wanted, [message._type.endswith(("Range", "BatteryState"))] * len(found))):
                sys.exit("%s at %s: %s, in the table %s" % (topic, time, found, row))
            if hasattr(message, "header") and message.header.frame_id != name + "_link":
                sys.exit("%s: frame %s" % (topic, message.header.frame_id))
            compared += 1
print(compared)
