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
# Of the mean error, and of the mean difference, in which noise cancels out; per cent. Above the noise of so few
# paths: with half as many, errors of 0.2, 1.6, 2.7, 0.1 and 1.4 were measured.
LIMITS = {"heap_noon": (0.5, 0.2), "void_day": (2, 0.5), "room_day": (3, 1), "room_lamp": (0.3, 0.1),
          "heap_noon_mirror": (2, 1), "crates_noon": (0.6, 0.2)}


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


def change(out, name, alter):
    """What the judge says of the heap that Cycles draws from an altered description."""
    view = json.loads((out / "heap_noon.json").read_text())
    alter(view)
    (out / (name + ".json")).write_text(json.dumps(view))
    options = argparse.Namespace(out=str(out), samples=64, threads=0)
    return cycles_judge.judge(shutil.which("blender"), name, options)


def check_judge(out):
    """A sun that is 5 % too bright, and a camera that is off by 2 cm, are seen."""
    def brighten(view):
        view["sun"]["illuminance"] = [1.05 * part for part in view["sun"]["illuminance"]]

    def move(view):
        view["camera"]["position"][0] += 0.02
    limit = LIMITS["heap_noon"][0]
    bright, off = change(out, "bright", brighten), change(out, "off", move)
    assert 100 * bright["mean"] > 3 * limit and 100 * bright["signed"] < -2, bright
    assert 100 * off["mean"] > 2 * limit, off


def check_principal_point(out):
    """An image whose middle is 8 pixels to the right and 4 down is the same picture, moved."""
    def shift(view):
        view["camera"]["cx"] += 8
        view["camera"]["cy"] += 4
    change(out, "shifted", shift)
    ours = cycles_judge.read_pfm(out / "heap_noon_ours.pfm")
    moved = cycles_judge.read_pfm(out / "shifted_cycles.pfm")
    found = cycles_judge.compare(ours[:-4, :-8], moved[4:, 8:], 8)
    assert 100 * found["mean"] < 1, found


def main():
    build, out = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(out, ignore_errors=True)
    check_views(build, out)
    check_judge(out)
    check_principal_point(out)


if __name__ == "__main__":
    main()
