"""Results of the demonstration that outlive the machine: one line each in records.jsonl (SLAM systems: slam_records.jsonl), which
are kept with the sources. A campaign of some nights goes on with any commit that gives the same bits: a record names the golden
hashes of its commit, and one whose golden hashes, mission, settings or judge are not those of the sources counts as missing."""
import hashlib
import json
import math
import os
import pathlib
import subprocess

import work as stages

HERE = pathlib.Path(__file__).resolve().parent
FILE = HERE / "records.jsonl"
GOLDEN = ("tests/golden/kernel.txt", "tests/determinism/missions/suite.golden.json")
MEASURES = ("matches.py", "carriers.py", "carrier.lua")
BIN = 0.5  # of frames together, by metres into the void; unit: m


def is_judged(mission, output):
    """None reads a rawlog, or sensors that a robot carries but for the motion of its camera."""
    return not output.startswith("mission.rawlog") and not (mission == "scanning_crawler" and (output == "frames" or output.startswith("mission.")))


def golden_hash():
    """Of what a judge reads."""
    kernel, suite = ((stages.ROOT / name).read_text() for name in GOLDEN)
    runs = {mission: {output: value for output, value in outputs.items() if is_judged(mission, output)}
            for mission, outputs in json.loads(suite)["runs"].items()}
    return hashlib.sha256((kernel + json.dumps(runs, sort_keys=True)).encode()).hexdigest()[:12]


def grouped(into, width, *columns):
    """Frames that follow each other in one bin, along the flight: [metres into the void where the bin begins, or null; frames; sums of
    the columns]. into: of each frame, metres, or None."""
    bins = []
    for place, *values in zip(into, *columns):
        at = None if place is None else math.floor(place / width) * width
        if not bins or bins[-1][0] != at:
            bins.append([at, 0] + [0] * len(columns))
        bins[-1][1] += 1
        for k, value in enumerate(values):
            bins[-1][2 + k] += value
    return [[at, *(round(x, 1) for x in sums)] for at, *sums in bins]


def bins_of(frames):
    """grouped(): sum of keypoints / MP; frames with a next one; sum of true matches / MP; frames that a model has."""
    columns = [(f["keypoints_mp"], int("matches_mp" in f), f.get("matches_mp", 0), int(f["model"] is not None)) for f in frames]
    return grouped([f["into"] for f in frames], BIN, *zip(*columns))


def shares(bins, width, column):
    """Of each frame, along the flight: metres into the void, to the middle of its bin, and the bin's mean of a column."""
    frames = [(b[0] + width / 2, b[column] / b[1]) for b in bins for _ in range(b[1])]
    return [list(values) for values in zip(*frames)]


def in_model(bins):
    """shares() of the frames that a model has."""
    return shares(bins, BIN, 5)


def mean_keypoints(bins, low=None, high=None):
    return mean(bins, 1, 2, low, high)


def mean_matches(bins, low=None, high=None):
    return mean(bins, 3, 4, low, high)


def share_in_model(bins, low=None, high=None):
    return mean(bins, 1, 5, low, high)


def mean(bins, count, total, low, high):
    """Of the frames from low to high metres, multiples of BIN; None: of all."""
    chosen = [b for b in bins if low is None or b[0] is not None and low <= b[0] < high]
    frames = sum(b[count] for b in chosen)
    return sum(b[total] for b in chosen) / frames if frames else None


class Records:
    def __init__(self, path=FILE):
        self.path = pathlib.Path(path)
        self.kept = self.read()
        self.golden = golden_hash()

    def read(self):
        lines = self.path.read_text().splitlines() if self.path.exists() else []
        return {tuple(r["key"]): r for r in map(json.loads, lines)}

    def depends(self, *parts):
        """parts: whatever the result follows from besides the program."""
        return {"golden": self.golden, "rest": hashlib.sha256(json.dumps(list(parts)).encode()).hexdigest()[:12]}

    def find(self, key, depends):
        """The record, or None. key: of strings and numbers."""
        record = self.kept.get(tuple(key))
        return record if record and record["depends"] == depends else None

    def add(self, key, depends, commit, result):
        """result: what the record has besides. What other commands have added meanwhile stays."""
        with stages.locked(self.path.parent):
            self.kept = {**self.read(), tuple(key): {"key": list(key), "commit": commit, "depends": depends, **result}}
            part = self.path.with_suffix(".part")
            part.write_text("".join(json.dumps(self.kept[key]) + "\n" for key in sorted(self.kept)))
            os.replace(part, self.path)


def flight_parts(flown, row):
    """What a recording follows from: for Records.depends()."""
    return [stages.digest_file(stages.MISSION), flown.settings(row), row.carrier]


class MappingRecords(Records):
    """Of structure from motion. judge: its identity (judges.py) for depends(), its name for the others. run: from 1; a judge that
    sees the same pictures again may find something else."""

    def depends(self, flown, row, judge):
        return super().depends(*flight_parts(flown, row), row.calibrated, judge, [stages.digest_file(HERE / name) for name in MEASURES])

    def find(self, size, seed, row, judge, depends, run=1):
        return super().find(self.key(size, seed, row, judge, run), depends)

    def add(self, size, seed, row, judge, depends, result, commit, run=1):
        super().add(self.key(size, seed, row, judge, run), depends, commit, {"score": result["score"], "bins": bins_of(result["frames"])})

    @staticmethod
    def key(size, seed, row, judge, run):
        return (size, row.name, seed, judge) + ((run,) if run > 1 else ())


def commit_of(run):
    """The commit of the program that made a run."""
    found = json.loads((run / "manifest.json").read_text())["program"].get("commit")
    return found or subprocess.run(["git", "-C", str(stages.ROOT), "rev-parse", "--short=8", "HEAD"], stdout=subprocess.PIPE, text=True).stdout.strip()
