"""A wheel in a folder: its record fits its files, and it runs where it is unpacked, or as pip installs it."""
import base64
import csv
import hashlib
import importlib.util
import io
import os
import subprocess
import sys
import zipfile

folder = sys.argv[1]
wheel = os.path.join(folder, next(name for name in os.listdir(folder) if name.endswith(".whl")))
place = os.path.join(folder, "installed")
with zipfile.ZipFile(wheel) as archive:
    names = archive.namelist()
    record = next(name for name in names if name.endswith(".dist-info/RECORD"))
    rows = list(csv.reader(io.StringIO(archive.read(record).decode())))
    assert sorted(row[0] for row in rows) == sorted(names), "the record lists other files"
    points = next(name for name in names if name.endswith(".dist-info/entry_points.txt"))
    module, call = archive.read(points).decode().split(" = ")[1].strip().split(":")
    assert f"def {call}(" in archive.read(module + ".py").decode(), points
    for name, digest, size in rows:
        if name == record:
            continue
        data = archive.read(name)
        want = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        assert digest == "sha256=" + want and int(size) == len(data), name
    if importlib.util.find_spec("pip") is None:
        archive.extractall(place)
if importlib.util.find_spec("pip") is not None:
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target", place, wheel],
                   check=True)
environment = {name: value for name, value in os.environ.items() if not name.startswith("RUBBLE_")}
environment["PYTHONPATH"] = place
code = ("import rubble; assert rubble.__file__.startswith('%s'); "
        "print(len(rubble.settle('scripts/small.lua')), 'pieces')" % place)
print(subprocess.run([sys.executable, "-c", code], check=True, env=environment, stdout=subprocess.PIPE).stdout.decode())
