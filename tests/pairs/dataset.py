"""A finished run: its manifest, recordings, cameras and poses, read once when they are asked for."""
import functools
import json
import os

import numpy as np

import geometry
import pictures
import recordings


class Finding(Exception):
    """What a judge found wrong."""


def need(condition, text, *values):
    if not condition:
        raise Finding(text % values if values else text)


class Camera:
    """One camera: where its files and topics are."""

    def __init__(self, dataset, name, settings):
        self.dataset, self.name, self.settings = dataset, name, settings
        several = bool(dataset.scenario["cameras"])
        self.folder = os.path.join(dataset.folder, "cameras", name) if several else dataset.folder
        self.prefix = settings.get("topic") or ("/" + name if several else "/camera")
        self.truth = "/%s/ground_truth" % name if several else "/ground_truth"
        self.ride = (settings.get("ride") or {}) if several else dataset.scenario["trajectory"]["ride"]

    def file(self, *path):
        return os.path.join(self.folder, *path)

    def topic(self, end):
        return self.prefix + end

    @functools.cached_property
    def poses(self):
        """(stamps in ns, positions, rotations) of the optical frame."""
        return read_tum(self.file("groundtruth.txt"))

    @functools.cached_property
    def lens(self):
        """K row by row, model and coefficients: as the scenario says, by the formulas of docs/reference/missions.md."""
        s, lens = self.settings, self.settings["lens"]
        width, height = s["width"], s["height"]
        half = np.radians(s["fov_deg"]) / 2
        if lens["model"] == "fisheye":
            bent = half * (1 + lens["k1"] * half**2 + lens["k2"] * half**4 + lens["k3"] * half**6 + lens["k4"] * half**8)
            focal = width / 2 / bent
        else:
            focal = width / 2 / np.tan(half)
        fx = lens["fx"] or focal
        fy = lens["fy"] or fx
        cx = (width - 1) / 2 if lens["cx"] is None else lens["cx"]
        cy = (height - 1) / 2 if lens["cy"] is None else lens["cy"]
        k = [fx, 0, cx, 0, fy, cy, 0, 0, 1]
        if lens["model"] == "fisheye":
            return k, "fisheye", [lens[name] for name in ("k1", "k2", "k3", "k4")]
        if lens["model"] == "plumb_bob":
            return k, "plumb_bob", [lens[name] for name in ("k1", "k2", "p1", "p2", "k3")]
        return k, "plumb_bob", [0.0] * 5

    def rays(self, pixels):
        k, model, coefficients = self.lens
        return [geometry.ray_of_pixel(pixel, k, model, coefficients) for pixel in pixels]

    def frames_of(self, channel):
        """Arrays of a channel, by whichever recording has it, and by how much they may be rounded; (None, 0) where none has."""
        folder = self.file("frames", channel)
        if os.path.isdir(folder):
            return [read_picture(os.path.join(folder, name)) for name in sorted(os.listdir(folder))], 1e-4
        recording = self.dataset.recording
        if recording is None:
            return None, 0
        ends = {"depth": ["/depth_registered/image", "/depth_registered/image_raw"], "rgb": ["/rgb/image_raw"]}
        topics = [self.topic(end) for end in ends.get(channel, [])] + \
                 [self.truth + "/%s/image" % ("depth" if channel == "depth_true" else channel)]
        for topic in topics:
            if recording.messages(topic):
                found = [decode_image(message) for message in recording.messages(topic)]
                return found, 6e-4 if channel == "depth" and topic.endswith("raw") else 1e-4
            if recording.messages(topic + "/compressed") and channel == "rgb":
                bodies = [bytes(message["data"]) for message in recording.messages(topic + "/compressed")]
                if bodies[0][:4] == b"\x89PNG":
                    return [pictures.read_png(body) for body in bodies], 0
            if recording.messages(topic + "/compressedDepth"):
                bodies = [bytes(message["data"]) for message in recording.messages(topic + "/compressedDepth")]
                found = [pictures.read_png(body[body.index(b"\x89PNG"):]).astype(float) / 1000 for body in bodies]
                return [np.where(depth > 0, depth, np.nan) for depth in found], 6e-4
        return None, 0

    def exact_depth(self):
        found = self.frames_of("depth_true")
        if found[0] is not None or self.settings["depth_sensor"]["type"] != "none":
            return found
        return self.frames_of("depth")


