"""What an online estimate is worth, picture by picture: does it have a pose, and does the motion agree with the true one?"""
import csv

import numpy as np

import carriers

WINDOW = 1.0          # of the true way, over which motions are compared; unit: m
TOLERANCE = 0.2       # error of such a motion that still counts as followed; unit: m
ON_TRACK = 0.1        # as of `rubble eval sfm`; unit: m
LOST_FOR = 0.5        # time without a followed motion after which the way counts as lost; unit: s


def read_estimate(path):
    """Stamps; the number of the map of each picture, -1: no pose; positions; matrices."""
    stamps, maps, positions, rotations = [], [], [], []
    for row in csv.reader(open(path)):
        stamps.append(float(row[0]))
        maps.append(int(row[1]) if row[1] else -1)
        values = [float(v) for v in row[2:9]] if row[1] else [0, 0, 0, 0, 0, 0, 1]
        positions.append(values[:3])
        rotations.append(carriers.matrix(values[3:]))
    return np.array(stamps), np.array(maps), np.array(positions).reshape(-1, 3), np.array(rotations).reshape(-1, 3, 3)


def true_poses(groundtruth, stamps):
    """Of the optical frame at these stamps, from a file in TUM's format: positions, matrices."""
    rows = np.loadtxt(groundtruth)
    quaternions = carriers.continuous(rows[:, 4:8])
    positions = np.stack([np.interp(stamps, rows[:, 0], c) for c in rows[:, 1:4].T], 1)
    turns = np.stack([np.interp(stamps, rows[:, 0], c) for c in quaternions.T], 1)
    return positions, np.array([carriers.matrix(q / np.linalg.norm(q)) for q in turns])


def moved(positions, rotations, offset, turn):
    """Poses of a frame that is fixed to that of the given poses."""
    return positions + rotations @ np.asarray(offset, float), rotations @ turn


def align(source, target, scaled):
    """Scale, rotation and shift of the least squares (Umeyama 1991) that bring source to target."""
    a, b = source - source.mean(0), target - target.mean(0)
    u, d, vt = np.linalg.svd(b.T @ a / len(a))
    s = np.diag([1, 1, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    r = u @ s @ vt
    spread = (a**2).sum() / len(a)
    scale = np.trace(np.diag(d) @ s) / spread if scaled and spread > 0 else 1.0
    return scale, r, target.mean(0) - scale * r @ source.mean(0)


def measure(estimate, truth, scaled):
    """estimate: of read_estimate(). truth: of true_poses(). Gives for every picture the number of its map, whether its motion was
    followed, and its distance from the true place after an alignment of its map (None without a pose)."""
    stamps, maps, positions, rotations = estimate
    true_positions, true_rotations = truth
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(true_positions, axis=0), axis=1))])
    followed, errors, scales = np.zeros(len(stamps), bool), [None] * len(stamps), {}
    for number in sorted(set(maps) - {-1}):
        own = np.flatnonzero(maps == number)
        scale, r, t = align(positions[own], true_positions[own], scaled) if len(own) > 2 else (1.0, np.eye(3), None)
        scales[int(number)] = scale
        for i in own:
            if t is not None:
                errors[i] = float(np.linalg.norm(scale * r @ positions[i] + t - true_positions[i]))
            earlier = own[(own < i) & (way[own] <= way[i] - WINDOW)]
            base = earlier[-1] if len(earlier) else own[0]
            if base == i:
                followed[i] = len(own) > 1
                continue
            found = scale * rotations[base].T @ (positions[i] - positions[base])
            right = true_rotations[base].T @ (true_positions[i] - true_positions[base])
            followed[i] = np.linalg.norm(found - right) <= TOLERANCE
    return {"map": [int(m) for m in maps], "followed": [bool(f) for f in followed], "error": errors, "way": [float(w) for w in way]}


def first_lost(stamps, followed):
    """The number of the first picture of the first stretch of LOST_FOR or more after the beginning in which no motion was followed;
    None: there is none."""
    begun, since = False, None
    for i, good in enumerate(followed):
        if good:
            begun, since = True, None
        elif begun:
            since = i if since is None else since
            if stamps[i] - stamps[since] >= LOST_FOR - 1e-6:
                return since
    return None


def summary(estimate, measured, into):
    """into: of each picture, metres into the void; None: a flight outside."""
    stamps, maps = estimate[0], np.array(measured["map"])
    errors = [e for e in measured["error"] if e is not None]
    lost = first_lost(stamps, measured["followed"])
    middle = len(stamps) / 2
    return {
        "frames": len(stamps), "maps": len(set(maps) - {-1}), "pose_percent": 100 * float((maps >= 0).mean()),
        "followed_percent": 100 * float(np.mean(measured["followed"])),
        "on_track_percent": 100 * sum(e <= ON_TRACK for e in errors) / len(stamps),
        "way_m": measured["way"][-1], "lost_after_m": None if lost is None else measured["way"][lost],
        "lost_into_m": None if lost is None or into is None else float(into[lost]),
        "lost_going": None if lost is None or into is None else "in" if lost < middle else "out",
    }
