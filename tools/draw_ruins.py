#!/usr/bin/python3
"""Runs each mission of scripts/ruins, draws all ruins from outside and cut open, and writes their table into a
document, between its marks; also a table that compares their voids with those of the stagings in
scripts/collapse, one that compares the debris with what is published, and a sheet and a table of buildings that
are no frames.

usage: tools/draw_ruins.py [--program build/release/rubble] [--out out/ruins] [--kinds] docs/explanation/collapse.md

Needs python3-opencv (tools/packages-pictures.txt).
"""
import argparse
import json
import os
import subprocess
import sys

import cv2
import numpy as np

from document_marks import write_between_marks

ORDER = ("soft_ground", "car_park", "loaded_roof", "loaded_floor", "quake", "quake_frame", "half_removed",
         "corner_bay", "row_of_columns", "blast", "lorry", "sinking")
KINDS = {"brick_house": -1.2, "precast_deck": -3, "bridge_span": 0.4, "planned_house": 3, "stair_shaft": -1.5}  # cut at y
STAGED = ("pancake", "lean_to", "v_shape", "a_frame", "cantilever", "inclined", "lean_over", "curtain", "heap", "culvert")
WIDTH = 420  # of a picture; pixels
COLUMNS = 3
NOT_SETTLED = 3  # exit code of rubble run


def make(args, script, folder, options=()):
    """The manifest of a run of the script, which is made unless it is there."""
    path = os.path.join(folder, "manifest.json")
    if not os.path.exists(path):
        code = subprocess.run([args.program, "run", script, "--quiet", "--force", "--out", folder, *options],
                              stdout=subprocess.DEVNULL).returncode
        if code not in (0, NOT_SETTLED):
            sys.exit(code)
    with open(path) as file:
        return json.load(file)


def run(args, name, y=0.4):
    folder = os.path.join(args.out, name)
    script = f"scripts/ruins/{name}.lua"
    manifest = make(args, script, folder)
    cut = os.path.join(folder, "cutaway.png")
    subprocess.run([args.program, "cutaway", folder, "--y", str(y), "--out", cut], check=True,
                   stdout=subprocess.DEVNULL)
    with open(script) as file:
        text = file.read()
    return {"name": name, "title": text.split("\n")[0][3:], "manifest": manifest,
            "outside": os.path.join(folder, "frames", "rgb", "000000.png"), "cut": cut}


def sheet(pictures, names, path, columns=COLUMNS):
    """Rows of pictures of one width under their names; a row is as high as its highest picture."""
    cells = []
    for picture, name in zip(pictures, names):
        label = np.full((26, WIDTH, 3), 255, np.uint8)
        cv2.putText(label, name, (6, 19), cv2.FONT_HERSHEY_SIMPLEX, 0.55, (30, 30, 30), 1, cv2.LINE_AA)
        height = round(picture.shape[0] * WIDTH / picture.shape[1])
        cells.append(np.vstack([label, cv2.resize(picture, (WIDTH, height), interpolation=cv2.INTER_AREA)]))
    rows = []
    for i in range(0, len(cells), columns):
        high = max(cell.shape[0] for cell in cells[i:i + columns])
        rows.append(np.hstack([cv2.copyMakeBorder(cell, 0, high - cell.shape[0], 0, 0, cv2.BORDER_CONSTANT,
                                                  value=(255, 255, 255)) for cell in cells[i:i + columns]]))
    cv2.imwrite(path, np.vstack(rows), [cv2.IMWRITE_JPEG_QUALITY, 82])


def kind_row(ruin):
    pile, m = ruin["manifest"]["pile"], ruin["manifest"]["metrics"]
    rest = f"{pile['simulated_s']:.1f}" if pile["settled"] else f"not within {pile['simulated_s']:.0f}"
    return (f"| `{ruin['name']}` | {ruin['title']} | {pile['pieces']} | {rest} | "
            f"{m['pile_height_m']:.1f} | {m['void_count']:.0f} | {m['void_covered_m3']:.0f} | {m['void_depth_m']:.1f} |")


def draw_kinds(args):
    """Buildings that are no frames: pictures from outside beside those cut open, and their table."""
    ruins = [run(args, name, y) for name, y in KINDS.items()]
    pictures = [cv2.imread(ruin[key]) for ruin in ruins for key in ("outside", "cut")]
    names = [name for ruin in ruins for name in (ruin["name"], ruin["name"] + ", cut open")]
    sheet(pictures, names, os.path.join(args.pictures, "ruin_kinds.jpg"), 2)
    lines = ["| mission | cause and effect | pieces | at rest after, s | height, m | voids | covered volume, m3 | "
             "deepest void, m |", "|---|---|---|---|---|---|---|---|"]
    write_between_marks(args.document, "kinds", "\n".join(lines + [kind_row(ruin) for ruin in ruins]) + "\n")


