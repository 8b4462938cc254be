#!/usr/bin/python3
"""usage: demonstration.py PROGRAM OUT: two rows of the demonstration, small, and what must hold of them on any machine:
outside mapping works, and in the dark void it breaks. COLMAP's threads make its results vary from run to run."""
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ROWS = ["exterior", "dark"]


def run(program, out, *options):
    return subprocess.run([str(ROOT / "bench" / "demonstration" / "run"), "--size", "small", "--seeds", "1", "--rows", ",".join(ROWS),
                           "--judges", "colmap", "--out", str(out), "--records", str(out / "records.jsonl"), "--program", program, *options],
                          check=True, stdout=subprocess.PIPE, text=True).stdout


def main():
    program, out = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(out, ignore_errors=True)
    print(run(program, out))
    judged = [json.loads(path.read_text()) for path in (out / "judged").glob("*/result.json")]
    assert len(judged) == len(ROWS), len(judged)
    outside, inside = sorted(judged, key=lambda r: r["score"]["on_track_percent"], reverse=True)
    assert outside["score"]["on_track_percent"] > 90 and outside["score"]["segments"] == 1, outside["score"]
    # Into several models, or with much of the way in none: which of the two varies.
    assert inside["score"]["on_track_percent"] < 80, inside["score"]
    deepest = max(f["into"] for f in inside["frames"])
    near, deep = (statistics.mean(f["matches_mp"] for f in inside["frames"] if "matches_mp" in f and low < f["into"] <= high)
                  for low, high in ((0, 4), (deepest - 4, deepest)))
    assert deep < 0.6 * near, (deep, near)
    # Done once, done for good: a second call finds everything there.
    start = time.monotonic()
    run(program, out, "--hours", "0")
    assert time.monotonic() - start < 20


if __name__ == "__main__":
    main()
