#!/usr/bin/env python3
"""page.py RECORDS: the figure and the tables of docs/explanation/verification.md from the records of verification_bench.

A figure agrees with that of the finest variant when zero lies within the 95 % interval of their difference (Welch's t).
Each work is its own judge: the finest step stands for the exact solution, and seeds stand for chance.
"""
import argparse
import collections
import json
import math
import pathlib
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import document_marks  # noqa: E402

PAGE = ROOT / "docs/explanation/verification.md"
PICTURE = ROOT / "docs/pictures/verification.png"
MEASURES = {  # name, heading, unit
    "rest_s": ("time to rest", "s"), "top_m": ("top", "m"), "mean_height_m": ("mean height", "m"), "radius_m": ("radius", "m"),
    "porosity": ("porosity", ""), "void_m3": ("voids", "m³"), "robot_void_m3": ("voids of a robot", "m³"),
    "contacts_a_piece": ("contacts a piece", ""), "force_mean": ("mean force", "weights"), "force_90": ("force, 90 %", "weights"),
    "force_99": ("force, 99 %", "weights"), "throw_90": ("fastest sideways or up, 90 % of the pieces", "m/s"),
    "throw_99": ("the same, 99 %", "m/s"), "ejected": ("pieces faster than 8 m/s sideways or up", ""), "distance_m": ("distance", "m"), "path_m": ("path", "m"), "work_j": ("work", "J"),
    "stuck_s": ("stuck", "s"), "pieces_moved": ("pieces moved", "")}
SHOWN = {False: ["mean_height_m", "porosity", "void_m3", "force_mean", "force_99", "rest_s"],
         True: ["distance_m", "path_m", "work_j", "stuck_s", "pieces_moved"]}


def load(path):
    """{work: {(hz, substeps): {measure: array by seed}}} in the order of the records."""
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    with open(path) as file:
        for line in file:
            record = json.loads(line)
            found[record["of"]][record["step_hz"], record["substeps"]].append(record)
    return {work: {variant: {name: np.array([r[name] for r in rows]) for name in list(MEASURES) + ["settled", "drift_m", "cpu_s"]
                             if name in rows[0]} for variant, rows in variants.items()}
            for work, variants in found.items()}


