"""Results of the demonstration that outlive the machine: one line each in records.jsonl, which is kept with the sources. A
campaign of some nights goes on with any commit that gives the same bits: a record names the golden hashes of its commit, and one
whose golden hashes, mission, settings or judge are not those of the sources counts as missing."""
import hashlib
import json
import math
import os
import pathlib
import subprocess

import work as stages

HERE = pathlib.Path(__file__).resolve().parent
FILE = HERE / "records.jsonl"
GOLDEN = ("tests/golden/kernel.txt", "tests/determinism/missions/suite.lua")
MEASURES = ("matches.py", "carriers.py", "carrier.lua")
BIN = 0.5  # of frames together, by metres into the void; unit: m


def golden_hash():
    return hashlib.sha256(b"".join((stages.ROOT / name).read_bytes() for name in GOLDEN)).hexdigest()[:12]


def bins_of(frames):
    """Frames that follow each other in one bin, along the flight: [metres into the void where the bin begins, or null; frames; sum of
    keypoints / MP; frames with a next one; sum of true matches / MP; frames that a model has]."""
    bins = []
    for f in frames:
        at = None if f["into"] is None else math.floor(f["into"] / BIN) * BIN
        if not bins or bins[-1][0] != at:
            bins.append([at, 0, 0.0, 0, 0.0, 0])
        sums = bins[-1]
        sums[1] += 1
        sums[2] += f["keypoints_mp"]
        if "matches_mp" in f:
            sums[3] += 1
            sums[4] += f["matches_mp"]
        sums[5] += f["model"] is not None
    return [[at, *(round(x, 1) for x in sums)] for at, *sums in bins]


def in_model(bins):
    """Of each frame, along the flight: metres into the void, to the middle of its bin, and the share of the bin that a model has."""
    frames = [(at + BIN / 2, modelled / count) for at, count, _, _, _, modelled in bins for _ in range(count)]
    return [list(column) for column in zip(*frames)]


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
        lines = self.path.read_text().splitlines() if self.path.exists() else []
        self.kept = {tuple(r["key"]): r for r in map(json.loads, lines)}
        self.golden = golden_hash()

    def depends(self, flown, row, judge):
        """flown: Flights."""
        text = json.dumps([stages.digest_file(stages.MISSION), flown.settings(row), row.carrier, row.calibrated, judge,
                           [stages.digest_file(HERE / name) for name in MEASURES]])
        return {"golden": self.golden, "rest": hashlib.sha256(text.encode()).hexdigest()[:12]}

    def find(self, size, seed, row, judge, depends):
        """The record, or None."""
        record = self.kept.get((size, row.name, seed, judge))
        return record if record and record["depends"] == depends else None

    def add(self, size, seed, row, judge, depends, result, commit):
        self.kept[(size, row.name, seed, judge)] = {"key": [size, row.name, seed, judge], "commit": commit, "depends": depends,
                                                    "score": result["score"], "bins": bins_of(result["frames"])}
        part = self.path.with_suffix(".part")
        part.write_text("".join(json.dumps(self.kept[key]) + "\n" for key in sorted(self.kept)))
        os.replace(part, self.path)


def commit_of(run):
    """The commit of the program that made a run."""
    found = json.loads((run / "manifest.json").read_text())["program"].get("commit")
    return found or subprocess.run(["git", "-C", str(stages.ROOT), "rev-parse", "--short=8", "HEAD"], stdout=subprocess.PIPE, text=True).stdout.strip()
