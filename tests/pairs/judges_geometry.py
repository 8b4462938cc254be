"""What sensors saw against the exported geometry: depth, scans, flow, labels, meshes."""
import os

import numpy as np

import geometry
from dataset import need

PIXELS = 40  # rays of a picture
RAYS = 60    # rays of a scan
FINES = 10**7  # the number of the first of the fines
CENTRE = 0.005  # pixels: the subpixels that vertices are on are 1/256 of a pixel
FAR = 60.0   # metres: beyond, a pixel's rounding of the ground's depth is large


def sampled_pixels(camera, count, seed):
    generator = np.random.default_rng(seed)
    width, height = camera.settings["width"], camera.settings["height"]
    return np.stack([generator.integers(0, width, count), generator.integers(0, height, count)], axis=1)


def shutter_poses(camera, frame):
    """Poses of a rolling shutter's camera from a readout before the stamp to one after, seen along its path."""
    readout = camera.settings["shutter"]["readout"]
    stamps, positions, rotations = camera.poses
    poses = []
    for other in (frame - 1, frame + 1):
        if readout > 0 and 0 <= other < len(stamps):
            share = min(1.0, readout / abs(float(stamps[other] - stamps[frame]) * 1e-9))
            u, _, v = np.linalg.svd(rotations[frame] + share * (rotations[other] - rotations[frame]))
            poses.append((positions[frame] + share * (positions[other] - positions[frame]), u @ v))
    return poses + [(positions[frame], rotations[frame])]


