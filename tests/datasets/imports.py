#!/usr/bin/env python3
"""Files of other programs as plans and packs: imports.py PROGRAM FOLDER. Exit code 77: no package index can be reached."""
import os
import subprocess
import sys
from pathlib import Path

from read_datasets import HERE, SKIPPED, prepare_readers


def main():
    program, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    python = prepare_readers(folder, "requirements-imports.txt")
    if python is None:
        print("skipped: the packages of tests/datasets/requirements-imports.txt cannot be installed here")
        return SKIPPED
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    return max(subprocess.run([python, HERE / script, program, folder / Path(script).stem], check=False, env=environment).returncode
               for script in ("plans.py", "packs.py", "damage.py"))


if __name__ == "__main__":
    sys.exit(main())
