"""The share of pictures or scans whose motion a system followed, against metres into the void."""
import matplotlib
import numpy as np

import slam_plan

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of the backend)

PANELS = [("dark", "no lamp, day outside"), ("night_15", "night, lamp of 15 cd"), ("night_200", "night, lamp of 200 cd"),
          ("smoke", "smoke of 0.3 / m")]
COLOURS = {"orbslam3_rgbd": "#1b6ca8", "orbslam3_monocular": "#74b3e0", "orbslam3_stereo": "#0b3c5d", "orbslam3_rgbd_inertial": "#2a9d8f",
           "orbslam3_stereo_inertial": "#1f6f54", "orbslam3_monocular_inertial": "#8fd3a8", "kiss_icp": "#f4a261", "kiss_icp_near": "#e76f51",
           "genz_icp": "#b5179e", "rko_lio": "#bdbd2b", "rko_lio_near": "#7a5c00"}
WIDTH = 1.0  # of a bin; unit: m


def binned(into, values):
    """Centres of bins, and the share of the values that are true in each."""
    into, values = np.asarray(into), np.asarray(values, float)
    numbers = np.floor(into / WIDTH).astype(int)
    chosen = sorted(set(numbers))
    return [(n + 0.5) * WIDTH for n in chosen], [100 * values[numbers == n].mean() for n in chosen]


def joined(results):
    """Of all seeds and runs."""
    into = [v for r in results.values() for v in r["frames"]["into"]]
    return into, [f for r in results.values() for f in r["frames"]["followed"]]


def draw(found, mapped, path):
    """mapped: tables.collect(), whose COLMAP is drawn beside the SLAM systems: frames that a model has."""
    chosen = [(name, title) for name, title in PANELS if any(flight == name for flight, _ in found)]
    figure, axes = plt.subplots(len(chosen), 1, figsize=(10, 3.1 * len(chosen) + 1), sharex=True, squeeze=False)
    lines = {}
    for (name, title), place in zip(chosen, axes[:, 0]):
        for judge in slam_plan.JUDGES:
            results = found.get((name, judge.name))
            if results:
                x, y = binned(*joined(results))
                lines[judge.title], = place.plot(x, y, "s--" if judge.kind == "lidar" else "o-", color=COLOURS[judge.name], ms=4, lw=1.6)
        frames = [f for r in mapped.get((name, "colmap"), {}).values() for f in r["frames"]]
        if frames:
            x, y = binned([f["into"] for f in frames], [f["model"] is not None for f in frames])
            lines["COLMAP 3.8: a model has it"], = place.plot(x, y, "x:", color="#555555", ms=5, lw=1.4)
        place.set_title(title, fontsize=10, loc="left")
        place.set_ylabel("motion followed, %")
        place.set_ylim(-4, 104)
        place.axvline(0, color="#999999", lw=1)
        place.grid(alpha=0.3)
    axes[-1, 0].set_xlabel("metres into the void (0: its entrance), on the way in and on the way out")
    figure.legend(lines.values(), lines.keys(), loc="lower center", ncol=3, fontsize=9)
    figure.tight_layout(rect=(0, 0.02 + 0.16 / len(chosen), 1, 1))
    figure.savefig(path, dpi=90)
