#!/usr/bin/env python3
"""The engines of others on small piles, each in an environment of its locked list: nightly.py PROGRAM WORK

Environments are made in WORK from requirements*.txt, and from that of tests/files, by pip. Exit code 77, which CTest takes as skipped: no index of packages
is reached. Otherwise that of judge_engines.py, on two piles and for one second.
"""
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def make_environment(requirements, folder):
    python = folder / "bin/python"
    if (folder / "complete").exists():
        return python
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    done = subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:", "-r", requirements],
                          capture_output=True, text=True)
    if done.returncode:
        print(f"{requirements.name}: no index of packages is reached, or it lacks one: {done.stderr.strip()[-300:]}")
        return None
    (folder / "complete").touch()
    return python


def main():
    program, work = sys.argv[1], Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    made = [make_environment(file, work / file.stem) for file in sorted(HERE.glob("requirements*.txt"))]
    made.append(make_environment(HERE.parent / "files/requirements.txt", work / "readers"))
    pythons = [python for python in made if python]
    if not pythons:
        return 77
    options = [part for python in pythons for part in ("--python", python)]
    return subprocess.run([sys.executable, HERE / "judge_engines.py", program, work, "--seconds", "1", "--piles", "concrete,hinged_slabs,robots,near",
                           *options]).returncode


if __name__ == "__main__":
    sys.exit(main())