def t_975(freedom):
    """The 97.5 % point of Student's t, by the expansion of Cornish and Fisher: right to 0.1 % from 5 degrees of freedom on."""
    z = 1.959964
    return z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2) + (
        3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / (384 * freedom**3)


def interval(values):
    """Half of the 95 % interval of the mean."""
    return t_975(len(values) - 1) * values.std(ddof=1) / math.sqrt(len(values)) if len(values) > 1 else math.nan


def compare(values, finest):
    """Difference of the means, half of its 95 % interval."""
    a, b = values.var(ddof=1) / len(values), finest.var(ddof=1) / len(finest)
    if a + b == 0:
        return values.mean() - finest.mean(), 0.0
    freedom = (a + b) ** 2 / (a**2 / (len(values) - 1) + b**2 / (len(finest) - 1))
    return values.mean() - finest.mean(), t_975(freedom) * math.sqrt(a + b)


def axes_of(variants):
    """The usual variant; the variants by step and by sweeps, each with the usual one and in order."""
    usual = next(iter(variants))
    steps = sorted(v for v in variants if v[1] == usual[1])
    sweeps = sorted(v for v in variants if v[0] == usual[0])
    return usual, steps, sweeps


def usual_first(variants):
    usual = (240, 4) if (240, 4) in variants and (240, 16) in variants else (60, 16)
    return {usual: variants[usual], **{v: m for v, m in variants.items() if v != usual}}


def text_of(value):
    return "%.3g" % value


def table(works):
    """A row for each figure that differs from the finest step or from the most sweeps, where the usual step is used."""
    lines = ["| work | figure | usual | finest step | most sweeps | holds from |", "|---|---|---|---|---|---|"]
    for work, variants in works.items():
        usual, steps, sweeps = axes_of(variants)
        for name, (heading, unit) in MEASURES.items():
            if name not in variants[usual]:
                continue
            cells, off = [], False
            for axis in (steps, sweeps):
                finest = variants[axis[-1]][name]
                difference, half = compare(variants[usual][name], finest)
                differs = abs(difference) > half
                off = off or differs
                share = " (%+.0f %%)" % (-100 * difference / abs(variants[usual][name].mean())) if differs and variants[usual][name].mean() else ""
                cells.append("%s ± %s%s" % (text_of(finest.mean()), text_of(interval(finest)), share))
            if not off:
                continue
            finest = variants[steps[-1]][name]
            good = len(steps) - 1
            while good > 0 and abs(compare(variants[steps[good - 1]][name], finest)[0]) <= compare(variants[steps[good - 1]][name], finest)[1]:
                good -= 1
            own = variants[usual][name]
            lines.append("| %s | %s%s | %s ± %s | %s | 1/%d s |" % (work, heading, ", " + unit if unit else "", text_of(own.mean()),
                                                                 text_of(interval(own)), " | ".join(cells), steps[good][0]))
    return "\n".join(lines)


def counts(works):
    """How many figures were compared, and how many agree."""
    compared = agree = 0
    for variants in works.values():
        usual, steps, sweeps = axes_of(variants)
        for name in MEASURES:
            if name not in variants[usual]:
                continue
            for axis in (steps, sweeps):
                difference, half = compare(variants[usual][name], variants[axis[-1]][name])
                compared, agree = compared + 1, agree + (abs(difference) <= half)
    return compared, agree


def draw(works, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    columns = max(len(names) for names in SHOWN.values())
    figure, panels = plt.subplots(len(works), columns, figsize=(3.1 * columns, 2.3 * len(works)), squeeze=False)
    for row, (work, variants) in zip(panels, works.items()):
        _, steps, sweeps = axes_of(variants)
        names = SHOWN["distance_m" in variants[steps[0]]]
        for panel, name in zip(row, names):
            for axis, at, colour, label in ((steps, 0, "#1f5fa8", "steps a second"), (sweeps, 1, "#c4561d", "sweeps a step")):
                means = [variants[v][name].mean() for v in axis]
                panel.errorbar([math.log2(v[at] / axis[0][at]) for v in axis], means, [interval(variants[v][name]) for v in axis],
                               color=colour, marker="o", markersize=3, capsize=2, linewidth=1, label=label)
            panel.set_title("%s: %s%s" % (work, MEASURES[name][0], ", " + MEASURES[name][1] if MEASURES[name][1] else ""), fontsize=9)
            panel.set_xticks(range(5))
            panel.set_xticklabels(["%d\n%d" % (s[0], w[1]) for s, w in zip(steps, sweeps)], fontsize=7)
            panel.tick_params(axis="y", labelsize=7)
            low, high = panel.get_ylim()
            panel.set_ylim(min(low, 0) if low < 0.3 * high else low - 0.3 * (high - low), high + 0.3 * (high - low))
            panel.grid(alpha=0.3)
        for panel in row[len(names):]:
            panel.axis("off")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=2, fontsize=9)
    figure.tight_layout(rect=(0, 0, 1, 0.98))
    figure.savefig(path, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("records")
    parser.add_argument("--print", action="store_true", help="print the tables; write nothing")
    parser.add_argument("--commit", help="that was measured (default: HEAD)")
    request = parser.parse_args()
    works = {work: usual_first(variants) for work, variants in load(request.records).items()}
    seeds = min(len(m["cpu_s"]) for variants in works.values() for m in variants.values())
    compared, agree = counts(works)
    rested = sum(int(m["settled"].sum()) for variants in works.values() for m in variants.values())
    runs = sum(len(m["settled"]) for variants in works.values() for m in variants.values())
    commit = request.commit or subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short=8", "HEAD"], stdout=subprocess.PIPE, text=True).stdout.strip()
    text = ("![Means over the seeds with their 95 %% intervals](../pictures/verification.png)\n\n%d runs of %d seeds at %s; %d came to rest. Of %d comparisons %d agree with the finest; the table has the others.\n\n%s\n"
            % (runs, seeds, commit, rested, compared, agree, table(works)))
    if request.print:
        print(text)
        return
    document_marks.write_between_marks(str(PAGE), "verification", text, request.commit)
    draw(works, PICTURE)


if __name__ == "__main__":
    main()
