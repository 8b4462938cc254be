"""Many runs of a mission on many machines: what `rubble batch` does, with the runs started by any pool of workers.

    with rubble.batch("mission.lua", range(1, 101), "s3://bucket/dataset", executor=dask_client) as batch:
        for name, future in batch.futures.items():
            print(name, future.result())

The folder is that of `rubble batch` (docs/how_to/batch.md): either of them continues what the other began.
"""
from __future__ import annotations

import csv
import os
import posixpath
import tempfile
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import Any, Iterable, Iterator, Mapping, Sequence, Union

from . import _core
from .arguments import whole
from .mission_text import MissionText, Path, check_seed, path_text, source_text, started_with
from .program import call, options

_FIXED = ("seed", "status", "state_hash", "bytes", "variant")


class RayExecutor(Executor):
    """Ray as an executor: batch(..., executor=RayExecutor()). options: those of ray.remote(), such as num_cpus."""

    def __init__(self, **options: Any) -> None:
        import ray  # type: ignore[import-not-found,unused-ignore]
        self._ray, self._options = ray, {"num_cpus": 1, **options}
        if not ray.is_initialized():
            ray.init()

    def submit(self, work: Any, /, *given: Any, **named: Any) -> Any:
        return self._ray.remote(**self._options)(work).remote(*given, **named).future()


class _Target:
    """The folder of a batch: of this machine, which the program writes itself, or of any file system that fsspec knows."""

    def __init__(self, out: str, storage: Mapping[str, Any]) -> None:
        self.out, self.storage = out, dict(storage)
        self.remote = "://" in out and not out.startswith("file://")
        self.path = os.path.abspath(out[len("file://"):] if out.startswith("file://") else out)
        if self.remote:
            try:
                import fsspec  # type: ignore[import-untyped,import-not-found,unused-ignore]
            except ImportError:
                raise _core.InputError(f"out: {out} needs fsspec: pip install fsspec, and for s3:// s3fs") from None
            self.fs, self.path = fsspec.core.url_to_fs(out, **self.storage)

    def of(self, *parts: str) -> str:
        return posixpath.join(self.path, *parts)

    def put_run(self, folder: str, name: str) -> None:
        """Sends the files of a run; the manifest comes last, as it says that all others are there."""
        files = sorted(os.path.relpath(os.path.join(at, one), folder) for at, _, names in os.walk(folder) for one in names)
        for file in sorted(files, key="manifest.json".__eq__):
            self.fs.put_file(os.path.join(folder, file), self.of(name, *file.split(os.sep)))

    @contextmanager
    def mirror(self) -> Iterator[str]:
        """A folder of this machine with what the table of runs is made of: the folder itself, or a copy without contents
        where only sizes count."""
        if not self.remote:
            yield self.path
            return
        with tempfile.TemporaryDirectory(prefix="rubble_batch_") as folder:
            self.fs.invalidate_cache()  # others write there
            found = self.fs.find(self.path, detail=True) if self.fs.exists(self.path) else {}
            for path, about in found.items():
                name = posixpath.relpath(path, self.fs._strip_protocol(self.path))
                there = os.path.join(folder, *name.split("/"))
                os.makedirs(os.path.dirname(there), exist_ok=True)
                if posixpath.basename(name) in ("manifest.json", "pile.bin", "batch.json") or name.startswith("failed/"):
                    self.fs.get_file(path, there)
                else:
                    with open(there, "wb") as file:
                        file.truncate(about["size"])
            yield folder


def _run_one(job: Mapping[str, Any]) -> str:
    """On a worker: one run of the batch. Returns "done" or "did_not_settle"; raises what the program says otherwise."""
    target, name = _Target(job["out"], job["storage"]), job["name"]
    log = target.of("failed", name + ".log")
    with tempfile.TemporaryDirectory(prefix="rubble_run_") as place, started_with(job["mission"]) as (at, script):
        folder = os.path.join(place, name) if target.remote else os.path.join(target.path, name)
        begun = os.path.exists(os.path.join(folder, "unfinished", "run.json"))
        words = (["resume", folder, *options(None, (), job["assets"], job["threads"])] if begun else
                 ["settle" if job["settle"] else "run", script, "--out", folder,
                  *options(job["seed"], job["overrides"], job["assets"], job["threads"])])
        try:
            code = call([*words, "--quiet"], at)
        except (_core.InputError, _core.RunError) as error:
            if target.remote:
                target.fs.pipe_file(log, str(error).encode())
            else:
                os.makedirs(os.path.dirname(log), exist_ok=True)
                with open(log, "w", encoding="utf-8") as file:
                    file.write(str(error))
            raise type(error)(f"{name}: {error}") from None
        if target.remote:
            target.put_run(folder, name)
            if target.fs.exists(log):
                target.fs.rm_file(log)
        elif os.path.exists(log):
            os.remove(log)
        return "did_not_settle" if code == 3 else "done"


