#!/usr/bin/python3
"""The reference of the environments in Markdown, from their spaces, their signatures and their docstrings:

    PYTHONPATH=build/release/python /usr/bin/python3 tools/environments_page.py docs/reference/environments.md

A docstring has sections ("Action:"), each with entries of two spaces, a name, two spaces and a text. Every part of an
observation and every argument must have an entry, and every entry must exist.
"""
import inspect
import re
import sys

import numpy as np

SECTIONS = ("Action", "Observation", "Reward", "End", "Info", "Arguments")
HIDDEN = {"self", "render_mode"}
HEAD = """# Environments for reinforcement learning

The package `rubble.envs` ([Python](python.md)) has these environments. With Gymnasium installed, they are subclasses of
its `Env`, registered by the names below when `rubble.envs` is imported. Without Gymnasium, the same classes work.

An episode depends on its seed alone: `reset(seed=...)` draws the pile from `pile_seeds` and the start. Earlier episodes,
other processes and the number of threads have no effect. An environment settles each pile once and keeps it. Debris does
not move in an episode.

An action outside -1 to 1, or a seed that is not a whole number of at least 0, raises `rubble.InputError`.
`gymnasium.wrappers.ClipAction` clips the actions of a policy.

"""


def parse(doc):
    """The title, the paragraphs after it, and the entries of each section."""
    parts = re.split(rf"^({'|'.join(SECTIONS)}):\n", doc.strip("\n"), flags=re.MULTILINE)
    title, _, about = parts[0].partition("\n")
    sections = {}
    for name, body in zip(parts[1::2], parts[2::2]):
        entries = [re.fullmatch(r"  (\S.*?)  (\S.*)", line) for line in body.splitlines() if line.strip()]
        if not all(entries):
            raise ValueError(f"{title}: section {name}: expected lines of two spaces, a name, two spaces and a text")
        sections[name] = [entry.groups() for entry in entries]
    missing = [name for name in SECTIONS if name not in sections]
    if missing:
        raise ValueError(f"{title}: no section {', '.join(missing)}")
    return title, about.strip(), sections


def number(value):
    return f"{float(value):g}"


def limits(space):
    """"0..5", or the limits of each component where they differ."""
    low, high = np.ravel(space.low), np.ravel(space.high)
    if (low == low[0]).all() and (high == high[0]).all():
        return f"{number(low[0])}..{number(high[0])}"
    return ", ".join(f"{number(a)}..{number(b)}" for a, b in zip(low, high))


def check_names(title, section, described, real):
    if set(described) != set(real):
        raise ValueError(f"{title}: section {section} describes {sorted(described)}, but there are {sorted(real)}")


def table(head, rows):
    lines = ["|" + "|".join(head) + "|", "|" + "---|" * len(head)] + ["|" + "|".join(row) + "|" for row in rows]
    return "\n".join(lines) + "\n\n"


def default(value):
    if isinstance(value, str):
        return "a small heap"
    return f"`{value.start}..{value.stop - 1}`" if isinstance(value, range) else f"`{value}`"


def section_of(environment, colour):
    """The page's part on a class; `colour`: with what it can observe besides."""
    title, about, sections = parse(inspect.getmodule(environment).__doc__)
    name, _, what = title.partition(": ")
    env = environment(**colour)
    action, spaces = env.action_space, env.observation_space.spaces
    arguments = {k: p.default for k, p in inspect.signature(environment.__init__).parameters.items() if k not in HIDDEN}
    check_names(title, "Observation", [key for key, _ in sections["Observation"]], spaces)
    check_names(title, "Arguments", [key for key, _ in sections["Arguments"]], arguments)
    text = f"## `{name}`\n\n{what[0].upper()}{what[1:]} {about}\n\n"
    text += f"Action: {action.shape[0]} numbers, {limits(action)}, held for `period`.\n\n"
    text += table(("action", "meaning"), sections["Action"])
    text += table(("observation", "shape", "type", "range", "meaning; unit"),
                  [(f"`{key}`", " x ".join(map(str, spaces[key].shape)), str(spaces[key].dtype), limits(spaces[key]), meaning)
                   for key, meaning in sections["Observation"]])
    text += table(("reward", "for"), sections["Reward"])
    text += table(("episode end", "when"), sections["End"])
    text += table(("info", "meaning"), [(f"`{key}`", meaning) for key, meaning in sections["Info"]])
    text += table(("argument", "default", "meaning; unit"),
                  [(f"`{key}`", default(arguments[key]), meaning) for key, meaning in sections["Arguments"]])
    return text


def make_page():
    from rubble import envs
    page = HEAD
    for name in sorted(envs.__all__):
        environment = getattr(envs, name)
        colour = "colour" in inspect.signature(environment.__init__).parameters
        page += section_of(environment, {"colour": True} if colour else {})
    return page.rstrip("\n") + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: environments_page.py FILE")
    text = make_page()
    with open(sys.argv[1], "w") as file:
        file.write(text)
