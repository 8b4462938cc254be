#!/usr/bin/env python3
"""Reads what `rubble run` records by the programs that users have: read_datasets.py PROGRAM FOLDER [CHECK...]

Records missions into FOLDER/data and compares what the readers of requirements.txt, installed into FOLDER/readers, say of
each format with the tables of the folders `frames`, `pcd` and `sensors`. Exit code 77: no package index can be reached.
CHECK: names of checks, such as `coco`; usually all.
"""
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
SKIPPED = 77

CAMERA = """
  seed = 2, start_ns = 1700000000000000000,
  pile = { layers = 1, pieces_per_layer = 20, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 3, 3, 3 } },
  trajectory = { rate_hz = 10, waypoints = {
    { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
    { t = 0.2, position = { -3.8, -0.4, 2.1 }, look_at = { 0, 0, 0.3 } },
    { t = 0.5, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } } } },
"""
MISSIONS = {
    "single": CAMERA + """
  camera = { width = 160, height = 120, channels = { "normals", "instance", "label", "flow" } },
  imu = { on = true }, lidars = { top = { model = "vlp16", position = { 0, 0, 0.15 } } },
  range_finders = { sonar = {} }, barometers = { height = {} }, magnetometers = { compass = {} }, gnss = { gps = {} },
  attitudes = { level = {} },
  outputs = { mcap = true, tum = true, colmap = true, frames = true, pcd = true, kitti_odometry = true, nerfstudio = true,
    coco = true, webdataset = true, lerobot = true, depth = "32FC1" },
""",
    "rig": CAMERA + """
  cameras = { front = { width = 160, height = 120, fov_deg = 70, stereo_baseline = 0.12 },
    left = { width = 100, height = 80, position = { 0.1, 0.2, 0 }, rpy_deg = { 0, 0, 90 }, rate_hz = 5 } },
  outputs = { mcap = true, bag = false, rawlog = false, simplemap = false, colmap = true, frames = true, nerfstudio = true },
""",
    "robot": """
  seed = 3, pile = { layers = 1, pieces_per_layer = 5, spawn_position = { 4, 0, 1 } },
  camera = { width = 96, height = 64, channels = { "normals" } }, robots = { { name = "crawler", model = "crawler", drive = { { t = 0, linear = 0.3 } } } },
  robot_run = { duration = 1 }, trajectory = { rate_hz = 10, ride = { robot = "crawler" } },
  outputs = { mcap = true, frames = true, lerobot = true, rawlog = false, simplemap = false, bag = false, vectors = "colours" },
""",
}


def prepare_readers(folder, locked="requirements.txt"):
    """The packages of a list of this folder in an environment of their own; None: they cannot be had here."""
    python = folder / "readers" / "bin" / "python"
    lock = (HERE / locked).read_text(encoding="ascii")
    stamp = folder / "readers" / "installed.txt"
    if stamp.exists() and stamp.read_text(encoding="ascii") == lock:
        return python
    shutil.rmtree(folder / "readers", ignore_errors=True)
    for command in ([sys.executable, "-m", "venv", folder / "readers"],
                    [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:",
                     "--requirement", HERE / locked]):
        if subprocess.run(command, check=False).returncode != 0:
            return None
    stamp.write_text(lock, encoding="ascii")
    return python


def record(program, data):
    shutil.rmtree(data, ignore_errors=True)
    data.mkdir(parents=True)
    for name, text in MISSIONS.items():
        script = data / (name + ".lua")
        script.write_text("return rubble.mission {" + text + "}\n", encoding="ascii")
        subprocess.run([program, "run", script, "--out", data / name, "--quiet"], check=True)


def disturbed(path, words_before, place):
    """The lines of a trajectory with errors of some centimetres, the same each time; place: columns of x, y, z."""
    lines = []
    for number, line in enumerate(path.read_text(encoding="ascii").splitlines()):
        words = line.split()
        if len(words) >= words_before and not line.startswith("#"):
            for axis, column in enumerate(place):
                words[column] = repr(float(words[column]) + 0.01 * ((7 * number + 3 * axis) % 11 - 5))
        lines.append(" ".join(words))
    return "\n".join(lines) + "\n"


def check_scripts(program, folder):
    """The schema of missions, and every mission of scripts/ with all keys; suites and parts of missions are no missions."""
    folder.mkdir()
    (folder / "schema.json").write_bytes(subprocess.run([program, "check", "--schema"], check=True, stdout=subprocess.PIPE).stdout)
    scripts = HERE.parents[1] / "scripts"
    for script in sorted(scripts.glob("**/*.lua")):
        if "rubble.mission" not in script.read_text(encoding="utf-8"):
            continue
        done = subprocess.run([program, "check", script.name], cwd=script.parent, check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            if "does not return a mission" not in done.stderr:
                raise SystemExit(f"rubble check {script}: {done.stderr}")
            continue
        (folder / ("_".join(script.relative_to(scripts).parts) + ".json")).write_text(done.stdout, encoding="utf-8")


def score(program, data):
    """What `rubble eval trajectory` says of a TUM and of a KITTI file, for evo to compare."""
    for name, file, columns, place in (("tum", "groundtruth.txt", 8, (1, 2, 3)), ("kitti", "kitti_odometry/poses/00.txt", 12, (3, 7, 11))):
        truth, estimate = data / "single" / file, data / ("estimate_" + name + ".txt")
        estimate.write_text(disturbed(truth, columns, place), encoding="ascii")
        done = subprocess.run([program, "eval", "trajectory", estimate, truth, "--json"], check=True, stdout=subprocess.PIPE)
        (data / ("score_" + name + ".json")).write_bytes(done.stdout)
    for ending in (".csv", ".parquet"):
        subprocess.run([program, "pieces", data / "single", "--out", data / ("pieces" + ending)], check=True)


def convert(python, program, data):
    """The dataset of BOP that rubble.bop makes of the images of a run; it refuses a lens, and a run without instances."""
    bop = [python, HERE.parents[1] / "python" / "rubble" / "bop.py"]
    subprocess.run([*bop, data / "single", "-o", data / "bop", "--program", program], check=True)
    refused = subprocess.run([*bop, data / "robot", "-o", data / "none", "--program", program], check=False, stderr=subprocess.PIPE, text=True)
    if refused.returncode != 1 or "has no instances" not in refused.stderr or (data / "none").exists():
        raise SystemExit("rubble.bop of a run without instances: " + refused.stderr)


def roll_out(program, data):
    """Episodes of environments, where the Python package is built beside the program."""
    package = program.parent / "python"
    if not (package / "rubble/_core.pyi").exists():
        print("no episodes of environments: the Python package is not built")
        return
    environment = dict(os.environ, PYTHONPATH=str(package), PYTHONDONTWRITEBYTECODE="1")
    subprocess.run(["/usr/bin/python3", HERE / "rollouts.py", data], check=True, env=environment)


def main():
    program, folder, wanted = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3:]
    folder.mkdir(parents=True, exist_ok=True)
    python = prepare_readers(folder)
    if python is None:
        print("skipped: the packages of tests/datasets/requirements.txt cannot be installed here")
        return SKIPPED
    record(program, folder / "data")
    check_scripts(program, folder / "data" / "missions")
    score(program, folder / "data")
    convert(python, program, folder / "data")
    roll_out(program, folder / "data")
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    return subprocess.run([python, HERE / "checks.py", folder / "data"] + wanted, check=False, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
