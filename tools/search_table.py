#!/usr/bin/python3
"""Plays the baselines of `rubble bench search` at each difficulty and writes their table into a document, between
its marks.

usage: tools/search_table.py [--seeds 1..30] [--agent COMMAND] [--out out/search] docs/search.md
"""
import argparse
import json
import os
import re
import subprocess

DIFFICULTIES = ("easy", "medium", "hard")
BASELINES = ("oracle", "frontier", "wall", "random")


def play(args, difficulty):
    out = os.path.join(args.out, difficulty)
    command = [args.program, "bench", "search", "scripts/search.lua", "--seeds", args.seeds, "--out", out, "--json",
               "--set", f"victims.difficulty={difficulty}"]
    for name in BASELINES:
        command += ["--baseline", name]
    if args.agent:
        command += ["--agent", args.agent]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["datasets"]


def cell(row, key):
    return f"{row[key]:.2f} ({row[key + '_low']:.2f} to {row[key + '_high']:.2f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1..30")
    parser.add_argument("--agent")
    parser.add_argument("--out", default="out/search")
    parser.add_argument("--program", default="build/release/rubble")
    parser.add_argument("document")
    args = parser.parse_args()
    lines = ["| difficulty | agent | searches | found | SPL | coverage | false reports | collisions | time, s |",
             "|---|---|---|---|---|---|---|---|---|"]
    for difficulty in DIFFICULTIES:
        for row in play(args, difficulty):
            name = "examples/search/agent.py" if row["name"] == "agent" else row["name"]
            lines.append(f"| {difficulty} | {name} | {row['searches']:.0f} | {cell(row, 'found_share')} | "
                         f"{cell(row, 'spl')} | {cell(row, 'coverage')} | {row['false_reports']:.2f} | "
                         f"{row['collisions']:.0f} | {row['time_s']:.0f} |")
    with open(args.document) as file:
        text = file.read()
    table = "\n".join(lines)
    text = re.sub(r"(<!-- begin search -->\n).*?(<!-- end search -->)", lambda m: m[1] + table + "\n" + m[2], text,
                  flags=re.DOTALL)
    with open(args.document, "w") as file:
        file.write(text)


if __name__ == "__main__":
    main()
