"""The program `rubble`, which a wheel has beside this file: the console script, run() and what batch() starts."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from typing import Any, NoReturn, Optional, Sequence, Union

from . import _core
from .mission_text import MissionText, Path, check_seed, path_text, started_with

_HERE = os.path.dirname(os.path.abspath(__file__))


def find_program() -> str:
    """The path of the program: $RUBBLE_PROGRAM, that of the wheel, that of the build, or the one in PATH."""
    places = [os.environ.get("RUBBLE_PROGRAM"), os.path.join(_HERE, "rubble"),
              os.path.normpath(os.path.join(_HERE, "..", "..", "rubble"))]
    for place in places:
        if place and os.path.isfile(place) and os.access(place, os.X_OK):
            return place
    found = shutil.which("rubble")
    if found and not _is_this_script(found):
        return found
    raise _core.RunError("the program `rubble` is not found: set RUBBLE_PROGRAM to its path")


def _is_this_script(path: str) -> bool:
    with open(path, "rb") as file:
        return file.read(2) == b"#!"


def main() -> NoReturn:
    """The console script `rubble`: becomes the program."""
    program = find_program()
    os.execv(program, ["rubble", *sys.argv[1:]])


def call(arguments: Sequence[str], folder: Optional[str] = None) -> int:
    """Runs the program in a working folder; returns 0, or 3 where a pile did not settle. Raises InputError for its exit code 1, RunError for
    others."""
    ran = subprocess.run([find_program(), *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace")
    if ran.returncode in (0, 3):
        return ran.returncode
    error = _core.InputError if ran.returncode == 1 else _core.RunError
    raise error((ran.stderr or ran.stdout).strip() or f"rubble {arguments[0]} ended with exit code {ran.returncode}")


def run(mission: Union[MissionText, Path], out: Path, seed: Optional[int] = None, overrides: Sequence[str] = (),
        assets: Sequence[Path] = (), threads: int = 0, settle: bool = False) -> dict[str, Any]:
    """Runs a mission as `rubble run` does, in a process of its own, and gives its manifest. settle: only its pile, as `rubble
    settle`."""
    out = path_text(out, "out")
    check_seed(mission, seed, overrides)
    with started_with(mission) as (folder, script):
        call(["settle" if settle else "run", script, "--out", os.path.abspath(out), "--quiet",
              *options(seed, overrides, assets, threads)], folder)
    with open(os.path.join(out, "manifest.json"), encoding="utf-8") as file:
        return json.load(file)


def options(seed: Optional[int], overrides: Sequence[str], assets: Sequence[Path], threads: int) -> list[str]:
    words = [] if seed is None else ["--seed", str(seed)]
    for flag, values in (("--set", _core._overrides(overrides)), ("--assets", _core._folders(assets))):
        for value in values:
            words += [flag, os.path.abspath(value) if flag == "--assets" else value]
    threads = _core._threads(threads)
    return words + (["--threads", str(threads)] if threads else [])
