"""read_bag.py BAG EXPECTED.json FOLDER COMPRESSION: compares a bag, read by ROS's own rosbag, with what the
JSON file and the raw pictures in FOLDER say. An assertion that fails names the difference."""

import json
import os
import sys

import rosbag

bag_path, expected_path, folder, compression = sys.argv[1:5]
with open(expected_path) as file:
    expected = json.load(file)
frames = expected["frames"]


def equal(found, wanted, what):
    if found != wanted:
        sys.exit("%s: found %r, expected %r" % (what, found, wanted))


def parts(time):
    return {"sec": time.secs, "nsec": time.nsecs}


channels = expected["channels"]
messages = {}
bag = rosbag.Bag(bag_path)
for topic, message, time in bag.read_messages():
    messages.setdefault(topic, []).append(message)
    # ROS computes the sum from the definition in the bag.
    for connection in bag._get_connections([topic]):
        equal(connection.md5sum, message._md5sum, topic + ": MD5")
    if hasattr(message, "header"):
        equal(parts(message.header.stamp), parts(time), topic + ": stamp against bag time")
equal(bag.version, 200, "bag version")
equal(bag.get_compression_info().compression, compression, "compression")


def check_image(topic, encoding, suffix):
    equal(len(messages.get(topic, [])), len(frames), "messages on " + topic)
    for i, image in enumerate(messages[topic]):
        equal(parts(image.header.stamp), frames[i]["stamp"], topic + ": stamp")
        equal(image.encoding, encoding, topic + ": encoding")
        equal((image.width, image.height), (expected["width"], expected["height"]), topic)
        with open(os.path.join(folder, "%d.%s" % (i, suffix)), "rb") as pixels:
            if pixels.read() != image.data:
                sys.exit("%s: the pixels of frame %d differ" % (topic, i))


def check_pose(translation, rotation, wanted, what):
    equal([translation.x, translation.y, translation.z], wanted["translation"], what)
    equal([rotation.w, rotation.x, rotation.y, rotation.z], wanted["rotation"], what)


check_image("/camera/rgb/image_raw", "rgb8", "rgb")
raw = expected["depth"] == "16UC1"
check_image("/camera/depth_registered/image" + ("_raw" if raw else ""), expected["depth"], "depth")
for camera in ("rgb", "depth_registered"):
    infos = messages["/camera/%s/camera_info" % camera]
    equal(len(infos), len(frames), "camera_info of " + camera)
    for info in infos:
        equal(list(info.K), expected["K"], "K")
        equal(info.P[0], expected["K"][0], "P")
for i, frame in enumerate(frames):
    pose = messages["/ground_truth/pose"][i].pose
    check_pose(pose.position, pose.orientation, frame, "/ground_truth/pose")
    tf = messages["/tf"][i].transforms[0]
    equal((tf.header.frame_id, tf.child_frame_id), ("world", "camera_link"), "/tf")
    check_pose(tf.transform.translation, tf.transform.rotation, frame, "/tf")
# Every stamp of every stream, once.
ticks = [message.clock.to_nsec() for message in messages["/clock"]]
equal(ticks, sorted({stamp.to_nsec() for _, _, stamp in bag.read_messages()}), "/clock")
equal(len(messages["/tf_static"]), 1, "/tf_static")
latching = [c.header.get("latching") for c in bag._get_connections(["/tf_static"])]
equal([str(b"1" if v in (b"1", "1") else v) for v in latching], [str(b"1")], "latching")
if channels:
    check_image("/camera/right/image_raw", "rgb8", "right")
    check_image("/ground_truth/depth/image", "32FC1", "true_depth")
    check_image("/ground_truth/normals/image", "32FC3", "normals")
    check_image("/ground_truth/flow/image", "32FC2", "flow")
    check_image("/ground_truth/instance/image", "32SC1", "instance")
    check_image("/ground_truth/label/image", "16UC1", "label")
    equal(len(messages["/imu"]), sum(len(frame["imu"]) for frame in frames), "messages on /imu")
    for i, frame in enumerate(frames):
        found = [[e.x, e.y, parts(e.ts), e.polarity] for e in messages["/camera/events"][i].events]
        equal(found, frame["events"], "/camera/events")
print("ok: %d frames" % len(frames))
