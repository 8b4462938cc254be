"""The factors of a mission and their levels. A level is a table of keys; missions.py puts those of a row together.

Keys that begin with `@` are not keys of a mission: missions.py explains what it makes of them. The first level of a factor
is the plainest one.
"""
from lua import Lua

LOOSE = {"layers": 1, "pieces_per_layer": 10, "spawn_position": [0, 0, 1.6], "spawn_bounds": [1.6, 1.6, 1.6]}
FEW = "{ layers = 1, pieces_per_layer = 6 }"

PILES = {
    "spawned": {"pile": LOOSE},
    "empty": {"pile": {"layers": 0}},
    "density": {"pile": dict(LOOSE, pieces_per_layer=5, spawn_density=Lua("rubble.density.gaussian { deviation = 0.3 }"))},
    "mix": {"pile": dict(LOOSE, mix=[{"asset": "brick", "weight": 2, "scale": [0.7, 1.4], "spread": "normal"},
                                     {"asset": "chunk_1", "materials": [{"material": "brick"}, {"material": "timber"}]}])},
    "heap": {"@pile": "rubble.collapse.heap { layers = 1, pieces_per_layer = 10, length = 1.6, width = 1.6, height = 1.6 }"},
    "placed": {"pile": {"layers": 0, "placed": [
        {"box": [0.2, 1.2, 0.8], "position": [0, 0, 0.4], "broken": ["+z"]},
        {"box": [1.2, 0.1, 0.2], "position": [0, 0, 0.95], "material": "timber", "fixed": False},
        {"asset": "brick", "position": [0.8, 0.3, 0.3], "fixed": False}]}},
    "lean_to": {"@pile": "rubble.collapse.lean_to { length = 2, width = 1.4, height = 1, debris = " + FEW + " }"},
    "pancake": {"@pile": "rubble.collapse.pancake { length = 3, width = 2, storeys = 2, debris = { layers = 0 } }"},
    "culvert": {"@pile": "rubble.collapse.culvert { rows = 1, segments = 1, debris = { layers = 0 } }"},
    "curtain": {"@pile": "rubble.collapse.curtain { length = 1.4, storey_height = 1, debris = { layers = 0 } }"},
    "joined": {"@pile": "rubble.join(rubble.collapse.lean_to { length = 2, width = 1.4, height = 1, debris = " + FEW + " }, "
                        "rubble.collapse.heap { layers = 1, pieces_per_layer = 4, length = 1, width = 1, height = 1, "
                        "position = { 0, 3, 0 } })"},
    "residential": {"@packs": ["residential"], "pile": dict(LOOSE, pieces_per_layer=5)},
    "parking": {"@packs": ["concrete", "parking"], "pile": dict(LOOSE, pieces_per_layer=5)},
    "articulated": {"pile": dict(LOOSE, pieces_per_layer=5, mix=[{"asset": "hinged_slab"}, {"asset": "half_brick"}])},
}

SMALL = {"storeys": 1, "bays_x": 1, "bays_y": 1, "span_x": 3, "span_y": 3, "piece": 1.6}
BUILDINGS = {
    "none": {},
    "frame": {"@building": dict(SMALL, infill="brick", openings=0.5)},
    "bare": {"@building": dict(SMALL, infill="none", continuity=0)},
    "furnished": {"@building": dict(SMALL, storeys=2, infill="none", parapet=0.4,
                                    furniture=[{"asset": "table", "per_bay": 1, "roof": True}]),
                  "@packs": ["concrete", "residential"]},
    "masonry": {"@building": dict(SMALL, kind="masonry")},
    "precast": {"@building": dict(SMALL, kind="precast", infill="none")},
    "bridge": {"@building": dict(SMALL, kind="bridge", bays_x=2)},
    "plan": {"@building": {"plan": Lua('rubble.read_plan("house.txt")')}, "@files": ["house.txt"]},
}

