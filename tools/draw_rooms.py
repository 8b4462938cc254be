#!/usr/bin/env python3
"""Draws the rooms of the source tree, from the ground up, with what each uses, into
docs/development/contributing.md. The arrows are the includes that are there; tests/app/include_direction_test.cpp
says which may be.

usage: tools/draw_rooms.py           # writes docs/development/contributing.md anew
       tools/draw_rooms.py --print
"""
import os
import re
import subprocess
import sys

FLOORS = ["kernel", "render", "io", "scripting", "assets", "app", "bench", "python"]
PAGE = "docs/development/contributing.md"
EVERYWHERE = "base"  # of its own part and of the kernel: left out of the arrows
BEGIN, END = "<!-- rooms: made by tools/draw_rooms.py -->", "<!-- end of rooms -->"


def room_of(path):
    folder = os.path.dirname(path)
    if path.startswith("kernel/"):  # folders inside its rooms are theirs
        return "/".join(folder.split("/")[:2])
    return folder if folder not in FLOORS or path.startswith(("bench", "python")) else path.rsplit(".", 1)[0]


def read_includes():
    """Room to the set of rooms that its files include; and rooms in the order in which they are met."""
    files = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *FLOORS],
                           check=True, capture_output=True, text=True).stdout.split("\n")
    uses = {}
    for name in files:
        if not name.endswith((".h", ".cpp")) or not os.path.exists(name):
            continue
        room = uses.setdefault(room_of(name), set())
        with open(name, encoding="utf-8") as file:
            for target in re.findall(r'^#include "([^"]+)"', file.read(), re.M):
                if target.split("/")[0] in FLOORS and room_of(target) != room_of(name):
                    room.add(room_of(target))
    return uses


def order(rooms, uses):
    """What is used comes first; names decide the rest."""
    done, left = [], sorted(rooms)
    while left:
        ready = [r for r in left if not (uses[r] & set(left)) - {r}]
        if not ready:
            sys.exit("these rooms use each other: " + ", ".join(left))
        done.append(ready[0])
        left.remove(ready[0])
    return done


def draw():
    uses = read_includes()
    lines = ["```text"]
    for floor in FLOORS:
        rooms = [r for r in uses if r.split("/")[0] == floor]
        lines.append(floor)
        for room in order(rooms, uses):
            arrows_to = [r for r in uses[room] if r not in (f"{floor}/{EVERYWHERE}", f"kernel/{EVERYWHERE}")]
            inside = sorted(r.split("/", 1)[-1] for r in arrows_to if r.split("/")[0] == floor)
            outside = sorted({r if r.startswith("kernel") else r.split("/")[0]
                              for r in arrows_to if r.split("/")[0] != floor})
            arrows = ", ".join(inside)
            if outside:
                arrows += (" | " if arrows else "| ") + ", ".join(outside)
            name = room.split("/", 1)[-1] if "/" in room else "."
            lines.append(f"  {name:<22}<- {arrows}".rstrip(" <-") if arrows else f"  {name}")
    return "\n".join(lines + ["```"])


def main():
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    drawing = draw()
    if "--print" in sys.argv:
        print(drawing)
        return
    with open(PAGE, encoding="utf-8") as file:
        text = file.read()
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(text[:begin] + "\n" + drawing + "\n" + text[end:])


if __name__ == "__main__":
    main()
