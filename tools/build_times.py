#!/usr/bin/env python3
"""What a build costs: compiles every unit of a target again, alone and without a compiler cache, and
prints processor seconds by folder, by file, by third-party library and by header.

usage: tools/build_times.py [--build build/release] [--target rubble] [--jobs N] [--rows N]
                            [--sample N] [--headers N]
    --sample N: compiles every N-th unit only, and estimates the total from them
    --headers N: also compiles the N headers that most of these units read, each by itself, without
                 the precompiled one; 0 (default): none

Nothing in the build folder changes but precompiled headers, which must be there: build the target
first. Processor time depends less on what else the machine does than waiting, but not little: two busy
threads of one core take about 1.6 times as long each.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile


def units_of(build, target):
    """The objects that the target needs, by ninja, with their commands."""
    inputs = subprocess.run(["ninja", "-C", build, "-t", "inputs", target], check=True,
                            capture_output=True, text=True).stdout.split("\n")
    needed = {os.path.normpath(line) for line in inputs if line.endswith(".o")}
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        entries = json.load(file)
    units = {}
    for entry in entries:
        words = shlex.split(entry["command"])
        output = os.path.normpath(words[words.index("-o") + 1])
        if output in needed:
            units[output] = (entry["file"], words, entry["directory"])
    return list(units.values())


def name_of(file):
    """A source by its path; a unit of a room (RUBBLE_ROOMS) by its folder and how many sources it has."""
    if os.path.basename(os.path.dirname(file)) != "Unity":
        return os.path.relpath(file)
    with open(file, encoding="utf-8") as text:
        sources = re.findall(r'^#include "(.*)"', text.read(), re.MULTILINE)
    folder = os.path.commonpath([os.path.dirname(source) for source in sources])
    return os.path.join(os.path.relpath(folder), f"* ({len(sources)} sources)")


def compile_once(unit):
    """Processor seconds of one unit, and the headers that it reads."""
    file, words, folder = unit
    with tempfile.TemporaryDirectory() as scratch:
        words = list(words)
        if os.path.basename(words[0]) == "ccache":
            words = words[1:]
        words[words.index("-o") + 1] = os.path.join(scratch, "unit.o")
        words += ["-MD", "-MF", os.path.join(scratch, "unit.d")]
        with open(os.path.join(scratch, "mistakes"), "w+", encoding="utf-8") as mistakes:
            child = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=mistakes)
            _, status, usage = os.wait4(child.pid, 0)  # with the compiler that g++ starts
            child.returncode = os.waitstatus_to_exitcode(status)
            if child.returncode:
                mistakes.seek(0)
                sys.exit(file + ": does not compile\n" + mistakes.read())
        headers = ""
        if os.path.exists(os.path.join(scratch, "unit.d")):
            with open(os.path.join(scratch, "unit.d"), encoding="utf-8") as text:
                headers = text.read()
    return name_of(file), usage.ru_utime + usage.ru_stime, headers


def compile_header(header, unit):
    """Processor seconds of one header by itself, with the flags of a unit that reads it."""
    file, words, folder = unit
    with tempfile.TemporaryDirectory() as scratch:
        source = os.path.join(scratch, "header.cpp")
        with open(source, "w", encoding="utf-8") as text:
            text.write('#include "' + header + '"\n')
        words = [source if os.path.realpath(os.path.join(folder, w)) == os.path.realpath(file) else w
                 for w in words if os.path.basename(w) != "ccache" and w != "-Winvalid-pch"]
        while "-include" in words:
            at = words.index("-include")
            del words[at:at + 2]
        words[words.index("-o") + 1] = os.path.join(scratch, "header.o")
        child = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime if child.returncode == 0 else None


def list_headers(results, units):
    """Headers of ours and those that stand for libraries: (path, a unit that reads it, how many do)."""
    readers = collections.defaultdict(list)
    for unit, (_, _, text) in zip(units, results):
        for path in set(re.findall(r"[^\s\\]+\.(?:h|hpp)\b", text)):
            path = os.path.normpath(os.path.join(unit[2], path))
            ours = path.startswith(os.getcwd() + os.sep) and os.sep + "build" + os.sep not in path
            if ours or any(path.endswith("/" + header) for header in LIBRARIES.values()):
                readers[path].append(unit)
    return [(path, units[0], len(units)) for path, units in readers.items()]


# A header that stands for its library.
LIBRARIES = {"CLI11": "CLI/CLI.hpp", "nlohmann/json": "nlohmann/json.hpp", "OpenVDB": "openvdb/openvdb.h",
             "OpenCV": "opencv2/core.hpp", "MRPT": "mrpt/", "ROS 1": "ros/ros.h", "Simbody": "Simbody.h",
             "Eigen": "Eigen/", "assimp": "assimp/scene.h", "GoogleTest": "gtest/gtest.h",
             "SDL": "SDL.h", "Lua": "lua.hpp", "OpenEXR": "ImfHeader.h", "Embree": "embree3/rtcore.h"}


def print_table(title, rows, count):
    print(f"\n{title}")
    for name, units, seconds in sorted(rows, key=lambda row: -row[2])[:count]:
        print(f"  {seconds:8.1f} s  {units:4d}  {name}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--target", default="rubble")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--rows", type=int, default=25)
    parser.add_argument("--sample", type=int, default=1)
    parser.add_argument("--headers", type=int, default=0)
    options = parser.parse_args()
    whole = sorted(units_of(options.build, options.target))
    units = whole[::options.sample]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(compile_once, units))
    total = sum(seconds for _, seconds, _ in results)
    print(f"{options.target}: {len(results)} of {len(whole)} units, {total:.0f} s of processor time")
    if len(results) < len(whole):
        print(f"all of them: about {total / len(results) * len(whole):.0f} s")
    folders = collections.defaultdict(lambda: [0, 0.0])
    for file, seconds, _ in results:
        folder = os.path.dirname(file)
        folders[folder][0] += 1
        folders[folder][1] += seconds
    print_table("by folder: seconds, units", [(f, n, s) for f, (n, s) in folders.items()], options.rows)
    print_table("by file: seconds", [(f, 1, s) for f, s, _ in results], options.rows)
    rows = []
    for library, header in LIBRARIES.items():
        users = [s for _, s, text in results if re.search(r"[ /]" + re.escape(header), text)]
        if users:
            rows.append((library, len(users), sum(users)))
    print_table("by library: seconds of the units that include it, units", rows, options.rows)
    if not options.headers:
        return
    headers = sorted(list_headers(results, units), key=lambda row: -row[2])[:options.headers]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        costs = list(pool.map(lambda row: compile_header(row[0], row[1]), headers))
    print_table("by header: seconds of one by itself, units that read it",
                [(os.path.relpath(h), n, c) for (h, _, n), c in zip(headers, costs) if c is not None],
                options.rows)


if __name__ == "__main__":
    main()
