#!/usr/bin/env python3
"""Breaks a small run at many places and continues it: run_faults.py PROGRAM WORK [KILLS [SIZES]]

Each run is broken once: a call of one kind fails (the n-th, for every n up to 40 and then ever rarer),
the process is killed after a share of its time, half of the kills while frames are drawn, files may not
grow beyond a size, the process may not have more than so much memory, or the wall's clock jumps. What
is left is continued by `rubble resume` (by `run --force` where it was broken before anything could be resumed), and
must give the same files, byte for byte, as a run that nobody broke. Prints a table; exit code 1 when
anything went otherwise.
"""
import errno
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

MISSION = """return rubble.mission {
  seed = 3,
  pile = { layers = 2, pieces_per_layer = 8, mix = { { asset = "brick" } },
           spawn_position = { 0, 0, 1.5 }, spawn_bounds = { 1, 1, 1 } },
  camera = { width = 64, height = 48 },
  trajectory = { rate_hz = 100, waypoints = {
    { t = 0, position = { -1.5, 0, 0.8 }, look_at = { 0, 0, 0.1 } },
    { t = 0.2, position = { -1.4, 0.1, 0.8 }, look_at = { 0, 0, 0.1 } },
  } },
  outputs = { mcap = true, tum = true },
}
"""
CALLS = ("open", "write", "fsync", "close", "rename", "mkdir", "unlink")


