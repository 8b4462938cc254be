"""Stages that are done once: each has a folder that is named by a hash of all it depends on. Several commands may share them."""
import contextlib
import fcntl
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MISSION = ROOT / "scripts" / "demonstration.lua"


class OutOfTime(Exception):
    pass


def digest(*parts):
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:16]


def digest_file(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


def run(command, log, nice=0, allowed=(0,)):
    """Runs a program whose output goes to log. Gives its exit code, one of `allowed`; any other ends all."""
    command = [str(word) for word in command]
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})  # until there is something to end

    def begin():
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
        os.nice(nice)

    with open(log, "ab") as sink:
        started = subprocess.Popen(command, stdout=sink, stderr=subprocess.STDOUT, preexec_fn=begin,
                                   env=dict(os.environ, QT_QPA_PLATFORM="offscreen"))
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
        code = started.wait()
    except BaseException:
        started.kill()
        started.wait()
        raise
    if code not in allowed:
        tail = pathlib.Path(log).read_text(errors="replace")[-2000:]
        raise SystemExit("%s\nfailed with %d; %s ends with\n%s" % (" ".join(command), code, log, tail))
    return code


@contextlib.contextmanager
def locked(path):
    """One command at a time is here. path: a folder, or a file that is made."""
    handle = os.open(path, os.O_RDONLY) if os.path.isdir(path) else os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print("waits for another command: %s" % path, file=sys.stderr, flush=True)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def stop(*_):
    raise SystemExit(143)  # on the way out, run() ends what it has started


class Work:
    """out: where everything goes. hours: no stage begins later than this."""

    def __init__(self, out, program, hours, nice=0):
        self.out, self.program, self.nice = pathlib.Path(out).resolve(), str(program), nice
        self.end = time.monotonic() + 3600 * hours
        self.out.mkdir(parents=True, exist_ok=True)
        self.identity = digest_file(program)
        signal.signal(signal.SIGTERM, stop)

    def stage(self, kind, depends, make, what):
        """The folder of the stage; make(folder) fills it unless that was done. depends: whatever the result follows from."""
        folder = self.out / kind / digest(kind, depends)
        if (folder / "done.json").exists():
            return folder
        folder.parent.mkdir(parents=True, exist_ok=True)
        with locked(folder.with_suffix(".lock")):
            return folder if (folder / "done.json").exists() else self.make_stage(folder, kind, depends, make, what)

    def make_stage(self, folder, kind, depends, make, what):
        if time.monotonic() > self.end:
            raise OutOfTime()
        print("%s  %s: %s" % (time.strftime("%H:%M:%S"), kind, what), file=sys.stderr, flush=True)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        begin = time.monotonic()
        make(folder)
        part = folder / "done.part"
        commit = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "HEAD"], stdout=subprocess.PIPE, text=True).stdout.strip()
        part.write_text(json.dumps({"what": what, "depends": depends, "commit": commit, "wall_s": round(time.monotonic() - begin, 1)}, indent=1))
        part.rename(folder / "done.json")
        return folder

    def run(self, command, log):
        run(command, log, self.nice)
