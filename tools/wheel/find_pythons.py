#!/usr/bin/env python3
"""Prints the Pythons of this machine that wheels are made with: 3.11, and the oldest of those of the stable ABI (3.12 and newer).
Looked for in PATH and among those of pyenv; each with its headers.
"""
import glob
import os
import shutil
import subprocess

OLDEST = 11
_TELL = "import os, sys, sysconfig; print(sys.version_info[1], os.path.exists(sysconfig.get_path('include') + '/Python.h'))"


def find_pythons():
    """{minor version: path}, in order."""
    names = ["/usr/bin/python3", *(f"python3.{minor}" for minor in range(OLDEST, 20)),
             *sorted(glob.glob(os.path.expanduser("~/.pyenv/versions/3.*/bin/python3")))]
    found = {}
    for path in filter(None, map(shutil.which, names)):
        told = subprocess.run([path, "-c", _TELL], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout.split()
        if len(told) == 2 and told[1] == "True" and int(told[0]) >= OLDEST:
            found.setdefault(int(told[0]), path)
    return dict(sorted(found.items()))


def find_makers(pythons):
    """Those of them that make the wheels for all."""
    stable = [minor for minor in pythons if minor > OLDEST]
    return [pythons[minor] for minor in [OLDEST] * (OLDEST in pythons) + stable[:1]]


if __name__ == "__main__":
    print(*find_makers(find_pythons()))
