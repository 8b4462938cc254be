"""Structure from motion by programs that nobody here wrote, at their defaults: COLMAP 3.8 of Debian, and both mappers of
pycolmap 4.x in a virtual environment of its own. What they find is scored by `rubble eval sfm`."""
import functools
import json
import pathlib
import shutil
import subprocess

import colmap
import environments
import matches
import work as stages

HERE = pathlib.Path(__file__).resolve().parent
SCORES = ["frames", "segments", "registered", "on_track", "on_track_percent", "points", "ate_rmse_m", "within_5cm_percent",
          "completeness_5cm_percent"]


def camera_params(dataset):
    """The true intrinsics: fx,fy,cx,cy."""
    for line in (dataset / "colmap" / "sparse" / "cameras.txt").read_text().splitlines():
        words = line.split()
        if words and words[0] != "#":
            if words[1] != "PINHOLE":
                raise SystemExit("%s: expected a PINHOLE camera, found %s" % (dataset, words[1]))
            return ",".join(words[4:8])
    raise SystemExit("%s: no camera" % dataset)


class Judges:
    def __init__(self, work):
        self.work = work

    @functools.lru_cache(maxsize=None)
    def identity(self, judge):
        if judge == "colmap":
            text = subprocess.run(["colmap", "help"], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()[0]
            return [text.strip(), "defaults, sequential"]
        return [judge, (HERE / "requirements.txt").read_text(), (HERE / "judge_pycolmap.py").read_text()]

    def depends(self, dataset_key, row, judge, run=1):
        again = {"run": run} if run > 1 else {}
        return {"dataset": dataset_key, "calibrated": row.calibrated, "judge": self.identity(judge), **again}

    def python(self):
        return environments.environment(self.work.out / "venv", HERE / "requirements.txt")

    def matched(self, seed, row, dataset):
        """Features and matches of pycolmap, from which both of its mappers begin."""
        camera = camera_params(dataset) if row.calibrated else ""
        return self.work.stage("matched", self.depends(dataset.parent.name, row, "pycolmap"), lambda folder: self.work.run(
            [self.python(), HERE / "judge_pycolmap.py", "match", dataset / "colmap" / "images", folder, camera], folder / "log.txt"),
            "seed %d, %s" % (seed, row.name))

    def clear(self, dataset_key, row):
        """Deletes what only judges need."""
        shutil.rmtree(self.work.out / "matched" / stages.digest("matched", self.depends(dataset_key, row, "pycolmap")), ignore_errors=True)

    def find(self, dataset_key, row, judge, run=1):
        """The result, where it is there already; else None."""
        path = self.work.out / "judged" / stages.digest("judged", self.depends(dataset_key, row, judge, run)) / "result.json"
        return json.loads(path.read_text()) if path.exists() else None

    def judge(self, seed, row, dataset, judge, deepest, run=1):
        """deepest: as of matches.measure()."""
        def make(folder):
            images, log = dataset / "colmap" / "images", folder / "log.txt"
            camera = camera_params(dataset) if row.calibrated else ""
            if judge == "colmap":
                colmap.reconstruct(folder, images, camera, log, self.work.nice)
            else:
                shutil.copy(self.matched(seed, row, dataset) / "database.db", folder)
                self.work.run([self.python(), HERE / "judge_pycolmap.py", judge.split("_")[1], images, folder, camera], log)
            self.score(folder, dataset, log, deepest)
            (folder / "database.db").unlink()

        folder = self.work.stage("judged", self.depends(dataset.parent.name, row, judge, run), make,
                                 "seed %d, %s, %s, run %d" % (seed, row.name, judge, run))
        return json.loads((folder / "result.json").read_text())

    def score(self, folder, dataset, log, deepest):
        score = {key: 0 for key in SCORES}
        score["frames"] = len(list((dataset / "colmap" / "images").iterdir()))
        score["ate_rmse_m"] = score["within_5cm_percent"] = None
        if any((folder / "sparse").iterdir()):
            self.work.run([self.work.program, "eval", "sfm", dataset, "--model", folder / "sparse", "--out", folder / "score.json",
                           "--details", folder / "details"], log)
            found = json.loads((folder / "score.json").read_text())["datasets"][0]
            score = {key: found[key] for key in SCORES}
        result = {"score": score, "frames": matches.measure(folder, dataset, deepest)}
        (folder / "result.json").write_text(json.dumps(result, indent=1))