CAUSES = {
    "none": {},
    "removed": {"@cause": {"removed": "@columns"}},
    "weak_storey": {"@cause": {"weak_storey": 0, "weakness": 0.02}},
    "overload": {"@cause": {"overloaded_floor": 0, "overload": 2500}},
    "shake": {"@cause": {"shake": 9, "shake_seconds": 2, "weak_storey": 0, "weakness": 0.1}},
    "accelerogram": {"@cause": {"accelerogram": [0, 3, -5, 8, -6, 4, -2, 1, 0], "accelerogram_step": 0.2, "shake": 8, "weak_storey": 0, "weakness": 0.1}},
    "blast": {"@cause": {"blast": 12000, "blast_at": [-2.5, 0, 0.8]}},
    "vehicle": {"@cause": {"vehicle": "@vehicle"}},
    "sinking": {"@cause": {"sinking": "@sinking"}},
}

TERRAINS = {
    "none": {},
    "function": {"@terrain": 'rubble.terrain.from(function(x, y) return 0.05 + 0.03 * x * x end, '
                             '{ length = 4, width = 4, spacing = 0.5 })'},
    "elevation": {"@terrain": 'rubble.terrain.image("heights.asc", { samples = 8 })', "@files": ["heights.asc"]},
    "mesh": {"@terrain": '{ file = "ground.obj", friction = 0.6 }', "@files": ["ground.obj"]},
}

FINES = {
    "none": {},
    "few": {"fines": {"amount": 60, "drifts": 2, "cables": 1, "pipes": 1}},
}

SURROUNDINGS = {
    "none": {},
    "street": {"surroundings": {"type": "street", "reach": 40, "clearance": 8, "trees": 0.2, "vehicles": 0.2, "storeys": [1, 2]}},
}

VICTIMS = {
    "none": {},
    "one": {"victims": {"count": 1, "difficulty": "easy", "radius": 0.15}, "@shelter": True},
}

WHEELS = {"left_wheels": ["left_wheel_joint"], "right_wheels": ["right_wheel_joint"], "wheel_radius": 0.1}
ROBOTS = {
    "none": {},
    "crawler": {"@robots": [{"model": "crawler", "name": "tank", "position": [-6, 0, 0.001]}]},
    "rover": {"@robots": [{"model": "rover", "name": "scout", "position": [-6, 0, 0.001], "odometry_noise": 0.001}]},
    "snake": {"@robots": [{"model": "snake", "name": "snake", "modules": 6, "position": [-6, 0, 0.03]}]},
    "vine": {"@robots": [{"model": "vine", "name": "vine", "length": 1, "link_length": 0.1, "position": [-6, 0, 0.052]}]},
    "cart": {"@robots": [dict({"urdf": "cart.urdf", "name": "cart", "position": [-6, 0, 0.001]}, **WHEELS)],
             "@files": ["cart.urdf"]},
    "arm": {"@robots": [{"urdf": "arm.urdf", "name": "arm", "position": [-6, 0, 0]}], "@files": ["arm.urdf"]},
    "team": {"@robots": [{"model": "rover", "name": "scout", "position": [-6, 0, 0.001]},
                         {"model": "snake", "name": "snake", "modules": 4, "position": [-6, 1.2, 0.03]}]},
}

# missions.py writes the commands that fit each robot.
CONTROLS = {
    "still": {},
    "drive": {"@control": "drive"},
    "function": {"@control": "function"},
    "senses": {"@control": "senses"},
}

DEBRIS = {
    "free": {},
    "fixed": {"robot_run.debris": "fixed"},
}

PATHS = {
    "spline": {"@waypoints": "spline"},
    "linear": {"@waypoints": "linear"},
    "one_frame": {"@waypoints": "one_frame"},
    "orbit": {"@path": "rubble.trajectory.orbit { radius_m = 5, height = 1.5, turns = 0.02, rate_hz = 5 }"},
    "spiral": {"@path": "rubble.trajectory.spiral { radii = { 5, 4.8 }, heights = { 2, 1.8 }, turns = 0.03, rate_hz = 5 }"},
    "push": {"@path": "rubble.trajectory.push { from = { -5, -1, 1.2 }, to = { -4.8, -1, 1.15 }, roll_deg = 5, rate_hz = 5 }"},
    "grow": {"@path": "rubble.trajectory.grow { from = { -5, -1, 1 }, towards = { { -4.8, -1, 1 } }, rate_hz = 5 }"},
    "along": {"@path": "rubble.trajectory.along(function(t) return { -5 + t * t, -1, 1.5 }, { 0, 0, 0.3 } end, "
                       "{ duration = 0.8, rate_hz = 5 })"},
    "file": {"@path": 'rubble.trajectory.file { path = "path.txt", rate_hz = 5 }', "@files": ["path.txt"]},
    "refuse": {"@waypoints": "linear", "trajectory": {"plan": "refuse", "radius": 0.05}},
    "avoid": {"@waypoints": "avoid", "trajectory": {"plan": "avoid", "radius": 0.05}},
    "limits": {"@waypoints": "spline", "trajectory": {"max_jerk": 50, "rest_at_ends": True, "max_turn_rate_deg": 90}},
    "void": {"@waypoints": "void", "@shelter": True},
    "ride": {"@ride": "rig"},
    "links": {"@ride": "links"},
}

