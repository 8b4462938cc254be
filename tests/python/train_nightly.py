#!/usr/bin/env python3
"""Trains PPO in each environment and compares it with random actions: train_nightly.py BUILD_FOLDER WORK [OPTION...]

  --minutes N            of processor time for each seed (default: 40, what two cores have in twenty minutes)
  --seeds N              (default: 5)
  --environments A,B     (default: all three)
  --jobs N               trainings beside each other, one thread each (default: 2)
  --budget N             minutes that this call may take; the next one goes on where it stopped (default: no limit)
  --python PATH          an interpreter with the packages of requirements-learning.txt (default: one is made in WORK)
  --write DOCUMENT       write the table between its marks "learning", and the curves into ../pictures/learning.svg beside it

Writes WORK/table.md and WORK/curves.svg. Trainings of other sources of the environments are made anew; with more minutes they
go on. Exit code 77, which
CTest takes as skipped: the budget is used up, or no index of packages is reached. Exit code 1: an environment of LEARNS is not
above random by two standard errors.
"""
import argparse
import csv
import hashlib
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from document_marks import write_between_marks  # noqa: E402

ENVIRONMENTS = ("CrawlerNav", "SnakeExplore", "VoidExplore")
LEARNS = ("CrawlerNav",)  # for certain, in this time
FEWEST = 40  # episodes of a point of a curve
COLOURS = ("#1b6ca8", "#c8553d", "#588b3c", "#8a5a9e", "#b08b2e")


def make_environment(work):
    python = work / "packages/bin/python"
    if not (work / "packages/complete").exists():
        subprocess.run([sys.executable, "-m", "venv", work / "packages"], check=True)
        done = subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:", "-r",
                               HERE / "requirements-learning.txt"])
        if done.returncode:
            return None
        (work / "packages/complete").touch()
    return python


def forget_other_sources(work, build):
    """Removes what was trained with other environments."""
    digest = hashlib.sha256()
    for path in [HERE / "train_one.py", *sorted((build / "python/rubble/envs").glob("*.py"))]:
        digest.update(path.name.encode() + path.read_bytes())
    stamp = work / "trained/sources.txt"
    if not stamp.exists() or stamp.read_text() != digest.hexdigest():
        shutil.rmtree(work / "trained", ignore_errors=True)
        stamp.parent.mkdir(parents=True)
        stamp.write_text(digest.hexdigest())


def read(path):
    return json.loads(path.read_text()) if path.exists() else {}


def describe(returns):
    """Mean and its standard error."""
    return statistics.mean(returns), statistics.stdev(returns) / math.sqrt(len(returns)) if len(returns) > 1 else math.nan


def compare(work, name, seeds):
    """Mean and standard error of the trained and of the random one, and whether the first is above by two standard errors."""
    trained = describe([statistics.mean(read(work / f"trained/{name}_{seed}/result.json")["returns"]) for seed in range(1, seeds + 1)])
    chance = describe(read(work / f"trained/{name}_random/result.json")["returns"])
    return trained, chance, trained[0] - chance[0] > 2 * math.hypot(trained[1], chance[1])


def read_curve(path):
    """Minutes, and the mean return of so many episodes at least: after each call all episodes begin anew, and the first that end are
    short ones."""
    curve, episodes, total = [], 0, 0.0
    with open(path) as file:
        for row in csv.reader(file):
            count = int(row[2])
            episodes, total = episodes + count, total + count * float(row[3] or 0)
            if episodes >= FEWEST:
                curve.append((float(row[1]) / 60, total / episodes))
                episodes, total = 0, 0.0
    return curve


