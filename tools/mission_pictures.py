#!/usr/bin/python3
"""Runs the missions that documents show, and draws their pictures anew: frames, sheets and sections.

usage: tools/mission_pictures.py [--program build/release/rubble] [--out out/pictures] [NAME ...]
NAME: file names in docs/pictures; all of the list below if none is given.

Needs python3-opencv (tools/packages-pictures.txt).
"""
import argparse
import os
import subprocess
import sys

import cv2

FOLDER = "docs/pictures"
JPEG = [cv2.IMWRITE_JPEG_QUALITY, 88]
NOT_SETTLED = 3  # exit code of rubble run and settle


class Frames:
    """Frames of a run, side by side in rows; width: that of one, in pixels, or None for its own."""

    def __init__(self, *indices, columns=1, width=None):
        self.indices, self.columns, self.width = indices, columns, width

    def draw(self, program, run, path):
        cells = [read(os.path.join(run, "frames", "rgb", f"{i:06d}.png")) for i in self.indices]
        if self.width:
            cells = [resize(c, self.width) for c in cells]
        rows = [cv2.hconcat(cells[i:i + self.columns]) for i in range(0, len(cells), self.columns)]
        write(path, cv2.vconcat(rows))


class Preview:
    """The sheet of frames and depths that a run writes; width: in pixels."""

    def __init__(self, width):
        self.width = width

    def draw(self, program, run, path):
        write(path, resize(read(os.path.join(run, "preview.png")), self.width))


class Section:
    """`rubble cutaway` at y, in metres."""

    def __init__(self, y, width=None):
        self.options = ["--y", str(y)] + (["--width", str(width)] if width else [])

    def draw(self, program, run, path):
        cut = os.path.join(run, "section.png")
        subprocess.run([program, "cutaway", run, *self.options, "--out", cut], check=True, stdout=subprocess.DEVNULL)
        write(path, read(cut))


PICTURES = {  # file name: mission, what of it
    "terrain.jpg": ("scripts/terrain.lua", Frames(0)),
    "record_settling.jpg": ("scripts/record_settling.lua", Preview(width=1200)),
    "robots.jpg": ("scripts/robots/portrait.lua", Frames(1)),
    "robot_lamps.jpg": ("scripts/robots/lamps.lua", Frames(2)),
    "street.jpg": ("scripts/surroundings.lua", Frames(0, 1, 2, 3, columns=2, width=720)),
    "collapse_building.png": ("scripts/collapse_building.lua", Section(0)),
    "planned_house.jpg": ("scripts/ruins/planned_house.lua", Frames(0)),
    "planned_house_cut.jpg": ("scripts/ruins/planned_house.lua", Section(3)),
    "car_park_cut.png": ("scripts/ruins/car_park.lua", Section(0.8)),
    "search.png": ("scripts/search.lua", Section(0.4, width=1000)),
}


def read(path):
    image = cv2.imread(path)
    if image is None:
        sys.exit(f"{path}: no such picture")
    return image


def resize(image, width):
    scale = width / image.shape[1]
    return cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)


def write(path, image):
    """Under another name first, so that a picture is never half written."""
    base, ending = os.path.splitext(path)
    part = base + ".part" + ending
    cv2.imwrite(part, image, JPEG if ending == ".jpg" else [])
    os.replace(part, path)


def run_mission(program, mission, folder):
    """A mission of which only sections are shown is settled and not flown."""
    if all(isinstance(part, Section) for other, part in PICTURES.values() if other == mission):
        command = [program, "settle", mission]
    else:
        command = [program, "run", mission, "--set", "outputs.frames=true"]
    command += ["--quiet", "--force", "--out", folder]
    code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
    if code not in (0, NOT_SETTLED):
        sys.exit(code)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/rubble")
    parser.add_argument("--out", default="out/pictures")
    parser.add_argument("names", nargs="*", metavar="NAME")
    args = parser.parse_args()
    unknown = [name for name in args.names if name not in PICTURES]
    if unknown:
        sys.exit(f"{', '.join(unknown)}: not in the list; it has {', '.join(PICTURES)}")
    names = args.names or list(PICTURES)
    done = set()  # missions: some have two pictures
    for i, name in enumerate(names):
        mission, part = PICTURES[name]
        print(f"{i + 1} of {len(names)}: {name}", flush=True)
        run = os.path.join(args.out, mission[len("scripts/"):-len(".lua")].replace("/", "_"))
        if mission not in done:
            run_mission(args.program, mission, run)
            done.add(mission)
        part.draw(args.program, run, os.path.join(FOLDER, name))


if __name__ == "__main__":
    main()
