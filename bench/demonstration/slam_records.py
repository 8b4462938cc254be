"""Results of SLAM systems that are kept with the sources, as records.py keeps those of structure from motion."""
import pathlib

import records

FILE = pathlib.Path(__file__).resolve().parent / "slam_records.jsonl"
WIDTH = 1.0  # of a bin; unit: m


class SlamRecords(records.Records):
    def __init__(self, path=FILE):
        super().__init__(path)

    def depends(self, judging, flown, row, judge, run):
        """judging: SlamJudges. flown: Flights of the judge's kind."""
        return super().depends(*records.flight_parts(flown, row), flown.size.outputs, *judging.parts(judge, run))

    def find(self, row, judge, seed, run, depends):
        return super().find((row.name, judge.name, seed, run), depends)

    def add(self, row, judge, seed, run, depends, commit, result):
        frames = result["frames"]
        into = frames["into"] or [None] * len(frames["followed"])
        bins = records.grouped(into, WIDTH, [int(f) for f in frames["followed"]])
        super().add((row.name, judge.name, seed, run), depends, commit, {"summary": result["summary"], "bins": bins})
