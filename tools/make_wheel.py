#!/usr/bin/python3
"""Packs the Python package with its assets as a wheel (PEP 427), the same bytes each time.

usage: tools/make_wheel.py VERSION build/release/python/rubble build/release/assets FOLDER
"""
import base64
import hashlib
import os
import sys
import sysconfig
import zipfile

METADATA = """Metadata-Version: 2.1
Name: rubble
Version: {version}
Summary: Collapsed structures for robots that map and search: piles, sensors, robots and environments
License: BSD-3-Clause
Requires-Python: >=3.11
Requires-Dist: numpy

Simulates collapsed structures. The module links libraries of Debian 12: see docs/how_to/install.md and docs/reference/python.md.
"""
WHEEL = """Wheel-Version: 1.0
Generator: rubble
Root-Is-Purelib: false
Tag: {tag}
"""
ENTRY_POINTS = """[gymnasium.envs]
__root__ = rubble_gymnasium:register
"""


def files_below(folder, inside, endings):
    """(name in the wheel, path) of each file, sorted."""
    found = []
    for at, folders, names in os.walk(folder):
        folders[:] = sorted(f for f in folders if f not in ("__pycache__", "CMakeFiles"))
        for name in sorted(names):
            if name.endswith(endings):
                path = os.path.join(at, name)
                found.append((os.path.join(inside, os.path.relpath(path, folder)), path))
    return found


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    version, package, assets, out = sys.argv[1:]
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")
    info = f"rubble-{version}.dist-info"
    path = os.path.join(out, f"rubble-{version}-{tag}.whl")
    files = files_below(package, "rubble", (".py", ".pyi", ".so", "py.typed"))
    files.append(("rubble_gymnasium.py", os.path.join(os.path.dirname(package.rstrip("/")), "rubble_gymnasium.py")))
    files += files_below(assets, "rubble/assets", (".lua", ".obj", ".mtl"))
    records = []
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED) as wheel:
        def add(name, data):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            records.append(f"{name},sha256={digest},{len(data)}")

        for name, source in files:
            with open(source, "rb") as file:
                add(name, file.read())
        add(info + "/METADATA", METADATA.format(version=version).encode())
        add(info + "/WHEEL", WHEEL.format(tag=tag).encode())
        add(info + "/entry_points.txt", ENTRY_POINTS.encode())
        records.append(f"{info}/RECORD,,")
        add(info + "/RECORD", ("\n".join(records) + "\n").encode())
    os.replace(path + ".part", path)
    print(path)


if __name__ == "__main__":
    main()
