#!/usr/bin/python3
"""Makes the film of the demo: the building comes down, then the robot's way in, by its own camera and from outside.

usage: tools/draw_film.py [--program build/release/rubble] [--mission scripts/film.lua] [--run out/film]
                          [--out docs/pictures/demo.mp4] [--rate 12] [--kilobytes 1000]

The mission has two parts (`--set part=...`): `collapse`, which one camera records, and `way`, with a camera `front` on the
robot and a camera `outside` at the rate of the film. A part that is finished in the folder of --run is used again.
Needs python3-opencv and ffmpeg (tools/packages-pictures.txt).
"""
import argparse
import os
import subprocess
import sys

from mission_pictures import NOT_SETTLED, colour_depth, fit, read  # before OpenCV, which it tells of EXR files

import cv2
import numpy as np

SIZE = (960, 540)  # of the film; pixels
SIDE = (320, 240)  # of a picture in the column on the right
PAPER, INK, FAINT = (28, 24, 22), (232, 232, 230), (150, 148, 144)
HOLD = 3.0  # of a title, and of the last picture; s


def put(image, text, at, size, ink=INK):
    cv2.putText(image, text, at, cv2.FONT_HERSHEY_SIMPLEX, size, ink, 1, cv2.LINE_AA)


def title(lines):
    """A page of text, the first line large."""
    page = np.full((SIZE[1], SIZE[0], 3), PAPER, np.uint8)
    for i, line in enumerate(lines):
        size = 1.6 if i == 0 else 0.75
        width = cv2.getTextSize(line, cv2.FONT_HERSHEY_SIMPLEX, size, 1)[0][0]
        put(page, line, ((SIZE[0] - width) // 2, 220 + (0 if i == 0 else 30 + 40 * i)), size, INK if i == 0 else FAINT)
    return page


def caption(image, text):
    """Text on a dark band at the lower edge."""
    band = image[-36:]
    band[:] = (band * 0.35).astype(np.uint8)
    put(image, text, (16, image.shape[0] - 12), 0.6)
    return image


class Reel:
    """The pictures of both parts, by number."""

    def __init__(self, run):
        cameras = os.path.join(run, "way", "cameras")
        self.fallen = os.path.join(run, "collapse", "frames", "rgb")
        self.outside = os.path.join(cameras, "outside", "frames", "rgb")
        self.front = os.path.join(cameras, "front", "frames", "rgb")
        self.depths = os.path.join(cameras, "front", "frames", "depth")
        self.sheet = os.path.join(cameras, "front", "preview.png")

    @staticmethod
    def count(folder):
        return sum(1 for name in os.listdir(folder) if name.endswith(".png"))

    @staticmethod
    def colour(folder, i):
        return read(os.path.join(folder, f"{i:06d}.png"))

    def depth(self, i):
        return colour_depth(os.path.join(self.depths, f"{i:06d}.exr"))


def split(reel, i):
    """The robot's camera beside its depth and the view from outside."""
    page = np.full((SIZE[1], SIZE[0], 3), PAPER, np.uint8)
    width = SIZE[0] - SIDE[0] - 12
    page[:SIZE[1], :width] = fit(reel.colour(reel.front, i), (width, SIZE[1]))
    height = (SIZE[1] - 12) // 2
    page[:height, -SIDE[0]:] = fit(reel.colour(reel.outside, i), (SIDE[0], height))
    page[-height:, -SIDE[0]:] = fit(reel.depth(i), (SIDE[0], height))
    put(page, "from outside", (SIZE[0] - SIDE[0] + 8, 20), 0.5)
    put(page, "depth", (SIZE[0] - SIDE[0] + 8, SIZE[1] - height + 20), 0.5)
    return page


def scenes(reel, rate):
    """All pictures of the film, one after another."""
    hold = round(HOLD * rate)
    yield from [title(["Rubble", "a building, an earthquake, a robot: computed, not drawn"])] * hold
    for i in range(reel.count(reel.fallen) - 1):  # the last one is the flight's
        yield caption(fit(reel.colour(reel.fallen, i), SIZE), "An earthquake under a weak ground storey, at half speed: bonds break, floors fall")
    yield from [title(["The way in", "a crawler with a lamp, a camera, a LiDAR and an inertial unit"])] * hold
    for i in range(min(reel.count(reel.front), reel.count(reel.outside))):
        yield caption(split(reel, i), f"By its lamp, through dust: colour and exact depth   {i / rate:.1f} s")
    if os.path.exists(reel.sheet):
        yield from [caption(fit(read(reel.sheet), SIZE), "The contact sheet of the run")] * (2 * hold)
    yield from [title(["make demo", "a ROS bag, an MRPT rawlog, exact depth and poses, from one page of Lua"])] * hold


def encode(pictures, rate, kilobytes, path):
    """By two passes, so that the file has the size that was asked for. pictures: read twice."""
    count = sum(1 for _ in pictures())
    bits = int(kilobytes * 8000 * 0.97 * rate / count)
    part = path + ".part.mp4"
    for number in (1, 2):
        command = ["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "bgr24", "-s", f"{SIZE[0]}x{SIZE[1]}",
                   "-r", str(rate), "-i", "-", "-c:v", "libx264", "-preset", "slow", "-b:v", str(bits), "-pix_fmt", "yuv420p",
                   "-pass", str(number), "-passlogfile", part, "-threads", "2"]
        command += ["-f", "null", os.devnull] if number == 1 else ["-movflags", "+faststart", part]
        encoder = subprocess.Popen(command, stdin=subprocess.PIPE)
        for picture in pictures():
            encoder.stdin.write(picture.tobytes())
        encoder.stdin.close()
        if encoder.wait() != 0:
            sys.exit(f"ffmpeg could not make {path}")
    os.replace(part, path)
    for ending in ("-0.log", "-0.log.mbtree"):
        if os.path.exists(part + ending):
            os.remove(part + ending)
    return count


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/rubble")
    parser.add_argument("--mission", default="scripts/film.lua")
    parser.add_argument("--run", default="out/film")
    parser.add_argument("--out", default="docs/pictures/demo.mp4")
    parser.add_argument("--rate", type=float, default=12, help="frames per second, those of both cameras")
    parser.add_argument("--kilobytes", type=float, default=1000, help="size of the film, about")
    args = parser.parse_args()
    for part in ("collapse", "way"):
        folder = os.path.join(args.run, part)
        if os.path.exists(os.path.join(folder, "manifest.json")):
            continue
        code = subprocess.run([args.program, "run", args.mission, "--set", f"part={part}", "--force", "--out", folder]).returncode
        if code not in (0, NOT_SETTLED):
            sys.exit(code)
    reel = Reel(args.run)
    count = encode(lambda: scenes(reel, args.rate), args.rate, args.kilobytes, args.out)
    print(f"{args.out}: {count / args.rate:.0f} s, {os.path.getsize(args.out) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