def depth_meets_geometry(data):
    """Exact depth against rays cast at the exported pile: equal where the picture shows a piece, never beyond it."""
    if data.solid is None:
        return
    for camera in data.cameras:
        depths, rounding = camera.exact_depth()
        if depths is None or data.is_inside(camera):  # there is no picture of a piece from within
            continue
        pieces, _ = camera.frames_of("instance")
        stamps, positions, rotations = camera.poses
        need(len(depths) == len(stamps), "%s: %d depth pictures and %d poses", camera.name, len(depths), len(stamps))
        rolling = camera.settings["shutter"]["readout"] > 0
        frames = data.flight_frames(camera)
        for frame in sorted({frames[0], frames[len(frames) // 2], frames[-1]}):
            pixels = sampled_pixels(camera, PIXELS, frame)
            wrong = []
            compared = 0
            moments = shutter_poses(camera, frame)
            for pixel, ray in zip(pixels, camera.rays(pixels)):
                ray = np.asarray(ray)
                seen = float(depths[frame][pixel[1], pixel[0]])
                distance, piece = data.solid.cast(positions[frame], rotations[frame] @ ray)
                expected = distance * ray[2]
                if expected > FAR or ray[2] < 0.05:
                    continue
                # Between the first row and the last, a ray that grazes the ground runs over metres of it.
                reached = [data.solid.cast(position, rotation @ ray)[0] * ray[2] for position, rotation in moments]
                expected = min(max(seen, min(reached)), max(reached)) if rolling and not np.isnan(seen) else expected
                instance = None if pieces is None else int(np.int32(pieces[frame][pixel[1], pixel[0]]))
                tolerance = 0.002 + rounding + 2e-4 * expected + (0.05 if rolling else 0)
                compared += 1
                if expected < seen - tolerance or expected > seen + tolerance:  # where it grazes, the centre of a pixel is not as exact
                    near = [np.asarray(camera.rays(np.array([pixel + [0, offset]]))[0]) for offset in (-CENTRE, CENTRE)]
                    nearby = [data.solid.cast(positions[frame], rotations[frame] @ r)[0] * r[2] for r in near]
                    expected = min(max(seen, min(nearby)), max(nearby)) if max(nearby) - min(nearby) < 0.01 * expected else expected
                if np.isnan(seen) or seen > expected + tolerance:
                    wrong.append((pixel.tolist(), seen, expected))
                elif seen < expected - tolerance and (instance == piece if instance is not None else not data.hidden_things):
                    wrong.append((pixel.tolist(), seen, expected))
            # A ray along an edge may meet either side of it.
            need(len(wrong) <= max(1, compared // 12), "%s, frame %d: depth of %d of %d pixels is not that of the geometry; "
                 "pixel %s: %.4f m, expected %.4f m", camera.name, frame, len(wrong), compared, *(wrong[0] if wrong else (0, 0, 0)))


def positions_meet_depth(data):
    """The channel `position` is the pose, the lens and the depth together."""
    for camera in data.cameras:
        if "position" not in camera.settings["channels"]:
            continue
        places, _ = camera.frames_of("position")
        depths, rounding = camera.exact_depth()
        if places is None or depths is None or camera.settings["shutter"]["readout"] > 0:
            continue
        _, positions, rotations = camera.poses
        frame = len(places) - 1
        for pixel, ray in zip(*(lambda p: (p, camera.rays(p)))(sampled_pixels(camera, PIXELS, 7))):
            seen = float(depths[frame][pixel[1], pixel[0]])
            if not 0 < seen < FAR or ray[2] < 0.05:
                continue
            point = positions[frame] + rotations[frame] @ (np.asarray(ray) * seen / ray[2])
            error = float(np.linalg.norm(point - places[frame][pixel[1], pixel[0]]))
            need(error < 0.003 + 3 * rounding + 1e-3 * seen, "%s, frame %d, pixel %s: position is %.4f m beside that of the depth",
                 camera.name, frame, pixel.tolist(), error)


def flow_meets_poses(data):
    """The flow of what stands still is that of its point, seen from the next pose."""
    for camera in data.cameras:
        if "flow" not in camera.settings["channels"] or camera.settings["shutter"]["readout"] > 0:
            continue
        flows, _ = camera.frames_of("flow")
        depths, rounding = camera.exact_depth()
        pieces, _ = camera.frames_of("instance")
        if flows is None or depths is None or pieces is None:
            continue
        _, positions, rotations = camera.poses
        k, model, coefficients = camera.lens
        frames = data.flight_frames(camera)
        for frame in frames[:-1][:2]:
            for pixel, ray in zip(*(lambda p: (p, camera.rays(p)))(sampled_pixels(camera, PIXELS, frame + 50))):
                seen = float(depths[frame][pixel[1], pixel[0]])
                instance = int(np.int32(pieces[frame][pixel[1], pixel[0]]))
                if not 0 < seen < FAR or ray[2] < 0.05 or not stands(data, instance):
                    continue
                point = positions[frame] + rotations[frame] @ (np.asarray(ray) * seen / ray[2])
                there = rotations[frame + 1].T @ (point - positions[frame + 1])
                expected = geometry.project([there], k, model, coefficients)[0] - pixel
                found = flows[frame][pixel[1], pixel[0]]
                if np.isnan(found).any() or np.isnan(expected).any():
                    continue
                error = float(np.abs(found - expected).max())
                need(error < 0.05 + 200 * rounding / seen, "%s, frame %d, pixel %s: flow %s, expected %s", camera.name, frame,
                     pixel.tolist(), found.tolist(), expected.tolist())


def stands(data, instance):
    """Whether a number in `instance` is the ground, or a piece of the export."""
    return instance == -1 or (data.solid is not None and instance in data.solid.names)


def labels_meet_legend(data):
    """Each pixel's label is that of its instance; instances are those of the legend."""
    if data.legend is None:
        return
    label_of = {item["instance"]: item["label"] for item in data.legend["instances"]}
    for camera in data.cameras:
        if not {"instance", "label"} <= set(camera.settings["channels"]):
            continue
        pieces, _ = camera.frames_of("instance")
        labels, _ = camera.frames_of("label")
        if pieces is None or labels is None:
            continue
        need(len(pieces) == len(labels), "%s: %d pictures of instances, %d of labels", camera.name, len(pieces), len(labels))
        for frame, (piece, label) in enumerate(zip(pieces, labels)):
            label = label if label.dtype.kind == "u" else np.nan_to_num(label * 1000)  # 16UC1 is not millimetres here
            for instance in np.unique(np.asarray(piece).astype(np.int64)):
                own = np.unique(np.round(label[np.asarray(piece).astype(np.int64) == instance]).astype(int)).tolist()
                if instance == -2:
                    expected = [0]
                elif instance == -1:
                    expected = [1]
                else:
                    need(int(instance) in label_of, "%s, frame %d: instance %d is not in the legend", camera.name, frame, instance)
                    expected = [label_of[int(instance)]]
                need(own == expected, "%s, frame %d: instance %d has the labels %s, expected %s", camera.name, frame, instance,
                     own, expected)


def read_pcd(path):
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"DATA binary\n") + 12
    head = dict(line.split(None, 1) for line in data[:end].decode("ascii").splitlines() if not line.startswith("#"))
    codes = {("F", "4"): "<f4", ("U", "2"): "<u2", ("U", "1"): "u1", ("U", "4"): "<u4", ("F", "8"): "<f8"}
    names, kinds, sizes = head["FIELDS"].split(), head["TYPE"].split(), head["SIZE"].split()
    record = np.dtype([(name, codes[kind, size]) for name, kind, size in zip(names, kinds, sizes)])
    points = np.frombuffer(data, record, int(head["POINTS"]), end)
    need(end + points.nbytes == len(data), "%s has another length than its head says", os.path.basename(path))
    return points


def read_motion(path):
    rows = np.loadtxt(path, ndmin=2)
    return rows[:, 0], rows[:, 1:4], rows[:, 4:8]


def pose_at(motion, time):
    times, places, turns = motion
    after = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1))
    share = np.clip((time - times[after - 1]) / (times[after] - times[after - 1]), 0, 1)
    place = (1 - share) * places[after - 1] + share * places[after]
    a, b = turns[after - 1], turns[after]
    mixed = (1 - share) * a + share * (b if a @ b > 0 else -b)
    x, y, z, w = mixed / np.linalg.norm(mixed)
    return place, geometry.matrix(w, x, y, z)


def scans_meet_geometry(data):
    """Ranges against rays cast from the true motion: equal in clear air, never beyond a surface by more than the noise."""
    if data.solid is None or not data.has("pcd"):
        return
    hazy = data.row.get("air", "clear") != "clear"
    for name, lidar in data.scenario["lidars"].items():
        folder = data.file("pcd", name)
        motion = read_motion(os.path.join(folder, "motion.txt"))
        with open(os.path.join(folder, "stamps.txt"), encoding="ascii") as file:
            scans = [line.split() for line in file if line.strip()]
        files = sorted(item for item in os.listdir(folder) if item.endswith(".pcd"))
        need([item for _, item in scans] == files, "%s: stamps.txt and the files differ", name)
        exact = not lidar["noise"]
        stamp, file = scans[len(scans) // 2] if data.row.get("record_settling", "off") == "off" else scans[-1]
        points = read_pcd(os.path.join(folder, file))
        generator = np.random.default_rng(3)
        wrong = []
        chosen = generator.choice(len(points), min(RAYS, len(points)), replace=False) if len(points) else []
        for i in chosen:
            point = np.array([points[axis][i] for axis in "xyz"], float)
            measured = float(np.linalg.norm(point))
            place, rotation = pose_at(motion, float(stamp) + float(points["time"][i]))
            distance, _ = data.solid.cast(place, rotation @ (point / measured))
            tolerance = 0.006 + 5e-4 * measured if exact else 0.25
            if lidar["divergence_mrad"] != 0:
                tolerance += 0.05 + 0.02 * measured  # a beam at a grazing angle lights a long ellipse
            if measured > distance + tolerance or (not hazy and not data.hidden_things and measured < distance - tolerance):
                wrong.append((measured, distance))
        need(len(wrong) <= max(2, len(chosen) // 8), "%s, %s: %d of %d ranges are not those of the geometry; the first is %.4f m, "
             "expected %.4f m", name, file, len(wrong), len(chosen), *(wrong[0] if wrong else (0, 0)))


def meshes_agree(data):
    """Every mesh format has the same triangles, in the same place."""
    if data.export is None:
        return
    points, pieces, triangles = geometry.read_ply(data.export)
    whole = data.manifest["pile"]["pieces"]
    corners = points[triangles].reshape(-1, 3)
    boxes = {"ply": (len(triangles), corners.min(axis=0), corners.max(axis=0))} if len(triangles) else {}
    for path in (data.file("pile.ply"), data.file("pile.stl"), data.file("pile.obj")):
        if not os.path.exists(path) or not boxes:
            continue
        if path.endswith("obj"):
            count, low, high = obj_box(path)
        else:
            found = geometry.read_stl(path) if path.endswith("stl") else \
                (lambda p, _, t: p[t])(*geometry.read_ply(path))
            count, low, high = len(found), found.reshape(-1, 3).min(axis=0), found.reshape(-1, 3).max(axis=0)
        need(count == boxes["ply"][0], "%s has %d triangles, pile.ply %d", os.path.basename(path), count, boxes["ply"][0])
        error = max(np.abs(low - boxes["ply"][1]).max(), np.abs(high - boxes["ply"][2]).max())
        need(error < 1e-4, "%s lies %.4f m beside pile.ply", os.path.basename(path), error)
    numbers = {int(piece) for piece in np.unique(pieces) if 0 <= piece < FINES}
    need(len(numbers) <= whole and (not numbers or max(numbers) < whole), "pile.ply has %d pieces, the manifest %d", len(numbers),
         whole)


def obj_box(path):
    low, high, count = np.full(3, np.inf), np.full(3, -np.inf), 0
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("v "):
                at = np.array([float(word) for word in line.split()[1:4]])
                low, high = np.minimum(low, at), np.maximum(high, at)
            elif line.startswith("f "):
                count += len(line.split()) - 3
    return count, low, high


JUDGES = [depth_meets_geometry, positions_meet_depth, flow_meets_poses, labels_meet_legend, scans_meet_geometry, meshes_agree]
