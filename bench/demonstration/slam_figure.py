"""The share of pictures or scans whose motion a system followed, against metres into the void."""
import numpy as np

import records
import slam_plan
from slam_records import WIDTH

PANELS = [("dark", "no lamp, day outside"), ("night_15", "night, lamp of 15 cd"), ("night_200", "night, lamp of 200 cd"),
          ("smoke", "smoke of 0.3 / m")]
COLOURS = {"orbslam3_rgbd": "#1b6ca8", "orbslam3_monocular": "#74b3e0", "orbslam3_rgbd_inertial": "#2a9d8f",
           "orbslam3_monocular_inertial": "#8fd3a8", "orbslam3_stereo": "#0b3c5d", "orbslam3_stereo_inertial": "#1f6f54",
           "kiss_icp": "#f4a261", "kiss_icp_near": "#e76f51", "genz_icp": "#b5179e", "rko_lio": "#bdbd2b", "rko_lio_near": "#7a5c00"}


def legs(into):
    """Of each picture of one flight: False on the way in, True on the way out."""
    return np.arange(len(into)) > np.argmax(into)


def binned(into, back, values, deepest):
    """Places along the way in and out again, where a bin on the way out is mirrored behind `deepest`, and the share of the values that
    are true in each bin."""
    into, back, values = np.asarray(into), np.asarray(back), np.asarray(values, float)
    numbers, places, shares = np.floor(into / WIDTH).astype(int), [], []
    for leg in (False, True):
        for n in sorted(set(numbers[back == leg]), reverse=leg):
            middle = (n + 0.5) * WIDTH
            places.append(2 * deepest - middle if leg else middle)
            shares.append(100 * values[(back == leg) & (numbers == n)].mean())
    return places, shares


def joined(flights):
    """flights: pairs of metres into the void and values. All of them, with their legs."""
    into = np.concatenate([np.asarray(i) for i, _ in flights])
    return into, np.concatenate([legs(i) for i, _ in flights]), np.concatenate([np.asarray(v, float) for _, v in flights])


def draw(found, mapped, path):
    """mapped: tables.collect(), whose COLMAP is drawn beside the SLAM systems: frames that a model has."""
    import matplotlib  # here: the tests of the parts above need it not
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    chosen = [(name, title) for name, title in PANELS if any(flight == name for flight, _ in found)]
    figure, axes = plt.subplots(len(chosen), 1, figsize=(10, 3.4 * len(chosen) + 0.9), sharex=True, squeeze=False)
    curves = {}  # by panel: (legend, style, flights)
    for name, _ in chosen:
        curves[name] = [(judge.title, dict(fmt="s--" if judge.kind == "lidar" else "o-", color=COLOURS[judge.name]),
                         [records.shares(r["bins"], WIDTH, 2) for r in found[name, judge.name].values()])
                        for judge in slam_plan.JUDGES if (name, judge.name) in found]
        seeds = {r["key"][2] for (flight, _), results in found.items() if flight == name for r in results.values()}  # the same ruins
        models = [r for seed, r in mapped.get((name, "colmap"), {}).items() if seed in seeds]
        if models:
            curves[name].append(("COLMAP 3.8: a model has it", dict(fmt="x:", color="#555555"), [records.in_model(r["bins"]) for r in models]))
    deepest = np.ceil(max(max(into) for drawn in curves.values() for _, _, flights in drawn for into, _ in flights) / WIDTH) * WIDTH
    lines = {}
    for (name, title), place in zip(chosen, axes[:, 0]):
        for label, style, flights in curves[name]:
            x, y = binned(*joined(flights), deepest)
            lines[label], = place.plot(x, y, style["fmt"], color=style["color"], ms=4, lw=1.5)
        place.set_title(title, fontsize=10, loc="left")
        place.set_ylabel("motion followed, %")
        place.set_ylim(-4, 104)
        for border in (0, 2 * deepest):
            place.axvline(border, color="#999999", lw=1)
        place.axvline(deepest, color="#999999", lw=1, ls=":")
        place.grid(alpha=0.3)
    ticks = np.arange(-2, deepest + 0.1, 2)
    axes[-1, 0].set_xticks(list(ticks) + [2 * deepest - t for t in ticks if t < deepest])
    axes[-1, 0].set_xticklabels(["%g" % t for t in ticks] + ["%g" % t for t in ticks if t < deepest])
    axes[-1, 0].set_xlabel("metres into the void: way in, the deepest place, and way out (0: the entrance)")
    figure.legend(lines.values(), lines.keys(), loc="lower center", ncol=3, fontsize=9)
    figure.tight_layout(rect=(0, 0.8 / (3.4 * len(chosen) + 0.9), 1, 1))
    figure.savefig(path, dpi=90)