CAMERAS = {
    "one": {"@cameras": "one"},
    "stereo": {"@cameras": "one", "@camera": {"stereo_baseline": 0.1}},
    "rig": {"@cameras": "rig"},
    "stereo_rig": {"@cameras": "rig", "@camera": {"stereo_baseline": 0.1}},
}

LENSES = {
    "pinhole": {},
    "plumb_bob": {"@camera": {"lens": {"model": "plumb_bob", "k1": -0.08, "k2": 0.01, "p1": 0.002, "p2": -0.001}}},
    "fisheye": {"@camera": {"fov_deg": 150, "lens": {"model": "fisheye", "k1": 0.01, "k2": -0.002}}},
    "calibrated": {"@camera": {"lens": {"fx": 41, "fy": 40, "cx": 30.25, "cy": 24.5}}},
}

SHUTTERS = {
    "global": {},
    "rolling": {"@camera": {"shutter": {"readout": 0.02}}},
    "blur": {"@camera": {"shutter": {"motion_blur": True, "most_samples": 3}}},
}

DEPTHS = {
    "none": {},
    "ideal": {"@depth": {"type": "ideal", "max_range": 8}},
    "structured_light": {"@depth": {"type": "structured_light", "max_range": 8}},
    "time_of_flight": {"@depth": {"type": "time_of_flight", "max_range": 7}},
}

EVENTS = {
    "off": {},
    "on": {"@events": {"on": True, "most_motion": 100}},
}

EXPOSURES = {
    "ideal": {},
    "fixed": {"@camera": {"exposure": {"mode": "fixed", "time": 0.002}, "sensor": {"mosaic": "rggb", "prnu": 0.01}}},
    "automatic": {"@camera": {"exposure": {"mode": "automatic"},
                              "optics": {"point_spread": 0.6, "glare": 0.02, "dirt": 0.2, "drops": 2},
                              "sensor": {"jpeg_quality": 80, "vignette": 1, "pixel_samples": 2}}},
}

QUALITIES = {
    "fast": {},
    "draft": {"@camera": {"quality": "draft"}},
    "reference": {"@camera": {"quality": "reference", "samples": 1}},
}

CHANNELS = {
    "geometry": {"@camera": {"channels": ["instance", "label", "normals", "flow", "position"]}},
    "none": {},
    "sky": {"@camera": {"channels": ["instance", "sky_visibility"]}},
}

LIDARS = {
    "none": {},
    "vlp16": {"@lidars": {"top": {"model": "vlp16", "noise": False, "divergence_mrad": 0, "range_step": 0}}},
    "os0": {"@lidars": {"top": {"model": "os0", "columns": 512, "driver": "ouster"}}},
    "mid360": {"@lidars": {"top": {"model": "mid360", "noise": False, "driver": "livox"}}},
    "utm30lx": {"@lidars": {"scan": {"model": "utm30lx", "rate_hz": 10, "noise": False, "range_step": 0, "divergence_mrad": 0}}},
    "two": {"@lidars": {"top": {"model": "vlp16", "returns": "dual"}, "scan": {"model": "utm30lx", "rate_hz": 10}}},
}

IMUS = {
    "off": {},
    "exact": {"@imu": {"gyroscope_noise": 0, "gyroscope_walk": 0, "accelerometer_noise": 0, "accelerometer_walk": 0}},
    "noisy": {"@imu": {"rate_hz": 100}},
    "lever": {"@imu": {"rate_hz": 400, "position": [0.1, -0.05, 0.03], "rpy_deg": [10, -20, 30], "gyroscope_noise": 0,
                       "gyroscope_walk": 0, "accelerometer_noise": 0, "accelerometer_walk": 0}},
    "two": {"@imus": 2},
}

