#!/usr/bin/env python3
"""`rubble serve` and `rubble run --ros2`, read and driven by the Python package cyclonedds with the types of `rubble info --idl`:
serve_by_cyclone.py PROGRAM FOLDER. Exit code 77: no package index can be reached."""
import copy
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "datasets"))
from read_datasets import SKIPPED, prepare_readers  # noqa: E402

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "ros2"

if os.environ.get("RUBBLE_READERS") == "ready":
    from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import make_idl_struct, types
    from cyclonedds.internal import InvalidSample

    sys.path.insert(0, str(EXAMPLES))
    from dds import Node

PROGRAM, FOLDER = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
DOMAIN = 1 + os.getpid() % 100  # their ports are free on Linux
SI = "simulation_interfaces/srv/"
MISSION = """local driver = rubble.parameter("driver", "velodyne", { choices = { "velodyne", "ouster", "livox" } })
local models = { velodyne = "vlp16", ouster = "os1", livox = "mid360" }
local on = { robot = "crawler" }
return rubble.mission {
  seed = 3, start_ns = 5000000000, packs = { "concrete" },
  pile = { layers = 1, pieces_per_layer = 6, mix = { { asset = "brick" } }, spawn_position = { 4, 0, 1 }, spawn_bounds = { 1, 1, 1 },
           placed = { { box = { 0.2, 4, 1 }, position = { 6, 0, 0.5 } } } },
  robots = { { name = "crawler", model = "crawler", position = { 0, 0, 0.001 }, drive = { { t = 0, linear = 0.3 } } } },
  lidars = { top = { model = models[driver], driver = driver, position = { 0, 0, 0.4 }, ride = on },
             flat = { model = "utm30lx", rate_hz = 10, position = { 0.3, 0, 0.3 }, ride = on } },
  range_finders = { tof = { ride = on, position = { 0.4, 0, 0.2 } } },
  bumpers = { bow = { ride = on, links = { "front_left_flipper", "front_right_flipper" } } },
  attitudes = { ahrs = { ride = on } }, barometers = { baro = { ride = on } }, magnetometers = { mag = { ride = on } },
  gnss = { gps = { ride = on, position = { -0.2, 0, 0.45 } } }, batteries = { pack = { ride = on } },
  imu = { on = true, ride = on },
  camera = { width = 48, height = 32 }, trajectory = { rate_hz = 10, ride = { robot = "crawler" } }, robot_run = { duration = 0.6 },
}
"""


def need(condition, text, *values):
    if not condition:
        raise AssertionError(text % values if values else text)


def until(seconds, ready, what):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = ready()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError("not within %g s: %s" % (seconds, what))


class Served:
    """The program at work; stopped at the end."""

    def __init__(self, *arguments):
        environment = {name: value for name, value in os.environ.items() if name not in ("CYCLONEDDS_URI", "ROS_DOMAIN_ID")}
        self.process = subprocess.Popen([PROGRAM, *arguments], env=environment, stderr=open(FOLDER / "served.txt", "wb"))

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.wait(20)
        if kind:
            print((FOLDER / "served.txt").read_text(errors="replace")[-2000:])


def published(node, ours):
    """Types by the topics that others publish."""
    reader = BuiltinDataReader(node.participant, BuiltinTopicDcpsPublication)
    found = {}
    for sample in reader.take(N=1000):
        if sample.topic_name.startswith("rt/") and sample.participant_key != ours:
            kind = sample.type_name.replace("::dds_::", "/").replace("::", "/")[:-1]
            found[sample.topic_name[2:]] = kind
    return found


def stamp_of(header):
    return header.stamp.sec * 10**9 + header.stamp.nanosec


def diagonal(covariance, size):
    return [covariance[i * (size + 1)] for i in range(size)]


def imu_is_right(message):  # REP 145
    if message.orientation_covariance[0] == -1:
        pull = message.linear_acceleration
        need(4 < (pull.x**2 + pull.y**2 + pull.z**2) ** 0.5 < 30, "gravity is in it: %s", pull)
        need(min(diagonal(message.angular_velocity_covariance, 3) + diagonal(message.linear_acceleration_covariance, 3)) > 0, "variances")
    else:
        q = message.orientation
        need(abs(q.x**2 + q.y**2 + q.z**2 + q.w**2 - 1) < 1e-9, "a rotation: %s", q)
        need(message.angular_velocity_covariance[0] == message.linear_acceleration_covariance[0] == -1, "what it does not measure is marked")


