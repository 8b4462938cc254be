"""Plan views of reconstructions: the pile from above, the points, the true and the estimated cameras."""
import csv

import cv2
import matplotlib
import numpy as np

import conditions

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of the backend)

HALF, PIXEL = 13.0, 0.02  # of the square that is shown, and of its pixels; unit: m
TRUE, ESTIMATED = "#1a9850", ["#d7301f", "#6a51a3", "#2171b5", "#fe9929"]  # estimated: by segment


def draw_plan(stl):
    """The pile from above: paler is higher."""
    raw = np.fromfile(stl, dtype=np.uint8)[84:]
    triangles = raw.reshape(-1, 50)[:, 12:48].copy().view("<f4").reshape(-1, 3, 3)
    inside = (np.abs(triangles[:, :, :2]) < HALF).all(axis=(1, 2))
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    triangles, normals = triangles[inside & (normals[:, 2] > 0)], normals[inside & (normals[:, 2] > 0)]
    order = np.argsort(triangles[:, :, 2].max(axis=1))
    top = max(1e-3, triangles[:, :, 2].max())
    up = normals[:, 2] / np.linalg.norm(normals, axis=1)
    shade = 120 + 110 * (triangles[:, :, 2].mean(axis=1) / top) * (0.4 + 0.6 * up)
    corners = np.round((triangles[:, :, :2] * [1, -1] + HALF) / PIXEL * 16).astype(np.int32)
    side = int(2 * HALF / PIXEL)
    plan = np.full((side, side), 245, np.uint8)
    for i in order:
        cv2.fillConvexPoly(plan, corners[i], int(shade[i]), shift=4)
    return plan


def read_points(path):
    data = path.read_bytes()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    kind = np.dtype([("p", "<f4", 3), ("rgb", "u1", 3), ("segment", "<i4")])
    return np.frombuffer(data[start:], kind)


def draw_panel(axes, plan, folder, truth, title):
    axes.imshow(plan, cmap="gray", vmin=0, vmax=255, extent=(-HALF, HALF, -HALF, HALF), interpolation="antialiased")
    points = read_points(next(folder.glob("*_points.ply")))
    axes.scatter(points["p"][:, 0], points["p"][:, 1], s=1.2, c="#0050c0", linewidths=0, label="points")
    rows = list(csv.DictReader(open(next(folder.glob("*_track.csv")))))
    axes.plot(truth[:, 1], truth[:, 2], "-", color=TRUE, lw=4, alpha=0.6, label="true cameras")
    for segment in sorted({int(r["segment"]) for r in rows}):
        mine = np.array([[float(r["x"]), float(r["y"])] for r in rows if int(r["segment"]) == segment])
        axes.plot(mine[:, 0], mine[:, 1], ".", color=ESTIMATED[segment % 4], ms=4,
                  label="estimated cameras, model %d" % (segment + 1))
    axes.set_title(title, fontsize=10)
    axes.set_xlabel("x, m"), axes.set_ylabel("y, m")
    axes.set_xlim(-HALF, HALF), axes.set_ylim(-HALF, HALF)
    axes.legend(loc="upper right", fontsize=7, markerscale=2, framealpha=0.9)


def draw(work, size, names, found, path):
    plan = draw_plan(work.pile(1) / "pile.stl")
    figure, axes = plt.subplots(1, len(names), figsize=(5.6 * len(names), 5.8), squeeze=False)
    for name, place in zip(names, axes[0]):
        condition = conditions.find([name])[0]
        score = found[(size, name)][1]
        truth = np.loadtxt(work.dataset(1, size, condition) / "groundtruth.txt")
        draw_panel(place, plan, work.sfm(1, size, condition) / "details", truth, "%s:\n%d of %d frames on track, %s points" % (
            condition.title, score["on_track"], score["frames"], format(score["points"], ",")))
    figure.tight_layout()
    figure.savefig(path, dpi=85)
