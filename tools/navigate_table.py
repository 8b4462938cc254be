#!/usr/bin/python3
"""Runs `rubble bench navigate` and writes its table into a document, between its marks.

usage: tools/navigate_table.py [--seeds 1..20] [--out out/navigate] docs/autonomy.md
"""
import argparse
import json
import subprocess

from document_marks import write_between_marks

ROWS = (("missions", "missions", 0), ("arrived", "arrived_share", 2), ("gave up, without progress for 30 s", "gave_up_share", 2),
        ("time up, after 120 s", "time_up_share", 2), ("fell over", "fell_share", 2),
        ("collisions in a mission", "collisions", 1), ("driven in a mission, m", "path_m", 1),
        ("of that within the void, m", "inside_m", 1), ("simulated time of a mission, s", "time_s", 1),
        ("periods of the navigator, of 0.2 s", "periods", 0), ("of these longer than 0.2 s of the clock", "deadlines_missed", 0),
        ("the slowest, ms", "slowest_ms", 0))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1..20")
    parser.add_argument("--mission", default="scripts/navigate.lua")
    parser.add_argument("--out", default="out/navigate")
    parser.add_argument("--program", default="build/release/rubble")
    parser.add_argument("document")
    args = parser.parse_args()
    command = [args.program, "bench", "navigate", args.mission, "--seeds", args.seeds, "--out", args.out, "--json"]
    row = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["datasets"][0]
    lines = ["| | |", "|---|---|"]
    for heading, key, digits in ROWS:
        between = f" (95 %: {row[key + '_low']:.2f} to {row[key + '_high']:.2f})" if key + "_low" in row else ""
        lines.append(f"| {heading} | {row[key]:.{digits}f}{between} |")
    write_between_marks(args.document, "navigate", "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