def cloud_is_right(message):
    names = [field.name for field in message.fields]
    need(names in (["x", "y", "z", "intensity", "ring", "time"],
                   ["x", "y", "z", "intensity", "t", "reflectivity", "ring", "ambient", "range"]), "fields %s", names)
    need(message.width * message.height * message.point_step == len(message.data) > 1000, "%d points", message.width)


def livox_is_right(message):
    need(message.timebase == stamp_of(message.header) and message.point_num == len(message.points) > 100, "%d points", message.point_num)
    times = [point.offset_time for point in message.points]
    need(0 <= min(times) and max(times) < 110_000_000, "within a scan: %d ns", max(times))


def odometry_is_right(message):  # REP 105
    need((message.header.frame_id, message.child_frame_id) in (("odom", "base_link"), ("world", "base_link")), "frames %s, %s",
         message.header.frame_id, message.child_frame_id)
    need(min(diagonal(message.pose.covariance, 6) + diagonal(message.twist.covariance, 6)) > 0, "variances %s", message.pose.covariance)


def battery_is_right(message):
    need(message.current < 0 and message.power_supply_status == 2, "it discharges: %s", message)
    need(0.9 < message.percentage <= 1 and abs(message.charge - 10 * message.percentage) < 1e-3, "charge %s", message.charge)
    need(math.isnan(message.temperature) and message.present and len(message.cell_voltage) == 7, "%s", message)
    need(abs(sum(message.cell_voltage) - message.voltage) < 1e-3, "cells %s of %g V", message.cell_voltage, message.voltage)


def scan_is_right(message):  # REP 117
    need(all(r == math.inf or message.range_min <= r <= message.range_max for r in message.ranges), "ranges")
    need(abs(message.angle_min + (len(message.ranges) - 1) * message.angle_increment - message.angle_max) < 1e-4, "angles")


def joints_are_right(message):
    need(len(message.name) == len(message.position) == len(message.velocity) == len(message.effort) > 0, "joints %s", message.name)


def range_is_right(message):  # REP 117
    need(math.isinf(message.range) or message.min_range <= message.range <= message.max_range, "range %g", message.range)


def fix_is_right(message):
    need(message.status.status >= 0 and message.position_covariance_type == 2, "fix %s", message.status)
    need(min(diagonal(message.position_covariance, 3)) > 0 and abs(message.latitude - 42.36) < 0.01, "fix %s", message)


def picture_is_right(message):
    need((message.width, message.height) == (48, 32) and len(message.data) == message.step * 32, "%d bytes", len(message.data))
    need(message.encoding in ("rgb8", "16UC1"), "encoding %s", message.encoding)  # REP 118: mm as 16UC1


def calibration_is_right(message):
    need((message.width, message.height) == (48, 32) and message.k[0] > 0 and message.k[8] == 1 == message.r[0] and message.p[0] == message.k[0],
         "calibration %s", message.k)


RIGHT = {"Imu": imu_is_right, "PointCloud2": cloud_is_right, "CustomMsg": livox_is_right, "Odometry": odometry_is_right,
         "BatteryState": battery_is_right, "LaserScan": scan_is_right, "Range": range_is_right, "NavSatFix": fix_is_right,
         "Image": picture_is_right, "CameraInfo": calibration_is_right, "JointState": joints_are_right}
SERVED = {"/clock", "/tf", "/tf_static", "/joint_states", "/odom", "/ground_truth/odom", "/contacts", "/robot_description", "/points", "/scan",
          "/tof", "/bow", "/bow/wrench", "/ahrs", "/baro", "/mag", "/gps", "/battery_state", "/imu"}
PICTURES = {"/camera/rgb/image_raw", "/camera/rgb/camera_info", "/camera/depth_registered/image_raw", "/camera/depth_registered/camera_info",
            "/ground_truth/pose"}
LATCHED = {"/tf_static", "/robot_description", "/ground_truth/legend"}


