"""The planned way, as it is (`spline`) or moved as a robot moves: what the simulated robot's camera does beside its mean motion over a bed of
bricks (carrier.lua) is added to every pose; a hand is a model."""
import json
import math
import pathlib

import numpy as np

import work as stages

RATE = 60.0   # poses a second of the track that is written
MOUTH = 2.0   # of the flight before the entrance and after it; unit: m
MEAN = 0.7    # standard deviation of the Gaussian that parts mean motion and shaking; unit: s
BODY_FROM_OPTICAL = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]], float)
MOUNTS = {"crawler": (0.3, 0, 0.3), "snake": (0.05, 0, 0), "vine": (0.06, 0, 0)}  # of the camera in the robot's frame; unit: m
# Amplitude, frequency (Hz) and phase of a walking person's hand: two steps a second, and the tremor of the hand.
HAND = {
    "x": [(0.010, 1.9, 0.3)], "y": [(0.025, 0.95, 1.1)], "z": [(0.020, 1.9, 2.0)],  # unit: m
    "roll": [(1.5, 0.95, 0.5), (0.15, 8.7, 0.2)], "pitch": [(1.2, 1.9, 1.4), (0.20, 9.3, 0.9)],  # unit: degree
    "yaw": [(2.0, 0.95, 2.6), (0.20, 7.9, 1.7)],
}


def matrix(q):
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def quaternion(m):
    """x y z w, of the largest of the four ways to it."""
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0], [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                  [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], 0],
                  [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m.trace()]])
    values, vectors = np.linalg.eigh(k)  # takes the lower triangle (Bar-Itzhack 2000)
    return vectors[:, values.argmax()]


def continuous(quaternions):
    """With signs that do not jump."""
    quaternions = quaternions.copy()
    for i in range(1, len(quaternions)):
        if quaternions[i] @ quaternions[i - 1] < 0:
            quaternions[i] *= -1
    return quaternions


def smooth(rows, rate):
    """The Gaussian mean of each column over time."""
    reach = int(4 * MEAN * rate)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / (MEAN * rate))**2)
    weight = np.convolve(np.ones(len(rows)), kernel, "same") if len(rows) >= len(kernel) else None
    if weight is None:
        raise SystemExit("the carrier's track is shorter than %.1f s" % (8 * MEAN))
    return np.stack([np.convolve(column, kernel, "same") / weight for column in rows.T], 1)


def read_tum(path):
    rows = np.loadtxt(path)
    return rows[:, 0] - rows[0, 0], rows[:, 1:4], continuous(rows[:, 4:8])


def at_rate(t, positions, quaternions, rate):
    times = np.arange(0, t[-1] + 1e-9, 1 / rate)
    p = np.stack([np.interp(times, t, c) for c in positions.T], 1)
    q = np.stack([np.interp(times, t, c) for c in quaternions.T], 1)
    return times, p, q / np.linalg.norm(q, axis=1, keepdims=True)


def shaking(path, mount):
    """What the camera does beside its mean motion, in the frame of that motion: translations and rotations, RATE a second."""
    _, p, q = at_rate(*read_tum(path), RATE)
    rotations = [matrix(v) for v in q]
    p = p + np.array([r @ mount for r in rotations])
    mean_p, mean_q = smooth(p, RATE), smooth(q, RATE)
    moves = []
    for i in range(len(p)):
        mean = matrix(mean_q[i] / np.linalg.norm(mean_q[i]))
        moves.append((mean.T @ (p[i] - mean_p[i]), mean.T @ rotations[i]))
    edge = int(2 * MEAN * RATE)  # where the mean lacks one side
    return moves[edge:-edge]


def hand(seconds):
    moves = []
    for i in range(int(seconds * RATE) + 1):
        v = {k: sum(a * math.sin(2 * math.pi * f * i / RATE + phase) for a, f, phase in waves) for k, waves in HAND.items()}
        r, p, y = (math.radians(v[k]) for k in ("roll", "pitch", "yaw"))
        rx = np.array([[1, 0, 0], [0, math.cos(r), -math.sin(r)], [0, math.sin(r), math.cos(r)]])
        ry = np.array([[math.cos(p), 0, math.sin(p)], [0, 1, 0], [-math.sin(p), 0, math.cos(p)]])
        rz = np.array([[math.cos(y), -math.sin(y), 0], [math.sin(y), math.cos(y), 0], [0, 0, 1]])
        moves.append((np.array([v["x"], v["y"], v["z"]]), rz @ ry @ rx))
    return moves


def drive(work, carrier):
    """The track of the simulated robot."""
    script = pathlib.Path(__file__).resolve().parent / "carrier.lua"
    depends = {"program": work.identity, "script": stages.digest_file(script), "carrier": carrier}
    return work.stage("carrier", depends, lambda folder: work.run(
        [work.program, "run", script, "--set", "robot=" + carrier, "--out", folder / "run", "--quiet"], folder / "log.txt"),
        carrier) / "run" / "robots" / "carrier.txt"


def way_in(planned):
    """Of the planned flight: the length of the way from the entrances to the deepest place; unit: m"""
    return json.loads((planned / "flight.json").read_text())["voids"][1]["way_in_m"]


def metres_into(positions, deepest):
    """How far into the void each position of a flight there and back is, along its way. deepest: way_in(); unit: m"""
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))])
    return deepest - abs(along - along[-1] / 2)


def move(work, planned, carrier):
    """The planned way from MOUTH before the void until MOUTH behind it, with the carrier's shaking: a text in TUM's format."""
    times, positions, quaternions = at_rate(*read_tum(planned / "groundtruth.txt"), RATE)
    inside = metres_into(positions, way_in(planned)) > -MOUTH
    times, positions, quaternions = times[inside] - times[inside][0], positions[inside], quaternions[inside]
    if carrier == "spline":
        moves = [(np.zeros(3), np.eye(3))] * 2
    elif carrier == "hand_held":
        moves = hand(times[-1])
    else:
        moves = shaking(drive(work, carrier), np.array(MOUNTS[carrier]))
    there_and_back = moves + moves[-2:0:-1]  # goes on without a jump, however long the way is
    lines = []
    for i, t in enumerate(times):
        shift, turn = there_and_back[i % len(there_and_back)]
        body = matrix(quaternions[i]) @ BODY_FROM_OPTICAL.T
        p, q = positions[i] + body @ shift, quaternion(body @ turn @ BODY_FROM_OPTICAL)
        lines.append("%.6f %s" % (t, " ".join("%.9f" % v for v in [*p, *q])))
    return "\n".join(lines) + "\n"


def dust_around(planned):
    """Settings for bursts of dust along the way in the void: in a box around it, down to the floor below."""
    positions = np.loadtxt(planned / "groundtruth.txt")[:, 1:4]
    positions = positions[metres_into(positions, way_in(planned)) > 0]
    low, high = positions.min(0), positions.max(0)
    low[2] = max(0.05, low[2] - 0.4)
    text = "%.2f,%.2f,%.2f"
    return ["air.dust.position=" + text % tuple((low + high) / 2), "air.dust.bounds=" + text % tuple(high - low)]
