"""What moves: inertial units against poses, contacts of robots against their momentum."""
import xml.etree.ElementTree as xml

import numpy as np

import geometry
from dataset import need, read_tum

TIME = 0.25  # s: windows between poses for an integral
ROTATION = 0.004  # rad
DRIFT = 0.02  # m/s2: of the mean specific force in a window


def imu_meets_poses(data):
    """Angular velocity integrated from pose to pose, and specific force integrated twice over two windows: no velocity is
    needed, as p2 - 2 p1 + p0 is the integral of (T - |s|) a(s)."""
    if data.recording is None:
        return
    for topic, settings in imus(data):
        poses = carrier_poses(data, settings)
        messages = data.recording.messages(topic)
        need(messages, "%s has no message", topic)
        if poses is None:
            continue
        stamps, places, turns = poses
        offset = geometry.rpy_matrix(settings["rpy_deg"])
        lever = np.array(settings["position"])
        places = places + turns @ lever
        turns = turns @ offset
        first = messages[0]["header"]["stamp"]  # seconds since the epoch have too few digits after the point
        times = np.array([m["header"]["stamp"] - first for m in messages]) / 1e9
        gyro = np.array([[m["angular_velocity"][a] for a in "xyz"] for m in messages])
        force = np.array([[m["linear_acceleration"][a] for a in "xyz"] for m in messages])
        gravity = np.array([0, 0, -data.scenario["settle"]["gravity"]])
        riding = bool(ride_of(settings)["robot"] or data.scenario["trajectory"]["ride"]["robot"])
        noise = 1 if settings["gyroscope_noise"] == 0 else 3
        for k in range(1, len(stamps) - 1):
            t0, t1, t2 = (stamps[k - 1:k + 2] - first) / 1e9
            if not np.isclose(t1 - t0, t2 - t1, atol=1e-6) or t1 - t0 > TIME or t2 > times[-1] + 1e-6 or t0 < times[0] - 1e-6:
                continue
            # Intervals that end where a reading's period does, and at the poses.
            period = 1 / settings["rate_hz"]
            edges = np.arange(np.floor(t0 / period), np.ceil(t2 / period) + 1, 0.25) * period
            edges = np.unique(np.round(np.concatenate([[t0, t1, t2], edges[(edges > t0) & (edges < t2)]]), 9))
            middles, lengths = (edges[:-1] + edges[1:]) / 2, np.diff(edges)
            if riding:  # means over a period about the stamp
                which = np.clip(np.round((middles - times[0]) / period).astype(int), 0, len(times) - 1)
                w, f = gyro[which], force[which]
            else:
                w = np.stack([np.interp(middles, times, gyro[:, i]) for i in range(3)], axis=1)
                f = np.stack([np.interp(middles, times, force[:, i]) for i in range(3)], axis=1)
            rotation, found, middle = turns[k - 1], np.zeros(3), None
            window = t1 - t0
            for at, length, rate, push in zip(middles, lengths, w, f):
                if middle is None and at > t1:
                    middle = rotation
                half = geometry.turn(rate * length / 2)
                found += (window - abs(at - t1)) * (rotation @ half @ push + gravity) * length
                rotation = rotation @ half @ half
            angle = max(geometry.angle_between(middle, turns[k]), geometry.angle_between(rotation, turns[k + 1]))
            limit = ROTATION * noise * (3 if riding else 1)
            need(angle < limit, "%s at %.3f s: turn rates give an attitude %.4f rad beside that of the poses", topic, t1, angle)
            wanted = places[k + 1] - 2 * places[k] + places[k - 1]
            error = float(np.linalg.norm(found - wanted)) / window**2
            need(error < DRIFT * noise * (4 if riding else 1), "%s at %.3f s: specific force is %.3f m/s2 beside that of the poses",
                 topic, t1, error)


def imu_is_steady(data):
    """Readings at the rate that was asked for, without a pause."""
    if data.recording is None:
        return
    for topic, settings in imus(data):
        stamps = [message["header"]["stamp"] for message in data.recording.messages(topic)]
        steps = np.diff(stamps)
        wrong = np.flatnonzero(np.abs(steps - 1e9 / settings["rate_hz"]) > 2)
        need(not len(wrong), "%s: %d pauses; the first is %.4f s after the first reading, of %.4f s", topic, len(wrong),
             (stamps[wrong[0]] - stamps[0]) / 1e9 if len(wrong) else 0, steps[wrong[0]] / 1e9 if len(wrong) else 0)


def ride_of(settings):
    return settings.get("ride") or {"robot": "", "link": ""}


def imus(data):
    scenario = data.scenario
    if scenario["imus"]:
        return [(item["topic"] or "/" + name, item) for name, item in scenario["imus"].items()]
    return [(scenario["imu"]["topic"] or "/imu", scenario["imu"])] if scenario["imu"]["on"] else []