class Heard:
    """Readers of every topic that is published, and all of their messages."""

    def __init__(self, node, expected):
        ours = node.participant.guid
        kinds = {}
        until(20, lambda: kinds.update(published(node, ours)) or expected <= set(kinds), "topics %s; there are %s" % (expected, kinds))
        need(set(kinds) == expected, "topics %s", set(kinds) ^ expected)
        self.kinds = kinds
        self.readers = {topic: node.subscribe(topic, kind, latched=topic in LATCHED) for topic, kind in kinds.items()}
        self.messages = {topic: [] for topic in kinds}

    def complete(self, least=1):
        for topic, reader in self.readers.items():
            self.messages[topic] += [sample for sample in reader.take(N=1000) if not isinstance(sample, InvalidSample)]  # the end of a writer
        return all(len(list) >= (1 if topic in LATCHED else least) for topic, list in self.messages.items())

    def check(self):
        """Each message of its kind; frames are those of one tree (REP 105)."""
        parents = {}
        for topic in ("/tf", "/tf_static"):
            for message in self.messages[topic]:
                for transform in message.transforms:
                    child, parent = transform.child_frame_id, transform.header.frame_id
                    need(parents.setdefault(child, parent) == parent, "%s has two parents", child)
        need(parents["base_link"] == "odom" and parents["odom"] == "world" and "world" not in parents, "frames %s", parents)
        for topic, messages in self.messages.items():
            right, last = RIGHT.get(self.kinds[topic].rsplit("/", 1)[1]), 0
            for message in messages:
                if hasattr(message, "header"):
                    frame = message.header.frame_id
                    need(frame == "world" or frame in parents, "%s: frame %s", topic, frame)
                    need(stamp_of(message.header) >= max(last, 5 * 10**9), "%s: stamps go back", topic)
                    last = stamp_of(message.header)
                if right:
                    right(message)
        clock = [m.clock.sec * 10**9 + m.clock.nanosec for m in self.messages["/clock"]]
        need(clock == sorted(clock) and clock[-1] > clock[0] >= 5 * 10**9, "the clock goes on")


def services_do_as_simulation_interfaces_says(node):
    def call(service, kind, **values):
        return node.call("/" + service, SI + kind, **values)
    need(call("get_simulation_state", "GetSimulationState").state.state == 2, "it begins paused")
    features = set(call("get_simulator_features", "GetSimulatorFeatures").features.features)
    need(features == {0, 1, 4, 6, 8, 10, 11, 12, 14, 20, 24, 25, 26, 31, 32}, "features %s", features)
    entities = call("get_entities", "GetEntities").entities
    need(entities[0] == "crawler" and len(entities) == 8, "entities %s", entities)
    robots = call("get_entities", "GetEntities", filters={"categories": [{"category": 1}]}).entities
    need(robots == ["crawler"], "robots %s", robots)
    bricks = call("get_entities", "GetEntities", filters={"filter": "^piece_", "tags": {"tags": ["brick"]}}).entities
    need(len(bricks) == 6, "bricks %s", bricks)
    (wall,) = call("get_entities", "GetEntities", filters={"categories": [{"category": 5}]}).entities
    states = call("get_entities_states", "GetEntitiesStates", filters={"filter": wall})
    need(states.entities == [wall] and abs(states.states[0].pose.position.x - 6) < 1e-9, "the wall %s", states)
    near = call("get_entities", "GetEntities", filters={"bounds": {"type": 3, "points": [{"x": 0.0}, {"x": 1.0}]}}).entities
    need(near == ["crawler"], "near %s", near)
    need(call("get_entities", "GetEntities", filters={"filter": "("}).result.result == 4, "a broken expression")
    need(call("get_entity_info", "GetEntityInfo", entity=bricks[1]).info.tags == ["piece", "brick"], "info")
    need(call("get_entity_state", "GetEntityState", entity="nobody").result.result == 2, "an entity that is not there")

    # 24 steps of a 240th of a second.
    def state(name):
        return call("get_entity_state", "GetEntityState", entity=name).state
    need(call("step_simulation", "StepSimulation", steps=24).result.result == 1, "24 steps")
    stamp = state("crawler").header.stamp
    need((stamp.sec, stamp.nanosec) == (5, 100_000_000), "time %s", stamp)

    # A brick that is lifted falls: after 48 steps by about g t^2 / 2.
    pose = {"position": {"x": 4.0, "y": 3.0, "z": 2.0}, "orientation": {"w": 1.0}}
    result = call("set_entity_state", "SetEntityState", entity=bricks[0], set_pose=True, set_twist=True, state={"pose": pose}).result
    need(result.result == 1, "%s", result.error_message)
    call("step_simulation", "StepSimulation", steps=48)
    lifted = state(bricks[0])
    need(abs(2.0 - lifted.pose.position.z - 9.81 * 0.02) < 0.01, "z %g", lifted.pose.position.z)
    need(abs(lifted.twist.linear.z + 9.81 * 0.2) < 0.05, "speed %g", lifted.twist.linear.z)
    bad = call("set_entity_state", "SetEntityState", entity=bricks[0], set_pose=True, state={"pose": {"position": {"x": 1.0}}}).result
    need(bad.result == 101, "no quaternion: %s", bad)
    fixed = call("set_entity_state", "SetEntityState", entity=wall, set_pose=True, state={"pose": pose}).result
    need(fixed.result == 4, "the wall is moved: %s", fixed)
    robot = {"position": {"x": -1.0, "y": 2.0, "z": 0.3}, "orientation": {"z": 2**-0.5, "w": 2**-0.5}}
    need(call("set_entity_state", "SetEntityState", entity="crawler", set_pose=True, set_twist=True, state={"pose": robot}).result.result == 1, "robot")
    placed = state("crawler").pose
    need(abs(placed.position.y - 2) < 1e-9 and abs(placed.orientation.z - 2**-0.5) < 1e-9, "placed at %s", placed)

    need(call("spawn_entity", "SpawnEntity", name="scout", entity_resource={"uri": "rubble://rover"}, initial_pose={"pose": robot}).result.result == 3,
         "spawned after the first step")
    need(call("reset_simulation", "ResetSimulation", scope=1).result.result == 0, "time alone")
    need(call("reset_simulation", "ResetSimulation").result.result == 1, "reset")
    need(abs(state("crawler").pose.position.y) < 1e-6 and state("crawler").header.stamp.sec == 5, "back at the start")
    uris = [s.entity_resource.uri for s in call("get_spawnables", "GetSpawnables").spawnables]
    need({"rubble://rover", "rubble://snake"} <= set(uris), "spawnables %s", uris)
    for values, code in (({"name": "scout", "entity_resource": {"uri": "rubble://boat"}, "initial_pose": {"pose": robot}}, 103), ({"name": "7up"}, 104),
                         ({"name": "7up", "entity_resource": {"uri": "rubble://rover"}, "initial_pose": {"pose": robot}}, 102),
                         ({"name": "crawler", "entity_resource": {"uri": "rubble://rover"}, "initial_pose": {"pose": robot}}, 101)):
        result = call("spawn_entity", "SpawnEntity", **values).result
        need(result.result == code, "%s: %d, %s", values, result.result, result.error_message)
    spawned = call("spawn_entity", "SpawnEntity", name="scout", entity_resource={"uri": "rubble://rover"}, initial_pose={"pose": robot})
    need(spawned.result.result == 1 and spawned.entity_name == "scout", "%s", spawned.result.error_message)
    need(abs(state("scout").pose.position.x + 1) < 1e-9, "the rover stands where it was put")
    need(call("delete_entity", "DeleteEntity", entity="scout").result.result == 1, "deleted")
    need(call("get_entity_state", "GetEntityState", entity="scout").result.result == 2, "gone")