def read_picture(path):
    if path.endswith(".png"):
        return pictures.read_png(path)
    if path.endswith(".flo"):
        return pictures.read_flo(path)
    channels = pictures.read_exr(path)
    if set(channels) == {"Y"}:
        return channels["Y"]
    return np.stack([channels[name] for name in "RGB" if name in channels], axis=2)


def decode_image(message):
    kinds = {"rgb8": ("u1", 3), "mono8": ("u1", 1), "16UC1": ("<u2", 1), "32FC1": ("<f4", 1), "32FC2": ("<f4", 2),
             "32FC3": ("<f4", 3), "32SC1": ("<i4", 1)}
    code, values = kinds[message["encoding"]]
    rows = np.frombuffer(bytes(message["data"]), code).reshape(message["height"], message["width"], values)
    if message["encoding"] == "16UC1" and values == 1:
        return np.where(rows[:, :, 0] > 0, rows[:, :, 0] / 1000.0, np.nan)
    return rows[:, :, 0] if values == 1 else rows


def nanoseconds(text):
    seconds, _, rest = text.partition(".")
    return int(seconds) * 10**9 + int((rest + "000000000")[:9])


def read_tum(path):
    stamps, positions, rotations = [], [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("#") or not line.strip():
                continue
            words = line.split()
            x, y, z, qx, qy, qz, qw = map(float, words[1:8])
            stamps.append(nanoseconds(words[0]))
            positions.append((x, y, z))
            rotations.append(geometry.matrix(qw, qx, qy, qz))
    return np.array(stamps), np.array(positions).reshape(-1, 3), np.array(rotations).reshape(-1, 3, 3)


class Dataset:
    """export: a pile.ply of this run, or None."""

    def __init__(self, folder, row, export=None):
        self.folder, self.row, self.export = folder, row, export
        with open(self.file("manifest.json"), encoding="utf-8") as file:
            self.manifest = json.load(file)
        self.scenario = self.manifest["scenario"]
        for key in ("cameras", "imus", "lidars"):  # null where there is none
            self.scenario[key] = self.scenario[key] or {}
        self.scenario["robots"] = self.scenario["robots"] or []

    def file(self, *path):
        return os.path.join(self.folder, *path)

    def has(self, *path):
        return os.path.exists(self.file(*path))

    @functools.cached_property
    def bag(self):
        return recordings.read_bag(self.file("mission.bag")) if self.has("mission.bag") else None

    @functools.cached_property
    def mcap(self):
        return recordings.read_mcap(self.file("mission.mcap")) if self.has("mission.mcap") else None

    @property
    def recording(self):
        return self.bag or self.mcap

    @functools.cached_property
    def cameras(self):
        if self.scenario["cameras"]:
            return [Camera(self, name, settings) for name, settings in self.scenario["cameras"].items()]
        settings = dict(self.scenario["camera"], depth_sensor=self.scenario["depth_sensor"],
                        event_camera=self.scenario["event_camera"])
        return [Camera(self, "camera", settings)]

    @functools.cached_property
    def solid(self):
        if self.export is None:
            return None
        points, pieces, triangles = geometry.read_ply(self.export)
        return geometry.Solid(points, pieces, triangles)

    @functools.cached_property
    def legend(self):
        for camera in self.cameras:
            if os.path.exists(camera.file("frames", "legend.json")):
                with open(camera.file("frames", "legend.json"), encoding="utf-8") as file:
                    return json.load(file)
        if self.recording and self.recording.messages("/ground_truth/legend"):
            return json.loads(self.recording.messages("/ground_truth/legend")[0]["data"])
        return None

    @property
    def hidden_things(self):
        """Whether what a camera sees may be in no export: robots, and what stands about the pile."""
        return bool(self.scenario["robots"]) or self.scenario["surroundings"]["type"] != "none"

    def is_inside(self, camera):
        """Whether the program has warned that this camera is inside a piece or below the ground; it names cameras that have names."""
        starts = tuple(who + "the camera is " + where for who in ("", "camera `%s`: " % camera.name) for where in ("inside", "below"))
        return any(warning.startswith(starts) for warning in self.manifest["warnings"])

    def flight_frames(self, camera):
        """Numbers of the frames in which the pile rests."""
        count = len(camera.poses[0])
        if self.row.get("record_settling", "off") == "off":
            return list(range(count))
        rest = int(self.scenario["start_ns"]) + int(self.manifest["pile"]["simulated_s"] * 1e9) - 10**6
        return [i for i in range(count) if int(camera.poses[0][i]) >= rest]
