#!/usr/bin/env python3
"""Runs the bench and writes its figures into docs/development/performance.md and docs/explanation/equilibrium.md.

Everything between `<!-- begin NAME -->` and `<!-- end NAME -->` there is replaced; the text around
it is written by people. Nothing in those tables is typed by hand.
"""
import argparse
import csv
import datetime
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools"))
import document_marks  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / "docs/development/performance.md"
DOCUMENTS = {"equilibrium": ROOT / "docs/explanation/equilibrium.md"}  # of sections that stand elsewhere
SETTLING = [  # work, schedule, threads
    ("w1", "layers", 1), ("w1", "layers", 2), ("w1", "planes", 1), ("w1", "planes", 2),
    ("w2", "layers", 1), ("w2", "layers", 2), ("w2", "planes", 1), ("w2", "planes", 2),
]
SEEDS = 20
NOT_SHOWN = ("CPU s", "pairs > 5 mm", "ground mm", "terrain mm", "lost")  # of equilibrium: times beside other programs, and goals that all piles meet
CALIBRATION = {"calibration ms": "calibration_1_ms calibration_2_ms"}
GOALS = {("void_lamp", "1024"): "12", ("exterior_sun", "1024"): "10", ("void_lamp", "512"): "30",
         ("exterior_sun", "512"): "30"}  # frames/s


def rows_of(command):
    """The lines of a --csv program as dictionaries; not having settled is a result as well."""
    print("$", " ".join(command), file=sys.stderr, flush=True)
    run = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if run.returncode not in (0, 3):
        sys.exit("%s failed with %d" % (command[0], run.returncode))
    return list(csv.DictReader(run.stdout.splitlines()))


def table(rows, columns):
    """A Markdown table; `columns` maps a heading to the keys whose values stand there."""
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    for row in rows:
        cells = [" / ".join(row[key] for key in keys.split()) for keys in columns.values()]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def make_settling(build):
    rows = []
    for work, schedule, threads in SETTLING:
        rows += rows_of([str(build / "settle_bench"), "--work", work, "--schedule", schedule,
                         "--threads", str(threads), "--csv"])
    speed = {"work": "work", "schedule": "schedule", "threads": "threads", "wall s": "wall_s",
             "CPU s": "cpu_s", "simulated s": "sim_s", "settled": "settled",
             "memory MiB": "peak_rss_mib", "state hash": "state_hash", **CALIBRATION}
    quality = {"work": "work", "schedule": "schedule", "touching pairs": "touching_pairs",
               "> 5 / > 10 mm": "over_5mm over_10mm", "ejected": "ejected", "lost": "lost",
               "drift median / p99 mm": "drift_median_mm drift_p99_mm"}
    return table(rows, speed) + "\n\n" + table([r for r in rows if r["threads"] == "1"], quality)


def make_scaling(build):
    rows = rows_of([str(build / "scaling_bench")])
    return table(rows, {"pieces": "pieces", "CPU s": "cpu_s", "simulated s": "sim_s", "settled": "settled",
                        "CPU ms per piece": "cpu_ms_per_piece",
                        "CPU us per piece and step": "cpu_us_per_piece_and_step",
                        "memory MiB": "peak_rss_mib", **CALIBRATION})


def make_recording(build):
    with tempfile.TemporaryDirectory() as folder:
        rows = rows_of([str(build / "recorder_bench"), folder, "30"])
    return table(rows, {"recorder": "recorder", "CPU ms a frame": "cpu_ms",
                        "frames/s": "frames_per_s",
                        "MB a frame": "mb_per_frame"})


def make_render(build):
    rows = rows_of([str(build / "render_bench"), "--csv", "--split", "--frames", "15"])
    for row in rows:
        row["goal"] = GOALS.get((row["view"], row["size"]), "")
    text = table(rows, {"view": "view", "size": "size", "median ms": "median_ms", "min ms": "min_ms",
                        "frames/s": "fps", "goal": "goal", "CPU ms": "cpu_ms",
                        "visibility": "visibility_ms", "resolve": "resolve_ms", "read": "read_ms",
                        "finish": "finish_ms", "triangles": "triangles", **CALIBRATION})
    return "%s\n\n%s\n\nFirst frame %s s after the start of the program; %s MiB of memory at most." % (
        make_machine(build), text, rows[0]["first_frame_s"],
        max(int(row["peak_rss_mib"]) for row in rows))


def make_equilibrium(build):
    """What out/equilibrium.jsonl has of an earlier run is used again; delete it for a new table."""
    records = ROOT / "out" / "equilibrium.jsonl"
    records.parent.mkdir(exist_ok=True)
    command = [str(build / "equilibrium_bench"), "--work", "all", "--seeds", "1..%d" % SEEDS,
               "--jobs", str(os.cpu_count()), "--markdown", "--out", str(records)]
    print("$", " ".join(command), file=sys.stderr, flush=True)
    run = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if run.returncode not in (0, 3):
        sys.exit("%s failed with %d" % (command[0], run.returncode))
    lines = [line.strip("|").split("|") for line in run.stdout.split("\n\n")[1].strip().split("\n")]
    left_out = [k for k, heading in enumerate(lines[0]) if heading.strip() in NOT_SHOWN]
    lines = ["|" + "|".join(cell for k, cell in enumerate(line) if k not in left_out) + "|" for line in lines]
    return make_machine(build) + "\n\n" + "\n".join(lines)


def make_machine(build):
    del build
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    commit = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--abbrev=12",
                             "--exclude=*"], stdout=subprocess.PIPE, text=True).stdout.strip()
    load = "%.1f" % os.getloadavg()[0]
    return "%s, %d logical processors; commit %s; %s; load average before the run %s." % (
        model.group(1) if model else "unknown processor", os.cpu_count(), commit or "unknown",
        datetime.date.today().isoformat(), load)


SECTIONS = {"machine": make_machine, "settling": make_settling, "scaling": make_scaling,
            "recording": make_recording, "render": make_render, "equilibrium": make_equilibrium}


def main():
    global SEEDS
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="piles of each kind in the table of equilibrium (default: %d)" % SEEDS)
    parser.add_argument("sections", nargs="*", help="of: " + ", ".join(SECTIONS))
    args = parser.parse_args()
    SEEDS = args.seeds
    unknown = [name for name in args.sections if name not in SECTIONS]
    if unknown:
        parser.error("no section is named " + ", ".join(unknown))
    for name in args.sections or SECTIONS:
        body = SECTIONS[name](args.build)
        document_marks.write_between_marks(DOCUMENTS.get(name, DOCUMENT), name, body + "\n")


if __name__ == "__main__":
    main()