def damaged_requests_are_refused(node):
    """Requests of types that lack their last fields, and one with more of them."""
    other = copy.copy(node)
    other.participant, other.clients = DomainParticipant(DOMAIN), {}
    short = make_idl_struct("Short", "short", {"client_number_": types.uint64, "request_number_": types.int64})
    for service, kind in (("step_simulation", "StepSimulation"), ("spawn_entity", "SpawnEntity"), ("get_entities", "GetEntities"),
                          ("set_entity_state", "SetEntityState"), ("delete_entity", "DeleteEntity")):
        name = f"simulation_interfaces.srv.dds_.{kind}_Request_"
        other.types = dict(node.types, **{SI + kind + "_Request": make_idl_struct(kind, name, dict(short.__annotations__))})
        answer = other.call("/" + service, SI + kind)
        need(answer.result.result == 4 and "what came is no " + kind in answer.result.error_message, "%s: %s", service, answer)
    whole = dict(node.types[SI + "ResetSimulation_Request"].__annotations__, more=types.array[types.uint8, 64])
    other.types = dict(node.types, **{SI + "ResetSimulation_Request":
                                      make_idl_struct("Reset", "simulation_interfaces.srv.dds_.ResetSimulation_Request_", whole)})
    need(other.call("/reset_simulation", SI + "ResetSimulation", more=64 * [1]).result.result == 4, "a longer request")


def every_topic_is_read_and_right(node):
    heard = Heard(node, SERVED)
    node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 1})
    until(60, lambda: heard.complete(3), "three messages of every topic")
    need(node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 2}).result.result == 1, "paused")
    heard.check()
    need(node.call("/reset_simulation", SI + "ResetSimulation").result.result == 1, "reset")


