#!/usr/bin/python3
"""usage: cycles_judge_nightly.py BUILD OUT: Cycles judges small images of every view, and sees wrong ones."""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bench" / "images"))
import cycles_judge  # noqa: E402

SIZE, SAMPLES = 128, 512
# Of the mean error, and of the mean difference, in which noise cancels out; per cent. Twice to three times
# what was measured: it is the noise of so few paths.
LIMITS = {"heap_noon": (0.6, 0.2), "void_day": (2, 0.4), "room_day": (3, 0.7), "room_lamp": (0.4, 0.1)}


def check_views(build, out):
    driver = str(ROOT / "bench" / "images" / "cycles_judge.py")
    run = subprocess.run([driver, "--build", build, "--out", str(out), "--size", str(SIZE), "--samples",
                          str(SAMPLES)], stdout=subprocess.PIPE, text=True)
    print(run.stdout)
    assert run.returncode == 0, run.returncode
    for name, (mean, signed) in LIMITS.items():
        view = json.loads((out / (name + ".json")).read_text())
        found = cycles_judge.compare(cycles_judge.read_pfm(out / view["ours"]),
                                     cycles_judge.read_pfm(out / (name + "_cycles.pfm")))
        assert 100 * found["mean"] < mean and abs(100 * found["signed"]) < signed, (name, found)


def check_judge(out):
    """A sun that is 5 % too bright, and a camera that is off by 2 cm, are seen."""
    options = argparse.Namespace(out=str(out), samples=64, threads=0)
    view = json.loads((out / "heap_noon.json").read_text())
    view["sun"]["illuminance"] = [1.05 * part for part in view["sun"]["illuminance"]]
    (out / "bright.json").write_text(json.dumps(view))
    bright = cycles_judge.judge(shutil.which("blender"), "bright", options)
    assert 100 * bright["mean"] > 3 * LIMITS["heap_noon"][0] and 100 * bright["signed"] < -2, bright
    view = json.loads((out / "heap_noon.json").read_text())
    view["camera"]["position"][0] += 0.02
    (out / "off.json").write_text(json.dumps(view))
    off = cycles_judge.judge(shutil.which("blender"), "off", options)
    assert 100 * off["mean"] > 2 * LIMITS["heap_noon"][0], off


def main():
    build, out = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(out, ignore_errors=True)
    check_views(build, out)
    check_judge(out)


if __name__ == "__main__":
    main()
