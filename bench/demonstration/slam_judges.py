"""SLAM systems that nobody here wrote, on recordings of the demonstration: ORB-SLAM3, and odometry by LiDAR. Each gives an estimate of
its own form, which becomes one table of all judges: stamp, map, pose of the optical frame (judge_orbslam3.py)."""
import json
import os
import pathlib
import re
import subprocess

import numpy as np

import carriers
import environments
import slam_plan
import slam_score
import work as stages

HERE = pathlib.Path(__file__).resolve().parent
REQUIREMENTS = HERE / "requirements-slam.txt"
PICTURES = stages.ROOT / "docs" / "pictures" / "gallery"  # of which the vocabulary of ORB-SLAM3 is made
# What is changed besides the defaults, which are those of a car in a street: KISS-ICP's voxels are a hundredth of the range, and
# RKO-LIO leaves out what is nearer than 1 m.
LIDAR_SETTINGS = {"kiss_icp_near": {"data": {"max_range": 20}}, "rko_lio_near": {"min_range": 0.3, "voxel_size": 0.2}}
ICP = ["{system}_pipeline", "{dataset}/mission.bag", "--topic", "/points", "--config", "{folder}/config.yaml"]
COMMANDS = {
    "kiss_icp": ICP, "genz_icp": ICP,
    "rko_lio": ["rko_lio", "{dataset}", "--config", "{folder}/config.yaml", "--dataloader", "rosbag", "--imu", "/imu", "--lidar", "/points",
                "--base_frame", "camera_link", "--log", "--log_dir", "{folder}/results"],
}
BASES = {"kiss_icp": slam_plan.LIDAR_IN_BODY, "genz_icp": slam_plan.LIDAR_IN_BODY, "rko_lio": (0, 0, 0)}  # in the body; unit: m
SCAN = 0.1  # time of a scan; unit: s
# From the stamp of a pose to the time that it is for: KISS-ICP corrects a scan to its end and gives the stamp of its first ray; GenZ-ICP
# corrects nothing; RKO-LIO gives that of the end. unit: s
POSE_AFTER = {"kiss_icp": SCAN, "genz_icp": SCAN / 2, "rko_lio": 0.0}
CRASHED = (134, 136, 139, -6, -8, -11)


def run_in(python, arguments, log, limit, extra=None):
    """Gives the exit code; None: it did not end within the limit in seconds."""
    with open(log, "ab") as sink:
        try:
            return subprocess.run([str(python)] + [str(a) for a in arguments], stdout=sink, stderr=subprocess.STDOUT, timeout=limit,
                                  env=dict(os.environ, OMP_NUM_THREADS="2", **(extra or {}))).returncode
        except subprocess.TimeoutExpired:
            return None


def system_of(judge):
    return "_".join(judge.name.split("_")[:2])


def found_poses(folder):
    return sorted((folder / "results").glob("**/*_tum.txt"))


def read_stamps(dataset):
    """Of all pictures, as texts."""
    return [line.split()[0] for line in (dataset / "groundtruth.txt").read_text().splitlines() if line[0] != "#"]


def fail(command, code, log):
    tail = pathlib.Path(log).read_text(errors="replace")[-2000:]
    raise SystemExit("%s failed with %s; %s ends with\n%s" % (command, code, log, tail))


def write_estimate(path, rows):
    """rows: stamp, and seven values of a pose of the optical frame, all of one map."""
    path.write_text("".join("%.9f,0,%s\n" % (row[0], ",".join("%.9f" % v for v in row[1:])) for row in rows))


def optical_rows(rows, offset):
    """Of a frame with the axes of the camera's body, which is `offset` from it: poses of the optical frame."""
    found = []
    for row in rows:
        turn = carriers.matrix(row[4:8] / np.linalg.norm(row[4:8]))
        position = row[1:4] - turn @ np.asarray(offset, float)
        found.append([row[0], *position, *carriers.quaternion(turn @ carriers.BODY_FROM_OPTICAL)])
    return found


def read_ape(text):
    """The root mean square of evo_ape's output; unit: m"""
    found = re.search(r"^\s*rmse\s+([0-9.eE+-]+)\s*$", text, re.MULTILINE)
    if not found:
        raise SystemExit("evo_ape: expected a line with rmse, found\n" + text[-500:])
    return float(found.group(1))