def the_example_prints_a_topic(node):
    arguments = [sys.executable, EXAMPLES / "dds.py", FOLDER / "rubble.idl", "/joint_states", "sensor_msgs/msg/JointState"]
    with subprocess.Popen(arguments, env=dict(os.environ, ROS_DOMAIN_ID=str(DOMAIN)), stdout=subprocess.PIPE, text=True) as example:
        node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 1})
        line = example.stdout.readline()
        example.terminate()
    need(line.startswith("JointState(header=") and "front_left_flipper_joint" in line, "it printed %s", line)
    need(node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 2}).result.result == 1, "paused")


def commands_are_obeyed(node):
    joints, odometry = node.subscribe("/joint_states", "sensor_msgs/msg/JointState"), node.subscribe("/ground_truth/odom", "nav_msgs/msg/Odometry")
    drive = node.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
    turn = node.advertise("/joint_commands", "sensor_msgs/msg/JointState")
    follow = node.advertise("/joint_trajectory", "trajectory_msgs/msg/JointTrajectory")
    node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 1})
    names = until(20, lambda: [m.name for m in joints.take(N=1000)], "joint states")[-1]
    left, right = (next(name for name in names if side in name) for side in ("front_left_flipper", "front_right_flipper"))
    ways, angles, others = [], [], []

    def moved():
        drive(linear={"x": 0.3})
        turn(name=[left], position=[0.4])
        ways.extend(m.pose.pose.position.x for m in odometry.take(N=1000))
        for message in joints.take(N=1000):
            angles.append(message.position[names.index(left)])
            others.append(message.position[names.index(right)])
        return ways and angles and ways[-1] - ways[0] > 0.2 and abs(angles[-1] - 0.4) < 0.05
    until(40, moved, "the crawler drives and lifts %s: %s, %s" % (left, ways[-1:], angles[-1:]))
    follow(joint_names=[right], points=[{"positions": [0.3], "time_from_start": {"sec": 1}}])
    until(40, lambda: moved() and abs(others[-1] - 0.3) < 0.05, "the trajectory is followed: %s" % others[-1:])
    turn(name=["nothing"], position=[1.0])
    until(10, lambda: "nothing" in (FOLDER / "served.txt").read_text(errors="replace"), "a word about a joint that is not there")
    need(node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 3}).result.result == 1, "quit")


def a_run_is_heard_while_it_draws(node):
    for driver in ("velodyne", "ouster", "livox"):
        with Served("run", FOLDER / "mission.lua", "--out", FOLDER / "out", "--force", "--quiet", "--ros2", "--ros-domain", str(DOMAIN), "--rate", "1",
                    "--wait-for-subscribers", "30", "--set", "driver=" + driver, "--set", "batteries.pack.rate_hz=5") as run:
            heard = Heard(node, SERVED | PICTURES)
            until(90, lambda: heard.complete() and run.process.poll() is not None, "every topic")
            heard.complete()
            need(run.process.returncode == 0, "exit code %d", run.process.returncode)
            heard.check()


def check():
    (FOLDER / "mission.lua").write_text(MISSION, encoding="ascii")
    (FOLDER / "rubble.idl").write_bytes(subprocess.run([PROGRAM, "info", "--idl"], check=True, stdout=subprocess.PIPE).stdout)
    node = Node(FOLDER / "rubble.idl", DOMAIN)
    with Served("serve", FOLDER / "mission.lua", "--paused", "--quiet", "--ros-domain", str(DOMAIN)) as served:
        for part in (every_topic_is_read_and_right, services_do_as_simulation_interfaces_says, damaged_requests_are_refused,
                     the_example_prints_a_topic, commands_are_obeyed):
            part(node)
            print("right:", part.__name__, flush=True)
        need(served.process.wait(20) == 0, "exit code %d", served.process.returncode)
    a_run_is_heard_while_it_draws(node)
    print("right: a_run_is_heard_while_it_draws")


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    if os.environ.get("RUBBLE_READERS") == "ready":
        return check()
    python = prepare_readers(FOLDER, "requirements-dds.txt")
    if python is None:
        print("skipped: the packages of tests/datasets/requirements-dds.txt cannot be installed here")
        return SKIPPED
    return subprocess.run([python, __file__, PROGRAM, FOLDER], check=False, env=dict(os.environ, RUBBLE_READERS="ready")).returncode


if __name__ == "__main__":
    sys.exit(main())
