"""What the classes of missions.py have in common: the text of a mission, in Lua, and the way back."""
from __future__ import annotations

import copy
import dataclasses
import difflib
import json
import math
import os
import re
import tempfile
from contextlib import contextmanager
from typing import Any, ClassVar, Iterator, Mapping, Optional, Sequence, Type, TypeVar, Union

from . import _core

_Table = TypeVar("_Table", bound="Keys")
Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
_WORDS = frozenset("and break do else elseif end false for function goto if in local nil not or repeat return then true until "
                   "while".split())


def _mistake(key: str, message: str, expected: str) -> _core.InputError:
    error = _core.InputError(f"{key}: {message}: expected {expected}")
    error.key = key
    error.diagnostics = [{"file": "", "line": 0, "key": key, "message": message, "expected": expected, "found": "", "hint": ""}]
    return error


def _lua_text(text: str) -> str:
    escaped = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\0": "\\000"}
    return '"' + "".join(escaped.get(c, c) for c in text) + '"'


def _lua_key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", key) and key not in _WORDS else f"[{_lua_text(key)}]"


def _lua(value: Any, key: str, indent: str) -> str:
    """The value in Lua; key: its place in the mission."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _lua_text(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise _mistake(key, f"{value} is not a finite number", "a finite number")
        return repr(value)
    if isinstance(value, Keys):
        value = value.given()
    deeper = indent + "  "
    if isinstance(value, Mapping):
        rows = [f"{_lua_key(str(name))} = {_lua(one, f'{key}.{name}' if key else str(name), deeper)}" for name, one in value.items()]
    elif isinstance(value, Sequence) or hasattr(value, "__iter__"):
        rows = [_lua(one, f"{key}[{i + 1}]", deeper) for i, one in enumerate(value)]
    else:
        raise _mistake(key, f"a {type(value).__name__} is no value of a mission", "a number, text, truth value, list, table or class of rubble.missions")
    short = "{ " + ", ".join(rows) + " }" if rows else "{}"
    if len(indent) + len(short) < 100 and "\n" not in short:
        return short
    return "{\n" + "".join(f"{deeper}{row},\n" for row in rows) + indent + "}"


class Keys:
    """A table of a mission. A key that is None is not given."""
    _parts: ClassVar[dict[str, tuple[str, Type["Keys"]]]] = {}

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_") and not hasattr(type(self), name):
            known = [f.name for f in dataclasses.fields(self)]  # type: ignore[arg-type]
            near = difflib.get_close_matches(name, known, 1)
            hint = f"; did you mean `{near[0]}`?" if near else ""
            raise AttributeError(f"{type(self).__name__} has no key `{name}`{hint}")
        super().__setattr__(name, value)

    def given(self) -> dict[str, Any]:
        """The keys that are given, by their names in Lua."""
        rows = ((f.name, getattr(self, f.name)) for f in dataclasses.fields(self))  # type: ignore[arg-type]
        return {name.rstrip("_"): value for name, value in rows if value is not None}

    @classmethod
    def from_dict(cls: Type[_Table], table: Mapping[str, Any]) -> _Table:
        """From a table as JSON has it. Raises InputError for a key that missions do not have."""
        known = {f.name.rstrip("_"): f.name for f in dataclasses.fields(cls)}  # type: ignore[arg-type]
        values = {}
        for key, value in table.items():
            if key not in known:
                raise _mistake(key, f"{cls.__name__} has no such key", "one of " + ", ".join(known))
            how, part = cls._parts.get(known[key], ("", Keys))
            if how == "list" and isinstance(value, list):
                value = [part.from_dict(one) if isinstance(one, dict) else one for one in value]
            elif how == "map" and isinstance(value, dict):
                value = {name: part.from_dict(one) if isinstance(one, dict) else one for name, one in value.items()}
            elif how == "one" and isinstance(value, dict):
                value = part.from_dict(value)
            values[known[key]] = value
        return cls(**values)


class MissionText(Keys):
    """What a mission can do besides holding its keys."""
    _drawn_seed: Optional[int] = None  # of a loaded script whose keys depend on its seed

    def to_lua(self) -> str:
        """The script of the mission, as Lua."""
        return "return rubble.mission " + _lua(self, "", "") + "\n"

    def check(self, overrides: Sequence[str] = ()) -> dict[str, Any]:
        """The complete scenario, with all defaults, as `rubble check` prints it. Raises InputError with all mistakes."""
        with script_of(self) as path:
            return json.loads(_core.check_mission(path, None, overrides))

    @classmethod
    def load(cls: Type[_Table], script: Path, overrides: Sequence[str] = ()) -> _Table:
        """The mission of a script: a file, or the text of one. All of its keys are given, also those that had their defaults,
        except those that nothing reads. The script is not run again: what it computed from its seed, such as numbers of
        rubble.random, stays. settle(), run() and batch() then refuse other seeds; with the script itself they take any."""
        with script_of(script) as path:
            whole = json.loads(_core.check_mission(path, None, overrides))
            drawn = _depends_on_seed(path, whole, overrides)
        mission = cls.from_dict(whole)
        if drawn:
            mission._drawn_seed = whole["seed"]  # type: ignore[attr-defined]
        return mission

    @classmethod
    def from_dict(cls: Type[_Table], table: Mapping[str, Any]) -> _Table:
        """From a table as JSON has it, such as check() returns. A default that nothing reads is left out. Raises InputError for
        a key that missions do not have."""
        table = _without_none(table)
        build = super().from_dict  # type: ignore[misc]
        try:
            return build(_without_idle(build, table))
        except _core.InputError:
            return build(table)


def _depends_on_seed(path: str, whole: Mapping[str, Any], overrides: Sequence[str]) -> bool:
    """Whether the script states other keys for another seed."""
    if any(text.startswith("seed=") for text in overrides):
        overrides = [text for text in overrides if not text.startswith("seed=")]
    try:
        other = json.loads(_core._scenario(path, whole["seed"] + 1 if whole["seed"] < 2**62 else 0, overrides)[0])
    except _core.InputError:
        return True
    return {**other, "seed": whole["seed"]} != whole


def _without_idle(build: Any, table: Mapping[str, Any]) -> Mapping[str, Any]:
    """The table of a mission without the keys that nothing reads, as far as they have their defaults."""
    with script_of(build(table)) as path:
        whole, idle = _core._scenario(path)

    def same(changed: Mapping[str, Any]) -> bool:
        with script_of(build(changed)) as path:
            return _core._scenario(path)[0] == whole

    pruned, removed = copy.deepcopy(dict(table)), []
    for key in idle:
        *way, last = [int(index) - 1 if index else name for name, index in re.findall(r"([^.\[\]]+)|\[(\d+)\]", key)]
        try:
            there: Any = pruned
            for part in way:
                there = there[part]
            removed.append((there, last, there.pop(last)))
        except (LookupError, TypeError, AttributeError):
            continue  # of another name for it
    if not same(pruned):
        for there, last, kept in removed:
            there[last] = kept
        for there, last, kept in removed:
            del there[last]
            if not same(pruned):
                there[last] = kept
    return pruned


def check_seed(mission: Any, seed: Optional[int], overrides: Sequence[str] = ()) -> None:
    """Raises InputError for another seed than that of a mission that its script computed from one."""
    drawn = mission._drawn_seed if isinstance(mission, MissionText) else None
    if drawn is None:
        return
    asked = [text[len("seed="):] for text in overrides if text.startswith("seed=")] + ([] if seed is None else [str(seed)])
    if any(text != str(drawn) for text in asked):
        raise _mistake("seed", "the script of this mission drew random numbers, and is not run again",
                       f"{drawn}, or the script itself instead of Mission.load(script)")


def _without_none(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_none(one) for key, one in value.items() if one is not None}
    return [_without_none(one) for one in value] if isinstance(value, list) else value


def path_text(path: Path, key: str) -> str:
    """The path as a text. Raises InputError for what is no path."""
    try:
        return os.fsdecode(path)
    except TypeError:
        raise _mistake(key, f"{path!r} is no path", "text, bytes or an os.PathLike") from None


def source_text(mission: Union[MissionText, Path]) -> str:
    """A mission as a text: a path, or a whole script."""
    return mission.to_lua() if isinstance(mission, MissionText) else path_text(mission, "mission")


@contextmanager
def started_with(mission: Union[MissionText, Path]) -> Iterator[tuple[Optional[str], str]]:
    """(working folder, script) for the program: of a file itself; of a text a temporary mission.lua, by its name alone, so that
    the provenance of equal texts is equal."""
    text = source_text(mission)
    if not isinstance(mission, MissionText) and "\n" not in text and "rubble.mission" not in text:
        yield None, text
        return
    with tempfile.TemporaryDirectory(prefix="rubble_mission_") as folder:
        with open(os.path.join(folder, "mission.lua"), "w", encoding="utf-8") as file:
            file.write(text)
        yield folder, "mission.lua"


@contextmanager
def script_of(mission: Union[MissionText, Path]) -> Iterator[str]:
    """The path of a script of the mission."""
    with started_with(mission) as (folder, script):
        yield os.path.join(folder or "", script)


def settle(mission: Union[MissionText, Path], seed: Optional[int] = None, overrides: Sequence[str] = (),
           threads: int = 0) -> _core.Pile:
    """Settles the pile of a mission: of an object, a file, or the text of a script. overrides: "key=value", as rubble run
    --set. seed: 0 to 2^63 - 1. threads: 0 to 256; 0: one per processor. Files that a text names are looked for in its temporary
    folder: name them by whole paths."""
    check_seed(mission, seed, overrides)
    with script_of(mission) as script:
        return _core.settle(script, seed, overrides, threads)
