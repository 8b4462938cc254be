#!/usr/bin/env python3
"""Tries public robots, meshes and trajectories: run_files.py PROGRAM CACHE [OPTION...]

Compares what the program says of each file of robots.json, meshes.json and trajectories.json with the figures
that pinocchio, trimesh and evo computed. Packages are downloaded into CACHE; repositories are looked for in
$RUBBLE_FILES/OWNER/NAME. Results are kept in CACHE/results.json, by file and program: a second call goes on.

  --seconds N      start no new file after N seconds (default: 3600)
  --again          try again what was not as expected
  --lists FOLDER   the lists to use (default: those beside this file)
  --only WORD      only sources and paths that contain WORD
  --report FILE    write the table and every difference there as well (default: CACHE/report.md)

Prints a table and every difference. Exit code 1: there was one. Environment: JOBS, files at once, usually 2.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import re
import resource
import signal
import subprocess
import tempfile
import threading
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from sources import Sources, short_hash

HERE = Path(__file__).resolve().parent
KINDS = ("robots", "meshes", "trajectories")
MOST_CPU_SECONDS = 120  # for one file: the processor's time, whatever else runs
MOST_SECONDS = 1200
GOOD = ("as expected", "refused as expected")
ABSENT = ("not here", "other version")

# Of the largest number of a figure. Bounds of collision parts: what cylinders of 32 sides, spheres of 96
# corners and a decomposition take away.
TOLERANCES = {"mass_kg": 1e-5, "centre_of_mass_m": 1e-4, "inertia_kg_m2": 1e-4, "joints": 0,
              "collision_bounds_m": 0.03, "visual_bounds_m": 0.03,
              "size_m": 1e-4, "volume_m3": 1e-3, "closed": 0,
              "pairs": 0, "ate_rmse_se3_m": 1e-5, "ate_rmse_sim3_m": 1e-5, "rpe_trans_rmse_m": 1e-5,
              "rpe_rot_rmse_deg": 1e-5}
ZERO = {"centre_of_mass_m": 1e-5, "inertia_kg_m2": 1e-9, "collision_bounds_m": 1e-3, "visual_bounds_m": 1e-3,
        "ate_rmse_se3_m": 1e-8, "ate_rmse_sim3_m": 1e-8, "rpe_trans_rmse_m": 1e-8, "rpe_rot_rmse_deg": 1e-5}

# Files that are broken, though other programs take them, and a part of the message that says so.
REFUSED = json.loads((HERE / "refused.json").read_text())

MISSION = """return rubble.mission {{
  seed = 1, pile = {{ layers = 0 }}, robot_run = {{ duration = 0.1 }},
  robots = {{ {{ urdf = {path}, name = "r", position = {{ 0, 0, 5 }} }} }},
}}
"""
PACK = "return pack {{ name = \"tried\", assets = {{ {{ name = \"mesh\", mesh = {path} }} }} }}\n"


def lua_text(path):
    return '"' + "".join(c if c.isalnum() or c in "/._-+ " else "".join(f"\\x{b:02x}" for b in c.encode())
                         for c in str(path)) + '"'


def flat(value):
    return [x for part in value for x in flat(part)] if isinstance(value, list) else [value]


def differs(name, expected, found):
    expected, found = flat([expected]), flat([found])
    if None in found or len(expected) != len(found):
        return True
    if name.endswith("bounds_m"):
        scale = max(b - a for a, b in zip(expected[:3], expected[3:]))
    else:
        scale = max(abs(x) for x in expected)
    limit = TOLERANCES[name] * scale + ZERO.get(name, 0)
    return not all(abs(a - b) <= limit for a, b in zip(expected, found))


def brief(value):
    return ("yes" if value else "no") if isinstance(value, bool) else \
        " ".join("?" if x is None else f"{x:.6g}" for x in flat([value]))


def limit_cpu():
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_SECONDS, MOST_CPU_SECONDS + 5))


class Trial:
    """One file, its command, and what the program says of it."""

    def __init__(self, program, kind, entry, folder, work):
        self.program, self.kind, self.entry = program, kind, entry
        self.path, self.work, self.folder = folder / entry["path"], Path(work), folder

    def arguments(self):
        if self.kind == "robots":
            script = self.work / "m.lua"
            script.write_text(MISSION.format(path=lua_text(self.path.resolve())))
            return ["check", script, "--robots"]
        if self.kind == "meshes":
            (self.work / "pack.lua").write_text(PACK.format(path=lua_text(self.path.resolve())))
            return ["assets", "check", self.work, "--json"]
        return ["eval", "trajectory", self.path, self.folder / self.entry["truth"], "--json"]

    def found(self, printed):
        data = json.loads(printed)
        if self.kind == "robots":
            return {**data[0], "joints": sum(j["kind"] != "fixed" for j in data[0]["joints"])}, ""
        if self.kind == "meshes":
            return data["assets"][0], "; ".join(data["assets"][0]["errors"])
        return data, ""

    def run(self):
        """What the program said: "found", its figures; "refused", its message; or "failed" and a message."""
        try:
            done = subprocess.run([self.program, *map(str, self.arguments())], capture_output=True, text=True,
                                  errors="replace", timeout=MOST_SECONDS, cwd=self.work, preexec_fn=limit_cpu)
        except subprocess.TimeoutExpired:
            return {"failed": "too slow", "message": f"no result within {MOST_SECONDS} s"}
        if done.returncode == -signal.SIGXCPU:
            return {"failed": "too slow", "message": f"no result within {MOST_CPU_SECONDS} s of processor time"}
        message = "\n".join(line for line in done.stderr.splitlines() if line and not line.startswith("warning"))
        found = {}
        if done.stdout.startswith(("{", "[")):
            found, mistakes = self.found(done.stdout)
            message = mistakes or message
        message = message.replace(str(self.folder) + "/", "").replace(str(self.work), ".")[:2000]
        if done.returncode not in (0, 1):
            return {"failed": "crashed", "message": f"exit code {done.returncode}: {message}"}
        if done.returncode == 1:
            return {"refused": message}
        return {"found": {name: found.get(name) for name in (*TOLERANCES, "warnings")}}


def judge(entry, said):
    """(outcome, message) of what the program said of a file."""
    if "failed" in said:
        return said["failed"], said["message"]
    if "refused" in said:
        expected = ("has no mass" if entry.get("massless") else None,
                    "do not span a volume" if entry.get("flat") else None, REFUSED.get(entry["path"]))
        right = any(words and words in said["refused"] for words in expected)
        return ("refused as expected" if right else "refused"), said["refused"]
    found = said["found"]
    bad = [f"{name} {brief(found[name])}, expected {brief(entry[name])}" for name in TOLERANCES
           if name in entry and not is_free(entry, name, found) and differs(name, entry[name], found[name])]
    return ("differs", "; ".join(bad)) if bad else ("as expected", "")


def links_without_mass(path):
    root = ElementTree.parse(path).getroot()
    masses = {link.get("name"): link.find("inertial/mass") for link in root.findall("link")}
    return [name for name, mass in masses.items() if mass is None or not float(mass.get("value") or 0) > 0]


def as_asked(kind, entry, path):
    """The expected figures as the file asks for them, and the links of a robot without a mass, which has to get one. trimesh leaves to its caller the axis that a COLLADA file
    states, and to nobody the skins of a glTF file, whose vertices lie where their joints are."""
    if kind == "robots":
        return {**entry, "without_mass": links_without_mass(path)}
    suffix = path.suffix.lower()
    if kind == "meshes" and suffix == ".dae" and re.search(rb"<up_axis>\s*Y_UP\s*</up_axis>", path.read_bytes()):
        x, y, z = entry["size_m"]
        return {**entry, "size_m": [x, z, y]}
    if kind == "meshes" and suffix in (".glb", ".gltf") and re.search(rb'"skins"\s*:\s*\[\s*\{', path.read_bytes()):
        return {name: figure for name, figure in entry.items() if name not in ("size_m", "volume_m3")}
    return entry


def is_free(entry, name, found):
    """Figures that are not compared: the inertia in place of one that no body has and the mass of links without one,
    bounds without shapes of size 0, which need a warning each, and the volume of a mesh that is open for the program,
    which is that of its hull."""
    got_mass = re.findall(r"the link `([^`]*)` (?:moves and )?has no mass", "\n".join(found["warnings"] or ()))
    if name.endswith("bounds_m") and any("has a size of 0 and is left out" in w for w in found["warnings"] or ()):
        return True
    if name in ("mass_kg", "centre_of_mass_m", "inertia_kg_m2") and got_mass:
        return all(link in entry.get("without_mass", ()) for link in got_mass)
    if name == "inertia_kg_m2" and entry.get("impossible"):
        return any("inertia" in warning for warning in found["warnings"] or ())
    return name == "volume_m3" and not found["closed"]


class Results:
    def __init__(self, cache, program):
        self.file = Path(cache) / "results.json"
        self.all = json.loads(self.file.read_text()) if self.file.exists() else {}
        self.program = hashlib.sha256(Path(program).read_bytes()).hexdigest()[:16]
        self.lock = threading.Lock()

    def key(self, kind, entry):
        return f"{self.program} {kind} {entry['source']} {entry['path']} {entry['sha256']}"

    def add(self, key, result):
        with self.lock:
            self.all[key] = result
            partial = self.file.with_suffix(".partial")
            partial.write_text(json.dumps(self.all))
            partial.replace(self.file)


def try_file(program, kind, entry, folder):
    with tempfile.TemporaryDirectory(prefix="rubble_files_") as work:
        return Trial(program, kind, entry, folder, work).run()


def is_other_version(kind, entry, folder):
    files = [folder / entry["path"]] + ([folder / entry["truth"]] if kind == "trajectories" else [])
    return not all(f.is_file() for f in files) or "".join(map(short_hash, files)) != entry["sha256"]


def try_all(options, manifest, results):
    """[(kind, entry, outcome, message)]; outcome "" where time was up."""
    sources, end, tried = Sources(options.cache), time.monotonic() + options.seconds, []
    jobs = int(os.environ.get("JOBS", "2"))

    def one(job):
        kind, entry = job
        folder = sources.folder(entry["source"])
        if folder is None:
            return kind, entry, "not here", sources.missing[entry["source"]]
        if is_other_version(kind, entry, folder):
            return kind, entry, "other version", "the file is not the one of the manifest"
        key = results.key(kind, entry)
        expected = as_asked(kind, entry, folder / entry["path"])
        if key not in results.all or options.again and judge(expected, results.all[key])[0] not in GOOD:
            if time.monotonic() > end:
                return kind, entry, "", ""
            results.add(key, try_file(options.program, kind, entry, folder))
        return (kind, entry, *judge(expected, results.all[key]))

    for source in sorted({entry["source"] for _, entry in manifest}):  # one download at a time
        sources.folder(source)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for number, result in enumerate(pool.map(one, manifest), 1):
            tried.append(result)
            if number % 50 == 0:
                print(f"{number} of {len(manifest)}", flush=True)
    return tried, sources


def table_of(tried):
    lines = ["| | files | as expected | refused as expected | refused | differs | crashed | too slow |",
             "|---|---|---|---|---|---|---|---|"]
    for kind in KINDS:
        for place, is_here in (("packages", False), ("repositories", True)):
            outcomes = [o for k, e, o, _ in tried if k == kind and o and o not in ABSENT
                        and e["source"].startswith("repository:") == is_here]
            counts = [outcomes.count(o) for o in (*GOOD, "refused", "differs", "crashed", "too slow")]
            if outcomes:
                lines.append(f"| {kind} of {place} | {len(outcomes)} | " + " | ".join(map(str, counts)) + " |")
    return "\n".join(lines)


def details_of(tried):
    lines = []
    for kind, entry, outcome, message in tried:
        if outcome and outcome not in GOOD[:1] and outcome not in ABSENT:
            lines.append(f"{kind}: {outcome}: {entry['source']}: {entry['path']}\n    " +
                         "\n    ".join(line for line in message.strip().splitlines()[:6]))
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("cache")
    parser.add_argument("--seconds", type=float, default=3600)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--lists", type=Path, default=HERE)
    parser.add_argument("--only", default="")
    parser.add_argument("--report", default="")
    options = parser.parse_args()
    options.program = str(Path(options.program).resolve())
    Path(options.cache).mkdir(parents=True, exist_ok=True)
    manifest = [(kind, entry) for kind in KINDS for entry in json.loads((options.lists / f"{kind}.json").read_text())
                if options.only in entry["source"] + " " + entry["path"]]
    tried, sources = try_all(options, manifest, Results(options.cache, options.program))
    for source, reason in sorted(sources.missing.items()):
        print(f"not here: {source}: {reason}")
    outcomes = [outcome for _, _, outcome, _ in tried]
    if all(outcome in ABSENT for outcome in outcomes):
        print("SKIPPED: no file could be had: no package index answers, and RUBBLE_FILES names no repositories")
        return 0
    report = table_of(tried) + "\n\n" + details_of(tried) + "\n"
    Path(options.report or Path(options.cache) / "report.md").write_text(report)
    print(report)
    left = outcomes.count("")
    if left:
        print(f"{left} files are left: call again to go on")
    return 0 if all(o in GOOD + ABSENT + ("",) for o in outcomes) else 1


if __name__ == "__main__":
    raise SystemExit(main())
