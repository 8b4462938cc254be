#!/usr/bin/env python3
"""`rubble serve` and `rubble run --ros2`, read and driven by the Python package cyclonedds with the types of `rubble info --idl`:
serve_by_cyclone.py PROGRAM FOLDER. Exit code 77: no package index can be reached."""
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "datasets"))
from read_datasets import SKIPPED, prepare_readers  # noqa: E402

PROGRAM, FOLDER = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
DOMAIN = 101 + os.getpid() % 100
SI = "simulation_interfaces/srv/"
MISSION = """return rubble.mission {
  seed = 3, start_ns = 5000000000, packs = { "concrete" },
  pile = { layers = 1, pieces_per_layer = 6, mix = { { asset = "brick" } }, spawn_position = { 4, 0, 1 }, spawn_bounds = { 1, 1, 1 } },
  robots = { { name = "crawler", model = "crawler", position = { 0, 0, 0.1 } } },
  lidars = { top = { model = "vlp16", rate_hz = 5, position = { 0, 0, 0.4 }, ride = { robot = "crawler" } } },
  camera = { width = 48, height = 32 }, trajectory = { rate_hz = 10, ride = { robot = "crawler" } }, robot_run = { duration = 0.4 },
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


def services_do_as_simulation_interfaces_says(node):
    def call(service, kind, **values):
        return node.call("/" + service, SI + kind, **values)
    need(call("get_simulation_state", "GetSimulationState").state.state == 2, "it begins paused")
    features = set(call("get_simulator_features", "GetSimulatorFeatures").features.features)
    need({0, 10, 11, 20, 26, 32} <= features and 33 not in features, "features %s", features)
    entities = call("get_entities", "GetEntities").entities
    need(entities[0] == "crawler" and len(entities) == 7, "entities %s", entities)
    robots = call("get_entities", "GetEntities", filters={"categories": [{"category": 1}]}).entities
    need(robots == ["crawler"], "robots %s", robots)
    bricks = call("get_entities", "GetEntities", filters={"filter": "^piece_[0-2]$", "tags": {"tags": ["brick"]}}).entities
    need(bricks == ["piece_0", "piece_1", "piece_2"], "bricks %s", bricks)
    near = call("get_entities", "GetEntities", filters={"bounds": {"type": 3, "points": [{"x": 0.0}, {"x": 1.0}]}}).entities
    need(near == ["crawler"], "near %s", near)
    need(call("get_entities", "GetEntities", filters={"filter": "("}).result.result == 4, "a broken expression")
    need(call("get_entity_info", "GetEntityInfo", entity="piece_1").info.tags == ["piece", "brick"], "info")
    need(call("get_entity_state", "GetEntityState", entity="nobody").result.result == 2, "an entity that is not there")

    # 24 steps of a 240th of a second.
    def state(name):
        return call("get_entity_state", "GetEntityState", entity=name).state
    need(call("step_simulation", "StepSimulation", steps=24).result.result == 1, "24 steps")
    stamp = state("crawler").header.stamp
    need((stamp.sec, stamp.nanosec) == (5, 100_000_000), "time %s", stamp)

    # A brick that is lifted falls: after 48 steps by about g t^2 / 2.
    pose = {"position": {"x": 4.0, "y": 3.0, "z": 2.0}, "orientation": {"w": 1.0}}
    result = call("set_entity_state", "SetEntityState", entity="piece_0", set_pose=True, set_twist=True, state={"pose": pose}).result
    need(result.result == 1, "%s", result.error_message)
    call("step_simulation", "StepSimulation", steps=48)
    lifted = state("piece_0")
    need(abs(2.0 - lifted.pose.position.z - 9.81 * 0.02) < 0.01, "z %g", lifted.pose.position.z)
    need(abs(lifted.twist.linear.z + 9.81 * 0.2) < 0.05, "speed %g", lifted.twist.linear.z)
    bad = call("set_entity_state", "SetEntityState", entity="piece_0", set_pose=True, state={"pose": {"position": {"x": 1.0}}}).result
    need(bad.result == 101, "no quaternion: %s", bad)
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
    for values, code in (({"name": "scout", "entity_resource": {"uri": "rubble://boat"}}, 103), ({"name": "7up"}, 104),
                         ({"name": "7up", "entity_resource": {"uri": "rubble://rover"}, "initial_pose": {"pose": robot}}, 102),
                         ({"name": "crawler", "entity_resource": {"uri": "rubble://rover"}, "initial_pose": {"pose": robot}}, 101)):
        result = call("spawn_entity", "SpawnEntity", **values).result
        need(result.result == code, "%s: %d, %s", values, result.result, result.error_message)
    spawned = call("spawn_entity", "SpawnEntity", name="scout", entity_resource={"uri": "rubble://rover"}, initial_pose={"pose": robot})
    need(spawned.result.result == 1 and spawned.entity_name == "scout", "%s", spawned.result.error_message)
    need(abs(state("scout").pose.position.x + 1) < 1e-9, "the rover stands where it was put")
    need(call("delete_entity", "DeleteEntity", entity="scout").result.result == 1, "deleted")
    need(call("get_entity_state", "GetEntityState", entity="scout").result.result == 2, "gone")


def topics_come_and_commands_go(node):
    joints, odometry, points = (node.subscribe(topic, kind) for topic, kind in (
        ("/joint_states", "sensor_msgs/msg/JointState"), ("/ground_truth/odom", "nav_msgs/msg/Odometry"), ("/points", "sensor_msgs/msg/PointCloud2")))
    drive = node.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
    turn = node.advertise("/joint_commands", "sensor_msgs/msg/JointState")
    node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 1})
    names = until(20, lambda: [m.name for m in joints.take(N=1000)], "joint states")[-1]
    flipper = next(name for name in names if "flipper" in name)
    ways, angles, clouds = [], [], []

    def moved():
        drive(linear={"x": 0.3})
        turn(name=[flipper], position=[0.4])
        ways.extend(m.pose.pose.position.x for m in odometry.take(N=1000))
        angles.extend(m.position[names.index(flipper)] for m in joints.take(N=1000))
        clouds.extend(points.take(N=100))
        return ways and angles and clouds and ways[-1] - ways[0] > 0.2 and abs(angles[-1] - 0.4) < 0.05
    until(40, moved, "the crawler drives and lifts %s: %s, %s, %d clouds" % (flipper, ways[-1:], angles[-1:], len(clouds)))
    cloud = clouds[-1]
    need([f.name for f in cloud.fields] == ["x", "y", "z", "intensity", "ring", "time"], "fields %s", cloud.fields)
    need(cloud.width * cloud.height * cloud.point_step == len(cloud.data) > 1000, "%d points", cloud.width)
    turn(name=["nothing"], position=[1.0])
    until(10, lambda: "nothing" in (FOLDER / "served.txt").read_text(errors="replace"), "a word about a joint that is not there")
    need(node.call("/set_simulation_state", SI + "SetSimulationState", state={"state": 3}).result.result == 1, "quit")


def pictures_come_while_a_run_draws(node):
    images = node.subscribe("/camera/rgb/image_raw", "sensor_msgs/msg/Image")
    constants = node.subscribe("/tf_static", "tf2_msgs/msg/TFMessage", latched=True)
    with Served("run", FOLDER / "mission.lua", "--out", FOLDER / "out", "--force", "--quiet", "--ros2", "--ros-domain", str(DOMAIN), "--rate", "fast",
                "--wait-for-subscribers", "3") as run:
        heard = []
        until(90, lambda: heard.extend(images.take(N=100)) or len(heard) >= 5 or run.process.poll() is not None, "pictures")
        need([(m.width, m.height, m.encoding, len(m.data)) for m in heard] == 5 * [(48, 32, "rgb8", 4608)], "%d pictures", len(heard))
        need(any(t.child_frame_id.endswith("optical_frame") for m in constants.take(N=10) for t in m.transforms), "no camera in /tf_static")


def check():
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples" / "ros2"))
    from dds import Node
    (FOLDER / "mission.lua").write_text(MISSION, encoding="ascii")
    (FOLDER / "rubble.idl").write_bytes(subprocess.run([PROGRAM, "info", "--idl"], check=True, stdout=subprocess.PIPE).stdout)
    node = Node(FOLDER / "rubble.idl", DOMAIN)
    with Served("serve", FOLDER / "mission.lua", "--paused", "--quiet", "--ros-domain", str(DOMAIN)) as served:
        for part in (services_do_as_simulation_interfaces_says, topics_come_and_commands_go):
            part(node)
            print("right:", part.__name__)
        need(served.process.wait(20) == 0, "exit code %d", served.process.returncode)
    pictures_come_while_a_run_draws(node)
    print("right: pictures_come_while_a_run_draws")


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