def debris_extent(manifest):
    """How far the debris of a frame reaches beyond its longer half side; unit: m."""
    building = manifest["scenario"]["pile"]["building"]
    half = max(building["bays_x"] * building["span_x"], building["bays_y"] * building["span_y"]) / 2
    return max(0.0, manifest["metrics"]["pile_radius_m"] - half)


def row(ruin):
    pile, m = ruin["manifest"]["pile"], ruin["manifest"]["metrics"]
    rest = f"{pile['simulated_s']:.1f}" if pile["settled"] else f"not within {pile['simulated_s']:.0f}"
    return (f"| `{ruin['name']}` | {ruin['title']} | {pile['pieces']} | "
            f"{rest} | {m['pile_height_m']:.1f} | {debris_extent(ruin['manifest']):.1f} | "
            f"{m['void_count']:.0f} | {m['void_covered_m3']:.0f} | {m['void_depth_m']:.1f} |")


def void_measures(manifest):
    """Of a pile, per volume of its pieces or of its voids, so that sizes do not matter."""
    m = manifest["metrics"]
    return (m["void_covered_m3"] / m["piece_volume_m3"], 10 * m["void_count"] / m["void_covered_m3"],
            m["void_reachable_m3"] / m["void_robot_m3"] if m["void_robot_m3"] > 0 else 0.0, m["void_depth_m"])


def compare_published(ruins):
    """Debris against the height of the building, and its bulk against the building's volume."""
    shares = []
    for ruin in ruins:
        b, m = ruin["manifest"]["scenario"]["pile"]["building"], ruin["manifest"]["metrics"]
        height = b["storeys"] * b["storey_height"]
        volume = b["bays_x"] * b["span_x"] * b["bays_y"] * b["span_y"] * height
        shares.append((m["pile_height_m"] / height, debris_extent(ruin["manifest"]) / height,
                       (m["piece_volume_m3"] + m["void_covered_m3"]) / volume))
    lines = ["| | height of the ruin / of the building | debris beyond the walls / height of the building | "
             "bulk / volume of the building |", "|---|---|---|---|",
             f"| {len(ruins)} ruins, median (least to most) | " + " | ".join(medians(shares)) + " |"]
    return "\n".join(lines) + "\n"


def medians(rows):
    """Of each column, with its range."""
    return [f"{np.median(c):.2f} ({min(c):.2f} to {max(c):.2f})" for c in zip(*rows)]


def compare_voids(ruins, staged):
    groups = {f"caused: {len(ruins)} ruins": ruins, f"staged: {len(staged)} modes": staged}
    lines = ["| piles | covered volume for each m3 of pieces | voids for each 10 m3 of it | reachable share | "
             "deepest void, m |", "|---|---|---|---|---|"]
    for name, manifests in groups.items():
        lines.append(f"| {name}, median (least to most) | " + " | ".join(medians(map(void_measures, manifests))) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/rubble")
    parser.add_argument("--out", default="out/ruins")
    parser.add_argument("--pictures", default="docs/pictures")
    parser.add_argument("--kinds", action="store_true", help="only the buildings that are no frames")
    parser.add_argument("document")
    args = parser.parse_args()
    draw_kinds(args)
    if args.kinds:
        return
    ruins = [run(args, name) for name in ORDER]
    names = [ruin["name"] for ruin in ruins]
    sheet([cv2.imread(ruin["outside"]) for ruin in ruins], names, os.path.join(args.pictures, "ruins.jpg"))
    sheet([cv2.imread(ruin["cut"]) for ruin in ruins], names, os.path.join(args.pictures, "ruins_cut.jpg"))
    lines = ["| mission | cause and effect | pieces | at rest after, s | height, m | debris beyond the walls, m | "
             "voids | covered volume, m3 | deepest void, m |", "|---|---|---|---|---|---|---|---|---|"]
    lines += [row(ruin) for ruin in ruins]
    write_between_marks(args.document, "ruins", "\n".join(lines) + "\n")
    staged = [make(args, f"scripts/collapse/{name}.lua", os.path.join(args.out, "staged", name), ["--set", "voids.on=true"])
              for name in STAGED]
    write_between_marks(args.document, "voids", compare_voids([ruin["manifest"] for ruin in ruins], staged))
    write_between_marks(args.document, "published", compare_published(ruins))


if __name__ == "__main__":
    main()
