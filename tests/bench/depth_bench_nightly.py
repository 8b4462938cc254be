#!/usr/bin/python3
"""usage: depth_bench_nightly.py DEPTH_BENCH: the fast renderer agrees with paths at both ends of a void, on small images."""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OPTIONS = ["--ruins", "lean_to:1", "--depths", "0,1", "--size", "64", "--samples", "256", "--regions", "8"]


def rows(bench, *options):
    """{depth: (mean error, bias, SSIM)}, the first two in per cent."""
    run = subprocess.run([bench, *OPTIONS, *options], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    print(run.stdout)
    found = {}
    for line in run.stdout.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[0] == "lean_to:1":
            found[cells[1]] = tuple(float(cell.split()[0]) for cell in cells[2:5])
    assert set(found) == {"0 %", "100 %"}, run.stdout
    return found


def main(bench):
    found = rows(bench)
    for depth, (error, bias, ssim) in found.items():
        assert error < 8 and abs(bias) < 5 and ssim > 0.9, (depth, error, bias, ssim)
    # It can fail: a bake by few rays is worse.
    worse = rows(bench, "--bake-rays", "8")
    assert worse["100 %"][0] > found["100 %"][0], (worse, found)
    # A ruin that is no ruin is refused, and the message says what is wanted.
    refused = subprocess.run([bench, "--ruins", "lean_to"], cwd=ROOT, stderr=subprocess.PIPE, text=True, check=False)
    assert refused.returncode != 0 and "STRUCTURE:SEED" in refused.stderr, refused


if __name__ == "__main__":
    main(sys.argv[1])