SENSORS = {
    "none": {},
    "exact": {"@sensors": {"attitudes": {"ahrs": {"noise": False, "rpy_deg": [5, -10, 80]}},
                           "barometers": {"baro": {"noise": False, "altitude": 300}},
                           "magnetometers": {"mag": {"noise": False, "declination_deg": 7, "rpy_deg": [0, 0, 45]}},
                           "gnss": {"gps": {"noise": False, "altitude": 30}},
                           "range_finders": {"sonar": {"noise": False, "radiation": "ultrasound", "range_step": 0}}}},
    "noisy": {"@sensors": {"range_finders": {"tof": {}}, "attitudes": {"ahrs": {}}, "gnss": {"gps": {}}, "bumpers": {"bow": {}},
                           "batteries": {"pack": {}}}},
}

AIRS = {
    "clear": {},
    "fog": {"air": {"fog_density": 0.03}},
    "smoke": {"air": {"fog_density": 0.1, "fog_height": 2, "fog_noise": 0.7, "wind": [1, 0, 0]}},
    "dust": {"air": {"dust": {"period": 0.2, "half_life": 2}}},
    "rain": {"air": {"rain_mm_h": 20, "wind": [2, 0, 0]}, "wetness": 0.8},
    "snow": {"air": {"snow_mm_h": 2}},
}

LIGHTS = {
    "directional": {},
    "random": {"light": {"random_rotation": True}},
    "spot": {"light": {"type": "spot", "intensity": 20, "position": [-4, 0, 8], "rpy_deg": [0, 60, 0], "random_position": True}},
    "point": {"light": {"type": "point", "intensity": 5, "position": [-3, 0, 5]}},
    "sun": {"light": {"type": "sun"}},
    "dusk": {"light": {"type": "sun", "elevation_deg": -3, "sky": "hazy"}},
    "cloudy": {"light": {"type": "sun", "sky": "cloudy", "cloud_cover": 0.5}},
    "overcast": {"light": {"type": "sun", "sky": "overcast"}},
    "moonlit": {"light": {"type": "sun", "sky": "moonlit"}},
    "city_night": {"light": {"type": "sun", "sky": "city_night"}},
    "cie_clear": {"light": {"type": "sun", "sky": "cie_clear"}},
    "by_place": {"light": {"type": "sun", "latitude_deg": 48, "longitude_deg": 11, "time": "2026-06-21T12:00:00Z"}},
    "further": {"light": {"intensity": 0.5}, "lights": [{"type": "spot", "intensity": 5, "position": [0, 0, 6],
                                                         "rpy_deg": [0, 90, 0]},
                                                        {"type": "point", "intensity": 1, "position": [-3, 2, 3]}]},
}

LAMPS = {
    "off": {"lamp": {"on": False}},
    "point": {"lamp": {"on": True}},
    "ring": {"lamp": {"on": True, "shape": "ring"}},
    "cluster": {"lamp": {"on": True, "shape": "cluster", "cone_deg": 60}},
    "robot": {"lamp": {"on": False}, "@robot_lamps": True},
}

SETTLING_RECORDS = {
    "off": {},
    "all": {"record_settling": {"on": True, "rate_hz": 1}},
    "window": {"record_settling": {"from": 0.2, "to": 0.6, "rate_hz": 5, "position": [-5, 1, 2], "look_at": [0, 0, 0.5]}},
}

SETTLES = {
    "usual": {},
    "planes": {"settle": {"schedule": "planes"}},
    "mars": {"settle": {"gravity": 3.71}},
    "small_step": {"settle": {"step": 1 / 120}},
}

STARTS = {
    "one_second": {},
    "today": {"start_ns": 1790000000123456789},
    "after_2038": {"start_ns": 2200000000000000000},
}

ROS1 = {
    "bag": {"outputs": {"bag": True}},
    "metres": {"outputs": {"bag": True, "depth": "32FC1"}},
    "png": {"outputs": {"bag": True, "pictures": "png"}},
    "jpeg": {"outputs": {"bag": True, "pictures": "jpeg", "depth": "32FC1"}},
    "none": {"outputs": {"bag": False}},
}

ROS2 = {
    "none": {},
    "mcap": {"outputs": {"mcap": True}},
}

