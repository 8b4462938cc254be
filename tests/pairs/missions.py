"""A mission of one row of the array: its Lua source and the files beside it."""
import copy

from factors import FACTORS
from lua import Lua, put, to_lua

RATE = 5  # frames in a second
SECONDS = 0.8

# A roof on two walls beside the pile: a void that every seed has.
SHELTER = [{"box": [1.6, 0.2, 0.8], "position": [0, 3.6, 0.4]}, {"box": [1.6, 0.2, 0.8], "position": [0, 5.0, 0.4]},
           {"box": [1.6, 1.6, 0.15], "position": [0, 4.3, 0.876]}]

FILES = {
    "house.txt": """storey 2.6
wall 0 0 3 0 0.3 name=street
wall 0 3 3 3 0.3 name=yard
wall 0 0 0 3 0.3
wall 3 0 3 3 0.3
window 1 0 2 0 0.9 2.1
door 1 3 2 3 2.1
joists 0 0 3 3 0.2
""",
    "heights.asc": "ncols 8\nnrows 8\nxllcorner 0\nyllcorner 0\ncellsize 0.5\nNODATA_value -9999\n" +
                   "\n".join(" ".join("%.2f" % (100.05 + 0.02 * ((i * 3 + j * 5) % 7)) for i in range(8)) for j in range(8)) + "\n",
    "ground.obj": "o ground\nv -2 -2 0.02\nv 2 -2 0.02\nv 2 2 0.2\nv -2 2 0.1\nf 1 2 3\nf 1 3 4\n",
    "path.txt": "".join("%.1f %.3f -1 1.5 -0.5 0.5 -0.5 0.5\n" % (0.1 * k, -5 + 0.02 * k) for k in range(9)),
    "cart.urdf": """<?xml version="1.0"?>
<robot name="cart">
  <link name="base_link">
    <inertial><origin xyz="0 0 0.15"/><mass value="8"/><inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 0.17"/><geometry><box size="0.5 0.3 0.1"/></geometry></visual>
    <collision><origin xyz="0 0 0.17"/><geometry><box size="0.5 0.3 0.1"/></geometry></collision>
  </link>
""" + "".join("""  <link name="%s_wheel">
    <inertial><mass value="1"/><inertia ixx="0.003" iyy="0.005" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.1" length="0.05"/></geometry></collision>
  </link>
  <joint name="%s_wheel_joint" type="continuous">
    <parent link="base_link"/><child link="%s_wheel"/><origin xyz="0 %g 0.1"/><axis xyz="0 1 0"/>
    <limit effort="5" velocity="10"/>
  </joint>
""" % (side, side, side, y) for side, y in (("left", 0.2), ("right", -0.2))) + """  <link name="caster">
    <inertial><mass value="0.2"/><inertia ixx="0.0002" iyy="0.0002" izz="0.0002" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <joint name="caster_joint" type="fixed"><parent link="base_link"/><child link="caster"/><origin xyz="-0.2 0 0.05"/></joint>
  <link name="caster_front">
    <inertial><mass value="0.2"/><inertia ixx="0.0002" iyy="0.0002" izz="0.0002" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <joint name="caster_front_joint" type="fixed"><parent link="base_link"/><child link="caster_front"/><origin xyz="0.2 0 0.05"/></joint>
</robot>
""",
    "arm.urdf": """<?xml version="1.0"?>
<robot name="arm">
  <link name="world"/>
  <link name="foot">
    <inertial><mass value="5"/><inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.11"/><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision>
  </link>
  <joint name="mount" type="fixed"><parent link="world"/><child link="foot"/></joint>
  <link name="upper">
    <inertial><origin xyz="0 0 0.25"/><mass value="2"/><inertia ixx="0.04" iyy="0.04" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.3"/><geometry><box size="0.06 0.06 0.4"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="foot"/><child link="upper"/><origin xyz="0 0 0.25"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="60" velocity="2"/>
  </joint>
  <link name="slide">
    <inertial><mass value="0.5"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.1 0.04 0.04"/></geometry></collision>
  </link>
  <joint name="reach" type="prismatic">
    <parent link="upper"/><child link="slide"/><origin xyz="0 0 0.58"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.2" effort="40" velocity="1"/>
  </joint>
</robot>
""",
}

