#!/usr/bin/python3
"""run_pairs.py PROGRAM FOLDER [options]: runs the missions of the covering array, judges each, and prints what is covered.

What is done is kept in FOLDER/results.jsonl by the hashes of the program and the row: a later call goes on from there.
"""
import argparse
import concurrent.futures
import datetime
import hashlib
import json
import os
import resource
import shutil
import subprocess
import sys
import time
import traceback

sys.dont_write_bytecode = True
import afterwards
import covering_array
import judges_formats
import judges_geometry
import judges_motion
import judges_sensors
import judges_streams
import known_failures
import report
import rules
from dataset import Dataset, Finding
from factors import FACTORS
from missions import make_mission

JUDGES = judges_streams.JUDGES + judges_formats.JUDGES + judges_motion.JUDGES + judges_sensors.JUDGES + judges_geometry.JUDGES

# What the dozen of `make test` must have among them; the array completes each row and goes on from these.
DOZEN = [
    {"pile": "lean_to", "robots": "crawler", "path": "ride", "imu": "exact", "lidar": "utm30lx", "control": "senses",
     "rawlog": "actions", "ros2": "mcap", "afterwards": "info", "surroundings": "none", "quality": "fast", "sensors": "noisy"},
    {"pile": "spawned", "building": "bare", "cause": "removed", "fines": "few", "folders": "all", "afterwards": "pack",
     "surroundings": "none", "quality": "fast", "record_settling": "off"},
    {"pile": "placed", "cameras": "rig", "imu": "noisy", "lidar": "two", "scans": "both", "afterwards": "python",
     "surroundings": "none", "quality": "fast", "ros1": "bag", "robots": "none"},
    {"pile": "articulated", "record_settling": "all", "track": "on", "meshes": "all", "afterwards": "resume",
     "surroundings": "none", "quality": "fast", "sensors": "exact"},
    {"pile": "heap", "robots": "rover", "path": "links", "imu": "lever", "ros1": "metres", "ros2": "mcap", "afterwards": "nothing",
     "surroundings": "none", "quality": "fast", "sensors": "exact"},
    {"pile": "residential", "lens": "fisheye", "depth": "time_of_flight", "air": "smoke", "lamp": "ring", "afterwards": "view",
     "surroundings": "none", "quality": "draft", "robots": "none"},
    {"pile": "joined", "terrain": "function", "victims": "one", "path": "void", "afterwards": "nothing", "surroundings": "none",
     "quality": "fast"},
    {"pile": "culvert", "robots": "snake", "control": "function", "path": "spline", "ros1": "bag", "afterwards": "nothing",
     "surroundings": "none", "quality": "fast"},
    {"pile": "mix", "events": "on", "shutter": "rolling", "exposure": "automatic", "imu": "two", "afterwards": "remake",
     "surroundings": "none", "quality": "fast", "robots": "none"},
    {"pile": "pancake", "robots": "cart", "lidar": "vlp16", "scans": "pcd", "start": "today", "afterwards": "export",
     "surroundings": "none", "quality": "fast"},
    {"pile": "density", "lens": "calibrated", "cameras": "stereo", "depth": "ideal", "rawlog": "gzip", "afterwards": "nothing",
     "surroundings": "none", "quality": "fast", "record_settling": "off"},
    {"pile": "empty", "robots": "vine", "settle": "mars", "light": "sun", "afterwards": "verify", "surroundings": "none",
     "quality": "fast"},
]


def cpu():
    own, children = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