def draw_curves(work, names, seeds, path):
    """A panel for each environment, a line for each seed; dashes: random actions."""
    width, height, left, top = 270, 180, 50, 40
    text = []
    for panel, name in enumerate(names):
        lines = [read_curve(work / f"trained/{name}_{seed}/curve.csv") for seed in range(1, seeds + 1)]
        chance = describe(read(work / f"trained/{name}_random/result.json")["returns"])[0]
        points = [point for line in lines for point in line] + [(0, chance)]
        low, high, last = min(y for _, y in points), max(y for _, y in points), max(x for x, _ in points)
        x0 = panel * (width + 70) + left

        def place(x, y):
            return f"{x0 + x / (last or 1) * width:.1f},{top + (high - y) / (high - low or 1) * height:.1f}"

        def label(x, y, words, more=""):
            text.append(f'<text x="{x:.1f}" y="{y:.1f}" {more}>{words}</text>')
        label(x0, top - 14, name, 'font-weight="bold"')
        text.append(f'<path d="M{place(0, high)} L{place(0, low)} L{place(last, low)}" stroke="#999" fill="none"/>')
        for y in (low, high):
            label(x0 - 6, top + (high - y) / (high - low or 1) * height + 4, f"{y:.3g}", 'text-anchor="end"')
        label(x0, top + height + 16, "0")
        label(x0 + width, top + height + 16, f"{last:.0f} min", 'text-anchor="end"')
        text.append(f'<polyline points="{place(0, chance)} {place(last, chance)}" stroke="#555" stroke-dasharray="4 4" fill="none"/>')
        for line, colour in zip(lines, COLOURS * len(lines)):
            text.append(f'<polyline points="{" ".join(place(*point) for point in line)}" stroke="{colour}" stroke-width="1.5" fill="none"/>')
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{len(names) * (width + 70)}" height="{height + top + 30}" '
                    'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>\n' + "\n".join(text) + "\n</svg>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("work", type=Path)
    parser.add_argument("--minutes", type=float, default=40)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--environments", default=",".join(ENVIRONMENTS))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--budget", type=float, default=math.inf)
    parser.add_argument("--python", type=Path)
    parser.add_argument("--write", metavar="DOCUMENT", type=Path)
    wish = parser.parse_args()
    names, until = wish.environments.split(","), time.monotonic() + 60 * wish.budget
    wish.work.mkdir(parents=True, exist_ok=True)
    python = wish.python or make_environment(wish.work)
    if python is None:
        print("skipped: the packages of tests/python/requirements-learning.txt cannot be installed here")
        return 77
    forget_other_sources(wish.work, wish.build)
    # The package lies beside the program, whose assets it finds.
    environment = dict(os.environ, PYTHONPATH=str(wish.build / "python"), PYTHONDONTWRITEBYTECODE="1", OMP_NUM_THREADS="1")

    def run(what, name, seed, folder, seconds=0.0):
        subprocess.run([python, HERE / "train_one.py", what, name, str(seed), folder, str(seconds)], check=True, env=environment)

    # Where PyTorch is, the checker of stable-baselines3 runs, too.
    subprocess.run([python, "-m", "unittest", "-k", "StableBaselines", HERE / "test_gymnasium.py"], check=True, env=environment, cwd=ROOT)
    def train(seed, name):
        """Returns how long the training lacks its time."""
        folder = wish.work / f"trained/{name}_{seed}"

        def missing():
            return 60 * wish.minutes - read(folder / "state.json").get("seconds", 0)
        while missing() > 1:
            left = until - time.monotonic()
            if left < 60:
                return missing()
            (folder / "result.json").unlink(missing_ok=True)
            run("train", name, seed, folder, min(left - 30, missing()))
        if not (folder / "result.json").exists():
            run("measure", name, seed, folder)
        return 0

    for name in names:
        folder = wish.work / f"trained/{name}_random"
        if not (folder / "result.json").exists():
            run("random", name, 0, folder)
    trainings = [(seed, name) for seed in range(1, wish.seeds + 1) for name in names]  # each environment by turns
    with ThreadPoolExecutor(wish.jobs) as jobs:
        missing = list(jobs.map(lambda training: train(*training), trainings))
    if any(missing):
        seed, name = trainings[next(i for i, seconds in enumerate(missing) if seconds)]
        print(f"skipped: {sum(not seconds for seconds in missing)} of {len(trainings)} trainings are complete; {name}, seed {seed} has trained "
              f"for {read(wish.work / f'trained/{name}_{seed}/state.json').get('seconds', 0) / 60:.0f} of {wish.minutes:g} minutes; call it again")
        return 77
    lines, failed = [f"|environment|steps of each seed, {wish.minutes:g} min|PPO: mean return|random actions|above by two standard errors|",
                     "|---|---|---|---|---|"], False
    for name in names:
        trained, chance, above = compare(wish.work, name, wish.seeds)
        steps = [read(wish.work / f"trained/{name}_{seed}/result.json")["steps"] for seed in range(1, wish.seeds + 1)]
        lines.append(f"|`{name}`|{min(steps)} to {max(steps)}|{trained[0]:.2f} ± {trained[1]:.2f}|{chance[0]:.2f} ± {chance[1]:.2f}|{'yes' if above else 'no'}|")
        failed |= name in LEARNS and not above
    (wish.work / "table.md").write_text("\n".join(lines) + "\n")
    draw_curves(wish.work, names, wish.seeds, wish.work / "curves.svg")
    print("\n".join(lines))
    if wish.write:
        write_between_marks(wish.write, "learning", "\n".join(lines) + "\n")
        shutil.copyfile(wish.work / "curves.svg", wish.write.parent.parent / "pictures/learning.svg")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
