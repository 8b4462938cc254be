"""Checks of mission.mcap and metadata.yaml by the readers of others."""
import json

import numpy as np

from recorded import DATA, Frames, close, matrix, need, of_webdataset, rotation


def header_ns(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def picture(message):
    kinds = {"rgb8": (np.uint8, 3), "16UC1": (np.uint16, 1), "32FC1": (np.float32, 1), "32FC2": (np.float32, 2),
             "32FC3": (np.float32, 3), "32SC1": (np.int32, 1), "mono8": (np.uint8, 1)}
    kind, values = kinds[message.encoding]
    shape = (message.height, message.width, values) if values > 1 else (message.height, message.width)
    return np.frombuffer(message.data.tobytes(), kind).reshape(shape)


def rosbags_reads_the_folder():
    """AnyReader opens the folder of the run as a ROS 2 bag; every message is that of the tables."""
    from rosbags.highlevel import AnyReader
    folder = DATA / "single"
    frames, arrays = Frames(folder), of_webdataset(folder)
    index = {stamp: i for i, stamp in enumerate(frames.stamps)}
    imu = np.loadtxt(folder / "frames" / "imu.csv", delimiter=",", skiprows=1)
    scans = [line.split() for line in (folder / "pcd" / "top" / "stamps.txt").read_text(encoding="ascii").splitlines()]
    tables = {name: np.genfromtxt(folder / "sensors" / (name + ".csv"), delimiter=",", dtype=np.float64, comments="#", ndmin=2)
              for name in ("sonar", "height", "compass", "gps", "level")}
    count, seen, last = {}, set(), 0
    with AnyReader([folder]) as reader:
        stated = {c.topic: c.msgcount for c in reader.connections}
        for connection in reader.connections:
            latched = connection.topic in ("/tf_static", "/ground_truth/legend")
            need(connection.ext.offered_qos_profiles[0].durability.value == (1 if latched else 2), "%s: QoS", connection.topic)
        need(reader.start_time == frames.stamps[0], "the bag begins at %d", reader.start_time)
        for connection, stamp, raw in reader.messages():
            topic, message = connection.topic, reader.deserialize(raw, connection.msgtype)
            k = count[topic] = count.get(topic, 0) + 1
            need(stamp >= last, "stamps go back in %s", topic)
            last = stamp
            if hasattr(message, "header"):
                need(header_ns(message) == stamp, "%s: message %d has another stamp than the bag", topic, k)
            check_message(topic, message, stamp, k, (frames, arrays, index, imu, scans, tables, folder))
            seen.add(topic)
    need(count == {topic: n for topic, n in stated.items() if n}, "counts of metadata.yaml are %s, of messages %s", stated, count)
    need(sum(count.values()) == sum(stated.values()), "not all messages were read")
    print("   %d messages of %d topics" % (sum(count.values()), len(seen)))


def check_message(topic, message, stamp, k, known):
    frames, arrays, index, imu, scans, tables, folder = known
    i = index.get(stamp)
    if topic == "/clock":
        need(message.clock.sec * 10**9 + message.clock.nanosec == stamp, "the clock")
    elif topic == "/ground_truth/pose":
        p, q = message.pose.position, message.pose.orientation
        close(matrix(rotation(q.w, q.x, q.y, q.z), [p.x, p.y, p.z]), frames.bodies[i], 1e-12, "pose %d", i)
    elif topic in ("/tf", "/tf_static"):
        for t in message.transforms:
            need(not t.header.frame_id.startswith("/") and t.child_frame_id != t.header.frame_id, "frames of %s", topic)
            if topic == "/tf":
                v = t.transform.translation
                close([v.x, v.y, v.z], frames.bodies[i][:3, 3], 1e-12, "/tf %d", i)
    elif topic.endswith("camera_info"):
        c = frames.camera
        need((message.width, message.height) == (c["width"], c["height"]), "size in %s", topic)
        close(message.k, [c["fx"], 0, c["cx"], 0, c["fy"], c["cy"], 0, 0, 1], 0, "K of %s", topic)
        close(message.p, [c["fx"], 0, c["cx"], 0, 0, c["fy"], c["cy"], 0, 0, 0, 1, 0], 0, "P of %s", topic)
        close(message.r, np.eye(3).ravel(), 0, "R of %s", topic)
    elif topic == "/camera/rgb/image_raw":
        need(np.array_equal(picture(message), frames.rgb(i)), "colour %d", i)
    elif topic == "/camera/depth_registered/image":
        need(np.array_equal(picture(message), arrays[i]["depth.npy"], equal_nan=True), "depth %d", i)
    elif topic.startswith("/ground_truth/") and topic.endswith("/image"):
        need(np.array_equal(picture(message), arrays[i][topic.split("/")[2] + ".npy"], equal_nan=topic[14:19] in ("norma", "flow/")),
             "%s %d", topic, i)
    elif topic == "/ground_truth/legend":
        need(json.loads(message.data) == json.loads((folder / "frames" / "legend.json").read_text(encoding="utf-8")), "the legend")
    elif topic == "/imu":
        row = imu[k - 1]
        need(int(row[0]) == np.float64(stamp), "stamp of inertial reading %d", k)
        w, a = message.angular_velocity, message.linear_acceleration
        close([w.x, w.y, w.z, a.x, a.y, a.z], row[1:7], 0, "inertial reading %d", k)
        need(message.orientation_covariance[0] == -1, "an orientation that is not measured has the covariance -1 (REP 145)")
        need(message.angular_velocity_covariance[0] > 0 and message.linear_acceleration_covariance[0] > 0, "covariances")
    elif topic == "/points":
        points = np.frombuffer(message.data.tobytes(), np.dtype({"names": [f.name for f in message.fields], "formats": [
            {7: "<f4", 4: "<u2"}[f.datatype] for f in message.fields], "offsets": [f.offset for f in message.fields],
            "itemsize": message.point_step}))
        content = (folder / "pcd" / "top" / scans[k - 1][1]).read_bytes()
        kinds = [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")]
        wanted = np.frombuffer(content[content.index(b"DATA binary\n") + 12:], kinds)
        need(len(points) == len(wanted) == message.width * message.height, "points of scan %d", k)
        for name, _ in kinds:
            need(np.array_equal(points[name], wanted[name]), "%s of scan %d", name, k)
    elif topic.split("/")[1] in tables:
        check_reading(topic, message, tables[topic.split("/")[1]][k - 1])
    else:
        need(topic in ("/robot_description",), "the topic %s is compared with nothing", topic)


def check_reading(topic, message, row):
    kind = type(message).__name__
    if "Range" in kind:
        wanted = np.float32(row[1])
        need(message.range == wanted or (np.isinf(wanted) and np.isinf(message.range)), "%s: %s, not %s", topic, message.range, wanted)
        need(message.min_range < message.max_range and message.field_of_view > 0, "limits of %s", topic)
    elif "FluidPressure" in kind:
        close(message.fluid_pressure, row[1], 0, topic)
    elif "MagneticField" in kind:
        close([message.magnetic_field.x, message.magnetic_field.y, message.magnetic_field.z], row[1:4], 0, topic)
    elif "NavSatFix" in kind:
        need(message.status.status in (-1, 0), "status of %s", topic)
        if message.status.status == 0:
            need(message.position_covariance_type == 2 and message.position_covariance[0] > 0, "covariance of %s", topic)
            need(any(abs(message.latitude - v) < 1e-12 for v in row[1:]), "latitude of %s", topic)
    elif "Imu" in kind:
        q = message.orientation
        close(q.x**2 + q.y**2 + q.z**2 + q.w**2, 1, 1e-9, "%s: length of the quaternion", topic)
        need(message.angular_velocity_covariance[0] == -1 and message.orientation_covariance[0] > 0, "covariances of %s", topic)
    else:
        need(False, "%s: nothing compares a %s", topic, kind)


def robots_are_as_rep_105_says():
    """Odometry and joints of a robot: frames, covariances, equal lengths; the truth is that of the rig."""
    from rosbags.highlevel import AnyReader
    kinds, parents = {}, {}
    with AnyReader([DATA / "robot"]) as reader:
        for connection, _, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            kinds.setdefault(connection.topic, []).append(message)
            if connection.topic in ("/tf", "/tf_static"):
                for t in message.transforms:
                    parents.setdefault(t.child_frame_id, set()).add(t.header.frame_id)
    need(kinds["/odom"] and kinds["/ground_truth/odom"] and kinds["/joint_states"], "topics of the robot")
    for topic in ("/odom", "/ground_truth/odom"):
        for message in kinds[topic]:
            for values in (message.pose.covariance, message.twist.covariance):
                c = np.asarray(values).reshape(6, 6)
                need((np.diag(c) > 0).all() and np.array_equal(c, c.T), "covariance of %s", topic)
    need(kinds["/odom"][0].header.frame_id == "odom" and kinds["/odom"][0].child_frame_id == "base_link", "frames of /odom")
    for message in kinds["/joint_states"]:
        need(len(message.name) == len(message.position) == len(message.velocity) == len(message.effort), "/joint_states")
    need(all(len(above) == 1 for above in parents.values()), "frames with two parents: %s", parents)
    need(parents["odom"] == {"world"} and parents["base_link"] == {"odom"}, "world -> odom -> base_link")


def mcap_has_one_schema_for_each_type():
    from mcap.reader import make_reader
    for name in ("single", "rig"):
        with open(DATA / name / "mission.mcap", "rb") as file:
            reader = make_reader(file, validate_crcs=True)
            summary = reader.get_summary()
            names = [schema.name for schema in summary.schemas.values()]
            need(len(names) == len(set(names)), "a type has two schemas: %s", sorted(names))
            need(summary.statistics.schema_count == len(names) and len(summary.channels) > len(names), "statistics")
            need(sum(1 for _ in reader.iter_messages()) == summary.statistics.message_count, "messages")


def rerun_converts_without_an_error():
    """Its importer knows no 32FC2 and 32FC3: the mission `robot` has its normals as colours."""
    import subprocess
    import sys
    from pathlib import Path
    rerun, path = Path(sys.executable).parent / "rerun", DATA / "robot" / "mission.mcap"
    done = subprocess.run([rerun, "mcap", "convert", path, "-o", DATA / "robot.rrd"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False, env={"RUST_LOG": "warn", "NO_COLOR": "1", "HOME": str(DATA)})
    need(done.returncode == 0 and "ERROR" not in done.stdout, "rerun says: %s", done.stdout)
    need("/ground_truth/normals/colours/image" in done.stdout or (DATA / "robot.rrd").stat().st_size > 10**5, "an empty recording")


def mcap_ros2_decodes_all_topics():
    """Every topic, also those whose types share a schema; vectors as colours where the mission wants them."""
    from mcap.reader import make_reader
    from mcap_ros2.reader import read_ros2_messages
    for name in ("single", "rig"):
        path = DATA / name / "mission.mcap"
        with open(path, "rb") as file:
            statistics = make_reader(file).get_summary().statistics
        counts = {}
        for message in read_ros2_messages(str(path)):
            counts[message.channel.id] = counts.get(message.channel.id, 0) + 1
        need(counts == dict(statistics.channel_message_counts), "messages of each topic")
    pictures = {m.channel.topic: m.ros_msg for m in read_ros2_messages(str(DATA / "robot" / "mission.mcap"), topics=[
        "/ground_truth/normals/image", "/ground_truth/normals/colours/image"])}
    need(set(pictures) == {"/ground_truth/normals/colours/image"}, "topics of normals: %s", sorted(pictures))
    image = pictures["/ground_truth/normals/colours/image"]
    need(image.encoding == "rgb8" and len(image.data) == 3 * image.width * image.height, "colours of normals")
