"""A recording by itself: stamps in order, streams that last as long as the run, nothing declared that is empty."""
import os

from dataset import need
from judges_motion import imus


def files_are_whole(data):
    """No part file is left, and every file of the manifest is there."""
    for folder, _, files in os.walk(data.folder):
        for name in files:
            need(not name.endswith(".part"), "%s is left", os.path.join(folder, name))
    for name in data.manifest["outputs"]:
        need(data.has(name), "%s of the manifest is not there", name)
    need(data.manifest["pile"]["lost"] == 0, "%d pieces are lost", data.manifest["pile"]["lost"])


def stamps_are_in_order(data):
    if data.recording is None:
        return
    for topic, messages in data.recording.topics.items():
        last = 0
        for stamp, message in messages:
            need(stamp >= last, "%s: a stamp goes back", topic)
            last = stamp
            if "header" in message:
                need(message["header"]["stamp"] == stamp, "%s: header and log have the stamps %d and %d", topic,
                     message["header"]["stamp"], stamp)


def topics_have_messages(data):
    if data.recording is not None:
        empty = sorted(topic for topic, messages in data.recording.topics.items() if not messages)
        need(not empty, "declared without a message: %s", ", ".join(empty))


def odometry_lasts(data):
    """Odometry and joints reach the last picture, or the end of what the mission drives."""
    if data.recording is None or not data.scenario["robots"]:
        return
    driven = int(data.cameras[0].poses[0][data.flight_frames(data.cameras[0])[0]]) + int(data.scenario["robot_run"]["duration"] * 1e9)
    end = min(driven, max(int(camera.poses[0][-1]) for camera in data.cameras))
    for topic in data.recording.of_type("nav_msgs/Odometry") + data.recording.of_type("sensor_msgs/JointState"):
        messages = data.recording.topics[topic]
        need(messages and messages[-1][0] >= end, "%s ends %.3f s before the last picture", topic,
             (end - messages[-1][0]) / 1e9 if messages else 0)


def odometry_has_covariance(data):
    if data.recording is None:
        return
    for topic in data.recording.of_type("nav_msgs/Odometry"):
        if "ground_truth" in topic or not data.recording.messages(topic):
            continue
        message = data.recording.messages(topic)[-1]
        need(any(message["pose"]["covariance"]), "%s: the covariance is all zero", topic)


def clock_is_finest(data):
    """/clock has every stamp that a sensor has."""
    if data.recording is None or "/clock" not in data.recording.topics:
        return
    ticks = {stamp for stamp, _ in data.recording.topics["/clock"]}
    for topic, messages in data.recording.topics.items():
        missing = sum(stamp not in ticks for stamp, _ in messages)
        need(missing == 0, "/clock has not %d of the %d stamps of %s", missing, len(messages), topic)


def imus_outlast_scans(data):
    """A scan can be undistorted by inertial readings: they last until its last ray."""
    if data.recording is None or not imus(data):
        return
    last = max((data.recording.topics[topic][-1][0] for topic, _ in imus(data) if data.recording.topics.get(topic)), default=0)
    for topic in data.recording.of_type("sensor_msgs/PointCloud2") + data.recording.of_type("sensor_msgs/LaserScan"):
        messages = data.recording.topics[topic]
        if messages:
            spacing = messages[1][0] - messages[0][0] if len(messages) > 1 else 0
            need(messages[-1][0] + spacing <= last + 1, "the last scan of %s runs %.3f s past the last inertial reading", topic,
                 (messages[-1][0] + spacing - last) / 1e9)


JUDGES = [files_are_whole, stamps_are_in_order, topics_have_messages, odometry_lasts, odometry_has_covariance, clock_is_finest,
          imus_outlast_scans]
