#!/usr/bin/env python3
"""Small settled piles in the simulators of others: judge_engines.py PROGRAM WORK [OPTION...]

Settles a mission of each pack and kind into WORK, exports it, reads it by every reader and simulates it by every engine that
the Python interpreters have (readers.py, engines.py). Prints a table of drifts. What is already in WORK is not made again.

  --seconds N        simulated time (default: 5)
  --python PATH      an interpreter with engines (repeatable; default: this one)
  --engines A,B      some of them alone
  --piles A,B        some of the piles alone
  --report FILE      write the table there as well
  --write DOCUMENT   write what it says of drift between the document's marks "engines"
  --limit N          seconds that one simulation may take (default: 600)

Exit code 1: a file was refused, or masses and places were not those of the pile.
"""
import argparse
import json
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "tools"))
from document_marks import write_between_marks  # noqa: E402

ENGINES = {"mujoco": "mujoco", "mujoco_drive": "mujoco", "drake": "pydrake", "pybullet": "pybullet", "newton": "newton", "rapier": "rapier3d",
           "usd": "pxr"}
READERS = {"pinocchio": "pinocchio", "trimesh": "trimesh, networkx, PIL", "gltf": "trimesh, networkx, PIL", "bullet_sdf": "pybullet"}

PACK = """return rubble.mission {{ seed = 5, packs = {{ "{pack}" }},
  pile = {{ layers = 2, pieces_per_layer = 20, spawn_position = {{ 0, 0, 3 }}, spawn_bounds = {{ 5, 5, 4 }} }},
  camera = {{ width = 64, height = 48 }}, {more} }}
"""
PILES = {pack: PACK.format(pack=pack, more="") for pack in ("concrete", "residential", "bridge", "parking")}
PILES["hinged_slabs"] = """return rubble.mission { seed = 12, camera = { width = 64, height = 48 },
  pile = { layers = 1, pieces_per_layer = 20, spawn_position = { 0, 0, 4 }, spawn_bounds = { 5, 5, 5 },
    mix = { { asset = "hinged_slab", weight = 2 }, { asset = "chunk_1" }, { asset = "cinder_block" } },
    placed = { { asset = "hinged_slab", position = { -1.5, 0, 2.2 }, fixed = true } } } }
"""
PILES["building"] = """return rubble.mission { seed = 3, packs = { "residential" }, camera = { width = 64, height = 48 },
  pile = rubble.building { storeys = 1, bays_x = 1, bays_y = 1, cause = { weak_storey = 0, weakness = 0.05 } } }
"""
PILES["fines"] = PACK.format(pack="concrete", more="fines = { amount = 200, drifts = 5, cables = 2, pipes = 1 }")
PILES["street"] = PACK.format(pack="concrete", more='surroundings = { type = "street" }')
PILES["hill"] = PACK.format(pack="concrete", more="").replace("pile = {", "pile = { terrain = { columns = 3, rows = 3, spacing = 5, "
                                                               "heights = { 0, 0, 0, 0, 1, 0, 0, 0, 0 } },")
# Every kind of bundled robot beside a pile; the rover drives into it.
PILES["robots"] = PACK.format(pack="concrete", more="""robots = {
    rubble.robot.rover { name = "rover", position = { -4.5, 0, 0.001 } },
    rubble.robot.snake { name = "snake", position = { -5, 2, 0.03 } },
    rubble.robot.crawler { name = "tank", position = { -5, -2, 0.001 } },
    rubble.robot.vine { name = "vine", position = { -5, 4, 0.001 } } },
  cameras = { front = { ride = { robot = "rover" }, position = { 0.22, 0, 0.25 }, width = 64, height = 48 } }""").replace(
      "camera = { width = 64, height = 48 }, ", "")

# Bricks and slabs; those that the rover meets are free, all others are fixed.
PILES["near"] = """return rubble.mission { seed = 6, packs = { "concrete" },
  pile = { layers = 3, pieces_per_layer = 50, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 5, 5, 3 },
    mix = { { asset = "half_brick", weight = 3 }, { asset = "brick", weight = 3 }, { asset = "slab_5" }, { asset = "cinder_block" } } },
  robots = { rubble.robot.rover { name = "rover", position = { -3.6, 0, 0.001 } } },
  cameras = { front = { ride = { robot = "rover" }, position = { 0.22, 0, 0.25 }, width = 64, height = 48 } } }
"""
DYNAMIC = {"near": "near=-2,0,1.5"}
DRIVEN = ("robots", "near")
# Of the document; what is missing here has the figures of another pile.
TITLES = {"concrete": "concrete", "residential": "residential", "parking": "parking", "bridge": "bridge", "hinged_slabs": "hinged slabs",
          "hill": "concrete on a hill", "street": "concrete in a street", "near": "bricks, `near`", "building": "fallen building"}