class Machine:
    def __init__(self, program, work):
        self.program, self.work = program, Path(work).resolve()
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir(parents=True)
        self.script = self.work / "m.lua"
        self.script.write_text(MISSION)
        self.shim = self.work / "fault_shim.so"
        source = Path(__file__).with_name("fault_shim.c")
        subprocess.run(["cc", "-O1", "-fPIC", "-shared", "-o", self.shim, source, "-ldl"], check=True)
        self.problems = []
        self.in_frames = self.signals = 0  # kills while frames were drawn; ends by another signal
        start = time.monotonic()
        self.call(["run", self.script, "--out", self.work / "whole"])
        self.seconds = time.monotonic() - start
        self.expected = self.outputs(self.work / "whole")

    def call(self, arguments, environment=None, limit=None, memory=None, kill_after=None,
             kill_in_frames=None):
        """The exit code; that of a signal is negative, as subprocess has it.

        kill_in_frames: so many seconds after the first frame was noted.
        """
        def before():
            import resource
            if limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
            if memory is not None:
                resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        process = subprocess.Popen(
            [self.program, *map(str, arguments), "--quiet", "--checkpoint-every", "0"],
            env=dict(os.environ, **(environment or {})), preexec_fn=before,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
        if kill_in_frames is not None:
            while process.poll() is None and not self.frames_noted():
                time.sleep(0.002)
            time.sleep(kill_in_frames)
            self.in_frames += process.poll() is None
            process.kill()
        try:
            _, self.said = process.communicate(timeout=kill_after if kill_after else 600)
        except subprocess.TimeoutExpired:
            process.kill()
            _, self.said = process.communicate()
            if not kill_after:
                return "does not end"
        return process.returncode

    def frames_noted(self):
        try:
            return (self.work / "broken/unfinished/frames.txt").stat().st_size > 0
        except OSError:
            return False

    def measure_frames(self):
        """Seconds from the first frame noted to the end, of a run that nobody breaks."""
        out = self.work / "broken"
        shutil.rmtree(out, ignore_errors=True)
        process = subprocess.Popen([self.program, "run", self.script, "--out", out, "--quiet"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not self.frames_noted():
            time.sleep(0.002)
        start = time.monotonic()
        process.wait()
        return time.monotonic() - start

    def outputs(self, folder):
        try:
            return json.loads((folder / "manifest.json").read_text())["outputs"]
        except (OSError, ValueError):
            return None

    def broken(self, name, allowed, **how):
        """One run, broken; False: it went otherwise than it must."""
        out = self.work / "broken"
        shutil.rmtree(out, ignore_errors=True)
        code = self.call(["run", self.script, "--out", out], **how)
        if code < 0 and code != -signal.SIGKILL:
            self.signals += 1
        if code not in allowed:
            return self.problem(name, f"exit code {code}: {self.said[-300:]}")
        if list(out.glob("*.part")) and code >= 0:
            return self.problem(name, f"left {list(out.glob('*.part'))}")
        if self.outputs(out) is None or (out / "unfinished/run.json").exists():
            resumable = (out / "unfinished/run.json").exists()
            code = self.call(["resume", out] if resumable
                             else ["run", self.script, "--force", "--out", out])
            if code != 0:
                return self.problem(name, f"cannot be continued: {code}: {self.said[-300:]}")
        if self.outputs(out) != self.expected:
            return self.problem(name, "other files than an unbroken run")
        if self.call(["info", out]) not in (0, 1):  # 1: info has no --quiet
            return self.problem(name, "the files are not what the manifest says")
        return True

    def problem(self, name, what):
        self.problems.append(f"{name}: {what}")
        print("  PROBLEM", self.problems[-1], flush=True)
        return False

    def count_calls(self, call):
        count = self.work / "count"
        out = self.work / "counted"
        shutil.rmtree(out, ignore_errors=True)
        self.call(["run", self.script, "--out", out], self.fault(call, 0, count, out))
        return int(count.read_text())

    def fault(self, call, at, count, folder):
        error = errno.ENOSPC if call in ("write", "open", "mkdir") else errno.EIO
        return {"LD_PRELOAD": str(self.shim), "FAULT_CALL": call, "FAULT_AT": str(at),
                "FAULT_ERRNO": str(error), "FAULT_FOLDER": str(folder), "FAULT_COUNT": str(count)}


def places(count, most):
    """1, 2, 3, ... and, when that is more than `most`, evenly spread ones."""
    if count <= most:
        return list(range(1, count + 1))
    return sorted({1 + i * (count - 1) // (most - 1) for i in range(most)})


def main():
    machine = Machine(sys.argv[1], sys.argv[2])
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 200
    most = int(sys.argv[4]) if len(sys.argv) > 4 else 40
    print(f"an unbroken run takes {machine.seconds:.1f} s\n| fault | places | all continued to the "
          "same bytes |\n|---|---|---|", flush=True)

    def row(name, tries):
        good = sum(tries)
        print(f"| {name} | {len(tries)} | {'yes' if good == len(tries) else good} |", flush=True)

    row("killed, anywhere", [machine.broken(f"kill {i}", (0, -signal.SIGKILL),
                                            kill_after=machine.seconds * (i + 0.5) / (kills - kills // 2))
                             for i in range(kills - kills // 2)])
    lasting = machine.measure_frames()
    row("killed while frames are drawn",
        [machine.broken(f"kill in frames {i}", (0, -signal.SIGKILL),
                        kill_in_frames=lasting * 0.8 * i / (kills // 2)) for i in range(kills // 2)])
    print(f"  of these {machine.in_frames} before the run was done")
    out = machine.work / "broken"
    for call in CALLS:
        count = machine.count_calls(call)
        row(f"{call}() fails, each of {count}" if count <= most else f"{call}() fails, of {count}",
            [machine.broken(f"{call} {n}", (0, 2),
                            environment=machine.fault(call, n, machine.work / "count", out))
             for n in places(count, most)])
    sizes = [int(1024 * 1.5 ** i) for i in range(min(most, 20))]
    row(f"no file larger than 1 kB to {sizes[-1] // 1000} kB", [machine.broken(f"limit {s}", (0, 2), limit=s)
                                               for s in sizes])
    # Mesa may crash without memory; 127: the loader finds no room for a library.
    crashes = (0, 2, 127, -signal.SIGABRT, -signal.SIGSEGV, -signal.SIGBUS)
    row("at most 400 MB to 2.4 GB of memory",
        [machine.broken(f"memory {m}", crashes, memory=m << 20)
         for m in range(400, 2401, max(50, 2000 // most))])
    print(f"  of these {machine.signals} ended by a signal")
    count = machine.count_calls("clock")
    row(f"the clock jumps by a year, back or on, of {count} looks at it",
        [machine.broken(f"clock {n}", (0,), environment=dict(
            machine.fault("clock", n, machine.work / "count", out),
            FAULT_JUMP=str(31536000 * (-1) ** n))) for n in places(count, most)])
    print(f"{len(machine.problems)} problems")
    return 1 if machine.problems else 0


if __name__ == "__main__":
    sys.exit(main())
