#!/usr/bin/python3
"""Runs `rubble bench navigate` without and with a global planner and writes their table into a document, between its
marks.

usage: tools/navigate_table.py [--seeds 1..64] [--out out/navigate] [--reuse] docs/explanation/autonomy.md
"""
import argparse
import json
import os
import subprocess

from document_marks import write_between_marks

ROWS = (("missions", "missions", 0), ("arrived", "arrived_share", 2), ("gave up, without progress for 30 s", "gave_up_share", 2),
        ("time up, after 120 s", "time_up_share", 2), ("fell over", "fell_share", 2),
        ("collisions in a mission", "collisions", 2), ("driven in a mission, m", "path_m", 1),
        ("of that within the void, m", "inside_m", 1), ("simulated time of a mission, s", "time_s", 1),
        ("plans in a mission", "plans", 1))


PLANNERS = (("navigator alone", "none"), ("with a planner", "ompl"))


def drive(args, planner):
    out = os.path.join(args.out, planner)
    kept = os.path.join(out, "printed.json")  # with what the clock said, which is in no file of the program
    if not (args.reuse and os.path.exists(kept)):
        os.makedirs(out, exist_ok=True)
        command = [args.program, "bench", "navigate", args.mission, "--seeds", args.seeds, "--planner", planner,
                   "--out", out, "--json", "--force"]
        printed = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
        with open(kept, "wb") as file:
            file.write(printed)
    with open(kept) as file:
        return json.load(file)["datasets"][0]


def cell(row, key, digits):
    between = f" (95 %: {row[key + '_low']:.2f} to {row[key + '_high']:.2f})" if key + "_low" in row else ""
    return f"{row[key]:.{digits}f}{between}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1..64")
    parser.add_argument("--mission", default="scripts/navigate.lua")
    parser.add_argument("--out", default="out/navigate")
    parser.add_argument("--program", default="build/release/rubble")
    parser.add_argument("--reuse", action="store_true", help="take the tables that are in the folder already")
    parser.add_argument("document")
    args = parser.parse_args()
    rows = [drive(args, planner) for _, planner in PLANNERS]
    lines = ["| | " + " | ".join(heading for heading, _ in PLANNERS) + " |", "|---|---|---|"]
    for heading, key, digits in ROWS:
        lines.append(f"| {heading} | " + " | ".join(cell(row, key, digits) for row in rows) + " |")
    write_between_marks(args.document, "navigate", "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