def hash_file(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def write_mission(row, seed, folder):
    os.makedirs(folder, exist_ok=True)
    source, files = make_mission(row, seed)
    for name, text in dict(files, **{"mission.lua": source}).items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    return os.path.join(folder, "mission.lua")


def run_row(program, number, row, work, python, keep):
    """The findings of one row: (judge, text) each, and processor seconds."""
    began, findings, commit = cpu(), [], None
    folder = os.path.join(work, "row_%03d" % number)
    shutil.rmtree(folder, ignore_errors=True)
    mission = write_mission(row, number + 1, folder)
    out = os.path.join(folder, "out")
    done = subprocess.run([program, "run", mission, "--out", out, "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode:
        findings.append(("run", "exit code %d: %s" % (done.returncode, done.stderr.strip().replace(folder + "/", "")[-400:])))
    else:
        ply = os.path.join(out, "pile.ply")
        if not os.path.exists(ply):
            exported = os.path.join(folder, "judge")
            subprocess.run([program, "export", out, "--format", "ply", "--out", exported, "--quiet"], capture_output=True, check=False)
            ply = os.path.join(exported, "pile.ply")
        data = Dataset(out, row, ply if os.path.exists(ply) else None)
        commit = data.manifest["program"]["commit"]
        for judge in JUDGES:
            try:
                judge(data)
            except Finding as finding:
                findings.append((judge.__name__, str(finding)))
            except Exception:  # a file that cannot be read is a finding, too
                findings.append((judge.__name__, traceback.format_exc(limit=-2)))
        tools = afterwards.Tools(program, mission, out, folder, number + 1, python)
        try:
            findings += afterwards.judge(tools, data, row["afterwards"])
        except Exception:
            findings.append(("afterwards:" + row["afterwards"], traceback.format_exc(limit=-2)))
    red = [item for item in findings if known_failures.find(row, *item) is None]
    if not keep and not red:
        shutil.rmtree(folder, ignore_errors=True)
    return {"row": number, "levels": row, "findings": findings, "commit": commit, "cpu": round(cpu() - began, 2)}


def refusal_row(pair):
    """A small mission with both levels, and with what gives them a meaning."""
    row = dict(pair)
    if row.get("control", "still") != "still" or row.get("debris") == "fixed" or row.get("lamp") == "robot":
        row.setdefault("robots", "rover")
    if row.get("cause", "none") != "none":
        row.setdefault("building", "bare")
    if row.get("control") == "senses" or row.get("scans", "none") != "none":
        row.setdefault("lidar", "utm30lx")
    return row


def run_refusal(program, number, pair, words, work):
    began = cpu()
    folder = os.path.join(work, "refused_%03d" % number)
    shutil.rmtree(folder, ignore_errors=True)
    mission = write_mission(refusal_row(pair), 1, folder)
    done = subprocess.run([program, "run", mission, "--out", os.path.join(folder, "out"), "--quiet"], capture_output=True, text=True,
                          check=False)
    text = done.stderr.replace("\n", " ")
    findings = []
    if done.returncode == 0:
        findings.append(("refusal", "is accepted, but was to be refused with `%s`" % words))
    elif words not in text or done.returncode != 1:
        findings.append(("refusal", "exit code %d, expected 1 and `%s`: %s" % (done.returncode, words, text[-300:])))
    shutil.rmtree(folder, ignore_errors=True)
    return {"refused": ["%s=%s" % item for item in pair], "words": words, "findings": findings, "cpu": round(cpu() - began, 2)}


def load_array(folder):
    """The rows, made once for the factors, rules and dozen as they are."""
    refused, meaningless = rules.expand(rules.REFUSED), rules.expand(rules.MEANINGLESS)
    names = {factor: list(levels) for factor, levels in FACTORS.items()}
    key = hashlib.sha256(json.dumps([names, list(refused), list(meaningless), DOZEN, hash_file(covering_array.__file__)]).encode()).hexdigest()
    path = os.path.join(folder, "array.json")
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            stored = json.load(file)
        if stored["key"] == key:
            return stored
    rows, implied = covering_array.make_array(FACTORS, list(refused) + list(meaningless), DOZEN)
    stored = {"key": key, "rows": rows, "implied": implied}
    with open(path + ".part", "w", encoding="utf-8") as file:
        json.dump(stored, file)
    os.replace(path + ".part", path)
    return stored


def dozen_rows():
    """The dozen, completed by the plainest levels."""
    plain = dict({factor: next(iter(levels)) for factor, levels in FACTORS.items()}, meshes="stl")
    return [dict(plain, **row) for row in DOZEN]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--seconds", type=float, default=7200, help="start no mission after this time (default: two hours)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--dozen", action="store_true", help="only the dozen missions of `make test`")
    parser.add_argument("--afresh", action="store_true", help="forget earlier results")
    parser.add_argument("--rows", help="only these rows, as in 3,17")
    parser.add_argument("--keep", action="store_true", help="keep the datasets of rows that pass, too")
    parser.add_argument("--python", help="the folder of the Python package")
    parser.add_argument("--report", help="write the tables of this document")
    arguments = parser.parse_args()
    program, folder = os.path.abspath(arguments.program), os.path.abspath(arguments.folder)
    os.makedirs(folder, exist_ok=True)
    os.environ["RUBBLE_THREADS"] = "1"
    os.environ.setdefault("RUBBLE_CACHE", os.path.join(folder, "cache"))
    if arguments.dozen:
        array = {"rows": dozen_rows(), "implied": []}
    else:
        array = load_array(folder)
    refusals = [] if arguments.dozen or arguments.rows else list(rules.expand(rules.REFUSED).items())
    chosen = [int(word) for word in arguments.rows.split(",")] if arguments.rows else range(len(array["rows"]))
    key = hash_file(program)
    results = read_results(os.path.join(folder, "results.jsonl"), key)
    began, started = time.monotonic(), cpu()
    tasks = [(" and ".join("%s=%s" % item for item in pair), run_refusal, (program, number, pair, words, folder), json.dumps([pair, words]))
              for number, (pair, words) in enumerate(refusals)]
    tasks += [("row %d" % number, run_row, (program, number, array["rows"][number], folder, arguments.python, arguments.keep),
              task_of(array["rows"][number], number + 1)) for number in chosen]
    if arguments.rows or arguments.afresh:
        results = {}
    todo = [task for task in tasks if task[3] not in results]
    print("%d missions and refusals, %d of them are done" % (len(tasks), len(tasks) - len(todo)), flush=True)
    with concurrent.futures.ProcessPoolExecutor(max_workers=arguments.jobs) as pool, \
            open(os.path.join(folder, "results.jsonl"), "a", encoding="utf-8") as kept:
        waiting = {}
        queue = iter(todo)
        more = True
        while more or waiting:
            while more and len(waiting) < arguments.jobs:
                task = next(queue, None)
                more = task is not None and time.monotonic() - began < arguments.seconds
                if more:
                    waiting[pool.submit(task[1], *task[2])] = task
            if not waiting:
                break
            ready, _ = concurrent.futures.wait(waiting, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in ready:
                task = waiting.pop(future)
                result = dict(future.result(), program=key, task=task[3])
                results[task[3]] = result
                kept.write(json.dumps(result) + "\n")
                kept.flush()
                say(task[0], result)
    answers = [results[task[3]] for task in tasks if task[3] in results]
    summary = report.count(array, answers, full=not arguments.dozen and not arguments.rows)
    print(report.in_words(summary))
    print("%.0f s of processor time in this call" % (cpu() - started))
    if arguments.report:
        report.write(arguments.report, summary, answers, program, datetime.date.today().isoformat())
    return 0 if summary["red"] == 0 and summary["left"] == 0 else 1


def task_of(row, seed):
    """What names a result: the mission and what is done with it."""
    return hashlib.sha256(json.dumps([make_mission(row, seed), row["afterwards"]]).encode()).hexdigest()


def read_results(path, key):
    results = {}
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            for line in file:
                result = json.loads(line)
                if result["program"] == key:
                    results[result["task"]] = result
    return results


def say(name, result):
    states = []
    for judge, text in result["findings"]:
        known = known_failures.find(result.get("levels", {}), judge, text)
        states.append("  known %s" % known if known else "  RED %s: %s" % (judge, text))
    print("%s: %s, %.1f s" % (name, "passes" if not any("RED" in state for state in states) else "fails", result["cpu"]))
    for state in states:
        print(state, flush=True)
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
