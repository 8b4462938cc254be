#!/usr/bin/env python3
"""Writes the missions of Rubble-50, their suite and the table of docs/explanation/rubble50.md.
usage: tools/rubble50.py [ROOT]"""
import argparse
import json
import pathlib

STRUCTURES = ["heap", "lean_to", "cantilever", "v_shape", "a_frame", "pancake", "inclined", "lean_over", "culvert", "curtain"]
CONDITIONS = ["clear", "dark", "smoke", "dust", "wet"]
CARRIERS = ["orbit", "push", "crawler", "rover", "snake"]
# The seed stands in the mission itself: structures draw numbers from it.
MISSION = """-- Rubble-50, mission {number}: docs/explanation/rubble50.md. Made by tools/rubble50.py.
local keys = rubble.include("fifty.lua")({words})
return rubble.mission {{
  seed = {number},
  pile = keys.pile,
  light = keys.light, lamp = keys.lamp, air = keys.air, wetness = keys.wetness,
  robots = keys.robots, robot_run = keys.robot_run, trajectory = keys.trajectory,
  camera = keys.camera, depth_sensor = keys.depth_sensor, imu = {{ on = true }},
  settle = {{ final_time_limit = 60 }},
  outputs = keys.outputs,
}}
"""
BEGIN, END = "<!-- table: made by tools/rubble50.py -->", "<!-- end of table -->"


def rows():
    """Number, structure, condition, carrier: each structure meets each condition and each carrier once."""
    for i, structure in enumerate(STRUCTURES):
        for j, condition in enumerate(CONDITIONS):
            yield 5 * i + j + 1, structure, condition, CARRIERS[(i + j) % 5]


def name_of(number, *parts):
    return f"{number:02}_" + "_".join(parts)


def write_missions(folder):
    names = []
    for number, *parts in rows():
        names.append(name_of(number, *parts))
        words = ", ".join(f'"{part}"' for part in parts)
        (folder / (names[-1] + ".lua")).write_text(MISSION.format(number=number, words=words))
    lines = "".join(f'    {{ name = "{name}", mission = "{name}.lua", pile_only = true }},\n' for name in names)
    (folder / "suite.lua").write_text(
        "-- The piles of Rubble-50 against the expected hashes: docs/explanation/rubble50.md. Made by tools/rubble50.py.\n"
        "return suite {\n  runs = {\n" + lines + "  },\n}\n")


def write_table(root):
    golden = root / "scripts/rubble50/suite.golden.json"
    hashes = json.loads(golden.read_text())["runs"] if golden.exists() else {}
    table = "|mission|structure|condition|carrier|state hash of the pile|\n|---|---|---|---|---|\n"
    for number, *parts in rows():
        found = hashes.get(name_of(number, *parts), {}).get("state_hash", "not run")
        table += f"|{number}|{'|'.join(f'`{part}`' for part in parts)}|`{found}`|\n"
    page = root / "docs/explanation/rubble50.md"
    text = page.read_text()
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    page.write_text(text[:begin] + "\n" + table + text[end:])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent,
                        metavar="ROOT", help="of the tree (default: this one)")
    root = parser.parse_args().root
    (root / "scripts/rubble50").mkdir(parents=True, exist_ok=True)
    write_missions(root / "scripts/rubble50")
    write_table(root)


if __name__ == "__main__":
    main()
