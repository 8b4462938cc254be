#!/usr/bin/env python3
"""Writes the manifest: make_manifest.py CACHE [robots] [meshes] [trajectories] [closedness]

Chooses files of the sources in sources.txt by rules that know nothing of Rubble, and computes the expected
figures by pinocchio, trimesh and evo. Needs the packages of requirements.txt, and RUBBLE_FILES for the
repositories. A manifest is made once and then kept: it is the yardstick, so a file that Rubble cannot read
stays in it.

Robots: pinocchio reads the file, a joint moves, and all meshes are there. Of one folder two robots are taken,
and of robots with equal mass, centre of mass and joints the first. Meshes and trajectories: at most so many of
each source and format, in the order of a hash of their names. closedness: of the open meshes of meshes.json, computes
anew whether they are open, and chooses none.
"""
import hashlib
import json
import signal
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from sources import Sources, short_hash

HERE = Path(__file__).resolve().parent
MOST_SECONDS = 100  # for the figures of one file
MOST_BYTES = {"robot": 60e6, "mesh": 8e6}
ROBOTS_OF_SOURCE = {"pypi:example-robot-data": 30, "pypi:pybullet": 16, "pypi:mani-skill": 8,
                    "repository:Daniella1/urdf_files_dataset": 12, "repository:unitreerobotics/unitree_ros": 8}
ROBOTS_OF_OTHERS, ROBOTS_OF_FOLDER = 4, 2
MASSLESS = 8  # robots with a moving link without mass, which cannot be simulated
MESHES_OF_FORMAT = {"repository:mikedh/trimesh": 16, "repository:assimp/assimp": 16,
                    "repository:alecjacobson/common-3d-test-models": 8}
MESHES_OF_OTHERS = {"package": 4, "repository": 2}
TRAJECTORIES_OF_SOURCE = 45


def is_repository(source):
    return source.startswith("repository:")


def shuffled(paths, root):
    """Each time alike, and wherever `root` is."""
    return sorted(paths, key=lambda p: hashlib.sha256(str(p).replace(str(root), "").encode()).digest())


def with_limit(work, job):
    def stop(*_):
        raise TimeoutError()
    signal.signal(signal.SIGALRM, stop)
    signal.alarm(MOST_SECONDS)
    try:
        return work(job)
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}"[:200]}
    finally:
        signal.alarm(0)


def robot_work(job):
    from robot_figures import robot_figures
    return with_limit(robot_figures, job)


def mesh_work(job):
    from mesh_figures import Mesh
    return with_limit(lambda path: Mesh(path).figures(), job)


def trajectory_work(job):
    from trajectory_figures import trajectory_figures
    return with_limit(trajectory_figures, job)


