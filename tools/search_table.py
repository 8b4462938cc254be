#!/usr/bin/python3
"""Plays the baselines of `rubble bench search` at each difficulty, and perhaps an agent, and writes their rows into the
table of a document, between its marks. Rows of what was not played stay. `--baselines ""` plays the agent alone.

usage: tools/search_table.py [--seeds 1..30] [--baselines oracle,frontier] [--agent COMMAND --name NAME]
       [--out out/search] [--reuse] docs/explanation/search.md
"""
import argparse
import json
import os
import subprocess

from document_marks import read_between_marks, write_between_marks

DIFFICULTIES = ("easy", "medium", "hard")
BASELINES = ("oracle", "octomap", "frontier", "wall", "random")
HEAD = ["| difficulty | agent | searches | found | SPL | coverage | false reports | collisions | time, s |",
        "|---|---|---|---|---|---|---|---|---|"]


def play(args, difficulty):
    out = os.path.join(args.out, difficulty)
    if args.reuse and os.path.exists(os.path.join(out, "table.json")):
        with open(os.path.join(out, "table.json")) as file:
            return json.load(file)["datasets"]
    command = [args.program, "bench", "search", "scripts/search.lua", "--seeds", args.seeds, "--out", out, "--json", "--force",
               "--set", f"victims.difficulty={difficulty}"]
    for name in args.baselines:
        command += ["--baseline", name]
    if args.agent:
        command += ["--agent", args.agent]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["datasets"]


def cell(row, key):
    return f"{row[key]:.2f} ({row[key + '_low']:.2f} to {row[key + '_high']:.2f})"


def key_of(line):
    return tuple(cell.strip() for cell in line.split("|")[1:3])


def rank(key):
    """Difficulties in their order; in each the baselines in theirs, then agents."""
    difficulty, name = key
    return DIFFICULTIES.index(difficulty), BASELINES.index(name) if name in BASELINES else len(BASELINES), name


def some_of(known):
    """The reader of an option that takes names after commas, or none."""
    def read(text):
        names = tuple(text.split(",")) if text else ()
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"expected some of {','.join(known)}, got '{name}'")
        return names
    return read


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1..30")
    parser.add_argument("--baselines", type=some_of(BASELINES), default=BASELINES)
    parser.add_argument("--agent")
    parser.add_argument("--name", default="examples/search/agent.py", help="of the agent, in the table")
    parser.add_argument("--out", default="out/search")
    parser.add_argument("--program", default="build/release/rubble")
    parser.add_argument("--reuse", action="store_true", help="take the tables that are in the folder already")
    parser.add_argument("--difficulties", type=some_of(DIFFICULTIES), default=DIFFICULTIES)
    parser.add_argument("document")
    args = parser.parse_args()
    rows = {key_of(line): line for line in read_between_marks(args.document, "search").splitlines()
            if line.startswith("|") and key_of(line)[0] in DIFFICULTIES}
    for difficulty in args.difficulties:
        for row in play(args, difficulty):
            name = args.name if row["name"] == "agent" else row["name"]
            rows[difficulty, name] = (
                f"| {difficulty} | {name} | {row['searches']:.0f} | {cell(row, 'found_share')} | "
                f"{row['spl']:.2f} | {row['coverage']:.2f} | {row['false_reports']:.2f} | "
                f"{row['collisions']:.0f} | {row['time_s']:.0f} |")
    lines = HEAD + [rows[key] for key in sorted(rows, key=rank)]
    write_between_marks(args.document, "search", "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