# What each robot is told: as `drive`, and what a function of the script returns.
COMMANDS = {
    "crawler": ({"linear": 0.3, "flippers_deg": [30, 30, 30, 30]}, "{ linear = 0.3, angular = 0.2 }"),
    "rover": ({"linear": 0.3}, "{ linear = 0.2, angular = 0.3 }"),
    "snake": ({"gait": "rolling"}, "{ joints = joints(s) }"),
    "vine": ({"growth": 0.2, "curvature": 0.5}, "{ growth = 0.15 }"),
    "cart": ({"linear": 0.3}, "{ linear = 0.2, angular = 0.2 }"),
    "arm": ({"joints": [0.4, 0.1]}, "{ joints = { 0.3, 0.05 } }"),
}
FUNCTION = """local function joints(s)
  local list = {}
  for i = 1, #s.joints do list[i] = 0.3 * math.sin(2 * s.t + i) end
  return list
end
"""


def make_mission(row, seed, name="row"):
    """(source, {file: text}) of a row; row may leave out factors, which then have their first level."""
    row = {factor: row.get(factor, next(iter(levels))) for factor, levels in FACTORS.items()}
    levels = [copy.deepcopy(FACTORS[factor][level]) for factor, level in row.items()]
    special = {}
    mission = {"seed": seed}
    for level in levels:
        for key, value in level.items():
            if key in ("@files", "@packs"):
                special.setdefault(key, []).extend(item for item in value if item not in special.get(key, []))
            elif key.startswith("@"):
                put(special, key, value)
            else:
                put(mission, key, value)
    source = FUNCTION
    add_pile(mission, special, row)
    robots = add_robots(mission, special, row)
    add_path(mission, special, robots)
    add_sensors(mission, special, robots)
    if "@packs" in special:
        mission["packs"] = special["@packs"] if row["pile"] == "residential" and row["building"] != "furnished" \
            else ["concrete"] + [pack for pack in special["@packs"] if pack != "concrete"]
    source += "local pile = " + special["pile"] + "\n" + special["more"]
    mission["pile"] = Lua("pile")
    return source + "return rubble.mission " + to_lua(mission) + "\n", {file: FILES[file] for file in special.get("@files", [])}


def add_pile(mission, special, row):
    source = special.get("@pile") or to_lua(mission.pop("pile", {}))
    mission.pop("pile", None)
    more = ""
    if "@building" in special:
        building = special["@building"]
        cause = special.get("@cause", {})
        plan, bridge = row["building"] == "plan", row["building"] == "bridge"
        here = {"part": "street"} if plan else {"i": 1 if bridge else 0, "j": 0}
        columns = [dict(here)] + ([] if plan else [{"i": here["i"], "j": 1}])
        if "removed" in cause:
            cause["removed"] = columns
        if "sinking" in cause:
            cause["sinking"] = [dict(column, depth=0.4) for column in columns]
        if "overload" in cause and (plan or row["building"] == "masonry"):
            cause["overload"] = 600  # thin boards carry no more
        if "vehicle" in cause:
            cause["vehicle"] = dict(here, mass=20000, speed=15, direction_deg=90)
        if cause:
            building["cause"] = cause
            put(mission, "settle.final_time_limit", 60)
        more += "local building = rubble.building " + to_lua(building) + "\n"
        if row["pile"] == "placed":  # not in a wall that may stand
            more += "for _, item in ipairs(pile.placed) do item.position[2] = item.position[2] - 6 end\n"
        # The two ways in which a building and other pieces come into one pile.
        more += "pile = rubble.join(pile, building)\n" if "@pile" in special else "pile.building = building.building\n"
    if "@terrain" in special:
        more += "pile.terrain = " + special["@terrain"] + "\n"
        if "@building" in special:
            more += "pile.terrain.position = { 8, 0, 0 }\n"  # a building stands beside it, on level ground
    if "@shelter" in special:
        more += "pile.placed = pile.placed or {}\n"
        more += "for _, box in ipairs(%s) do pile.placed[#pile.placed + 1] = box end\n" % to_lua(SHELTER)
    special["pile"], special["more"] = source, more


def add_robots(mission, special, row):
    robots = special.get("@robots", [])
    if not robots:
        return robots
    for robot in robots:
        if row["building"] == "furnished" or row["building"] != "none" and row["cause"] != "none":
            robot["position"] = [-10 if row["surroundings"] == "none" else -7.4] + robot["position"][1:]  # of what falls off it
        kind = robot.get("model") or robot["name"]
        drive, told = COMMANDS[kind]
        control = special.get("@control")
        if control == "drive":
            robot["drive"] = [dict(drive, t=0)]
        elif control:
            robot["control"] = Lua("rubble.controller(function(s) return %s end)" % told)
        if special.get("@robot_lamps") and robot is robots[0]:  # three lights beside the main one are the most
            robot["lamps"] = [{"link": "foot" if kind == "arm" else "base_link"} if "urdf" in robot else {}]
    mission["robots"] = robots
    put(mission, "robot_run.duration", SECONDS)
    return robots