class SlamJudges:
    def __init__(self, work):
        self.work = work

    def python(self):
        return environments.environment(self.work.out / "venv-slam", REQUIREMENTS)

    def vocabulary(self):
        script, pictures = HERE / "orb_vocabulary.py", sorted(PICTURES.glob("*.jpg"))
        depends = {"script": stages.digest_file(script), "pictures": [stages.digest_file(p) for p in pictures],
                   "packages": REQUIREMENTS.read_text()}
        return self.work.stage("vocabulary", depends, lambda folder: self.work.run(
            [self.python(), script, folder / "orb.txt", *pictures], folder / "log.txt"), "of %d pictures" % len(pictures)) / "orb.txt"

    def depends(self, dataset_key, judge, number):
        depends = {"dataset": dataset_key, "judge": judge.name, "run": number, "packages": REQUIREMENTS.read_text()}
        if judge.kind == "lidar":
            return dict(depends, command=COMMANDS[system_of(judge)], settings=LIDAR_SETTINGS.get(judge.name, {}))
        return dict(depends, scripts=[stages.digest_file(HERE / name) for name in ("judge_orbslam3.py", "orb_vocabulary.py")])

    def depends_score(self, dataset_key, judge, number):
        return {"run": self.depends(dataset_key, judge, number), "scaled": judge.scaled, "base": BASES.get(system_of(judge)),
                "after": POSE_AFTER.get(system_of(judge)), "score": stages.digest_file(HERE / "slam_score.py")}

    def parts(self, judge, number):
        """What a result follows from besides the recording: for records.Records.depends()."""
        return [self.depends_score("", judge, number), [stages.digest_file(HERE / name) for name in ("carriers.py", "carrier.lua")]]

    def find(self, dataset_key, judge, number):
        """The result, where it is there already; else None."""
        path = self.work.out / "slam_score" / stages.digest("slam_score", self.depends_score(dataset_key, judge, number)) / "result.json"
        return json.loads(path.read_text()) if path.exists() else None

    def ran(self, dataset_key, judge, number):
        """Whether the system has seen the recording already."""
        return (self.work.out / "slam" / stages.digest("slam", self.depends(dataset_key, judge, number)) / "done.json").exists()

    def judge(self, seed, row, dataset, judge, number, deepest):
        """deepest: as of matches.measure()."""
        what = "seed %d, %s, %s, run %d" % (seed, row.name, judge.name, number)
        key = dataset.parent.name
        run = self.work.stage("slam", self.depends(key, judge, number), lambda folder: (
            self.lidar if judge.kind == "lidar" else self.orbslam3)(folder, dataset, judge), what)
        folder = self.work.stage("slam_score", self.depends_score(key, judge, number),
                                 lambda folder: self.score(folder, run, dataset, judge, deepest), what)
        return json.loads((folder / "result.json").read_text())

    def settings(self, dataset):
        path = dataset / "settings" / "orbslam3.yaml"
        if not path.exists():
            self.work.run([self.work.program, "pack", dataset, "--settings"], dataset.parent / "pack.txt")
        return path

    def orbslam3(self, folder, dataset, judge):
        out, stamps = folder / "estimate.csv", read_stamps(dataset)
        code = run_in(self.python(), [HERE / "judge_orbslam3.py", dataset, self.settings(dataset), self.vocabulary(),
                                      judge.name.split("_", 1)[1], out], folder / "log.txt", 1800)
        if code not in (0, None, *CRASHED):
            fail("judge_orbslam3.py", code, folder / "log.txt")
        note = ""
        if code != 0:  # what it did not live to see has no pose
            seen = out.read_text().splitlines() if out.exists() else []
            out.write_text("".join(line + "\n" for line in seen + ["%s,,,,,,,," % s for s in stamps[len(seen):]]))
            note = "ended at picture %d (%s)" % (len(seen), "no answer" if code is None else "signal %d" % abs(code))
        (folder / "note.txt").write_text(note)

    def lidar(self, folder, dataset, judge):
        system, log = system_of(judge), folder / "log.txt"
        (folder / "config.yaml").write_text(json.dumps(LIDAR_SETTINGS.get(judge.name, {})))  # JSON is YAML
        program, *words = [word.format(system=system, dataset=dataset, folder=folder) for word in COMMANDS[system]]
        python = self.python()
        code = run_in(python, [python.parent / program, *words], log, 1800, {system + "_out_dir": str(folder / "results")})
        if code != 0 or not found_poses(folder):
            fail(system, code, log)
        (folder / "note.txt").write_text("")

    def score(self, folder, run, dataset, judge, deepest):
        if judge.kind == "lidar":
            rows = np.atleast_2d(np.loadtxt(found_poses(run)[0]))
            rows[:, 0] += POSE_AFTER[system_of(judge)]
            write_estimate(folder / "estimate.csv", optical_rows(rows, BASES[system_of(judge)]))
        estimate = slam_score.read_estimate((folder if judge.kind == "lidar" else run) / "estimate.csv")
        truth = slam_score.true_poses(dataset / "groundtruth.txt", estimate[0])
        measured = slam_score.measure(estimate, truth, judge.scaled)
        into = carriers.metres_into(truth[0], deepest) if deepest is not None else None
        result = slam_score.summary(estimate, measured, into)
        result.update(self.evo(folder, estimate, truth, judge.scaled), note=(run / "note.txt").read_text())
        frames = {"into": None if into is None else [round(float(v), 3) for v in into], **measured}
        (folder / "result.json").write_text(json.dumps({"summary": result, "frames": frames}))

    def evo(self, folder, estimate, truth, scaled):
        """The position error of all maps, each aligned on its own, by evo."""
        stamps, maps, positions, rotations = estimate
        squares = count = 0
        for number in sorted(set(maps) - {-1}):
            own = np.flatnonzero(maps == number)
            if len(own) < 3:
                continue
            files = []
            for name, (p, r) in (("true", truth), ("found", (positions, rotations))):
                files.append(folder / ("map_%d_%s.txt" % (number, name)))
                files[-1].write_text("".join("%.9f %s\n" % (stamps[i], " ".join("%.9f" % v for v in [*p[i], *carriers.quaternion(r[i])]))
                                             for i in own))
            done = subprocess.run([self.python().parent / "evo_ape", "tum", *files, "--align"] + ["--correct_scale"] * scaled,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if done.returncode:
                if "egenerate" in done.stdout:  # a map whose pictures stand in one place
                    continue
                raise SystemExit("evo_ape failed with %d:\n%s" % (done.returncode, done.stdout[-1000:]))
            squares, count = squares + len(own) * read_ape(done.stdout)**2, count + len(own)
        return {"ate_rmse_m": (squares / count)**0.5 if count else None}