class Manifest:
    def __init__(self, cache):
        self.sources = Sources(cache)
        self.known_file = Path(cache) / "figures.json"  # of files that were computed before, by their hash
        self.known = json.loads(self.known_file.read_text()) if self.known_file.exists() else {}
        self.names = (HERE / "sources.txt").read_text().split()

    def folders(self):
        for source in self.names:
            folder = self.sources.folder(source)
            if folder is None:
                print(f"{source}: {self.sources.missing[source]}")
            else:
                yield source, folder

    def compute(self, work, jobs):
        """(entry, figures) of each (entry, argument), in order; what takes too long or fails is left out."""
        new = [job for job in jobs if job[0]["sha256"] not in self.known]
        with ProcessPoolExecutor(2) as pool:
            for (entry, _), figures in zip(new, pool.map(work, [argument for _, argument in new])):
                self.known[entry["sha256"]] = figures
                if "TimeoutError" in figures.get("error", ""):
                    continue  # the machine may have been busy: tried again next time
                self.known_file.write_text(json.dumps(self.known))
        found = [(entry, self.known[entry["sha256"]]) for entry, _ in jobs]
        for entry, figures in found:
            if "error" in figures:
                print(f"left out: {entry['source']} {entry['path']}: {figures['error']}")
        return [(entry, figures) for entry, figures in found if "error" not in figures]

    def robots(self):
        from robot_figures import outline
        jobs, seen = [], set()
        for source, folder in self.folders():
            in_folder = Counter()
            for path in sorted(folder.rglob("*.urdf"), key=lambda p: (len(p.name), str(p))):
                digest = short_hash(path)
                if digest in seen or "random_urdfs" in path.parts or in_folder[path.parent] >= ROBOTS_OF_FOLDER:
                    continue
                seen.add(digest)
                read = outline(path)
                if read is None or sum(m.stat().st_size for m in read[1]) > MOST_BYTES["robot"]:
                    continue
                in_folder[path.parent] += 1
                jobs.append(({"source": source, "path": str(path.relative_to(folder)), "sha256": digest}, path))
        chosen, counts, alike = [], Counter(), set()
        for entry, figures in self.compute(robot_work, jobs):
            kind = "massless" if figures["massless"] else entry["source"]
            key = (figures["joints"], round(figures["mass_kg"], 3),
                   tuple(round(x, 3) for x in figures.get("centre_of_mass_m", ())))
            most = (MASSLESS if kind == "massless"
                    else ROBOTS_OF_SOURCE.get(kind.split("==")[0].split("@")[0], ROBOTS_OF_OTHERS))
            if key in alike or counts[kind] >= most:
                continue
            alike.add(key)
            counts[kind] += 1
            chosen.append({**entry, **figures})
        return chosen

    def meshes(self):
        from mesh_figures import SUFFIXES
        jobs, seen = [], set()
        for source, folder in self.folders():
            for suffix in SUFFIXES:
                most = MESHES_OF_FORMAT.get(source.split("@")[0],
                                            MESHES_OF_OTHERS["repository" if is_repository(source) else "package"])
                named = [p for p in folder.rglob("*") if p.suffix.lower() == suffix and p.is_file()]
                for path in shuffled(named, folder):
                    digest = short_hash(path)
                    if most == 0:
                        break
                    if digest in seen or path.stat().st_size > MOST_BYTES["mesh"]:
                        continue
                    seen.add(digest)
                    most -= 1
                    jobs.append(({"source": source, "path": str(path.relative_to(folder)), "sha256": digest}, path))
        return [{**entry, **figures} for entry, figures in self.compute(mesh_work, jobs)]

    def closedness(self):
        from mesh_figures import Mesh
        entries = json.loads((HERE / "meshes.json").read_text())
        for entry in entries:
            folder = self.sources.folder(entry["source"]) if entry.get("closed") is False else None
            if folder and "closed" not in Mesh(folder / entry["path"]).figures():
                del entry["closed"]
                print(f"closed but for cracks: {entry['source']}: {entry['path']}", flush=True)
        return entries

    def trajectories(self):
        from trajectory_figures import find_pairs
        jobs, seen = [], set()
        for source, folder in self.folders():
            for estimate, truth in shuffled(find_pairs(folder), folder)[:TRAJECTORIES_OF_SOURCE]:
                digest = short_hash(estimate) + short_hash(truth)
                if digest in seen:
                    continue
                seen.add(digest)
                jobs.append(({"source": source, "path": str(estimate.relative_to(folder)),
                              "truth": str(truth.relative_to(folder)), "sha256": digest}, (estimate, truth)))
        return [{**entry, **figures} for entry, figures in self.compute(trajectory_work, jobs)]


def main():
    manifest = Manifest(sys.argv[1])
    for kind in sys.argv[2:] or ("robots", "meshes", "trajectories"):
        entries = getattr(manifest, kind)()
        lines = ",\n".join(" " + json.dumps(entry) for entry in entries)
        (HERE / f"{'meshes' if kind == 'closedness' else kind}.json").write_text(f"[\n{lines}\n]\n")
        packages = sum(not is_repository(e["source"]) for e in entries)
        print(f"{kind}: {len(entries)}, {packages} of them from packages")


if __name__ == "__main__":
    main()
