"""The stages of the work, each done once: a stage whose folder has `STAGE.json` is not done again, and one
that was stopped starts afresh."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

import maps

HERE = pathlib.Path(__file__).resolve().parent
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MISSIONS = ROOT / "scripts" / "paper"
OUTPUTS = ["rawlog=false", "simplemap=false", "bag=false", "stl=false", "preview=false", "colmap=true"]


class Stages:
    """out: where everything goes. program: the built `rubble`. Shows what it runs on standard error."""

    def __init__(self, out, program, nice=0, log=sys.stderr):
        self.out, self.program, self.nice, self.log = pathlib.Path(out), str(program), nice, log

    def run(self, command, logfile, no_failure=None):
        """Runs a program whose output goes to logfile. A failure ends all, showing the end of the log, unless
        that has the words no_failure in it."""
        command = [str(word) for word in command]
        with open(logfile, "ab") as sink:
            environment = dict(os.environ, QT_QPA_PLATFORM="offscreen")
            code = subprocess.run(command, stdout=sink, stderr=subprocess.STDOUT, env=environment,
                                  preexec_fn=lambda: os.nice(self.nice)).returncode
        if code:
            tail = pathlib.Path(logfile).read_text(errors="replace")[-2000:]
            if no_failure and no_failure in tail:
                return
            raise SystemExit("%s\nfailed with %d; %s ends with\n%s" % (" ".join(command), code, logfile, tail))

    def once(self, folder, stage, work):
        """work() unless it was done before; its wall time is kept beside it. Returns that time; unit: s"""
        folder.mkdir(parents=True, exist_ok=True)
        mark = folder / (stage + ".json")
        if mark.exists():
            return json.loads(mark.read_text())["wall_s"]
        print("%s  %s: %s" % (time.strftime("%H:%M:%S"), folder.relative_to(self.out), stage),
              file=self.log, flush=True)
        start = time.monotonic()
        work()
        seconds = time.monotonic() - start
        part = folder / (stage + ".json.part")
        part.write_text(json.dumps({"stage": stage, "wall_s": round(seconds, 2)}))
        part.rename(mark)
        return seconds

    # Folders

    def pile(self, seed):
        return self.out / ("seed%d" % seed) / "pile"

    def dataset(self, seed, size, condition):
        return self.out / ("seed%d" % seed) / size / condition.dataset

    def sfm(self, seed, size, condition):
        name = "sfm_" + condition.images if condition.images else "sfm"
        return self.dataset(seed, size, condition) / name

    # Stages

    def settle(self, seed):
        def work():
            shutil.rmtree(self.pile(seed), ignore_errors=True)
            self.run([self.program, "settle", MISSIONS / "exterior.lua", "--seed", seed, "--out",
                      self.pile(seed), "--quiet"], self.out / ("seed%d" % seed) / "settle.log")

        return self.once(self.pile(seed).parent, "settled", work)

    def render(self, seed, size_name, size, condition):
        folder = self.dataset(seed, size_name, condition)

        def work():
            settings = ["outputs." + o for o in OUTPUTS] + list(size.settings) + list(condition.settings)
            shutil.rmtree(folder, ignore_errors=True)
            words = [word for setting in settings for word in ("--set", setting)]
            self.run([self.program, "render", self.pile(seed), "--mission",
                      MISSIONS / (condition.mission + ".lua"), "--out", folder, "--quiet"] + words,
                     folder.parent / (condition.dataset + ".log"))

        return self.once(folder.parent, condition.dataset + ".rendered", work)

    def images(self, seed, size_name, condition):
        """The folder with the pictures that COLMAP sees."""
        source = self.dataset(seed, size_name, condition) / "colmap" / "images"
        if not condition.images:
            return source
        folder = self.sfm(seed, size_name, condition)
        self.once(folder, "images", lambda: equalize(source, folder / "images"))
        return folder / "images"

    def features(self, folder, images, camera, size):
        def work():
            database = folder / "database.db"
            database.unlink(missing_ok=True)
            (folder / "matches.json").unlink(missing_ok=True)
            self.run(["colmap", "feature_extractor", "--database_path", database, "--image_path", images,
                      "--ImageReader.single_camera", 1, "--ImageReader.camera_model", "PINHOLE",
                      "--ImageReader.camera_params", camera, "--SiftExtraction.use_gpu", 0] + size.features,
                     folder / "colmap.log")

        return self.once(folder, "features", work)

    def matches(self, folder, size):
        return self.once(folder, "matches", lambda: self.run(
            ["colmap", "sequential_matcher", "--database_path", folder / "database.db",
             "--SiftMatching.use_gpu", 0] + size.matching, folder / "colmap.log"))

    def map(self, folder, images):
        def work():
            part = folder / "sparse"
            shutil.rmtree(part, ignore_errors=True)
            part.mkdir()
            # The camera is calibrated: its true intrinsics are given, and stay. To find no model is a result.
            self.run(["colmap", "mapper", "--database_path", folder / "database.db", "--image_path", images,
                      "--output_path", part, "--Mapper.ba_refine_focal_length", 0,
                      "--Mapper.ba_refine_extra_params", 0], folder / "colmap.log",
                     no_failure="failed to create sparse model")

        return self.once(folder, "map", work)

    def reconstruct(self, seed, size_name, size, condition):
        folder = self.sfm(seed, size_name, condition)
        folder.mkdir(parents=True, exist_ok=True)
        camera = camera_params(self.dataset(seed, size_name, condition))
        images = self.images(seed, size_name, condition)
        self.features(folder, images, camera, size)
        self.matches(folder, size)
        self.map(folder, images)

    def evaluate(self, seed, size_name, condition):
        """The score of `rubble eval sfm`, as a dictionary. Cheap enough to be done anew each time."""
        dataset = self.dataset(seed, size_name, condition)
        folder = self.sfm(seed, size_name, condition)
        if not any((folder / "sparse").iterdir()):  # COLMAP found no two images to begin with
            images = len(list((dataset / "colmap" / "images").glob("*.png")))
            counts = ["segments", "registered", "on_track", "on_track_percent", "points"]
            unknown = ["ate_rmse_m", "rpe_trans_rmse_m", "rpe_rot_rmse_deg", "reprojection_px", "within_1cm_percent",
                       "within_2cm_percent", "within_5cm_percent", "median_distance_m"]
            return dict({key: 0 for key in counts}, frames=images, completeness_5cm_percent=0,
                        **{key: None for key in unknown})
        score = folder / "score.json"
        self.run([self.program, "eval", "sfm", dataset, "--model", folder / "sparse", "--out", score,
                  "--details", folder / "details"], folder / "eval.log")
        return json.loads(score.read_text())["datasets"][0]

    # RGB-D consumers and surfaces

    def record(self, seed, condition):
        """A flight with all its frames, 640x640, as a bag and for MRPT. Returns its folder."""
        folder = self.out / ("seed%d" % seed) / ("slam_" + condition.name)
        settings = ["camera.width=640", "camera.height=640", "outputs.colmap=true", "outputs.stl=false",
                    "outputs.preview=false"]
        settings += condition.settings

        def work():
            shutil.rmtree(folder, ignore_errors=True)
            words = [word for setting in settings for word in ("--set", setting)]
            self.run([self.program, "render", self.pile(seed), "--mission",
                      MISSIONS / (condition.mission + ".lua"), "--out", folder, "--quiet"] + words,
                     folder.parent / (folder.name + ".log"))

        self.once(folder.parent, folder.name + ".recorded", work)
        return folder

    def odometry(self, seed, condition, method):
        folder = self.record(seed, condition)
        out = folder / "slam"
        log = folder / "slam.log"
        self.once(out, method + ".run", lambda: self.run(
            ["/usr/bin/python3", HERE / "slam.py", folder / "mission.bag", out, method], log))

        def score():
            track = subprocess.run([self.program, "eval", "trajectory", out / (method + ".txt"),
                                    folder / "groundtruth.txt", "--json"], check=True, stdout=subprocess.PIPE)
            (out / (method + ".track.json")).write_bytes(track.stdout)
            self.run([self.program, "eval", "surface", folder, out / (method + ".ply"), "--out",
                      out / (method + ".surface.json")], log)

        self.once(out, method + ".scored", score)

    def score_surface(self, dataset, mesh, title, align=()):
        stem = str(mesh)[:-len(".ply")]
        self.run([self.program, "eval", "surface", dataset, mesh, "--out", stem + ".score.json"] + list(align),
                 mesh.parent / "meshes.log")
        pathlib.Path(stem + ".title.json").write_text(json.dumps(title))

    def surfaces(self, seed, condition, size_name):
        """Meshes and points of the true depth, and of COLMAP's points where this COLMAP can."""
        folder, out = self.record(seed, condition), self.out / ("seed%d" % seed) / "meshes"
        log = out / "meshes.log"

        def fuse():
            self.run(["/usr/bin/python3", HERE / "meshes.py", folder / "mission.bag", out], log)
            self.run(["/usr/bin/python3", HERE / "mrpt.py", folder / "mission.simplemap", out / "mrpt_points.ply"], log)
            self.run(["colmap", "poisson_mesher", "--input_path", out / "fused_points.ply", "--output_path",
                      out / "fused_poisson.ply", "--PoissonMeshing.depth", 10, "--PoissonMeshing.trim", 8], log)

        def score():
            self.score_surface(folder, out / "fused_tsdf.ply", "true depth and poses, Open3D's volume of 2 cm")
            self.score_surface(folder, out / "fused_poisson.ply",
                               "the same points, `colmap poisson_mesher` (depth 10, trim 8)")
            self.score_surface(folder, out / "mrpt_points.ply",
                               "the simplemap's frames, points of MRPT's `observations2map` (2 cm apart)")
            for model in sorted((self.sfm(seed, size_name, condition) / "sparse").glob("[0-9]*"))[:1]:
                self.mesh_points(self.dataset(seed, size_name, condition), model, out)

        self.once(out, "fused", fuse)
        self.once(out, "scored", score)

    def map_scores(self, seed, condition):
        """`rubble eval map` of maps.MAPS against the flight with all its frames. {name: score}"""
        folder, out = self.record(seed, condition), self.out / ("seed%d" % seed) / "maps"
        scores = {}
        for name, _, pattern in maps.MAPS:
            for path in sorted(folder.parent.glob(pattern))[:1]:
                ply = out / (name + ".ply")
                score = out / (name + ".json")

                def work():
                    shutil.copyfile(path, ply)
                    self.run([self.program, "eval", "map", ply, folder, "--out", score, "--details", out / name,
                              "--quiet"], out / "maps.log")

                self.once(out, name + ".scored", work)
                scores[name] = json.loads(score.read_text())["datasets"][0]
        return scores

    def mesh_points(self, dataset, model, out):
        mesh = out / "sparse_delaunay.ply"
        run = subprocess.run(["colmap", "delaunay_mesher", "--input_type", "sparse", "--input_path", model,
                              "--output_path", mesh], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if not mesh.exists():  # Debian's COLMAP is built without CGAL
            print("no sparse mesh: " + run.stdout.strip(), file=self.log)
            return
        self.score_surface(dataset, mesh, "COLMAP's points, `delaunay_mesher --input_type sparse`",
                           ["--align", model])


def camera_params(dataset):
    """fx,fy,cx,cy as the dataset's own cameras.txt has them."""
    for line in (dataset / "colmap" / "sparse" / "cameras.txt").read_text().splitlines():
        words = line.split()
        if words and words[0] != "#":
            if words[1] != "PINHOLE":
                raise SystemExit("%s: expected a PINHOLE camera, found %s" % (dataset, words[1]))
            return ",".join(words[4:8])
    raise SystemExit("%s: no camera" % dataset)


def equalize(source, target):
    """Contrast-limited adaptive histogram equalization of the lightness (clip limit 3, 8 x 8 tiles)."""
    import cv2
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    clahe = cv2.createCLAHE(clipLimit=3.0, tileGridSize=(8, 8))
    for path in sorted(source.glob("*.png")):
        lab = cv2.cvtColor(cv2.imread(str(path)), cv2.COLOR_BGR2LAB)
        lab[:, :, 0] = clahe.apply(lab[:, :, 0])
        cv2.imwrite(str(target / path.name), cv2.cvtColor(lab, cv2.COLOR_LAB2BGR))