def link_of(robot):
    return {"arm": "upper", "snake": "head"}.get(robot.get("model") or robot["name"], "")


def ride_on(robot):
    ride = {"robot": robot["name"]}
    if link_of(robot):
        ride["link"] = link_of(robot)
    return ride


def add_path(mission, special, robots):
    ends = [{"t": 0, "position": [-5, -2, 1.8], "look_at": [0, 0, 0.4]},
            {"t": SECONDS, "position": [-4.8, -2.2, 1.7], "look_at": [0, 0, 0.4]}]
    given = mission.pop("trajectory", {})
    if "@path" in special:
        mission["trajectory"] = Lua(special["@path"])
        return
    path = dict({"rate_hz": RATE}, **given)
    kind = special.get("@waypoints")
    if special.get("@ride") == "rig":
        # Where no robot is, the mission must be refused.
        path["ride"] = dict(ride_on(robots[0]) if robots else {"robot": "nobody"}, position=[0.3, 0, 0.4])
    elif kind == "one_frame":
        path["waypoints"] = ends[:1]
    elif kind == "void":
        path["waypoints"] = [{"position": [-3, 4.3, 0.5], "look_at": Lua("rubble.find_void { radius = 0.15 }.deepest"), "t": 0},
                             {"position": [-2.8, 4.3, 0.5], "look_at": Lua("rubble.find_void { radius = 0.15 }.deepest"), "t": SECONDS}]
    elif kind == "spline":
        middle = {"t": SECONDS / 2, "position": [-4.95, -2.1, 1.8], "look_at": [0, 0, 0.4]}
        path.update(waypoints=[ends[0], middle, ends[1]], interpolation="spline")
    elif kind == "avoid":
        path["waypoints"] = [{"position": end["position"], "look_at": end["look_at"], "speed": 0.35} for end in ends]
        del path["waypoints"][0]["speed"]
    else:
        path["waypoints"] = ends
        if kind == "linear":
            path["interpolation"] = "linear"
    mission["trajectory"] = path


def add_sensors(mission, special, robots):
    on_links = special.get("@ride") == "links"
    ride = ride_on(robots[0]) if robots else {"robot": "nobody"}
    camera = dict({"width": 64, "height": 48, "fov_deg": 75}, **special.get("@camera", {}))
    for key, name in (("@depth", "depth_sensor"), ("@events", "event_camera")):
        if key in special and (on_links or special["@cameras"] == "rig"):
            camera[name] = special[key]
        elif key in special:
            mission[name] = special[key]
    if special["@cameras"] == "rig" or on_links:
        cameras = {"front": dict(camera), "aside": dict(camera, width=32, height=24, rate_hz=2 * RATE, position=[0, 0.1, 0],
                                                        rpy_deg=[0, 10, 40])}
        if special["@cameras"] == "one":
            del cameras["aside"]
        if on_links:
            for place, item in enumerate(cameras.values()):
                # EuRoC knows one moving body.
                last = 0 if mission["outputs"].get("euroc") else len(robots) - 1
                carrier = ride_on(robots[min(place, last)]) if robots else ride
                item.update(ride=carrier, position=[0.3, 0, 0.4])
        mission["cameras"] = cameras
    else:
        mission["camera"] = camera
    imu = special.get("@imu")
    if imu is not None and on_links:
        mission["imus"] = {"inside": dict(imu, ride=ride)}
    elif imu is not None:
        mission["imu"] = dict(imu, on=True)
    if special.get("@imus"):
        mission["imus"] = {"inside": {}, "second": {"rate_hz": 50, "position": [0, 0.1, 0]}}
        if on_links:
            for item in mission["imus"].values():
                item["ride"] = ride
    for kind, by_name in special.get("@sensors", {}).items():
        if kind in ("bumpers", "batteries") and not robots:
            continue  # what flies has none
        mission[kind] = {name: dict(settings) for name, settings in by_name.items()}
        if on_links or kind in ("bumpers", "batteries"):
            for settings in mission[kind].values():
                settings.update(ride=ride, position=[0, 0, 0.6])
    if "@lidars" in special:
        senses = special.get("@control") == "senses"
        for lidar in special["@lidars"].values():
            if on_links or senses:
                lidar.update(ride=ride, position=[0, 0, 0.6])
        mission["lidars"] = special["@lidars"]
        if senses:
            mission["robots"][0]["senses"] = list(special["@lidars"])