def carrier_poses(data, settings):
    """Body poses of what an IMU is on, at equal times; None where no file has them."""
    ride = ride_of(settings)
    if ride["robot"]:
        if ride["link"] not in ("", "head", "base_link") or not data.has("robots", ride["robot"] + ".txt"):
            return None
        stamps, places, turns = read_tum(data.file("robots", ride["robot"] + ".txt"))
        return stamps[::9], places[::9], turns[::9]
    on_rig = [camera for camera in data.cameras if not camera.ride["robot"] or not data.scenario["cameras"]]
    for camera in on_rig:
        if data.scenario["cameras"] and (any(camera.settings["position"]) or any(camera.settings["rpy_deg"])):
            continue
        stamps, places, turns = camera.poses
        if data.row.get("record_settling", "off") != "off":
            stamps, places, turns = stamps[-3:], places[-3:], turns[-3:]
        return stamps, places, turns @ geometry.BODY_FROM_OPTICAL.T
    return None


def contacts_meet_momentum(data):
    """The impulse of all contacts, less that of the weight, is the change of a robot's momentum."""
    if data.recording is None:
        return
    robots = data.scenario["robots"]
    for robot in robots:
        prefix = "/" + robot["name"] if len(robots) > 1 else ""
        contacts, truth = data.recording.messages(prefix + "/contacts"), data.recording.messages(prefix + "/ground_truth/odom")
        if not contacts or not truth or robot["name"] in ("arm", "vine"):
            continue  # what is fixed to the world is held by it
        masses = read_masses(data.file("robots", robot["name"] + ".urdf"))
        frames = read_frames(data, robot, prefix)
        stamps = [message["header"]["stamp"] for message in truth]
        total = sum(mass for mass, _ in masses.values())
        centre, impulse = [], np.zeros(3)
        forces, hardest = {}, 0.0
        for message in contacts:
            forces.setdefault(message["header"]["stamp"], []).append(message)
        for k, stamp in enumerate(stamps):
            links = frames[stamp]
            centre.append(sum(mass * (links[name][0] + links[name][1] @ at) for name, (mass, at) in masses.items()) / total)
            if k:
                step = (stamp - stamps[k - 1]) / 1e9
                for message in forces.get(stamp, []):
                    name = message["header"]["frame_id"].split("/")[-1]
                    push = links[name][1] @ np.array([message["wrench"]["force"][a] for a in "xyz"]) * step
                    impulse += push
                    hardest = max(hardest, float(np.linalg.norm(push)))
        if len(stamps) < 2:
            continue  # nothing to compare a blow with
        duration = (stamps[-1] - stamps[0]) / 1e9
        last = (stamps[-1] - stamps[-2]) / 1e9
        weight = total * data.scenario["settle"]["gravity"] * duration
        wanted = total * (centre[-1] - centre[-2]) / last + np.array([0, 0, weight])
        error = float(np.linalg.norm(impulse - wanted))
        # A blow is shorter than the time between two messages.
        need(error < 0.06 * weight + 0.15 * total + hardest, "%s: contacts gave %s N s, weight and momentum ask for %s", robot["name"],
             np.round(impulse, 2).tolist(), np.round(wanted, 2).tolist())


def read_masses(path):
    """Link -> (mass, centre of mass), of links with a mass."""
    found = {}
    for link in xml.parse(path).getroot().iter("link"):
        inertial = link.find("inertial")
        if inertial is not None:
            origin = inertial.find("origin")
            at = [float(word) for word in origin.get("xyz", "0 0 0").split()] if origin is not None else [0, 0, 0]
            found[link.get("name").split("/")[-1]] = (float(inertial.find("mass").get("value")), np.array(at))
    return found


def read_frames(data, robot, prefix):
    """stamp -> link -> (position, rotation) in the world: the base by ground truth, the links by /tf and /tf_static."""
    def parts(transform):
        t, r = transform["transform"]["translation"], transform["transform"]["rotation"]
        return np.array([t[a] for a in "xyz"]), geometry.matrix(r["w"], r["x"], r["y"], r["z"])

    fixed = {}
    for message in data.recording.messages("/tf_static"):
        for transform in message["transforms"]:
            fixed[transform["child_frame_id"]] = (transform["header"]["frame_id"], parts(transform))
    moving = {}
    for message in data.recording.messages("/tf"):
        for transform in message["transforms"]:
            moving.setdefault(transform["header"]["stamp"], {})[transform["child_frame_id"]] = (
                transform["header"]["frame_id"], parts(transform))
    found = {}
    for message in data.recording.messages(prefix + "/ground_truth/odom"):
        stamp, base = message["header"]["stamp"], message["child_frame_id"]
        p, q = message["pose"]["pose"]["position"], message["pose"]["pose"]["orientation"]
        known = {base: (np.array([p[a] for a in "xyz"]), geometry.matrix(q["w"], q["x"], q["y"], q["z"]))}
        parents = dict(fixed, **moving.get(stamp, {}))
        changed = True
        while changed:
            changed = False
            for child, (parent, (place, rotation)) in parents.items():
                if child not in known and parent in known:
                    at, turned = known[parent]
                    known[child] = (at + turned @ place, turned @ rotation)
                    changed = True
        found[stamp] = {name.split("/")[-1]: pose for name, pose in known.items() if len(data.scenario["robots"]) == 1
                        or name.startswith(robot["name"] + "/")}
    return found


JUDGES = [imu_is_steady, imu_meets_poses, contacts_meet_momentum]