class Batch:
    """A batch that is at work. futures: by the names of the runs, each with "done", "did_not_settle" or what went wrong; those
    that were there before have ended. result() waits for all and writes index.csv; leaving `with` does, too."""

    def __init__(self, arguments: Sequence[str], target: _Target, job: Mapping[str, Any], executor: Any) -> None:
        self._arguments, self._target, self._mission = list(arguments), target, job["mission"]
        self._own = None if executor is not None else ThreadPoolExecutor(os.cpu_count())
        # A client of Dask gives the result of an earlier call with the same arguments, unless it is told that there is more to a run.
        pool = self._own or (executor.get_executor(pure=False) if hasattr(executor, "get_executor") else executor)
        self.futures: dict[str, Future[str]] = {}
        for row in self._write_index():
            keys = [key for key in row if key not in _FIXED and key in job["keys"]]
            name = (f"v{row['variant']}_" if "variant" in row else "") + f"seed_{row['seed']}"
            if row["status"] in ("done", "did_not_settle"):
                future: Future[str] = Future()
                future.set_result(row["status"])
            else:
                one = {**job, "name": name, "seed": int(row["seed"]),
                       "overrides": [*job["overrides"], *(f"{key}={row[key]}" for key in keys)]}
                future = pool.submit(_run_one, one)
            self.futures[name] = future

    def _write_index(self) -> list[dict[str, str]]:
        with self._target.mirror() as folder, started_with(self._mission) as (at, script):
            call(["batch", script, *self._arguments, "--out", folder, "--index-only", "--quiet"], at)
            if self._target.remote:
                for name in ("batch.json", "index.csv"):
                    self._target.fs.put_file(os.path.join(folder, name), self._target.of(name))
            with open(os.path.join(folder, "index.csv"), newline="", encoding="utf-8") as table:
                return list(csv.DictReader(table))

    def result(self) -> list[dict[str, str]]:
        """The rows of index.csv, when all runs have ended. A run that failed has the status `failed`. Raises what a worker could
        not do besides: reach the target, or find the program."""
        wait(self.futures.values())
        rows = self._write_index()
        for future in self.futures.values():
            error = None if future.cancelled() else future.exception()
            if error is not None and not isinstance(error, (_core.InputError, _core.RunError)):
                raise error
        return rows

    def __enter__(self) -> "Batch":
        return self

    def __exit__(self, kind: Any, *_: Any) -> None:
        if kind is not None:
            for future in self.futures.values():
                future.cancel()
        self.result()
        if self._own:
            self._own.shutdown()


def batch(mission: Union[MissionText, Path], seeds: Union[str, Iterable[int]], out: Path, executor: Any = None,
          vary: Sequence[str] = (), samples: int = 0, overrides: Sequence[str] = (), assets: Sequence[Path] = (),
          threads: int = 1, settle: bool = False, storage_options: Mapping[str, Any] = {}) -> Batch:
    """Starts the runs that are not there yet. The arguments are those of `rubble batch`.

    seeds: numbers, or a text as "1..100". out: a folder that all workers see, or a target of fsspec ("s3://bucket/folder"), with
    storage_options. executor: what starts the runs: a client of Dask, a RayExecutor, or anything with submit(); None: processes
    of this machine. Workers need this package. A mission that is a file must be seen by them, one that is a text need not."""
    out, vary = path_text(out, "out"), _core._overrides(vary, "vary")
    overrides, assets = _core._overrides(overrides), _core._folders(assets)
    words = ["--seeds", seeds if isinstance(seeds, str) else ",".join(str(whole("seeds", seed, 0)) for seed in seeds)]
    for seed in words[1].split(","):
        check_seed(mission, None, [f"seed={seed}"])
    for text in vary:
        words += ["--vary", text]
    words += ["--samples", str(samples)] if samples else []
    words += ["--pile-only"] if settle else []
    job = {"mission": source_text(mission), "out": out, "storage": dict(storage_options), "settle": settle,
           "overrides": overrides, "assets": assets, "threads": _core._threads(threads),
           "keys": [text.split("=")[0] for text in vary]}
    return Batch([*words, *options(None, overrides, assets, 0)], _Target(out, storage_options), job, executor)
