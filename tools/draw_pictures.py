#!/usr/bin/python3
"""Draws the pictures of the documents anew, all but the film: `make pictures`.

usage: tools/draw_pictures.py [--build build/release] [--list] [NAME ...]
NAME: some of the steps that --list prints, drawn again even if they are finished; all of them if none is given.

Runs and notes of finished steps are in out/pictures/HASH, where HASH is that of the program. A step that this program has
finished is not repeated, so a command that was stopped goes on. A step that fails is named at the end; the others go on.
"""
import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys

import mission_pictures

os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
WORK = "out/pictures"
COLLAPSE = "docs/explanation/collapse.md"


def mission_steps():
    """A step for each mission that has pictures, by the name of the first; some have two."""
    names = {}
    for name, row in mission_pictures.PICTURES.items():
        names.setdefault(row[0], []).append(name)
    for pictures in names.values():
        yield os.path.splitext(pictures[0])[0], ["tools/mission_pictures.py --program {program} --out {work}/missions " + " ".join(pictures)]


def gallery_steps():
    with open("docs/gallery.json") as file:
        for section in json.load(file)["sections"]:
            title = section["title"]
            yield "gallery_" + title.lower().replace(" ", "_"), ["{build}/gallery --section '%s'" % title]


def steps():
    """Name and commands of each step, the quick ones first."""
    packs = "concrete residential parking bridge victims".split()
    yield "packs", ["{program} assets show %s --tile 168 --out docs/pictures/pack_%s.jpg" % (p, p) for p in packs]
    yield "first_pile", [
        "{program} run scripts/first_pile.lua --quiet --out {work}/first_pile --force",
        "tools/frames_of_bag.py {work}/first_pile/mission.bag docs/pictures/first_pile.png 341 0 55 118",
        "{program} voids {work}/first_pile --radius 0.2 --force",
        "cp {work}/first_pile/voids/plan_r200.png docs/pictures/void_plan.png",
        "cp {work}/first_pile/voids/cut_y_r200.png docs/pictures/void_cut.png",
    ]
    yield "collapse_modes", ["tools/collapse_pictures.sh {build}"]
    yield from mission_steps()
    yield "lidar", [
        "{program} run scripts/lidar.lua --quiet --out {work}/lidar --force",
        "{program} run scripts/lidar.lua --quiet --set fogdensity=0.1 --out {work}/lidar_smoke --force",
        "/usr/bin/python3 tools/draw_lidar.py {work}/lidar top docs/pictures/lidar.png --beside {work}/lidar_smoke",
    ]
    yield "drive", ["tools/drive_sheet.sh {program}", "tools/inspect_sheet.sh {program}"]
    ways = "{work}/navigate/%s/ways/2.csv"
    yield "navigate", [
        "{program} bench navigate scripts/navigate.lua --seeds 2 --planner %s --force --out {work}/navigate/%s" % (p, p)
        for p in ("none", "ompl")
    ] + ["PYTHONPATH={build}/python /usr/bin/python3 tools/draw_navigate.py scripts/navigate.lua 2 " +
         ways % "none" + " " + ways % "ompl" + " docs/pictures/navigate.png"]
    yield from gallery_steps()
    yield "ruins", [
        "tools/draw_ruins.py --program {program} --out {work}/ruins " + COLLAPSE,
    ]
    yield "demonstration", ["bench/demonstration/run --program {program} --document"]
    yield "slam_judges", ["bench/demonstration/slam --program {program} --document"]


def run(commands, names):
    for command in commands:
        if subprocess.run(command.format(**names), shell=True).returncode != 0:
            print("failed: " + command.format(**names), flush=True)
            return False
    return True


def start_work(program):
    """The folder of this program; those of other programs are removed."""
    with open(program, "rb") as file:
        work = os.path.join(WORK, hashlib.sha256(file.read()).hexdigest()[:12])
    if os.path.isdir(WORK):
        for name in os.listdir(WORK):
            if os.path.join(WORK, name) != work:
                shutil.rmtree(os.path.join(WORK, name))
    os.makedirs(os.path.join(work, "done"), exist_ok=True)
    return work


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--list", action="store_true", help="print the names of the steps")
    parser.add_argument("names", nargs="*", metavar="NAME")
    args = parser.parse_args()
    wanted = [step for step in steps() if not args.names or step[0] in args.names]
    unknown = set(args.names) - {name for name, _ in wanted}
    if unknown:
        sys.exit(f"{', '.join(sorted(unknown))}: not in the list; --list prints it")
    if args.list:
        print("\n".join(name for name, _ in wanted))
        return
    program = os.path.join(args.build, "rubble")
    work = start_work(program)
    failed = []
    for i, (name, commands) in enumerate(wanted):
        done = os.path.join(work, "done", name)
        if os.path.exists(done) and not args.names:
            continue
        print(f"{i + 1} of {len(wanted)}: {name}", flush=True)
        if run(commands, {"program": program, "build": args.build, "work": work}):
            open(done, "w").close()
        else:
            failed.append(name)
    if failed:
        sys.exit("not drawn: " + ", ".join(failed))


if __name__ == "__main__":
    main()