COLUMNS = {"mujoco": "MuJoCo", "drake": "Drake", "pybullet": "PyBullet", "newton": "Newton", "rapier": "Rapier"}


def run(*command, limit=3600):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=limit)


def make(program, work, name, script):
    folder, export = work / name, work / name / "export"
    if not (folder / "manifest.json").exists():
        (work / (name + ".lua")).write_text(script)
        done = run(program, "settle", work / (name + ".lua"), "--out", folder, "--force", "--quiet")
        if done.returncode:
            raise SystemExit(f"{name} does not settle: {done.stderr}")
    if not (export / "urdf").exists():
        done = run(program, "export", folder, "--format", "mjcf,sdf,usd,urdf,obj,glb", "--dynamic", DYNAMIC.get(name, "all"), "--force", "--quiet")
        if done.returncode:
            raise SystemExit(f"{name} is not exported: {done.stderr}")
        (work / (name + ".notes")).write_text(done.stderr)
    return export


def find_engines(interpreters):
    found = {}
    for engine, module in {**ENGINES, **READERS}.items():
        for python in interpreters:
            if run(python, "-I", "-c", f"import {module}").returncode == 0:
                found.setdefault(engine, python)
    return found


def row(pile, engine, result):
    if "errors" in result:
        text = "no error" if not result["errors"] else f"{len(result['errors'])} errors: {result['errors'][0]}"
        return f"|{pile}|{result['engine']}|{result.get('pieces', '')}|{text}{': ' + result['compared'] if 'compared' in result else ''}|||||"
    if "driven_m" in result:
        return f"|{pile}|{result['engine']}, {result['robot']}|{result['pieces']}|drives {result['driven_m']} m, meets {result['met']} pieces, climbs {result['climbed_m']} m|||||"
    if "failed" in result:
        return f"|{pile}|{engine}||{result['failed']}|||||"
    return (f"|{pile}|{result['engine']}|{result['pieces']}|{result['median_mm']}|{result['p90_mm']}|{result['max_mm']}|"
            f"{result['beyond_5_cm']}|{result['speed']}|")


def short(number):
    return f"{number:.1f}" if number < 10 else f"{number:.0f}"


def drift_table(results):
    """results: {(pile, engine): what the engine told}."""
    names = {engine: next((r["engine"] for (_, e), r in results.items() if e == engine and "engine" in r), title)
             for engine, title in COLUMNS.items()}
    lines = ["|pile|free pieces|" + "|".join(names.values()) + "|", "|---|---|" + "---|" * len(names)]
    for pile, title in TITLES.items():
        of = [results.get((pile, engine), {}) for engine in COLUMNS]
        cells = [f"{short(r['median_mm'])}, {r['max_mm']:.0f}; {r['beyond_5_cm']}" if "median_mm" in r else "" for r in of]
        pieces = next((str(r["pieces"]) for r in of if "pieces" in r), "")
        lines.append(f"|{title}|{pieces}|" + "|".join(cells) + "|")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("work", type=Path)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--python", action="append")
    parser.add_argument("--engines", default=",".join([*READERS, *ENGINES]))
    parser.add_argument("--piles", default=",".join(PILES))
    parser.add_argument("--report", type=Path)
    parser.add_argument("--write", metavar="DOCUMENT")
    parser.add_argument("--limit", type=int, default=600)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    interpreters = find_engines(options.python or [sys.executable])
    lines = ["|pile|engine|free pieces|median drift, mm|90 % below, mm|largest, mm|beyond 5 cm|speed|", "|---|---|---|---|---|---|---|---|"]
    wrong, results = False, {}
    for pile in options.piles.split(","):
        export = make(options.program, options.work.resolve(), pile, PILES[pile])
        for engine in options.engines.split(","):
            if engine not in interpreters or (engine == "mujoco_drive") > (pile in DRIVEN):
                continue
            try:
                words = [HERE / "readers.py", engine, export] if engine in READERS else [HERE / "engines.py", engine, export, options.seconds]
                done = run(interpreters[engine], *words, limit=options.limit)
                result = json.loads(done.stdout) if done.returncode == 0 else {
                    "failed": (done.stderr.strip().splitlines() or ["no reason given"])[-1][:200]}
            except subprocess.TimeoutExpired:
                result = {"failed": f"not done after {options.limit} s"}
            except json.JSONDecodeError:
                result = {"failed": "no result: " + done.stdout[-200:]}
            results[pile, engine] = result
            wrong = wrong or "failed" in result or bool(result.get("errors"))
            lines.append(row(pile, engine, result))
            print(lines[-1], flush=True)
    for engine in options.engines.split(","):
        if engine not in interpreters:
            print(f"skipped: {engine}: no interpreter has {({**ENGINES, **READERS})[engine]}")
    if options.report:
        options.report.write_text("\n".join(lines) + "\n")
    if options.write:
        write_between_marks(options.write, "engines", drift_table(results))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
