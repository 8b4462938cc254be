#!/usr/bin/python3
"""usage: cycles_judge_quick.py BUILD OUT: what of bench/images/cycles_judge.py needs no Blender."""
import json
import pathlib
import subprocess
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bench" / "images"))
from judge_measures import compare, read_pfm, write_pfm  # noqa: E402

DRIVER = ROOT / "bench" / "images" / "cycles_judge.py"


def near(found, expected):
    assert abs(found - expected) < 1e-9, (found, expected)


def check_measures():
    """On images whose differences are known."""
    judge = numpy.ones((32, 32, 3))
    near(compare(judge, judge)["mean"], 0)
    ours = judge * 1.1
    near(compare(ours, judge)["mean"], 0.1)
    near(compare(ours, judge)["signed"], 0.1)
    # Half of the regions brighter, half darker: the sign cancels, the error does not.
    ours[:16] = 0.9
    near(compare(ours, judge)["mean"], 0.1)
    near(compare(ours, judge)["signed"], 0)
    # One region of one colour: of 16 x 16 regions and 3 colours.
    ours = judge.copy()
    ours[30:, 2:4, 1] = 2
    found = compare(ours, judge)
    near(found["mean"], 1 / (256 * 3))
    near(found["worst"], 1)
    assert (found["worst_row"], found["worst_column"]) == (15, 1), found
    # A black region counts as 1 % of the mean.
    judge[:16], ours = 0, numpy.ones((32, 32, 3))
    near(compare(ours, judge)["worst"], 1 / (0.01 * 0.5))
    try:
        compare(ours[:8], judge)
    except ValueError as error:
        assert "images of different sizes" in str(error)
    else:
        raise AssertionError("images of different sizes were compared")


def check_files(out):
    image = numpy.arange(5 * 3 * 3, dtype=float).reshape(5, 3, 3)
    write_pfm(str(out / "made.pfm"), image)
    assert (read_pfm(str(out / "made.pfm")) == image).all()
    (out / "made.pfm").write_bytes(b"PF\n2 2\n-1.0\n1234")
    try:
        read_pfm(str(out / "made.pfm"))
    except ValueError as error:
        assert "numbers, not 2 x 2 x 3" in str(error), error
    else:
        raise AssertionError("half a file was read")


def check_teaching(build, out):
    """Without Blender it says what to install, before anything is traced."""
    run = subprocess.run([str(DRIVER), "--blender", "no_such_blender", "--build", build, "--out",
                          str(out / "none")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert run.returncode == 1 and run.stdout == "", run
    assert "Debian's package blender" in run.stderr and "no_such_blender" in run.stderr, run.stderr
    assert not (out / "none").exists()
    packages = (ROOT / "tools" / "packages-nightly.txt").read_text().splitlines()
    assert "blender" in packages, packages


def check_views(build, out):
    """What is written of each view."""
    run = subprocess.run([build + "/judge_scenes", "--only", "room", "--size", "16", "--samples", "2",
                          "--out", str(out)], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    assert run.stdout.split() == ["room_day", "room_lamp"], run.stdout
    day, night = (json.loads((out / (name + ".json")).read_text()) for name in ("room_day", "room_lamp"))
    for view in day, night:
        image = read_pfm(str(out / view["ours"]))
        assert image.shape == (16, 16, 3) and image.min() >= 0 and image.mean() > 0
        assert (out / view["mesh"]).stat().st_size > 1000 and (out / view["sky"]).stat().st_size > 1000
    assert day["sun"] and not day["lamp"] and night["lamp"] and not night["sun"]
    assert 0.0045 < day["sun"]["angular_radius"] < 0.0048, day["sun"]
    assert night["lamp"]["radius"] > 0, night["lamp"]


def main():
    build, out = sys.argv[1], pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    check_measures()
    check_files(out)
    check_teaching(build, out)
    check_views(build, out)


if __name__ == "__main__":
    main()