RAWLOGS = {
    "none": {"outputs": {"rawlog": False, "simplemap": False}},
    "observations": {"outputs": {"rawlog": True, "simplemap": True}},
    "gzip": {"outputs": {"rawlog": True, "rawlog_gzip": 1, "simplemap": False}},
    "actions": {"outputs": {"rawlog": True, "rawlog_format": "actions", "simplemap": False}},
}

FOLDERS = {
    "none": {},
    "frames": {"outputs": {"frames": True}},
    "tum": {"outputs": {"tum": True}},
    "euroc": {"outputs": {"euroc": True}},
    "colmap": {"outputs": {"colmap": True}},
    "all": {"outputs": {"frames": True, "tum": True, "euroc": True, "colmap": True, "nerfstudio": True, "webdataset": True}},
}

SCAN_FILES = {
    "none": {},
    "pcd": {"outputs": {"pcd": True}},
    "kitti": {"outputs": {"kitti": True}},
    "both": {"outputs": {"pcd": True, "kitti": True}},
}

MESHES = {
    "none": {"outputs": {"stl": False}},
    "stl": {"outputs": {"stl": True, "meshes": ["ply"]}},
    "all": {"outputs": {"stl": True, "meshes": ["ply", "obj", "glb", "sdf", "mjcf", "usd", "urdf"]}},
}

TRACKS = {
    "off": {},
    "on": {"outputs": {"track": True}},
}

VOIDS = {
    "off": {},
    "on": {"voids": {"on": True, "voxel": 0.1, "radius": 0.1}},
}

# What is done with the run, or to it: afterwards.py.
AFTERWARDS = {name: {} for name in ("nothing", "resume", "remake", "verify", "render", "view", "pack", "report", "voids",
                                    "cutaway", "export", "python", "info")}

FACTORS = {
    "pile": PILES, "building": BUILDINGS, "cause": CAUSES, "terrain": TERRAINS, "fines": FINES,
    "surroundings": SURROUNDINGS, "victims": VICTIMS, "robots": ROBOTS, "control": CONTROLS, "debris": DEBRIS, "path": PATHS,
    "cameras": CAMERAS, "lens": LENSES, "shutter": SHUTTERS, "depth": DEPTHS, "events": EVENTS, "exposure": EXPOSURES,
    "quality": QUALITIES, "channels": CHANNELS, "lidar": LIDARS, "imu": IMUS, "sensors": SENSORS, "air": AIRS, "light": LIGHTS, "lamp": LAMPS,
    "record_settling": SETTLING_RECORDS, "settle": SETTLES, "start": STARTS, "ros1": ROS1, "ros2": ROS2, "rawlog": RAWLOGS,
    "folders": FOLDERS, "scans": SCAN_FILES, "meshes": MESHES, "track": TRACKS, "voids": VOIDS, "afterwards": AFTERWARDS,
}

# Keys of the mission's first level that no factor has, each with the reason.
NOT_FACTORS = {
    "seed": "every mission has its own: the number of its row",
    "device": "a row needs no graphics driver; tests/render and tests/app compare the devices",
}

# The names of the published simulator stand for other keys, one to one (docs/reference/missions.md); tests/scripting compares them.
PUBLISHED_NAMES = "spawnpos spawnbound lightrot lightpos".split()
PUBLISHED_WHOLE = "numlayers numobjs setlightrot lighttype lightintensity fogdensity fogintensity randomseed exportstl".split()


def is_published_name(key):
    return key in PUBLISHED_WHOLE or any(key == name + axis for name in PUBLISHED_NAMES for axis in "xyz")


def keys_of_levels():
    """Keys of the mission's first level that some level sets."""
    made = {"@pile": "pile", "@packs": "packs", "@building": "pile", "@cause": "pile", "@terrain": "pile", "@robots": "robots",
            "@control": "robots", "@waypoints": "trajectory", "@path": "trajectory", "@ride": "trajectory", "@camera": "camera",
            "@depth": "depth_sensor", "@events": "event_camera", "@lidars": "lidars", "@imu": "imu", "@imus": "imus"}
    kinds = {kind for level in FACTORS["sensors"].values() for kind in level.get("@sensors", {})}
    keys = {made.get(key, key).split(".")[0] for levels in FACTORS.values() for level in levels.values() for key in level}
    keys |= {"cameras"} | kinds  # of several cameras
    return {key for key in keys if not key.startswith("@")}
