#!/usr/bin/env python3
"""Lists the kernel's constants of physics on one page: value and unit, by file. The reasons stay in the sources.

  tools/constants.py            writes docs/development/constants.md
  tools/constants.py --check    fails when the page is not what the sources say, when a name has two
                                values, or when a number has no reason
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "development" / "constants.md"
ROOMS = {
    "collision": "Collision: pairs and contact points",
    "solver": "Contact forces",
    "structure": "Structures: members, bonds and their strength",
    "multibody": "Free rotation, joints and trees",
    "world": "The step, sleep and rest",
    "settling": "The schedule of a pile",
}
DECLARATION = re.compile(r"^\s*(?:inline |static )*constexpr (?:float|double|int|std::\w+) (k[A-Z]\w*(?:\[\d+\])? = .*)$")
UNIT = re.compile(r"[;,]?\s*unit: ([^;.)]+)")
HEAD = """# Constants of the kernel

This page lists every named number in the kernel's folders of physics: name, value and unit; without a unit it is a ratio,
a count or a code. The comment beside each constant in its file has the reason. A test fails if a constant has no comment,
or if one name has two values. Numbers that follow from others are left out.

Settings with a default are in `SolverSettings` (`kernel/solver/contact_solver.h`) and `NarrowSettings`
(`kernel/collision/narrow_phase.h`). The [reference](../reference/missions.md) has the keys that a mission may set.
[Performance](performance.md#closed-forms) measures how far clamps and limits deviate from the laws of Newton and Coulomb.

`tools/constants.py` writes this page.
"""


def read_comment(lines, row):
    """The comment block right above a line: it belongs to this constant, not to those that follow it."""
    text = []
    while row > 0 and lines[row - 1].strip().startswith("//"):
        text.insert(0, lines[row - 1].strip().lstrip("/ "))
        row -= 1
    return " ".join(text)


def read_constants(path):
    lines = path.read_text().splitlines()
    for row, line in enumerate(lines):
        code, _, trailing = line.partition("//")
        if re.search(r"constexpr \S+ k[A-Z]\w* =$", code.rstrip()) and is_number(lines[row + 1].split(";")[0].strip()):
            yield code.split()[-2], lines[row + 1].split(";")[0].strip(), "", ""  # without a reason: a problem
        match = DECLARATION.match(code.rstrip())
        if not match or ";" not in code:
            continue
        block, trailing = read_comment(lines, row), trailing.strip()
        unit = UNIT.search(trailing) or UNIT.search(block)
        reason = " ".join(t for t in (block, UNIT.sub("", trailing).strip(" ;.")) if t)
        for name, value in re.findall(r"(k[A-Z]\w*)(?:\[\d+\])? = ([^,;{]+|\{.*\})(?=[,;])", match.group(1)):
            given = unit.group(1).strip() if unit and not name.endswith(("Cosine", "Share")) else ""
            yield name, value.strip(), given, UNIT.sub("", reason).strip(" ;")


def is_number(value):
    return re.fullmatch(r"-?[\d.]+(e-?\d+)?[fF]?", value) is not None


def make_page(problems):
    text, known = HEAD, {}
    for room, title in ROOMS.items():
        text += f"\n## {title}\n\n| in `kernel/{room}` | constants |\n|---|---|\n"
        for path in sorted((ROOT / "kernel" / room).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            where, cells = path.relative_to(ROOT / "kernel" / room), []
            for name, value, unit, reason in read_constants(path):
                if not is_number(value):
                    continue
                value = value.rstrip("fF")
                if known.setdefault(name, value) != value:
                    problems.append(f"kernel/{room}/{where}: {name} is {value} here and {known[name]} elsewhere: give it a name of its own")
                if not reason:
                    problems.append(f"kernel/{room}/{where}: {name} has no comment: say why it is {value}, and its unit")
                cells.append(f"`{name}` {value} {'' if unit == '1' else unit}".strip())
            if cells:
                text += f"| `{where}` | {', '.join(cells)} |\n"
    return text


def main():
    problems = []
    page = make_page(problems)
    if "--check" in sys.argv:
        if not PAGE.exists() or PAGE.read_text() != page:
            problems.append("docs/development/constants.md is not what the sources say: run tools/constants.py")
    else:
        PAGE.write_text(page)
    for problem in problems:
        print(problem, file=sys.stderr)
    sys.exit(1 if problems else 0)


main()
