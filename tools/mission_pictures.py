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

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # before OpenCV is loaded: depths are EXR files

import cv2  # noqa: E402
import numpy as np  # noqa: E402

FOLDER = "docs/pictures"
JPEG = [cv2.IMWRITE_JPEG_QUALITY, 88]
NOT_SETTLED = 3  # exit code of rubble run and settle
GAP = 6  # between pictures; pixels
NEAR, FAR = 0.3, 8.0  # of the colours of depth, on a logarithmic scale; m


def frames_folder(run, camera, kind):
    """camera: one of `cameras`, or None for `camera`; kind: rgb or depth."""
    return os.path.join(run, *(["cameras", camera] if camera else []), "frames", kind)


class Frames:
    """Frames of a run, side by side in rows; width: that of one, in pixels, or None for its own."""

    def __init__(self, *indices, columns=1, width=None, camera=None):
        self.indices, self.columns, self.width, self.camera = indices, columns, width, camera

    def picture(self, program, run):
        cells = [read(os.path.join(frames_folder(run, self.camera, "rgb"), f"{i:06d}.png")) for i in self.indices]
        if self.width:
            cells = [resize(c, self.width) for c in cells]
        rows = [cv2.hconcat(cells[i:i + self.columns]) for i in range(0, len(cells), self.columns)]
        return cv2.vconcat(rows)


class Depth:
    """The depth of a frame in the colours of the contact sheet."""

    def __init__(self, index, camera=None):
        self.index, self.camera = index, camera

    def picture(self, program, run):
        return colour_depth(os.path.join(frames_folder(run, self.camera, "depth"), f"{self.index:06d}.exr"))


class Preview:
    """The sheet of frames and depths that a run writes; width: in pixels."""

    def __init__(self, width):
        self.width = width

    def picture(self, program, run):
        return resize(read(os.path.join(run, "preview.png")), self.width)


class Section:
    """`rubble cutaway` at y, in metres."""

    def __init__(self, y, width=None):
        self.options = ["--y", str(y)] + (["--width", str(width)] if width else [])

    def picture(self, program, run):
        cut = os.path.join(run, "section.png")
        subprocess.run([program, "cutaway", run, *self.options, "--out", cut], check=True, stdout=subprocess.DEVNULL)
        return read(cut)


class Beside:
    """A large picture, two small ones of one shape in a column on its right, and a wide one below; width: of all, in
    pixels. Nothing is cut off."""

    def __init__(self, large, upper, lower, below, width):
        self.parts, self.below, self.width = (large, upper, lower), below, width

    def picture(self, program, run):
        large, upper, lower = (part.picture(program, run) for part in self.parts)
        twice = 2 * upper.shape[0] / upper.shape[1]  # height of the column for its width, without the gap
        wide = round((self.width - GAP + GAP / twice) / (1 + large.shape[0] / large.shape[1] / twice))
        large = resize(large, wide)
        small = [fit(part, (self.width - GAP - wide, (large.shape[0] - GAP) // 2)) for part in (upper, lower)]
        rest = large.shape[0] - small[0].shape[0] - small[1].shape[0]
        column = cv2.vconcat([small[0], paper(rest, small[0].shape[1]), small[1]])
        top = cv2.hconcat([large, paper(large.shape[0], GAP), column])
        return cv2.vconcat([top, paper(GAP, self.width), resize(self.below.picture(program, run), self.width)])


LARGE = ("part=way", "trajectory.rate_hz=0.5", "cameras.outside.width=1024", "cameras.outside.height=640",
         "cameras.outside.sensor.pixel_samples=2", "cameras.front.width=640", "cameras.front.sensor.pixel_samples=2",
         "cameras.front.height=480")
PICTURES = {  # file name: mission, what of it, and keys of the mission for a picture that is larger or smaller
    "demo.jpg": ("scripts/film.lua", Beside(Frames(3, camera="outside"), Frames(5, camera="front"), Depth(5, "front"),
                                            Section(-3.6, width=1200), width=1200), *LARGE),
    "terrain.jpg": ("scripts/terrain.lua", Frames(0), "camera.fov_deg=50"),
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


def read(path, how=cv2.IMREAD_COLOR):
    image = cv2.imread(path, how)
    if image is None:
        sys.exit(f"{path}: no such picture")
    return image


def resize(image, width):
    scale = width / image.shape[1]
    return cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)


def fit(image, size):
    """Scaled to the size; what does not fit is cut off."""
    scale = max(size[0] / image.shape[1], size[1] / image.shape[0])
    way = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    image = cv2.resize(image, None, fx=scale, fy=scale, interpolation=way)
    y, x = (image.shape[0] - size[1]) // 2, (image.shape[1] - size[0]) // 2
    return image[y:y + size[1], x:x + size[0]].copy()


def paper(height, width):
    return np.full((height, width, 3), 255, np.uint8)


def colour_depth(path):
    """Near is warm, as on the contact sheet; no return is grey. The file has metres."""
    metres = read(path, cv2.IMREAD_UNCHANGED)
    seen = np.isfinite(metres) & (metres > 0)
    share = np.log(np.where(seen, metres, FAR) / NEAR) / np.log(FAR / NEAR)
    colours = cv2.applyColorMap(np.uint8(255 * (1 - np.clip(share, 0, 1))), cv2.COLORMAP_TURBO)
    colours[~seen] = (52, 48, 46)
    return colours


def write(path, image):
    """Under another name first, so that a picture is never half written."""
    base, ending = os.path.splitext(path)
    part = base + ".part" + ending
    cv2.imwrite(part, image, JPEG if ending == ".jpg" else [])
    os.replace(part, path)


def run_mission(program, mission, folder, keys):
    """A mission of which only sections are shown is settled and not flown."""
    if all(isinstance(row[1], Section) for row in PICTURES.values() if row[0] == mission):
        command = [program, "settle", mission]
    else:
        command = [program, "run", mission, "--set", "outputs.frames=true"]
    for key in keys:
        command += ["--set", key]
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
        mission, part, *keys = PICTURES[name]
        print(f"{i + 1} of {len(names)}: {name}", flush=True)
        run = os.path.join(args.out, mission[len("scripts/"):-len(".lua")].replace("/", "_"))
        if mission not in done:
            run_mission(args.program, mission, run, keys)
            done.add(mission)
        write(os.path.join(FOLDER, name), part.picture(args.program, run))


if __name__ == "__main__":
    main()
