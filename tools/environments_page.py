#!/usr/bin/python3
"""The reference of the environments in Markdown, from their spaces, their signatures and their docstrings:

    PYTHONPATH=build/release/python /usr/bin/python3 tools/environments_page.py docs/reference/environments.md

A docstring has sections ("Action:"), each with entries of two spaces, a name, two spaces and a text. Every part of an
observation and every argument must have an entry, and every entry must exist.
"""
import dataclasses
import inspect
import re
import sys

import numpy as np

SECTIONS = ("Action", "Observation", "Reward", "End", "Info", "Arguments")
HIDDEN = {"self", "render_mode"}
ENVIRONMENTS = ("CrawlerNav", "SnakeExplore", "TeamNav", "VoidExplore")
HEAD = """# Environments for reinforcement learning

The package `rubble.envs` ([Python](python.md)) has these environments. With Gymnasium installed, they are subclasses of
its `Env`, registered by the names below when `rubble.envs` is imported. Without Gymnasium, the same classes work.
`TeamNav` has several robots. Where PettingZoo is installed, it is a `ParallelEnv`; Gymnasium does not know it.

An episode depends on its seed alone: `reset(seed=...)` draws the pile from `pile_seeds` and the start. Earlier episodes,
other processes and the number of threads have no effect. The environments of a process settle each pile once and share it.
A reset puts the robot back into the laid pile, which takes milliseconds. Debris does not move in an episode.

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
    if hasattr(env, "possible_agents"):
        agent = env.possible_agents[0]
        action, spaces = env.action_space(agent), env.observation_space(agent).spaces
    else:
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


RANDOMIZATION = """## Randomization

With `randomization`, each episode draws more values from its seed. A key may be a number (or a name), `Uniform(low, high)`,
`LogUniform(low, high)`, `Normal(mean, std, low=, high=)` or `Choice(values, weights=)`. Keys that are not given stay as the
environment has them.

```python
from rubble.envs import Calibration, Choice, CrawlerNav, Materials, Normal, Poses, Randomization, Uniform

env = CrawlerNav(pile_seeds=[1], randomization=Randomization(
    materials=Materials(friction=Uniform(0.4, 0.9)),
    calibration=Calibration(range_noise=Normal(0.02, 0.01, low=0, high=0.05), dropout=Choice([0, 0.02])),
    poses=Poses(yaw_deg=Uniform(-20, 20))))
observation, info = env.reset(seed=3)
info["randomization"]      # {"calibration.dropout": 0, "calibration.range_noise": 0.018, ...}
```

`info` of `reset()` records the values. The same seed gives the same values and the same observations, bit for bit. Each key
has random numbers of its own: when you add a key, the values of the others do not change. A value out of range, and a key that
has no effect in the environment, raise `rubble.InputError`. The materials of the debris belong to the pile: vary them by
`mission` and `pile_seeds`. A new light is baked, which takes seconds: prefer `Choice` for the keys of `light`.

"""
BATCH = """## Many environments

`Batch(make, count, threads=None)` steps many environments in one process, with the interface of Gymnasium's vector
environments. `gymnasium.make_vec()` gives one, with `batch_threads=` as its number of threads.

```python
from rubble.envs import Batch, CrawlerNav

env = Batch(lambda: CrawlerNav(pile_seeds=[1], rays=16), 4)
observations, infos = env.reset(seed=3)                 # seeds 3, 4, 5, 6
observations, rewards, terminated, truncated, infos = env.step(env.action_space.sample())
```

Each environment gives what it gives alone. One that has ended begins its next episode at its next step, whose action has no
effect.

## Episodes as a dataset

`LerobotRecorder` writes the episodes of an environment as a LeRobot dataset, version 3.0. It is complete when it is closed.

```python
from rubble.envs import CrawlerNav, LerobotRecorder

with LerobotRecorder(CrawlerNav(pile_seeds=[1], rays=16), "out/episodes") as env:
    for seed in range(2):
        env.reset(seed=seed)
        for _ in range(3):
            env.step([1, 0, 0, 0])
```

A row has the observation before an action, the action, and what it gave: pictures of uint8 as videos
(`observation.images.NAME`), all other values in `observation.state`, then `action`, `next.reward`, `next.done`. The column
`info` of `meta/episodes` has seed, randomization, return and end of each episode, as JSON.
"""


def randomization_table(envs):
    """Every key, with the environments in which it has an effect."""
    rows = []
    for part in dataclasses.fields(envs.Randomization):
        for one in dataclasses.fields(part.default):
            key, about = f"{part.name}.{one.name}", one.metadata
            where = [name for name in ENVIRONMENTS
                     if {key, part.name + ".*"} & set(getattr(envs, name).randomized)]
            limit = ", ".join(f"`{n}`" for n in about["names"]) or f"{number(about['low'])}..{number(about['high'])}"
            rows.append((f"`{key}`", limit, about["meaning"] + (f"; {about['unit']}" if about["unit"] else ""), ", ".join(where)))
    return table(("key", "range", "meaning; unit", "environments"), rows) + (
        "`light` and `weather` change colours: they need `colour`. `calibration` changes scans and depth pictures.\n\n")


def make_page():
    from rubble import envs
    page = HEAD
    for name in ENVIRONMENTS:
        environment = getattr(envs, name)
        colour = "colour" in inspect.signature(environment.__init__).parameters
        page += section_of(environment, {"colour": True} if colour else {})
    page += RANDOMIZATION + randomization_table(envs) + BATCH
    return page.rstrip("\n") + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: environments_page.py FILE")
    text = make_page()
    with open(sys.argv[1], "w") as file:
        file.write(text)
