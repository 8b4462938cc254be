"""What breaks mapping, against metres into the void: light that the camera gets, in keypoints and true matches, and the frames
that a model has."""
import matplotlib
import numpy as np

import flights
import plan
import records
import tables

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of the backend)

SHOWN = ["dark", "lamp_15", "lamp_200", "night_15", "night_200", "smoke"]
COLOURS = ["#222222", "#e6550d", "#fdae6b", "#3182bd", "#08519c", "#74c476"]
ON_THE_WAY = ["dark", "lamp_15", "lamp_200", "night_15", "night_200", "smoke"]  # of the sheet of pictures
WIDTH = 1.0  # of a bin; unit: m


def binned(bins, mean):
    """Centres of bins of WIDTH, and the mean in each."""
    begins = sorted({np.floor(b[0] / WIDTH) * WIDTH for b in bins})
    means = [(begin + WIDTH / 2, mean(bins, begin, begin + WIDTH)) for begin in begins]
    return zip(*[(x, y) for x, y in means if y is not None])


PANELS = [
    ("keypoints a megapixel", records.mean_keypoints, True),
    ("true matches a megapixel", records.mean_matches, True),
    ("frames that a model has, %", lambda *of: 100 * records.share_in_model(*of), False),
]


def draw(found, title, path):
    figure, axes = plt.subplots(3, 1, figsize=(9, 11), sharex=True)
    titles = {r.name: r.title for r in plan.ROWS}
    seeds = tables.common_seeds(found, SHOWN)
    for name, colour in zip(SHOWN, COLOURS):
        results = found.get((name, "colmap"))
        if not results:
            continue
        bins = [b for seed, r in results.items() if seed in seeds for b in r["bins"]]
        for (label, mean, log), place in zip(PANELS, axes):
            x, y = binned(bins, mean)
            place.plot(x, np.maximum(y, 0.8) if log else y, "o-", color=colour, ms=4, lw=1.6, label=titles[name])
    for (label, _, log), place in zip(PANELS, axes):
        place.set_ylabel(label)
        if log:
            place.set_yscale("log")
        place.axvline(0, color="#999999", lw=1)
        place.grid(alpha=0.3)
    axes[0].set_title("COLMAP 3.8, %s, seeds %s" % (title, ", ".join(map(str, seeds))), fontsize=10)
    axes[-1].set_xlabel("metres into the void (0: its entrance), on the way in and on the way out")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="lower center", ncol=3, fontsize=9)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(path, dpi=90)


def draw_way(flown, path):
    """What the camera sees on its way in, without a lamp and with lamps: the same places side by side. False: no picture is
    kept."""
    sheets = {}
    for row in plan.ROWS:
        if row.name in ON_THE_WAY:
            files = flights.shown_frames(flown.work.out / "flight" / flown.key(1, row) / "run")
            if files:
                sheets[row] = [plt.imread(file) for file in files]
    if not sheets:
        return False
    height, width = next(iter(sheets.values()))[0].shape[:2]
    columns = len(flights.SHOWN)
    figure, axes = plt.subplots(len(sheets), columns, figsize=(3.2 * columns, 3.2 * height / width * len(sheets)), squeeze=False)
    for (row, pictures), line in zip(sheets.items(), axes):
        for place, picture in zip(line, pictures):
            place.imshow(picture)
            place.axis("off")
        line[0].text(0.03, 0.05, row.title, color="white", fontsize=10, transform=line[0].transAxes,
                     bbox={"facecolor": "black", "alpha": 0.6, "pad": 2})
    figure.subplots_adjust(0, 0, 1, 1, 0.01, 0.015)
    figure.savefig(path, dpi=100, pil_kwargs={"quality": 88})
    return True
