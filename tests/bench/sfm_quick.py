#!/usr/bin/python3
"""usage: sfm_quick.py PROGRAM OUT: makes the quick table of docs/explanation/sfm.md afresh and checks what must hold of it
on any machine. COLMAP's threads make its results vary a little from run to run."""
import json
import pathlib
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FRAMES = {"exterior": 42, "dark": 30, "lit": 53}


def main():
    program, out = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(out, ignore_errors=True)
    start = time.monotonic()
    run = subprocess.run([str(ROOT / "bench" / "sfm" / "run"), "--quick", "--out", str(out), "--program", program],
                         check=True, stdout=subprocess.PIPE, text=True)
    print(run.stdout, "%.0f s" % (time.monotonic() - start))
    scores = dict(zip(FRAMES, map(json.loads, run.stdout.splitlines())))
    for name, frames in FRAMES.items():
        score = scores[name]
        assert score["frames"] == frames, (name, score)
        assert score["segments"] >= 1 and score["on_track_percent"] > 60, (name, score)
        assert score["points"] > 300 and score["reprojection_px"] < 1.5, (name, score)
        assert score["ate_rmse_m"] < 0.2, (name, score)
        # Points lie on the surface that was rendered, not merely somewhere: a wrong frame or scale by half a
        # per cent would be seen.
        assert score["median_distance_m"] < 0.06 and score["within_5cm_percent"] > 45, (name, score)
        assert score["completeness_5cm_percent"] > 1, (name, score)
    assert scores["dark"]["points"] < scores["lit"]["points"], scores
    # Done once, done for good: a second call finds everything there.
    start = time.monotonic()
    subprocess.run([str(ROOT / "bench" / "sfm" / "run"), "--quick", "--out", str(out), "--program", program,
                    "--no-eval"], check=True)
    assert time.monotonic() - start < 20


if __name__ == "__main__":
    main()
